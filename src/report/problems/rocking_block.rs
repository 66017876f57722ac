//! A slender block rocks back from its corner, which does not slip, as an inverted pendulum: `I_o a'' = -m g R sin(b -
//! a)`. Here `a` is its tilt, `b` that of tipping over, `R` half the diagonal (Housner 1963). SI units.
//!
//! The block starts at rest with the depth of its corner that bears the force of a rigid block. With a contact of stiffness `k` the
//! error of the ideal falls as `1/k`. The run ends before the other corner strikes. Friction acts on the surface of the floor.

use super::{Class, Constant, EventTiming, Problem, ProblemSetting, Truth};
use jostle_engine::Simulation;

/// The problem.
pub const PROBLEM: Problem = Problem {
    name: "rocking_block",
    law: "a block swings back about its corner as an inverted pendulum",
    source: "Housner 1963; truth file C10, with a contact of finite stiffness",
    class: Class::VelocityDependent,
    tick: TIME / 1024.0,
    samples: &[TIME],
    unit: "m",
    always_located: true,
    scene: |setting, duration| scene(setting, duration, 1e5),
    error,
    leading_error: None,
    constants: CONSTANTS,
    // Sums are compensated: a place below 0.5 m is rounded a few times only.
    rounding: |_| 4.0 * f64::EPSILON * 0.5,
};

/// Measured at finer ticks.
const CONSTANTS: &[Constant] = &[
    Constant::located("ExplicitEuler", 1, 1.800e-1),
    Constant::located("SemiImplicitEuler", 1, 1.341e-1),
    Constant::located("VelocityVerlet", 2, 5.007e-2),
    Constant::located("RungeKutta4", 4, 3.495e1),
    Constant::located("ImplicitMidpoint", 2, 1.004e-1),
];

/// The reference values for a rigid block.
pub const TRUTH: &str = include_str!("../../../assets/truths/C10_rocking_block.json");
/// Those for a contact of 1e5 N/m.
const SOFT: &str = include_str!("../../../assets/truths/C10_soft_rocking_block.json");
/// Of the run, in s.
const TIME: f64 = 0.25;
/// Half the width and half the height, in m.
const HALVES: [f64; 2] = [0.1, 0.4];
/// In kg.
const MASS: f64 = 5.0;
/// In m/s2.
const GRAVITY: f64 = 9.81;

/// The block on its right corner, at half the tilt of tipping over. Its contact has a stiffness in N/m.
pub fn scene(setting: &ProblemSetting, duration: f64, stiffness: f64) -> String {
    let clock = ProblemSetting { events: EventTiming::Located, ..*setting }.clock(duration);
    let angle = -0.5 * libm::atan(HALVES[0] / HALVES[1]);
    let (sin, cos) = libm::sincos(angle);
    // From the centre to the corner.
    let (x, y) = (HALVES[0] * cos + HALVES[1] * sin, HALVES[0] * sin - HALVES[1] * cos);
    // About the corner the inertia is four times that about the centre.
    let inertia = MASS * (HALVES[0] * HALVES[0] + HALVES[1] * HALVES[1]) / 3.0;
    let turning = x * MASS * GRAVITY / (4.0 * inertia);
    let height = -y - MASS * (GRAVITY - turning * x) / stiffness;
    format!(
        "Scene({clock}, gravity: (0, -{GRAVITY:?}), contacts: Penalty(tangential: Exact),
        materials: {{ \"stone\": (stiffness: {stiffness:?}, restitution: 1, friction: 20) }},
        walls: [(name: \"floor\", left: (1, 0), right: (0, 0), material: \"stone\")],
        bodies: [(name: \"block\", at: (0, {height:?}), angle: {angle:?}, mass: {MASS:?}, material: \"stone\",
                  shape: Rectangle(width: {:?}, height: {:?}))])",
        2.0 * HALVES[0],
        2.0 * HALVES[1]
    )
}

/// Of the middle, or of the angle at half the height.
fn error(simulation: &Simulation, _: f64, _: f64) -> f64 {
    let (exact, bodies) = (Truth::read(SOFT).numbers("x, y, theta at 0.25 s"), simulation.bodies());
    let place = bodies.position[0];
    (place.x - exact[0]).hypot(place.y - exact[1]).max(HALVES[1] * (bodies.angle[0] - exact[2]).abs())
}
