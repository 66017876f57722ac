//! Settings as a work-precision diagram: error to the right, cost upwards, both logarithmic, a curve for each course.

use super::{Cost, MethodChoice, Setting, SettingOutcome, Settings};
use jostle_engine::record::plot::{Axis, Content, Curve, Plot, Sample};
use jostle_film::raster::{Diagram, Look, Sign, Spot};

/// The greatest distance of the axis' beginning from the smallest error. So a floor far below does not push curves
/// aside.
const MARGIN: f64 = 1e-2;

/// The words of a diagram.
pub struct DiagramLegend {
    /// The title.
    pub title: String,
    /// The meaning of the error.
    pub error: String,
    /// The reason why smaller errors are unknown.
    pub floor: String,
    /// The error from which results are useless, and its label. Failed settings are in the decade above.
    pub useless: (f64, String),
}

/// A curve that was measured elsewhere.
#[derive(Clone, Debug, PartialEq)]
pub struct Peer {
    /// Its name.
    pub name: String,
    /// Error and cost, from coarse to fine.
    pub points: Vec<(f64, f64)>,
}

/// The diagram of settings, with the curves of others.
pub fn diagram(settings: &Settings, legend: DiagramLegend, peers: &[Peer]) -> Diagram {
    let (useless, claim) = (legend.useless.0, settings.claim);
    let courses = settings.courses();
    let least = settings.all.iter().filter_map(|setting| settings.claimed(setting)).fold(useless, f64::min);
    let low = decade_below(claim.map_or(least, |claim| claim / 4.0).max(MARGIN * least));
    let mut spots = Vec::new();
    let mut curves = Vec::new();
    let looks = looks(&courses).into_iter().chain((0..peers.len()).map(Look::Aside)).collect();
    for (curve, course) in courses.iter().enumerate() {
        // Side by side: crosses of several courses at one cost are all seen.
        let failed = useless * libm::exp10((curve as f64 + 0.5) / courses.len() as f64);
        let own = || settings.of(*course);
        let points: Vec<_> = own().filter_map(|setting| point(settings, setting, failed, useless)).collect();
        spots.extend(points.iter().map(|&(x, y, sign)| Spot { curve, x, y, sign }));
        // Failed settings have no point on the curve.
        let samples = points.into_iter().filter(|(.., sign)| *sign != Sign::Cross);
        let samples = samples.enumerate().map(|(index, (x, y, _))| Sample { time: index as f64, x, y }).collect();
        let refused = own().any(|setting| matches!(setting.outcome, SettingOutcome::Refused(_)));
        let name = course.name();
        let label = if refused { format!("{name} (refused)") } else { name };
        curves.push(Curve { label, body: None, samples });
    }
    for peer in peers {
        let curve = curves.len();
        let points = peer.points.iter().filter(|(error, cost)| *error < useless && *cost > 0.0);
        let points: Vec<(f64, f64)> = points.map(|(error, cost)| (error.max(claim.unwrap_or(0.0)), *cost)).collect();
        spots.extend(points.iter().map(|&(x, y)| Spot { curve, x, y, sign: Sign::Dot }));
        let samples = points.iter().enumerate().map(|(index, &(x, y))| Sample { time: index as f64, x, y }).collect();
        curves.push(Curve { label: peer.name.clone(), body: None, samples });
    }
    // Rings are seen above the dots of others.
    spots.sort_by_key(|spot| spot.sign == Sign::Best);
    let costs = spots.iter().map(|spot| spot.y);
    let (cheapest, dearest) = costs.fold((f64::INFINITY, 0.0_f64), |(low, high), y| (low.min(y), high.max(y)));
    let range = (cheapest <= dearest).then(|| (decade_below(cheapest), 1.0 / decade_below(1.0 / dearest)));
    let up = match settings.cost {
        Cost::Time => "seconds per second of physics",
        Cost::Evaluations => "evaluations of all forces per second of physics",
    };
    let axis = |label: String, range| Axis { label, unit: String::new(), range, logarithmic: true };
    Diagram {
        plot: Plot {
            title: legend.title,
            across: axis(legend.error, Some((low, 10.0 * useless))),
            up: axis(up.to_owned(), range.or(Some((1e-6, 1.0)))),
            content: Content::Phases(curves, None),
        },
        aside: if peers.is_empty() {
            "ringed: no setting is more exact for less".to_owned()
        } else {
            "ringed: no setting of Jostle is more exact for less; grey: others".to_owned()
        },
        looks,
        spots,
        floor: claim.map(|claim| {
            let before = if claim <= low { "farther left: " } else { "" };
            (claim, format!("{before}{}", legend.floor))
        }),
        useless: legend.useless,
    }
}

/// A method has one colour; its courses differ in their dashes.
fn looks(courses: &[MethodChoice]) -> Vec<Look> {
    let mut methods: Vec<(&str, usize)> = Vec::new();
    let mut look = |course: &MethodChoice| {
        let color = methods.iter().position(|(method, _)| *method == course.method).unwrap_or(methods.len());
        if color == methods.len() {
            methods.push((course.method, 0));
        }
        let before = &mut methods[color].1;
        *before += 1;
        // The first two dashes are both unbroken.
        Look::Main { color, dash: color + 2 * (*before - 1) }
    };
    courses.iter().map(&mut look).collect()
}

/// The point of a setting; a useless one has the error `failed`.
fn point(settings: &Settings, setting: &Setting, failed: f64, useless: f64) -> Option<(f64, f64, Sign)> {
    let cost = setting.cost(settings.cost).filter(|cost| *cost > 0.0)?;
    match setting.outcome {
        SettingOutcome::Measured(_) => {
            let error = settings.claimed(setting)?;
            let sign = if settings.is_best(setting) { Sign::Best } else { Sign::Dot };
            Some(if error < useless { (error, cost, sign) } else { (failed, cost, Sign::Cross) })
        }
        SettingOutcome::Failed(_) => Some((failed, cost, Sign::Cross)),
        SettingOutcome::Unknown | SettingOutcome::Refused(_) | SettingOutcome::Stopped(_) => None,
    }
}

/// The power of ten that is no greater than a number.
fn decade_below(value: f64) -> f64 {
    format!("1e{}", libm::floor(libm::log10(value) + 1e-9) as i32).parse().unwrap_or(value)
}
