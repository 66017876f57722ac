//! A chain of six uniform links hangs by one end and is released level. The reference solves Lagrange's equations, and
//! independently the equations of bodies with multipliers. SI units.

use std::f64::consts::FRAC_PI_2;

use super::linkage::{Chain, ChainLink, chain, turned_off};
use super::{Class, Constant, Problem, ProblemSetting, Truth, rounding_of};
use jostle_engine::Simulation;

/// The problem.
pub const PROBLEM: Problem = Problem {
    name: "falling_chain",
    law: "a chain that is let go level falls as Lagrange's equations say",
    source: "Lagrange's equations against bodies with multipliers; truth file J10",
    class: Class::Smooth,
    tick: 0.1 / 256.0,
    samples: &[0.1, 0.3, 0.5, 0.7],
    unit: "1",
    always_located: false,
    scene,
    error,
    leading_error: None,
    constants: CONSTANTS,
    // Links swing with up to 30 rad/s. Errors of angles grow by about ten in each quarter of such a swing in which they
    // fall.
    rounding: |tick| rounding_of(0.7 / tick, 100.0),
};

/// Measured at finer ticks.
const CONSTANTS: &[Constant] = &[
    Constant::located("ExplicitEuler", 1, 1.312e2),
    Constant::per_tick("SemiImplicitEuler", 1, 1.227e1),
    Constant::located("SemiImplicitEuler", 1, 1.227e1),
    Constant::per_tick("VelocityVerlet", 2, 2.497e2),
    Constant::located("VelocityVerlet", 2, 7.517e1),
    Constant::located("RungeKutta4", 4, 1.265e5),
    Constant::located("ImplicitMidpoint", 2, 2.543e2),
];

/// The reference values.
pub const TRUTH: &str = include_str!("../../../assets/truths/J10_hinged_rod_fall.json");
/// Number of links.
const COUNT: usize = 6;

fn scene(setting: &ProblemSetting, duration: f64) -> String {
    let clock = setting.clock(duration);
    let links = [ChainLink { mass: 0.1, length: 0.2, angle: FRAC_PI_2 }; COUNT];
    let Chain { bodies, joints, .. } = chain("link", &links);
    format!("Scene({clock}, gravity: (0, -9.81), contacts: None, bodies: [{bodies}], joints: [{joints}])")
}

/// The greatest of the angles, in rad.
fn error(simulation: &Simulation, time: f64, _: f64) -> f64 {
    let Some(row) = Truth::read(TRUTH).row("6-link chain released horizontally: angles", time) else { return f64::NAN };
    turned_off(simulation, 0, &row)
}
