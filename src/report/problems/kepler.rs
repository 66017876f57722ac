//! A planet on an ellipse of eccentricity 0.9 about a fixed sun (Kepler 1609). SI units, `G M = 1`, `a = 1`.
//!
//! With the eccentric anomaly `E` of `E - e sin E = M` (Kepler's equation): `x = cos E - e`, `y = sqrt(1 - e^2) sin E`.
//! It starts at the farthest point, `M = pi`, and passes the sun at a tenth of the mean distance. So the motion is
//! smooth, but with two very different rates.

use std::f64::consts::{PI, TAU};

use glam::DVec2;

use super::{Class, Constant, Problem, ProblemSetting, rounding_of};
use jostle_engine::Simulation;

/// The problem.
pub const PROBLEM: Problem = Problem {
    name: "kepler",
    law: "equal areas in equal times, on an ellipse with the sun in a focus",
    source: "Kepler's equation; Hairer, Lubich, Wanner, Geometric Numerical Integration, I.2; truth file P07",
    class: Class::Smooth,
    tick: TAU / 16_000.0,
    samples: &[0.25 * TAU, 0.5 * TAU, 1.3 * TAU],
    unit: "1",
    always_located: false,
    scene,
    error,
    leading_error: Some(leading_error),
    constants: CONSTANTS,
    // A rounding error of the energy makes a phase error that grows with time: see below.
    rounding: |tick| rounding_of(1.3 * TAU / tick, PHASE_GROWTH),
};

/// Measured at finer ticks.
const CONSTANTS: &[Constant] = &[
    Constant::located("ExplicitEuler", 1, 5.860e3),
    Constant::per_tick("SemiImplicitEuler", 1, 2.414e0),
    Constant::located("SemiImplicitEuler", 1, 2.414e0),
    Constant::per_tick("VelocityVerlet", 2, 3.895e2),
    Constant::located("VelocityVerlet", 2, 3.895e2),
    Constant::located("ImplicitMidpoint", 2, 7.791e2),
    Constant::located("RungeKutta4", 4, 1.420e5),
];

/// Eccentricity.
pub const ECCENTRICITY: f64 = 0.9;
/// `delta E/E` makes the planet late by `1.5 t delta E/E` (third law), at the mean speed of 0.64 m/s.
const PHASE_GROWTH: f64 = 1.5 * 1.3 * TAU * 0.65;

/// Position in m and velocity in m/s at `time`.
pub fn state(time: f64) -> (DVec2, DVec2) {
    let mean = PI + (time % TAU);
    let mut eccentric = mean;
    // Newton's method from the mean anomaly converges for e < 1; it doubles the digits each time.
    for _ in 0..60 {
        let (sin, cos) = libm::sincos(eccentric);
        eccentric -= (eccentric - ECCENTRICITY * sin - mean) / (1.0 - ECCENTRICITY * cos);
    }
    let (sin, cos) = libm::sincos(eccentric);
    let minor = (1.0 - ECCENTRICITY * ECCENTRICITY).sqrt();
    let rate = 1.0 / (1.0 - ECCENTRICITY * cos);
    (DVec2::new(cos - ECCENTRICITY, minor * sin), DVec2::new(-sin, minor * cos) * rate)
}

fn scene(setting: &ProblemSetting, duration: f64) -> String {
    scene_of(setting, duration, ECCENTRICITY)
}

/// The planet on an ellipse of any eccentricity.
pub fn scene_of(setting: &ProblemSetting, duration: f64, eccentricity: f64) -> String {
    let clock = setting.clock(duration);
    let (farthest, speed) = (1.0 + eccentricity, ((1.0 - eccentricity) / (1.0 + eccentricity)).sqrt());
    format!(
        "Scene({clock}, forces: [Attraction(constant: 1)], bodies: [
            (name: \"sun\", fixed: true, at: (0, 0), collides: false, atoms: Disc(radius: 0.01, mass: 1)),
            (name: \"planet\", at: (-{farthest:?}, 0), velocity: (0, -{speed:?}), collides: false,
             atoms: Disc(radius: 0.01, mass: 0.5)),
        ])"
    )
}

/// Distance over the major half-axis.
fn error(simulation: &Simulation, time: f64, _: f64) -> f64 {
    (simulation.bodies().position[1] - state(time).0).length()
}

/// At its passage of the sun, `r = 0.1`, the rate is `r^-1.5` and the kinetic energy 19 times the total. The energy may
/// be off by that times `(rate dt)^p`, and the phase by the delay above.
fn leading_error(order: u32, tick: f64) -> f64 {
    let rate = (1.0 - ECCENTRICITY).powf(-1.5);
    19.0 * PHASE_GROWTH * (rate * tick).powi(order as i32)
}
