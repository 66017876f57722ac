//! Law: a method of order p errs by a constant times `dt^p`. Source: any textbook (Hairer, Norsett, Wanner 1993); where
//! the force has a kink inside a tick at most order 2 is left, where it jumps order 1, on average over the phase of the
//! event in the tick.
//!
//! Tolerance: the slope of a least-squares fit over six ticks may fall short of the order by 0.25 (the next error
//! term is a factor of 2 smaller per halving than the leading one: at the coarsest ticks it may bend the line). Smooth
//! problems may not exceed it by more either: a slope that is too good is a test that does not test. Methods that are
//! exact on a problem must stay within the worst case of rounding.
//!
//! Errors of problems with a kink or jump are root mean squares over 16 phases at irrational distances, each with its
//! own tick, up to a tenth shorter: two events of one contact fall on unrelated places of a tick only if the length of
//! the contact in ticks is as arbitrary as its beginning.
//!
//! Where events are located a method keeps its order through kinks and jumps. Methods of higher order begin at coarser ticks,
//! closer to each other, because rounding ends the line soon: points within a hundred times the worst case of rounding
//! are left out. Where fewer than three are left the method is at rounding from the beginning, and nothing else is asked. Coarse ticks bend their line upwards, so that only methods up to order 2 are
//! held to "not better than stated". Of a ladder the six finest ticks above rounding count.
//!
//! Not tested: the size of the errors (see `problems`).

use jostle::integrate::Description;
use jostle::problems::{self, EventTiming, Expected, Problem, Setting};

use super::support::{fitted_order, phases, table};

/// Points of a fit.
const POINTS: usize = 6;
const PHASES: u32 = 16;
const SLACK: f64 = 0.25;

fn error_at(problem: &Problem, (method, events): (&Description, EventTiming), tick: f64) -> f64 {
    // A run that explodes has an infinite error.
    let measure = |setting: Setting| problem.measure(&setting).unwrap_or(f64::INFINITY);
    let setting = Setting { method: method.name, tick, shift: 0.0, events };
    if !problem.class.depends_on_phase() {
        return measure(setting);
    }
    let squares = phases(PHASES).enumerate().map(|(number, phase)| {
        let tick = tick * (1.0 - 0.1 * (number as f64 * std::f64::consts::SQRT_2).fract());
        measure(Setting { tick, shift: phase * tick, ..setting }).powi(2)
    });
    (squares.sum::<f64>() / f64::from(PHASES)).sqrt()
}

/// The ticks over the problem's own. Where the state is compared at given times, those must be whole numbers of ticks.
fn ladder(problem: &Problem, order: u32, events: EventTiming) -> Vec<f64> {
    if !problem.class.depends_on_phase() {
        let whole = |ticks: f64| (ticks - ticks.round()).abs() < 1e-9 * ticks.max(1.0);
        let divides = |share: &f64| problem.samples.iter().all(|time| whole(time / (share * problem.tick)));
        let coarse = [16.0, 12.0, 10.0, 8.0, 6.0, 5.0, 4.0, 3.0, 2.0].into_iter().filter(divides);
        let fine = [1.0, 1.0 / 2.0, 1.0 / 4.0, 1.0 / 8.0, 1.0 / 16.0, 1.0 / 32.0];
        let fine = fine.into_iter().take(if order > 2 { 4 } else { 6 });
        return coarse.filter(|share| order > 2 && (order > 4 || *share <= 4.0)).chain(fine).collect();
    }
    let (coarsest, ratio, steps) = match (order, events) {
        (0..=2, EventTiming::PerTick) => (1.0, 2.0, 6),
        (0..=2, _) => (3.0, 1.5, 6),
        (3..=5, _) => (4.0, 1.4, 6),
        _ => (8.0, 1.25, 10),
    };
    (0..steps).map(|step| coarsest / f64::powi(ratio, step)).collect()
}

/// Whether a method shows what is expected, and how.
fn judge(problem: &Problem, method: &Description, events: EventTiming) -> (bool, String) {
    let called = format!("{} {} {events:?}", problem.name, method.name);
    let expected = problem.class.expected_located(method.order, events == EventTiming::Located);
    let Expected::Order(order) = expected else {
        let error = error_at(problem, (method, events), problem.tick);
        let bound = (problem.rounding)(problem.tick);
        return (error <= bound, format!("{called}: exact, {error:.1e} of {bound:.1e}"));
    };
    let ticks = ladder(problem, order, events).into_iter().map(|share| share * problem.tick);
    let mut all: Vec<(f64, f64)> = ticks.map(|tick| (tick, error_at(problem, (method, events), tick))).collect();
    if method.stability_limit == 0.0 && all.iter().any(|(_, error)| *error == f64::INFINITY) {
        return (true, format!("{called}: explodes, as no tick is stable"));
    }
    // Ticks coarser than the problem's may be above the method's limit.
    all.retain(|(tick, error)| *tick <= problem.tick || *error != f64::INFINITY);
    let above = |&&(tick, error): &&(f64, f64)| error.is_nan() || error > 100.0 * (problem.rounding)(tick);
    let mut points: Vec<(f64, f64)> =
        if events == EventTiming::PerTick { all.clone() } else { all.iter().filter(above).copied().collect() };
    points.drain(..points.len().saturating_sub(POINTS));
    if points.len() < 3 {
        let good = all.iter().all(|(_, error)| error.is_finite());
        return (good, format!("{called}: at rounding from the beginning;{}", table(&all)));
    }
    let (found, order) = (fitted_order(&points), f64::from(order));
    let too_high = !problem.class.depends_on_phase() && order <= 2.0 && found > order + SLACK;
    let good = found >= order - SLACK && !too_high;
    (good, format!("{called}: order {found:.2}, expected {order};{}", table(&points)))
}

fn every_method_shows_its_order(problems: impl Iterator<Item = &'static Problem>) {
    let mut report = Vec::new();
    let mut failed = false;
    for problem in problems {
        for method in &problems::methods() {
            let whole = method.whole_ticks.map(|_| EventTiming::PerTick);
            let located = method.one_step.map(|_| EventTiming::Located);
            for events in whole.into_iter().chain(located) {
                let (good, line) = judge(problem, method, events);
                failed |= !good;
                report.push(format!("{} {line}", if good { "   " } else { "BAD" }));
            }
        }
    }
    println!("{}", report.join("\n"));
    assert!(!failed, "\n{}", report.join("\n"));
}

/// Two tests, so that two threads share the work.
#[test]
fn every_method_shows_its_order_on_every_other_problem() {
    every_method_shows_its_order(problems::ALL.iter().step_by(2));
}

#[test]
fn every_method_shows_its_order_on_the_problems_between() {
    every_method_shows_its_order(problems::ALL.iter().skip(1).step_by(2));
}
