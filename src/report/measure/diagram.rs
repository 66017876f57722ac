//! The measured settings as a work-precision diagram.

use super::advice::USELESS;
use super::{Cost, Measured, Outcome, Setting, is_best};
use crate::raster::{Diagram, Sign, Spot};
use crate::record::plot::{Axis, Content, Curve, Plot, Sample};

/// Where the axis of errors ends. What failed stands in its last decade.
const END: f64 = 10.0;
/// The axis begins no farther than this from the smallest error, so that a floor far below does not push curves aside.
const MARGIN: f64 = 1e-2;

/// The diagram of what was measured of a scene called `name`.
pub fn diagram(measured: &Measured, name: &str) -> Diagram {
    let claim = measured.reference.as_ref().ok().map(super::Reference::claim);
    let mut methods: Vec<&'static str> = Vec::new();
    for setting in &measured.settings {
        if !methods.contains(&setting.method) {
            methods.push(setting.method);
        }
    }
    let least = measured.settings.iter().filter_map(|setting| measured.claimed(setting)).fold(USELESS, f64::min);
    let low = decade_below(claim.map_or(least, |claim| claim / 4.0).max(MARGIN * least));
    let mut spots = Vec::new();
    let mut curves = Vec::new();
    for (curve, method) in methods.iter().enumerate() {
        // Side by side: crosses of several methods at one cost are all seen.
        let failed = USELESS * libm::exp10((curve as f64 + 0.5) / methods.len() as f64);
        let own = || measured.settings.iter().filter(|setting| setting.method == *method);
        let points = own().filter_map(|setting| point(measured, setting, failed));
        spots.extend(points.clone().map(|(x, y, sign)| Spot { curve, x, y, sign }));
        // What failed has no place on the curve.
        let samples = points.filter(|(.., sign)| *sign != Sign::Cross);
        let samples = samples.enumerate().map(|(place, (x, y, _))| Sample { time: place as f64, x, y }).collect();
        let refused = own().any(|setting| matches!(setting.outcome, Outcome::Refused(_)));
        let label = if refused { format!("{method} (refused)") } else { (*method).to_owned() };
        curves.push(Curve { label, body: None, samples });
    }
    // Rings are seen above the dots of others.
    spots.sort_by_key(|spot| spot.sign == Sign::Best);
    let costs = spots.iter().map(|spot| spot.y);
    let (cheapest, dearest) = costs.fold((f64::INFINITY, 0.0_f64), |(low, high), y| (low.min(y), high.max(y)));
    let range = (cheapest <= dearest).then(|| (decade_below(cheapest), 1.0 / decade_below(1.0 / dearest)));
    let up = match measured.cost {
        Cost::Time => "seconds per second of physics",
        Cost::Evaluations => "evaluations of all forces per second of physics",
    };
    let until = measured.reference.as_ref().ok().filter(|reference| reference.until < measured.duration);
    let until = until.map_or_else(String::new, |reference| format!(", until t = {:.3} s", reference.until));
    let axis = |label: String, range| Axis { label, unit: String::new(), range, logarithmic: true };
    Diagram {
        plot: Plot {
            title: format!("{name}: cost against error"),
            across: axis(format!("error as a share of the motion{until}"), Some((low, END))),
            up: axis(up.to_owned(), range.or(Some((1e-6, 1.0)))),
            content: Content::Phases(curves, None),
        },
        aside: "ringed: nothing is more exact for less".to_owned(),
        spots,
        floor: claim.map(|claim| {
            let before = if claim <= low { "farther left: " } else { "" };
            (claim, format!("{before}what the reference leaves unknown, {claim:.0e}"))
        }),
        useless: (USELESS, "failed, or useless".to_owned()),
    }
}

/// Where a setting stands; one that is of no use stands at `failed`.
fn point(measured: &Measured, setting: &Setting, failed: f64) -> Option<(f64, f64, Sign)> {
    let cost = setting.cost(measured.cost).filter(|cost| *cost > 0.0)?;
    match setting.outcome {
        Outcome::Measured(_) => {
            let error = measured.claimed(setting)?;
            let sign = if is_best(measured, setting) { Sign::Best } else { Sign::Dot };
            Some(if error < USELESS { (error, cost, sign) } else { (failed, cost, Sign::Cross) })
        }
        Outcome::Failed(_) => Some((failed, cost, Sign::Cross)),
        Outcome::Unknown | Outcome::Refused(_) | Outcome::Stopped(_) => None,
    }
}

/// The power of ten that is no greater than a number.
fn decade_below(value: f64) -> f64 {
    format!("1e{}", libm::floor(libm::log10(value) + 1e-9) as i32).parse().unwrap_or(value)
}
