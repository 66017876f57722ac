//! A ladder slides down between a wall and a floor without friction. It leaves the wall at `sin a = (2/3) sin a0`. SI units.
//!
//! The ladder is a capsule. Forces on its round ends go through their centres. So it moves as a thin rod at the
//! distance of its radius. It starts at rest with those overlaps that carry the forces of a rigid ladder. Its contacts
//! then hardly swing.
//!
//! Off the wall no force acts along the floor, and the middle keeps its velocity. With contacts of stiffness `k` the error of
//! the ideal falls as `1/k`.

use super::{Class, Constant, Problem, ProblemSetting, Truth, rounding_of};
use jostle_engine::Simulation;

/// The problem.
pub const PROBLEM: Problem = Problem {
    name: "falling_ladder",
    law: "a ladder without friction leaves the wall with the velocity of its middle",
    source: "textbook; truth file C11, with contacts of finite stiffness",
    class: Class::Kink,
    tick: 1.0 / 1024.0,
    samples: &[0.75, 0.9],
    unit: "m",
    always_located: false,
    scene: |setting, duration| scene(setting, duration, STIFFNESS),
    error,
    leading_error: None,
    constants: CONSTANTS,
    // Places and angles are near 1, an overlap counts for 3300 m/s2 per metre over half a second.
    rounding: |tick| rounding_of(0.9 / tick, 2.0),
};

/// Measured at finer ticks.
const CONSTANTS: &[Constant] = &[
    Constant::located("ExplicitEuler", 1, 1.460e0),
    Constant::per_tick("SemiImplicitEuler", 1, 7.040e-1),
    Constant::located("SemiImplicitEuler", 1, 7.039e-1),
    Constant::per_tick("VelocityVerlet", 2, 4.992e-1),
    Constant::located("VelocityVerlet", 2, 9.223e-1),
    Constant::located("RungeKutta4", 4, 2.918e2),
    Constant::located("ImplicitMidpoint", 2, 1.589e0),
];

/// The reference values for rigid walls.
pub const TRUTH: &str = include_str!("../../../assets/truths/C11_falling_ladder.json");
/// Those for contacts of [`STIFFNESS`].
pub const SOFT: &str = include_str!("../../../assets/truths/C11_soft_ladder.json");
/// In N/m.
pub const STIFFNESS: f64 = 1e4;
/// Of the ends, in m.
pub const RADIUS: f64 = 0.05;
/// Half the length of the rod, in m.
pub const HALF: f64 = 1.0;
/// In kg.
const MASS: f64 = 3.0;
/// In m/s2.
const GRAVITY: f64 = 9.81;
/// Between ladder and floor at the start, in degrees.
const START: f64 = 75.0;

/// The ladder between walls of a stiffness in N/m.
pub fn scene(setting: &ProblemSetting, duration: f64, stiffness: f64) -> String {
    let clock = setting.clock(duration);
    let angle = START.to_radians();
    let (sin, cos) = libm::sincos(angle);
    // A rigid rod begins to fall with this angular acceleration.
    let turning = 0.75 * GRAVITY / HALF * cos;
    let wall = MASS * HALF * sin * turning / stiffness;
    let floor = MASS * (GRAVITY - HALF * cos * turning) / stiffness;
    let (x, y) = (HALF * cos + RADIUS - wall, HALF * sin + RADIUS - floor);
    let inertia = MASS * HALF * HALF / 3.0;
    format!(
        "Scene({clock}, gravity: (0, -{GRAVITY:?}), contacts: Penalty(tangential: None),
        materials: {{ \"ice\": (stiffness: {stiffness:?}, restitution: 1) }},
        walls: [(name: \"floor\", left: (1, 0), right: (0, 0), material: \"ice\"),
                (name: \"wall\", left: (0, 0), right: (0, 1), material: \"ice\")],
        bodies: [(name: \"ladder\", at: ({x:?}, {y:?}), angle: -{angle:?}, mass: {MASS:?}, inertia: {inertia:?}, material: \"ice\",
                  shape: Capsule(from: (-{HALF:?}, 0), to: ({HALF:?}, 0), radius: {RADIUS:?}))])"
    )
}

/// The position in m of the soft ladder's middle along the floor, at a `time` after it leaves the wall.
fn way(time: f64) -> f64 {
    let truth = Truth::read(SOFT);
    let left = truth.number("detach time");
    let at = truth.numbers("x from the wall surface, y above the floor surface of the rod at that time")[0];
    at + truth.numbers("vx, vy, theta rate at that time")[0] * (time - left)
}

/// Of the middle along the floor.
fn error(simulation: &Simulation, time: f64, _: f64) -> f64 {
    (simulation.bodies().position[0].x - way(time)).abs()
}
