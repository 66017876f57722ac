//! Law: a method of order p errs by a constant times `dt^p`. Source: any textbook (Hairer, Norsett, Wanner 1993). If
//! the force has a kink inside a tick, at most order 2 remains. If it jumps, order 1 remains, on average over the phase
//! of the event in the tick.
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
//! If events are located, a method keeps its order through kinks and jumps. An order is a statement on small ticks: the
//! line begins at ticks as coarse as bear six points, and as long as its slope is not the one that is asked, a finer
//! tick is added and the coarsest left out, down to a last one. Points within ten times the worst case of rounding are
//! left out; where fewer than four are above it, the method is at rounding from the beginning, and nothing else is
//! asked. Coarse ticks bend their line upwards, so that only methods up to order 2 are held to "not better than
//! stated".
//!
//! Of smooth problems the samples within the first 16384 ticks count, because an order does not depend on the length of
//! a run.
//!
//! Not tested: the size of the errors (see `problems`).

use jostle::integrate::Description;
use jostle::problems::{self, EventTiming, Expected, Problem};

use super::support::{fitted_order, rms_error, table};
use crate::part;

/// Points of a fit.
const POINTS: usize = 6;
/// Points with which a fit is made where rounding ends the line.
const FEWEST: usize = 4;
const SLACK: f64 = 0.25;
/// Samples count up to so many ticks of the problem's own length.
const LONGEST: f64 = 16_384.0;

/// The ticks over the problem's own, from coarse to fine. Where the state is compared at given times, those must be whole
/// numbers of ticks.
fn ladder(problem: &Problem, order: u32, events: EventTiming) -> Vec<f64> {
    if !problem.class.depends_on_phase() {
        let whole = |ticks: f64| (ticks - ticks.round()).abs() < 1e-9 * ticks.max(1.0);
        let divides = |share: &f64| problem.samples.iter().all(|time| whole(time / (share * problem.tick)));
        let coarse =
            [64.0, 32.0, 25.0, 20.0, 16.0, 12.0, 10.0, 8.0, 6.0, 5.0, 4.0, 3.0, 2.0].into_iter().filter(divides);
        let finest = if order > 2 { -3 } else { -5 };
        let fine = (finest..=0).rev().map(|power| 2.0_f64.powi(power));
        return coarse.filter(|share| order > 4 || *share <= if order > 2 { 16.0 } else { 8.0 }).chain(fine).collect();
    }
    let (coarsest, ratio, steps): (f64, f64, i32) = match (order, events) {
        (0..=2, EventTiming::PerTick) => (4.0, 2.0, 8),
        (0..=2, _) => (4.0, 1.5, 8),
        (3..=5, _) => (4.0, 1.4, 8),
        _ => (16.0, 1.25, 12),
    };
    (0..steps).map(|step| coarsest / ratio.powi(step)).collect()
}

/// Whether a method shows what is expected, and how.
fn judge(problem: &Problem, method: &Description, events: EventTiming) -> (bool, String) {
    let called = format!("{} {} {events:?}", problem.name, method.name);
    let expected = problem.class.expected_located(method.order, events == EventTiming::Located);
    let Expected::Order(order) = expected else {
        let error = rms_error(problem, method, events, problem.tick);
        let bound = (problem.rounding)(problem.tick);
        return (error <= bound, format!("{called}: exact, {error:.1e} of {bound:.1e}"));
    };
    let above = |&&(tick, error): &&(f64, f64)| error.is_nan() || error > 10.0 * (problem.rounding)(tick);
    let (mut all, mut verdict) = (Vec::new(), None);
    for share in ladder(problem, order, events) {
        let tick = share * problem.tick;
        let error = rms_error(problem, method, events, tick);
        if error == f64::INFINITY && method.stability_limit == 0.0 {
            return (true, format!("{called}: explodes, as no tick is stable"));
        }
        // Ticks coarser than the problem's may be above the method's limit.
        if error == f64::INFINITY && share > 1.0 {
            continue;
        }
        all.push((tick, error));
        let mut points: Vec<(f64, f64)> = all.iter().filter(above).copied().collect();
        // What is at rounding once stays there.
        if points.len() < POINTS && all.len() - points.len() < 2 {
            continue;
        }
        points.drain(..points.len().saturating_sub(POINTS));
        if points.len() < FEWEST {
            let good = all.iter().all(|(_, error)| error.is_finite());
            return (good, format!("{called}: at rounding from the beginning;{}", table(&all)));
        }
        let (found, order) = (fitted_order(&points), f64::from(order));
        let too_high = !problem.class.depends_on_phase() && order <= 2.0 && found > order + SLACK;
        let good = found >= order - SLACK && !too_high;
        verdict = Some((good, format!("{called}: order {found:.2}, expected {order};{}", table(&points))));
        // A slope that is much too good is not yet the order.
        if good && found <= order + 1.0 || points.len() < POINTS {
            break;
        }
    }
    verdict.unwrap_or_else(|| (false, format!("{called}: fewer than {POINTS} ticks;{}", table(&all))))
}

/// Every `of`-th combination of problem, method and timing of events, so that threads share the work evenly.
fn every_method_shows_its_order(share: usize, of: usize) {
    let methods = problems::methods();
    let problems: Vec<Problem> = problems::ALL.iter().map(|problem| problem.within_ticks(LONGEST)).collect();
    let pairs = problems.iter().flat_map(|problem| methods.iter().map(move |method| (problem, method)));
    let combinations = pairs
        .flat_map(|(problem, method)| problem.timings(method).into_iter().map(move |events| (problem, method, events)));
    let mut report = Vec::new();
    let mut failed = false;
    for (problem, method, events) in part::of(combinations.skip(share).step_by(of)) {
        let (good, line) = judge(problem, method, events);
        failed |= !good;
        report.push(format!("{} {line}", if good { "   " } else { "BAD" }));
    }
    println!("{}", report.join("\n"));
    assert!(!failed, "\n{}", report.join("\n"));
}

#[test]
fn every_method_shows_its_order_first_share() {
    every_method_shows_its_order(0, 4);
}

#[test]
fn every_method_shows_its_order_second_share() {
    every_method_shows_its_order(1, 4);
}

#[test]
fn every_method_shows_its_order_third_share() {
    every_method_shows_its_order(2, 4);
}

#[test]
fn every_method_shows_its_order_fourth_share() {
    every_method_shows_its_order(3, 4);
}
