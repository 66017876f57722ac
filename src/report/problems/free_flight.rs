//! A ball thrown with spin, without drag: `x = x0 + v t - g t^2/2`, `angle = omega t` (any textbook). SI units.
//!
//! Semi-implicit Euler is off by exactly `g t dt/2`; methods of order 2 and more are exact.

use glam::DVec2;

use super::{Class, Constant, Problem, ProblemSetting, rounding_of};
use jostle_engine::Simulation;

/// The problem.
pub const PROBLEM: Problem = Problem {
    name: "free_flight",
    law: "a thrown ball flies along a parabola and keeps its spin",
    source: "textbook kinematics; truth file P01",
    class: Class::ConstantAcceleration,
    tick: 0.05,
    samples: &[0.5, 1.0, 2.0, 3.0],
    unit: "m",
    always_located: false,
    scene,
    error,
    // The exact discrete solution of a method of order 1: g t dt/2.
    leading_error: Some(|_, tick| GRAVITY * 3.0 * tick / 2.0),
    constants: CONSTANTS,
    // Velocities round at every tick without compensation. That adds up over the flight of 3 s at up to 20 m/s.
    rounding: |tick| rounding_of(3.0 / tick, 60.0),
};

/// Derived: under constant acceleration `g` methods of order 1 are ahead or behind by `g t dt/2`, at most after 3 s.
const CONSTANTS: &[Constant] = &[
    Constant::located("ExplicitEuler", 1, 1.5 * GRAVITY),
    Constant::per_tick("SemiImplicitEuler", 1, 1.5 * GRAVITY),
    Constant::located("SemiImplicitEuler", 1, 1.5 * GRAVITY),
];

const GRAVITY: f64 = 9.81;

/// Position in m and velocity in m/s at `time`.
pub fn state(time: f64) -> (DVec2, DVec2) {
    let (start, velocity, gravity) = (DVec2::new(1.0, 2.0), DVec2::new(12.0, 15.0), DVec2::new(0.0, -GRAVITY));
    (start + velocity * time + gravity * (0.5 * time * time), velocity + gravity * time)
}

/// Angle in rad at `time`.
pub fn angle(time: f64) -> f64 {
    3.0 * time
}

fn scene(setting: &ProblemSetting, duration: f64) -> String {
    let clock = setting.clock(duration);
    format!(
        "Scene({clock}, gravity: (0, {:?}),
        bodies: [(name: \"ball\", at: (1, 2), velocity: (12, 15), spin: 3, atoms: Disc(radius: 0.1, mass: 1))])",
        -GRAVITY
    )
}

/// Distance in m; the angle counts as the way of a point of the rim, 0.1 m from the centre.
fn error(simulation: &Simulation, time: f64, _: f64) -> f64 {
    let bodies = simulation.bodies();
    let turned = 0.1 * (bodies.angle[0] - angle(time)).abs();
    (bodies.position[0] - state(time).0).length().max(turned)
}
