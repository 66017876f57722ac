//! Three uniform rods, each hung on the end of the one before. Lagrange's equations, and independently the equations of bodies with
//! multipliers. SI units.
//!
//! The motion is chaotic. The problem ends after 3 s, at which rounding has grown by a few hundred.

use std::f64::consts::PI;

use super::linkage::{Chain, ChainLink, chain, turned_off};
use super::{Class, Constant, Problem, ProblemSetting, Truth, rounding_of};
use jostle_engine::Simulation;

/// The problem.
pub const PROBLEM: Problem = Problem {
    name: "triple_pendulum",
    law: "a triple pendulum of rods follows Lagrange's equations",
    source: "Lagrange's equations against bodies with multipliers; truth file J04",
    class: Class::Smooth,
    tick: 1.0 / 1024.0,
    samples: &[0.5, 1.0, 2.0, 3.0],
    unit: "1",
    always_located: false,
    scene,
    error,
    leading_error: None,
    constants: CONSTANTS,
    // Errors of angles grow as the motion is sensitive. The reference is known to 9e-13 rad.
    rounding: |tick| rounding_of(3.0 / tick, 100.0) + 2.9e-13,
};

/// Measured at finer ticks.
const CONSTANTS: &[Constant] = &[
    Constant::located("ExplicitEuler", 1, 6.106e2),
    Constant::per_tick("SemiImplicitEuler", 1, 1.318e0),
    Constant::located("SemiImplicitEuler", 1, 1.316e0),
    Constant::per_tick("VelocityVerlet", 2, 6.274e1),
    Constant::located("VelocityVerlet", 2, 9.558e0),
    Constant::located("RungeKutta4", 4, 8.662e3),
    Constant::located("ImplicitMidpoint", 2, 1.345e2),
];

/// The reference values.
pub const TRUTH: &str = include_str!("../../../assets/truths/J04_triple_pendulum.json");
/// Masses in kg, lengths in m and angles at the start in degrees from the downward vertical.
const RODS: [(f64, f64, f64); 3] = [(1.0, 1.0, 100.0), (0.8, 0.8, 80.0), (0.6, 0.6, 120.0)];

fn scene(setting: &ProblemSetting, duration: f64) -> String {
    let clock = setting.clock(duration);
    let links = RODS.map(|(mass, length, degrees)| ChainLink { mass, length, angle: degrees.to_radians() });
    let Chain { bodies, joints, .. } = chain("rod", &links);
    format!("Scene({clock}, gravity: (0, -9.81), contacts: None, bodies: [{bodies}], joints: [{joints}])")
}

/// The greatest of the angles as a share of half a turn: rods turn as far.
fn error(simulation: &Simulation, time: f64, _: f64) -> f64 {
    let Some(row) = Truth::read(TRUTH).row("theta..omega (t<=3)", time) else { return f64::NAN };
    turned_off(simulation, 0, &row[..RODS.len()]) / PI
}
