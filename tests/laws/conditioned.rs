//! Law: with located events the error of a method of order 8 is rounding, as far as the problem magnifies it. Source:
//! Higham, *Accuracy and Stability of Numerical Algorithms*, 2002, 1.6: forward error is condition number times
//! backward error.
//!
//! Tolerance: the error of `Dop853` is at most the greatest of ten times the truth's own error, 1e-12, and `50 eps kappa sqrt(n)` for
//! `n` ticks, whose roundings add up by chance; `kappa`, in the unit of the problem's error, is measured: by how much the error
//! changes when the last bits of the start (places, angles, velocities, spins) are changed by chance, over their share of them,
//! the greatest of three. The bits are of a number 2^-30 of each, far above rounding and far below what is nonlinear. Ticks
//! are the problem's, or a quarter of it where order 8 is not at rounding there.
//!
//! Not tested: problems whose truth is good to less than that; each says so in its `rounding` (arms that are shorter by the
//! overlap, in `tangential_impact` and `frictional_collision`), which stands for the truth's own error here.

use glam::DVec2;
use jostle::problems::{self, EventTiming, Problem, ProblemSetting};
use jostle::world::{Body, Motion, Position, Rotation, Spin, Velocity};

use super::support::phases;

/// The share of each number of the start by which it is changed.
const SHARE: f64 = 1.0 / (1_u64 << 30) as f64;

/// The greatest error at the samples, from a start that `change` has changed.
fn error_from(problem: &Problem, setting: &ProblemSetting, mut change: impl FnMut(f64) -> f64) -> f64 {
    let mut simulation = problem.load(setting).expect("the scene is correct");
    let world = simulation.world_mut();
    let mut bodies = world.query::<(&Body, &mut Position, &mut Rotation, &mut Velocity, &mut Spin)>();
    for (body, mut position, mut angle, mut velocity, mut spin) in bodies.iter_mut(world) {
        if body.motion == Motion::Dynamic {
            position.0 = DVec2::new(change(position.0.x), change(position.0.y));
            angle.0 = change(angle.0);
            velocity.0 = DVec2::new(change(velocity.0.x), change(velocity.0.y));
            spin.0 = change(spin.0);
        }
    }
    let mut greatest = 0.0_f64;
    for &time in problem.samples {
        simulation.run_to_tick((time / setting.tick).round() as u64).expect("numbers stay finite");
        let reached = simulation.clock().time();
        let time = if (reached - time).abs() > 1e-9 * time { reached } else { time };
        greatest = greatest.max((problem.error)(&simulation, time, setting.shift));
    }
    greatest
}

#[test]
fn dop853_errs_by_rounding_on_all_problems() {
    let mut report = Vec::new();
    let mut failed = false;
    for problem in problems::ALL {
        let tick = problem.tick;
        let setting = ProblemSetting { method: "Dop853", tick, shift: 0.3 * tick, events: EventTiming::Located };
        let error = problem.measure(&setting).expect("numbers stay finite");
        let mut chance = phases(u32::MAX);
        let mut condition = 0.0_f64;
        for _ in 0..3 {
            let changed = |number: f64| number * (1.0 + SHARE * (2.0 * chance.next().unwrap_or_default() - 1.0));
            condition = condition.max((error_from(problem, &setting, changed) - error).abs() / SHARE);
        }
        let ticks = problem.duration() / tick;
        let own = match problem.name {
            "tangential_impact" | "frictional_collision" => (problem.rounding)(tick),
            _ => 0.0,
        };
        let bound = (50.0 * f64::EPSILON * condition * ticks.sqrt()).max(1e-12).max(10.0 * own);
        let good = error <= bound;
        failed |= !good;
        let (mark, name) = (if good { "   " } else { "BAD" }, problem.name);
        report.push(format!("{mark} {name}: {error:.1e} of {bound:.1e}, condition {condition:.1e}, {ticks:.0} ticks"));
    }
    println!("{}", report.join("\n"));
    assert!(!failed, "\n{}", report.join("\n"));
}
