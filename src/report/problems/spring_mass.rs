//! A mass on a spring: `m x'' = -k x`, so `x = x0 cos(w t) + v0/w sin(w t)` with `w = sqrt(k/m)` (Hooke 1678). SI units.
//!
//! The spring has zero length, so it is linear through its middle.

use super::{Class, Constant, Problem, ProblemSetting, rounding_of};
use jostle_engine::Simulation;

/// The problem.
pub const PROBLEM: Problem = Problem {
    name: "spring_mass",
    law: "a mass on a spring swings as a sine",
    source: "textbook; truth file O01",
    class: Class::Smooth,
    tick: 0.1 / 128.0,
    samples: &[0.1, 1.0, 10.0, 20.0],
    unit: "1",
    always_located: false,
    scene,
    error,
    leading_error: Some(leading_error),
    constants: CONSTANTS,
    // Each tick rounds the velocity by an ulp of at most `A w`. That is an ulp of the amplitude in the position.
    rounding: |tick| rounding_of(20.0 / tick, 2.0),
};

/// Measured at finer ticks.
const CONSTANTS: &[Constant] = &[
    Constant::located("ExplicitEuler", 1, 2.924e2),
    Constant::per_tick("SemiImplicitEuler", 1, 4.147e0),
    Constant::located("SemiImplicitEuler", 1, 4.147e0),
    Constant::per_tick("VelocityVerlet", 2, 8.276e2),
    Constant::located("VelocityVerlet", 2, 8.276e2),
    Constant::located("ImplicitMidpoint", 2, 1.665e3),
    Constant::located("RungeKutta4", 4, 1.665e4),
];

/// The reference values.
pub const TRUTH: &str = include_str!("../../../assets/truths/O01_spring_mass.json");
/// `w` in rad/s.
pub const OMEGA: f64 = 10.0;
/// In m.
const START: f64 = 0.1;
/// In m/s.
const SPEED: f64 = 0.5;

/// Displacement in m and velocity in m/s at `time`.
pub fn state(time: f64) -> (f64, f64) {
    let (sin, cos) = libm::sincos(OMEGA * time);
    (START * cos + SPEED / OMEGA * sin, SPEED * cos - START * OMEGA * sin)
}

fn scene(setting: &ProblemSetting, duration: f64) -> String {
    let clock = setting.clock(duration);
    format!(
        "Scene({clock}, forces: [Spring(a: \"mass\", b: World, stiffness: 100, length: 0)],
        bodies: [(name: \"mass\", at: ({START:?}, 0), velocity: ({SPEED:?}, 0), atoms: Disc(radius: 0.01, mass: 1))])"
    )
}

/// Over the amplitude.
fn error(simulation: &Simulation, time: f64, _: f64) -> f64 {
    (simulation.bodies().position[0].x - state(time).0).abs() / START.hypot(SPEED / OMEGA)
}

/// Let `z = w dt`. Velocity Verlet swings with the frequency `(2/dt) asin(z/2) = w (1 + z^2/24)`. From a start with a
/// velocity it swings too far by `1/sqrt(1 - z^2/4) = 1 + z^2/8`. Semi-implicit Euler swings with the same frequency on
/// an ellipse that is sheared by `z/2`. The shear counts for the start and for the sample. The constants of higher
/// orders are not known here, so these methods are held to the bound of order 2.
fn leading_error(order: u32, tick: f64) -> f64 {
    let z = OMEGA * tick;
    let late = z * z / 24.0 * OMEGA * 20.0 + z * z / 8.0;
    if order >= 2 { late } else { z + late }
}
