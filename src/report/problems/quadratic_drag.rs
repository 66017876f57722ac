//! A fall and an oblique shot through air: `m v' = m g - c |v| v` (Newton 1687). SI units.
//!
//! The fall from rest has a closed form: with the terminal speed `u = sqrt(m g/c)`, `v = u tanh(g t/u)` and `depth =
//! (u^2/g) ln cosh(g t/u)`. The oblique shot has none. Its positions come from the truth file, in which two independent
//! methods agree to 2e-15.

use glam::DVec2;

use super::{Class, Constant, Problem, ProblemSetting, Truth, rounding_of};
use jostle_engine::Simulation;

/// The problem.
pub const PROBLEM: Problem = Problem {
    name: "quadratic_drag",
    law: "drag in proportion to the square of the speed",
    source: "textbook (tanh); oblique: extrapolation and DOP853 to 18 digits; truth file P04",
    class: Class::VelocityDependent,
    tick: 0.0125,
    samples: &SAMPLES,
    unit: "1",
    always_located: false,
    scene,
    error,
    leading_error: Some(leading_error),
    constants: CONSTANTS,
    rounding: |tick| rounding_of(4.0 / tick, 4.0),
};

/// Measured at finer ticks.
const CONSTANTS: &[Constant] = &[
    Constant::located("ExplicitEuler", 1, 3.953e0),
    Constant::per_tick("SemiImplicitEuler", 1, 4.016e0),
    Constant::located("SemiImplicitEuler", 1, 4.016e0),
    Constant::per_tick("VelocityVerlet", 2, 4.067e-1),
    Constant::located("VelocityVerlet", 2, 1.202e-1),
    Constant::located("ImplicitMidpoint", 2, 1.818e-1),
    Constant::located("RungeKutta4", 4, 1.079e-1),
    Constant::located("Symplectic4", 4, 2.364e-3),
];

/// The reference values.
pub const TRUTH: &str = include_str!("../../../assets/truths/P04_quadratic_drag.json");
/// Times of the samples in seconds.
pub const SAMPLES: [f64; 4] = [0.25, 1.0, 2.0, 4.0];
const GRAVITY: f64 = 9.81;
/// `c/m` in 1/m.
const COEFFICIENT: f64 = 0.02 / 0.5;

/// Depth in m and speed in m/s of the fall at `time`.
pub fn fall(time: f64) -> (f64, f64) {
    let terminal = (GRAVITY / COEFFICIENT).sqrt();
    let argument = GRAVITY * time / terminal;
    (terminal * terminal / GRAVITY * libm::log(libm::cosh(argument)), terminal * libm::tanh(argument))
}

/// Position in m of the oblique shot at one of the samples; `None` elsewhere.
pub fn oblique(time: f64) -> Option<DVec2> {
    let row = SAMPLES.iter().position(|&sample| sample == time)? * 4;
    let numbers = Truth::read(TRUTH).numbers("oblique[x,y,vx,vy]");
    Some(DVec2::new(numbers[row], numbers[row + 1]))
}

fn scene(setting: &ProblemSetting, duration: f64) -> String {
    let clock = setting.clock(duration);
    let angle = 40.0_f64.to_radians();
    let (x, y) = (30.0 * libm::cos(angle), 30.0 * libm::sin(angle));
    format!(
        "Scene({clock}, gravity: (0, -{GRAVITY:?}), forces: [Drag(quadratic: 0.02)], bodies: [
            (name: \"fall\", at: (0, 0), collides: false, atoms: Disc(radius: 0.1, mass: 0.5)),
            (name: \"shot\", at: (0, 0), velocity: ({x:?}, {y:?}), collides: false, atoms: Disc(radius: 0.1, mass: 0.5)),
        ])"
    )
}

/// Relative to the distance from the start, the greater of both bodies.
fn error(simulation: &Simulation, time: f64, _: f64) -> f64 {
    let position = &simulation.bodies().position;
    let depth = fall(time).0;
    let fallen = (position[0] - DVec2::new(0.0, -depth)).length() / depth;
    oblique(time).map_or(fallen, |exact| fallen.max((position[1] - exact).length() / exact.length()))
}

/// As for linear drag, with the rate `2 c v/m` and the acceleration at the start of the shot. Both are greatest there.
fn leading_error(order: u32, tick: f64) -> f64 {
    let (rate, acceleration) = (2.0 * COEFFICIENT * 30.0, GRAVITY + COEFFICIENT * 900.0);
    let shot = |&time: &f64| {
        let distance = oblique(time).map_or(f64::INFINITY, DVec2::length);
        acceleration * time * (1.0 + rate * time) / distance
    };
    // The fall begins with g and with a rate that is at most that of the terminal speed.
    let slow = 2.0 * COEFFICIENT * (GRAVITY / COEFFICIENT).sqrt();
    let fallen = |&time: &f64| GRAVITY * time * (1.0 + slow * time) / fall(time).0;
    let greatest = SAMPLES.iter().map(|time| shot(time).max(fallen(time))).fold(0.0, f64::max);
    greatest * rate.powi(order as i32 - 1) * tick.powi(order as i32)
}
