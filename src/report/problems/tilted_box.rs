//! A box slides down an incline with `g (sin a - mu cos a)`. The incline is steeper than the angle of friction, and too
//! flat to topple the box. Friction loads the lower edge of the base more, but the upper one becomes free only at `tan
//! a = w/h`. SI units.
//!
//! The floor is level and the weight tilted. The box starts with the overlaps and the tilt that balance its forces. It
//! keeps them, and its acceleration is constant.

use super::linkage::greatest;
use super::{Class, Constant, EventTiming, Problem, ProblemSetting, rounding_of};
use jostle_engine::Simulation;

/// The problem.
pub const PROBLEM: Problem = Problem {
    name: "tilted_box",
    law: "a box slides on the two corners of its base before it topples",
    source: "textbook (Coulomb 1785); truth file F07",
    class: Class::ConstantAcceleration,
    tick: 1.0 / 1024.0,
    samples: &[0.25, 0.5],
    unit: "m",
    always_located: true,
    scene: |setting, duration| scene(setting, duration, &INCLINE),
    error,
    leading_error: None,
    constants: CONSTANTS,
    rounding: |tick| rounding_of(0.5 / tick, 4.0),
};

/// Measured at finer ticks.
const CONSTANTS: &[Constant] =
    &[Constant::located("ExplicitEuler", 1, 1.074e-1), Constant::located("SemiImplicitEuler", 1, 1.074e-1)];

/// The reference values.
pub const TRUTH: &str = include_str!("../../../assets/truths/F07_topple_or_slide.json");
/// Its slope lies between that of friction, 0.5, and that of toppling, 0.6.
const INCLINE: Incline = Incline { slope: 0.55, friction: 0.5, stiffness: 1e4, restitution: 1.0 };
/// In kg.
const MASS: f64 = 4.0;
/// In m/s2.
pub const GRAVITY: f64 = 9.81;
/// Width and height in m.
const SIDES: [f64; 2] = [0.3, 0.5];

/// An incline and its contact with the box.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Incline {
    /// The tangent of its angle.
    pub slope: f64,
    /// The coefficient of friction.
    pub friction: f64,
    /// Of a corner, in N/m.
    pub stiffness: f64,
    /// Of the contact.
    pub restitution: f64,
}

impl Incline {
    /// The box with its base in balance: the height of its middle in m, and its angle in rad.
    pub fn balance(&self) -> (f64, f64) {
        let load = MASS * GRAVITY * libm::cos(libm::atan(self.slope));
        let pull = self.slope.min(self.friction);
        let (mut height, mut angle) = (0.5 * SIDES[1], 0.0);
        // Overlaps are at most a hundredth of the sides: each round gains two digits.
        for _ in 0..10 {
            let (sin, cos) = libm::sincos(angle);
            let uneven = (height * pull - 0.5 * SIDES[1] * sin) / (SIDES[0] * cos);
            height = 0.5 * SIDES[1] * cos - 0.5 * load / self.stiffness;
            angle = -libm::asin(2.0 * uneven * load / (self.stiffness * SIDES[0]));
        }
        (height, angle)
    }
}

/// The box on an incline.
pub fn scene(setting: &ProblemSetting, duration: f64, incline: &Incline) -> String {
    let clock = ProblemSetting { events: EventTiming::Located, ..*setting }.clock(duration);
    let Incline { slope, friction, stiffness, restitution } = incline;
    let (sin, cos) = libm::sincos(libm::atan(*slope));
    let (height, angle) = incline.balance();
    format!(
        "Scene({clock}, gravity: ({:?}, -{:?}), contacts: Penalty(tangential: Exact),
        materials: {{ \"wood\": (stiffness: {stiffness:?}, friction: {friction:?}, restitution: {restitution:?}) }},
        walls: [(name: \"incline\", left: (1, 0), right: (0, 0), material: \"wood\")],
        bodies: [(name: \"box\", at: (0, {height:?}), angle: {angle:?}, mass: {MASS:?}, material: \"wood\",
                  shape: Rectangle(width: {:?}, height: {:?}))])",
        GRAVITY * sin,
        GRAVITY * cos,
        SIDES[0],
        SIDES[1]
    )
}

/// The greatest of the way down the incline, the height above it, and the turning at half the height.
fn error(simulation: &Simulation, time: f64, _: f64) -> f64 {
    let (sin, cos) = libm::sincos(libm::atan(INCLINE.slope));
    let (height, angle) = INCLINE.balance();
    let way = 0.5 * GRAVITY * (sin - INCLINE.friction * cos) * time * time;
    let bodies = simulation.bodies();
    let (place, turned) = (bodies.position[0], bodies.angle[0] - angle);
    greatest([place.x - way, place.y - height, 0.5 * SIDES[1] * turned])
}
