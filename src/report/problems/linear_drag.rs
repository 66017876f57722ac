//! A throw through a viscous medium: `m v' = m g - c v` (Stokes 1851). SI units.
//!
//! With the rate `r = c/m` and the terminal velocity `u = g/r`: `v = u + (v0 - u) e^(-r t)`,
//! `x = u t + (v0 - u) (1 - e^(-r t))/r`.

use glam::DVec2;

use super::{Class, Constant, Problem, ProblemSetting, rounding_of};
use jostle_engine::Simulation;

/// The problem.
pub const PROBLEM: Problem = Problem {
    name: "linear_drag",
    law: "drag in proportion to the speed: velocities approach the terminal one exponentially",
    source: "textbook, exact exponential; truth file P03",
    class: Class::VelocityDependent,
    tick: 0.025,
    samples: &SAMPLES,
    unit: "1",
    always_located: false,
    scene,
    error,
    leading_error: Some(leading_error),
    constants: CONSTANTS,
    rounding: |tick| rounding_of(10.0 / tick, 4.0),
};

/// Measured at finer ticks.
const CONSTANTS: &[Constant] = &[
    Constant::located("ExplicitEuler", 1, 4.228e-1),
    Constant::per_tick("SemiImplicitEuler", 1, 8.158e-1),
    Constant::located("SemiImplicitEuler", 1, 8.158e-1),
    Constant::per_tick("VelocityVerlet", 2, 2.641e-2),
    Constant::located("VelocityVerlet", 2, 1.416e-2),
    Constant::located("ImplicitMidpoint", 2, 1.759e-2),
    Constant::located("RungeKutta4", 4, 1.105e-4),
];

const SAMPLES: [f64; 5] = [0.5, 1.0, 2.0, 5.0, 10.0];
/// `c/m` in 1/s.
const RATE: f64 = 0.25;

/// Position in m and velocity in m/s at `time`.
pub fn state(time: f64) -> (DVec2, DVec2) {
    let terminal = DVec2::new(0.0, -9.81 / RATE);
    let start = DVec2::new(10.0, 20.0);
    let decay = libm::exp(-RATE * time);
    (terminal * time - (start - terminal) * (libm::expm1(-RATE * time) / RATE), terminal + (start - terminal) * decay)
}

fn scene(setting: &ProblemSetting, duration: f64) -> String {
    let clock = setting.clock(duration);
    format!(
        "Scene({clock}, gravity: (0, -9.81), forces: [Drag(linear: 0.5)],
        bodies: [(name: \"ball\", at: (0, 0), velocity: (10, 20), atoms: Disc(radius: 0.1, mass: 2))])"
    )
}

/// Relative to the distance from the start.
fn error(simulation: &Simulation, time: f64, _: f64) -> f64 {
    let exact = state(time).0;
    (simulation.bodies().position[0] - exact).length() / exact.length()
}

/// The error of a tick is at most `dt^(p+1)` times the next derivative of the velocity. That is `a r^p` with `a` the
/// acceleration at the start. Over `t` velocities are off by `a t r^p dt^p`. Positions are off by the sum of that and
/// of the same one derivative lower: `a t r^(p-1) (1 + r t) dt^p`.
fn leading_error(order: u32, tick: f64) -> f64 {
    let acceleration = DVec2::new(10.0 * RATE, 9.81 + 20.0 * RATE).length();
    let missed = |&time: &f64| time * (1.0 + RATE * time) / state(time).0.length();
    let power = RATE.powi(order as i32 - 1) * tick.powi(order as i32);
    acceleration * power * SAMPLES.iter().map(missed).fold(0.0, f64::max)
}
