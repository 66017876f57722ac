//! The corner of a turning box hits a floor without friction. The effective mass at the corner is `1/(1/m + x^2/I)`. Here `x` is the
//! distance of the corner from the centre along the floor. The impulse of a hard impact is `(1 + e) v` times that mass. SI units, no
//! gravity.
//!
//! With a contact of stiffness `k` the box turns during the contact. The error of the ideal falls as `1/sqrt(k)`. The
//! force jumps at the deepest overlap.

use super::{Class, Constant, Problem, ProblemSetting, Truth, rounding_of};
use jostle_engine::Simulation;

/// The problem.
pub const PROBLEM: Problem = Problem {
    name: "corner_impact",
    law: "a box that falls on a corner takes up spin",
    source: "textbook; truth file C09, with a contact of finite stiffness",
    class: Class::Jump,
    tick: 1.0 / 65_536.0,
    samples: &[6.0 / 1024.0],
    unit: "1",
    always_located: false,
    scene: |setting, duration| scene(setting, duration, STIFFNESS),
    error,
    leading_error: None,
    constants: CONSTANTS,
    rounding,
};

/// Measured at finer ticks.
const CONSTANTS: &[Constant] = &[
    Constant::located("ExplicitEuler", 1, 5.592e2),
    Constant::per_tick("SemiImplicitEuler", 1, 1.579e0),
    Constant::located("SemiImplicitEuler", 2, 3.458e4),
    Constant::per_tick("VelocityVerlet", 1, 1.173e0),
    Constant::located("VelocityVerlet", 2, 5.279e4),
    Constant::located("RungeKutta4", 4, 3.030e8),
    Constant::located("ImplicitMidpoint", 2, 1.438e3),
    Constant::located("Symplectic4", 4, 1.082e8),
];

/// The reference values for a hard impact.
pub const TRUTH: &str = include_str!("../../../assets/truths/C09_box_corner_impact.json");
/// Those for a contact of [`STIFFNESS`].
pub const SOFT: &str = include_str!("../../../assets/truths/C09_soft_corner_impact.json");
/// In N/m.
pub const STIFFNESS: f64 = 1e6;
/// In m/s, downwards.
pub const SPEED: f64 = 3.0;
/// In rad/s.
const SPIN: f64 = 1.5;
/// In kg.
const MASS: f64 = 2.0;
/// In m.
const SIDES: [f64; 2] = [0.6, 0.4];
/// When the corner touches, in degrees.
const ANGLE: f64 = 25.0;
/// The force grows with this share while the corner sinks: `e` is a half.
const INELASTICITY: f64 = 0.6;
/// To the touch at [`STIFFNESS`], in s.
const LEAD: f64 = 1.0 / 1024.0;

/// The box above a floor, with a contact of a stiffness in N/m. The time to the touch goes with `1/sqrt(k)`. A shift lets the box
/// start that much earlier on its way.
pub fn scene(setting: &ProblemSetting, duration: f64, stiffness: f64) -> String {
    let clock = setting.clock(duration);
    let lead = LEAD * (STIFFNESS / stiffness).sqrt() + setting.shift;
    let touching = ANGLE.to_radians();
    let (sin, cos) = libm::sincos(touching);
    let height = 0.5 * (SIDES[0] * sin + SIDES[1] * cos) + SPEED * lead;
    let angle = touching - SPIN * lead;
    format!(
        "Scene({clock}, contacts: Penalty(tangential: None),
        materials: {{ \"wood\": (stiffness: {stiffness:?}, inelasticity: {INELASTICITY:?}) }},
        walls: [(name: \"floor\", left: (1, 0), right: (0, 0), material: \"wood\")],
        bodies: [(name: \"box\", at: (0, {height:?}), angle: {angle:?}, velocity: (0, -{SPEED:?}), spin: {SPIN:?}, mass: {MASS:?},
                  material: \"wood\", shape: Rectangle(width: {:?}, height: {:?}))])",
        SIDES[0], SIDES[1]
    )
}

/// The deviation of a box from a velocity upwards in m/s and a spin in rad/s, over the speed before. The spin counts at
/// the end of half the longer side.
pub fn off(simulation: &Simulation, after: &[f64]) -> f64 {
    let bodies = simulation.bodies();
    let rim = 0.5 * SIDES[0] * (bodies.spin[0] - after[1]);
    (bodies.velocity[0].y - after[0]).abs().max(rim.abs()) / SPEED
}

fn error(simulation: &Simulation, _: f64, _: f64) -> f64 {
    off(simulation, &Truth::read(SOFT).numbers("v_y, omega after"))
}

/// Rounding of states in all ticks, and of an overlap near 1 mm. It is a difference of positions near 0.3 m.
fn rounding(tick: f64) -> f64 {
    rounding_of(6.0 / 1024.0 / tick, 4.0) + f64::EPSILON * 0.3 / 1e-3
}
