//! Spools roll on a floor without slipping. A string pulls each one from the bottom of its drum, at an angle `a` above the floor. The
//! acceleration is `F R (R cos a - r)/(I + m R^2)`: forwards up to `cos a = r/R`, backwards above. SI units.
//!
//! `R` is the height of the centre above the floor: the radius minus the overlap that bears the load. The string's
//! direction does not change. So its pull is a force in the centre and a torque `F r`.

use std::fmt::Write;

use super::linkage::greatest;
use super::{Class, Constant, EventTiming, Problem, ProblemSetting, rounding_of};
use jostle_engine::Simulation;

/// The problem.
pub const PROBLEM: Problem = Problem {
    name: "spool",
    law: "a spool rolls towards the string or away from it, as the string's line of action tells",
    source: "textbook; truth file F06",
    class: Class::ConstantAcceleration,
    tick: 1.0 / 128.0,
    samples: &[0.5, 1.0],
    unit: "m",
    always_located: true,
    scene,
    error,
    leading_error: None,
    constants: CONSTANTS,
    rounding: |tick| rounding_of(1.0 / tick, 4.0),
};

/// Measured at finer ticks.
const CONSTANTS: &[Constant] =
    &[Constant::located("ExplicitEuler", 1, 5.036e-1), Constant::located("SemiImplicitEuler", 1, 5.036e-1)];

/// The reference values.
pub const TRUTH: &str = include_str!("../../../assets/truths/F06_spool.json");
/// Angles of the strings in degrees, as the truth file has them; the third is the neutral one.
pub const ANGLES: [&str; 4] = ["0", "40", "65.37568164780463", "80"];
/// In N/m.
const STIFFNESS: f64 = 1e4;
/// In kg.
const MASS: f64 = 2.0;
/// In kg m2.
const INERTIA: f64 = 0.012;
/// Of spool and drum, in m.
const RADII: [f64; 2] = [0.12, 0.05];
/// Of a string, in N.
const PULL: f64 = 5.0;
/// In m/s2.
const GRAVITY: f64 = 9.81;
/// Of neighbours, in m.
const DISTANCE: f64 = 2.0;

/// The angle of a string in rad.
fn radians(angle: &str) -> f64 {
    angle.parse::<f64>().expect("an angle is a number").to_radians()
}

/// The height of the centre in m of a spool that is pulled at an angle in rad.
fn height(angle: f64) -> f64 {
    RADII[0] - (MASS * GRAVITY - PULL * libm::sin(angle)) / STIFFNESS
}

/// The acceleration in m/s2 of a spool, by its centre's height in m and the pull's angle in rad.
pub fn acceleration(height: f64, angle: f64) -> f64 {
    PULL * height * (height * libm::cos(angle) - RADII[1]) / (INERTIA + MASS * height * height)
}

fn scene(setting: &ProblemSetting, duration: f64) -> String {
    let clock = ProblemSetting { events: EventTiming::Located, ..*setting }.clock(duration);
    let (mut spools, mut pulls) = (String::new(), String::new());
    for (number, angle) in ANGLES.into_iter().map(radians).enumerate() {
        let _ = write!(
            spools,
            "(name: \"spool_{number}\", at: ({:?}, {:?}), mass: {MASS:?}, inertia: {INERTIA:?}, material: \"rubber\",
              shape: Disc(radius: {:?})),",
            DISTANCE * number as f64,
            height(angle),
            RADII[0]
        );
        let (sin, cos) = libm::sincos(angle);
        let _ = write!(
            pulls,
            "Drive(of: \"spool_{number}\", force: ({:?}, {:?}), torque: {:?}, course: Piecewise([(0, 1)])),",
            PULL * cos,
            PULL * sin,
            PULL * RADII[1]
        );
    }
    format!(
        "Scene({clock}, gravity: (0, -{GRAVITY:?}), contacts: Penalty(tangential: Exact), forces: [{pulls}],
        materials: {{ \"rubber\": (stiffness: {STIFFNESS:?}, friction: 0.4, restitution: 1) }},
        walls: [(name: \"floor\", left: (1, 0), right: (0, 0), material: \"rubber\")], bodies: [{spools}])"
    )
}

/// The greatest of a spool's way, or of what its rim turned by.
fn error(simulation: &Simulation, time: f64, _: f64) -> f64 {
    let bodies = simulation.bodies();
    greatest(ANGLES.into_iter().map(radians).enumerate().flat_map(|(spool, angle)| {
        let way = 0.5 * acceleration(height(angle), angle) * time * time;
        let rolled = height(angle) * bodies.angle[spool];
        [bodies.position[spool].x - DISTANCE * spool as f64 - way, rolled + way]
    }))
}
