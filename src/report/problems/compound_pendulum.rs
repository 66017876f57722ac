//! A rigid cluster of discs on a pin: `I theta'' = -M g d sin theta`, with the inertia `I` about the pin by Steiner's theorem.
//! Solved by elliptic functions. SI units.
//!
//! Mass, middle and inertia are those of the atoms as discs; the anchor counts from the origin of the atoms.

use super::{Class, Constant, Problem, ProblemSetting, Truth, rounding_of};
use jostle_engine::Simulation;

/// The problem.
pub const PROBLEM: Problem = Problem {
    name: "compound_pendulum",
    law: "a cluster on a pin swings as its inertia about the pin says",
    source: "textbook, elliptic functions; truth file J02",
    class: Class::Smooth,
    tick: 0.1 / 32.0,
    samples: &[0.3, 1.0, 3.0, 6.0],
    unit: "1",
    always_located: false,
    scene,
    error,
    leading_error: None,
    constants: CONSTANTS,
    // A wrong amplitude gives a wrong period. So errors grow by the passed angle, at up to 5 rad/s.
    rounding: |tick| rounding_of(6.0 / tick, 6.0 * 5.0),
};

/// Measured at finer ticks.
const CONSTANTS: &[Constant] = &[
    Constant::per_tick("SemiImplicitEuler", 1, 2.501e0),
    Constant::located("SemiImplicitEuler", 1, 2.500e0),
    Constant::per_tick("VelocityVerlet", 2, 3.955e1),
    Constant::located("VelocityVerlet", 2, 2.220e1),
    Constant::located("RungeKutta4", 4, 5.883e1),
    Constant::located("ImplicitMidpoint", 2, 2.779e1),
    Constant::located("Symplectic4", 4, 1.973e0),
];

/// The reference values.
pub const TRUTH: &str = include_str!("../../../assets/truths/J02_compound_pendulum.json");

fn scene(setting: &ProblemSetting, duration: f64) -> String {
    let clock = setting.clock(duration);
    format!(
        "Scene({clock}, gravity: (0, -9.81), contacts: None,
        bodies: [(name: \"cluster\", datum: Origin, at: (0, 0), atoms: List([
            (at: (0, 0), radius: 0.1, mass: 1), (at: (0.3, -0.2), radius: 0.15, mass: 1.5), (at: (0.5, 0.1), radius: 0.1, mass: 0.7)]))],
        joints: [Revolute(name: \"pin\", a: World, b: \"cluster\", anchor_b: (0, 0))])"
    )
}

/// In rad.
fn error(simulation: &Simulation, time: f64, _: f64) -> f64 {
    let Some(row) = Truth::read(TRUTH).row("body rotation angle (theta-theta0)", time) else { return f64::NAN };
    (simulation.bodies().angle[0] - row[0]).abs()
}
