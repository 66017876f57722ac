//! Constant acceleration from rest in ticks of a second: the table that distinguishes integrators.
//!
//! `x = a t^2/2`. In `n` ticks semi-implicit Euler arrives at `a dt^2 n (n + 1)/2`, and explicit Euler at `a dt^2 n
//! (n - 1)/2`. Methods of order 2 and more arrive at the exact value. SI units.

use super::{Class, Constant, Problem, ProblemSetting, rounding_of};
use jostle_engine::Simulation;

/// The problem.
pub const PROBLEM: Problem = Problem {
    name: "constant_acceleration",
    law: "the way grows with the square of time",
    source: "Galilei, Discorsi, 1638; truth file P02",
    class: Class::ConstantAcceleration,
    tick: 1.0,
    samples: &[1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0, 10.0],
    unit: "m",
    always_located: false,
    scene,
    error,
    // The exact discrete solution of a method of order 1: a t dt/2.
    leading_error: Some(|_, tick| ACCELERATION * 10.0 * tick / 2.0),
    constants: CONSTANTS,
    rounding: |tick| rounding_of(10.0 / tick, 500.0),
};

/// Derived: methods of order 1 are ahead or behind by `a t dt/2`, at most after 10 s.
const CONSTANTS: &[Constant] = &[
    Constant::located("ExplicitEuler", 1, 5.0 * ACCELERATION),
    Constant::per_tick("SemiImplicitEuler", 1, 5.0 * ACCELERATION),
    Constant::located("SemiImplicitEuler", 1, 5.0 * ACCELERATION),
];

/// In m/s2.
pub const ACCELERATION: f64 = 10.0;

fn scene(setting: &ProblemSetting, duration: f64) -> String {
    let clock = setting.clock(duration);
    format!(
        "Scene({clock}, gravity: ({ACCELERATION:?}, 0),
        bodies: [(name: \"cart\", at: (0, 0), atoms: Disc(radius: 0.1, mass: 3))])"
    )
}

fn error(simulation: &Simulation, time: f64, _: f64) -> f64 {
    let position = simulation.bodies().position[0];
    (position.x - ACCELERATION * time * time / 2.0).abs() + position.y.abs()
}
