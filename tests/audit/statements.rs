//! Promise: the stated error of a run has the size of the error, for any method and tick. A wrong run is never called
//! trustworthy.
//!
//! Two twins understate an error where both meet events in the phase of the first run. With ticks that share one end in ten that is
//! rare; the shares below are asked for, not found. Errors below 1e-13 of the motion are rounding, of which nothing is stated.

use super::draw;
use super::impact::{Impact, Tangential};
use super::ran::run;

/// Impacts for each method and tick.
const IMPACTS: u64 = 100;

/// An error stated, the true one, and how far the disc goes, in m.
struct Stated {
    stated: Option<f64>,
    error: f64,
    motion: f64,
    trusted: bool,
}

impl Stated {
    fn ratio(&self) -> Option<f64> {
        let rounding = self.error < 1e-13 * self.motion.max(1.0);
        self.stated.filter(|_| !rounding).map(|stated| stated / self.error)
    }
}

/// One impact under one clock; nothing if it has no solution, or the method cannot run it.
fn judge(seed: u64, method: &str, ticks: Option<f64>) -> Option<Stated> {
    let drawn = draw::impact(seed);
    let impact = drawn.impact;
    let by_ticks = ticks.is_some() && ["VelocityVerlet", "SemiImplicitEuler"].contains(&method);
    if impact.solve().is_err() || by_ticks && impact.tangential == Tangential::Exact {
        return None;
    }
    let omega = (impact.stiffness / impact.mass).sqrt();
    let tick = ticks.map(|ticks| (std::f64::consts::PI / omega / ticks).min(impact.duration));
    let clock = match tick {
        Some(tick) => format!(", method: {method}, tick: {tick:?}"),
        None => format!(", {method}"),
    };
    let ran = run(&drawn.scene(&clock), 16).unwrap_or_else(|why| panic!("{seed} {method}: {why}"));
    let (stated, until) = ran.stated().map_or((None, f64::INFINITY), |(error, until)| (Some(error), until));
    let (mut error, mut motion) = (0.0_f64, 0.0_f64);
    for &(duration, ref bodies) in ran.seen.iter().filter(|(time, _)| *time > 0.0 && *time <= until) {
        let Ok(truth) = (Impact { duration, ..impact }).solve() else { continue };
        let (disc, begin) = (bodies[0], impact.begin);
        let far = (disc.place.x - truth.x).hypot(disc.place.y - truth.y);
        error = error.max(far + (disc.angle - truth.angle).abs() * impact.radius);
        let way = (truth.x - begin.x).hypot(truth.y - begin.y) + truth.angle.abs().min(1.0) * impact.radius;
        motion = motion.max(way);
    }
    Some(Stated { stated, error, motion, trusted: ran.is_trusted() })
}

#[test]
fn statements_are_of_the_size_of_the_error() {
    let methods = [
        "VelocityVerlet",
        "SemiImplicitEuler",
        "VelocityVerlet, events: Located",
        "RungeKutta4",
        "Dop853",
        "Symplectic4",
        "ImplicitMidpoint",
    ];
    let ticks = methods.iter().flat_map(|&method| [40.0, 12.0, 4.0].map(|ticks| (method, Some(ticks))));
    let tolerances = [("tolerance: 1e-3", None), ("tolerance: 1e-6", None)];
    let mut all = Vec::new();
    for (number, (method, ticks)) in ticks.chain(tolerances).enumerate() {
        // Other impacts for each, so that none counts twenty times.
        let first = 10_000 + number as u64 * IMPACTS;
        all.extend(
            (first..first + IMPACTS).filter_map(|seed| Some(((method, ticks, seed), judge(seed, method, ticks)?))),
        );
    }
    let ratios: Vec<f64> = all.iter().filter_map(|(_, judged)| judged.ratio()).collect();
    let share =
        |good: &dyn Fn(f64) -> bool| ratios.iter().filter(|ratio| good(**ratio)).count() as f64 / ratios.len() as f64;
    let found =
        [share(&|ratio| ratio < 1.0 / 3.0), share(&|ratio| ratio < 0.1), share(&|r| (1.0 / 3.0..=3.0).contains(&r))];
    let low = all.iter().filter(|(_, judged)| judged.ratio().is_some_and(|ratio| ratio < 0.1));
    let low: Vec<_> = low.map(|(which, judged)| (which, judged.ratio())).collect();
    assert!(ratios.len() > 1500, "{} statements", ratios.len());
    assert!(found[0] <= 0.01 && found[1] <= 0.001 && found[2] >= 0.8, "{found:?} of {}: {low:?}", ratios.len());
    let small = all.iter().filter(|(_, judged)| judged.error < 0.01 * judged.motion);
    let (silent, known): (Vec<_>, Vec<_>) = small.partition(|(_, judged)| judged.stated.is_none());
    assert!(silent.len() * 10 <= silent.len() + known.len(), "{} of {} state nothing", silent.len(), known.len());
    let wrong = |judged: &Stated| {
        judged.trusted && judged.error > 1e-13 && judged.stated.is_none_or(|stated| judged.error > 10.0 * stated)
    };
    let trusted: Vec<_> = all.iter().filter(|(_, judged)| wrong(judged)).map(|(which, _)| which).collect();
    assert!(trusted.is_empty(), "trusted, and wrong by more than ten times what is stated: {trusted:?}");
}
