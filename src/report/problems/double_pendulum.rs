//! Two masses on massless rods, one hung on the other, released level. The reference solves Lagrange's equations by
//! extrapolation with 64 bits of mantissa. SI units.
//!
//! The motion is chaotic: errors grow by `e` in 1.16 s on average. The problem ends after 5 s, long before the horizon of 34 s at
//! which rounding has grown to 1e-3.

use std::f64::consts::FRAC_PI_2;
use std::fmt::Write;

use glam::DVec2;

use super::linkage::{greatest, hanging};
use super::{Class, Constant, Problem, ProblemSetting, Truth, rounding_of};
use jostle_engine::Simulation;

/// The problem.
pub const PROBLEM: Problem = Problem {
    name: "double_pendulum",
    law: "a double pendulum follows Lagrange's equations",
    source: "Lagrange's equations, extrapolation in extended precision; truth file J03",
    class: Class::Smooth,
    tick: 1.0 / 512.0,
    samples: &[1.0, 2.0, 5.0],
    unit: "1",
    always_located: false,
    scene,
    error,
    leading_error: None,
    constants: CONSTANTS,
    // Errors of places grow as the motion is sensitive. The reference is known to 6e-13.
    rounding: |tick| rounding_of(5.0 / tick, GROWTH) + 6.2e-13,
};

/// Measured at finer ticks.
const CONSTANTS: &[Constant] = &[
    Constant::located("ExplicitEuler", 1, 2.911e2),
    Constant::per_tick("SemiImplicitEuler", 1, 2.858e0),
    Constant::located("SemiImplicitEuler", 1, 2.855e0),
    Constant::per_tick("VelocityVerlet", 2, 2.583e1),
    Constant::located("VelocityVerlet", 2, 8.166e0),
    Constant::located("RungeKutta4", 4, 2.383e2),
    Constant::located("ImplicitMidpoint", 2, 2.068e1),
];

/// The reference values.
pub const TRUTH: &str = include_str!("../../../assets/truths/J03_double_pendulum.json");
/// `e^(lambda t)` with the Lyapunov exponent of 0.86/s, after 5 s.
const GROWTH: f64 = 74.0;

fn scene(setting: &ProblemSetting, duration: f64) -> String {
    let clock = setting.clock(duration);
    let (mut bodies, mut at) = (String::new(), DVec2::ZERO);
    for name in ["upper", "lower"] {
        at += hanging(FRAC_PI_2);
        let _ = write!(
            bodies,
            "(name: \"{name}\", at: ({:?}, {:?}), mass: 1, inertia: 1, atoms: Disc(radius: 0.1)),",
            at.x, at.y
        );
    }
    format!(
        "Scene({clock}, gravity: (0, -9.81), contacts: None, bodies: [{bodies}],
        joints: [Distance(name: \"rod_1\", a: World, anchor_a: (0, 0), b: \"upper\", length: 1),
                 Distance(name: \"rod_2\", a: \"upper\", b: \"lower\", length: 1)])"
    )
}

/// The places of both masses in m, from the angles of both rods in rad.
pub fn places(angles: &[f64]) -> [DVec2; 2] {
    let upper = hanging(angles[0]);
    [upper, upper + hanging(angles[1])]
}

/// The greater distance of a mass from its place, over the length of a rod.
fn error(simulation: &Simulation, time: f64, _: f64) -> f64 {
    let Some(row) = Truth::read(TRUTH).row("theta..omega (t<=5)", time) else { return f64::NAN };
    let found = &simulation.bodies().position;
    greatest(found.iter().zip(places(&row)).map(|(found, exact)| found.distance(exact)))
}
