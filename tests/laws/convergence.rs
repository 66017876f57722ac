//! Law: a method of order p errs by a constant times `dt^p`. Source: any textbook (Hairer, Norsett, Wanner 1993); where
//! the force has a kink inside a tick at most order 2 is left, where it jumps order 1, on average over the phase of the
//! event in the tick.
//!
//! Tolerance: the slope of a least-squares fit over five halvings may fall short of the order by 0.25 (the next error
//! term is a factor of 2 smaller per halving than the leading one: at the coarsest ticks it may bend the line). Smooth
//! problems may not exceed it by more either: a slope that is too good is a test that does not test. Methods that are
//! exact on a problem must stay within the worst case of rounding.
//!
//! Errors of problems with a kink or jump are root mean squares over 16 phases at irrational distances, each with its
//! own tick, up to a tenth shorter: two events of one contact fall on unrelated places of a tick only if the length of
//! the contact in ticks is as arbitrary as its beginning.
//!
//! Not tested: the size of the errors (see `problems`), methods that locate events.

use jostle::integrate::Description;
use jostle::problems::{self, Expected, Problem, Setting};

use super::support::{fitted_order, phases, table};

const HALVINGS: i32 = 5;
const PHASES: u32 = 16;
const SLACK: f64 = 0.25;

fn error_at(problem: &Problem, method: &Description, tick: f64) -> f64 {
    let measure = |setting: Setting| {
        problem.measure(&setting).unwrap_or_else(|error| panic!("{} {}: {error}", problem.name, method.name))
    };
    if !problem.class.depends_on_phase() {
        return measure(Setting { method: method.name, tick, shift: 0.0 });
    }
    let squares = phases(PHASES).enumerate().map(|(number, phase)| {
        let tick = tick * (1.0 - 0.1 * (number as f64 * std::f64::consts::SQRT_2).fract());
        measure(Setting { method: method.name, tick, shift: phase * tick }).powi(2)
    });
    (squares.sum::<f64>() / f64::from(PHASES)).sqrt()
}

#[test]
fn every_method_shows_its_order_on_every_problem() {
    let mut report = Vec::new();
    let mut failed = false;
    for problem in problems::ALL {
        for method in &problems::methods() {
            let (name, called) = (problem.name, method.name);
            let Expected::Order(order) = problem.class.expected(method.order) else {
                let error = error_at(problem, method, problem.tick);
                let bound = (problem.rounding)(problem.tick);
                failed |= error.is_nan() || error > bound;
                report.push(format!("{name} {called}: exact, {error:.1e} of {bound:.1e}"));
                continue;
            };
            let ticks = (0..=HALVINGS).map(|halving| problem.tick / 2.0_f64.powi(halving));
            let points: Vec<(f64, f64)> = ticks.map(|tick| (tick, error_at(problem, method, tick))).collect();
            let (found, order) = (fitted_order(&points), f64::from(order));
            let too_high = !problem.class.depends_on_phase() && found > order + SLACK;
            failed |= found.is_nan() || found < order - SLACK || too_high;
            report.push(format!("{name} {called}: order {found:.2}, expected {order};{}", table(&points)));
        }
    }
    println!("{}", report.join("\n"));
    assert!(!failed, "\n{}", report.join("\n"));
}
