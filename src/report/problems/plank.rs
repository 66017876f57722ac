//! A plank with five feet on posts. Statics alone does not determine five forces; the stiffness of the feet does. A
//! foot at `x` bears `k (d + t x)`. The balance of forces and that of torques give `d` and `t`. SI units.
//!
//! The feet touch the posts at the start, and the plank sinks. Dashpots take its swing. All methods end at the same forces.

use std::fmt::Write;

use super::linkage::greatest;
use super::{Class, Problem, ProblemSetting};
use jostle_engine::Simulation;

/// The problem.
pub const PROBLEM: Problem = Problem {
    name: "plank",
    law: "five equal feet share a load by what their stiffness makes of sinking and tilt",
    source: "least complementary energy; truth file S03",
    class: Class::Free,
    tick: 1.0 / 2048.0,
    samples: &[0.3125],
    unit: "1",
    always_located: false,
    scene,
    error,
    leading_error: None,
    constants: &[],
    // An overlap is a difference of heights up to 0.55 m. So is the one from which the error is read.
    rounding: |_| 4.0 * f64::EPSILON * 0.55 * STIFFNESS / WEIGHT,
};

/// The reference values.
pub const TRUTH: &str = include_str!("../../../assets/truths/S03_plank_supports.json");
/// The places of the feet, in m.
pub const FEET: [f64; 5] = [-1.0, -0.5, 0.1, 0.6, 1.0];
/// Of the plank with its feet, in N.
pub const WEIGHT: f64 = MASS * GRAVITY;
/// In kg.
const MASS: f64 = 10.0;
/// In m/s2.
const GRAVITY: f64 = 9.81;
/// The place of the centre of mass, in m.
const CENTRE: f64 = 0.12;
/// Of each foot, in N/m.
const STIFFNESS: f64 = 1e5;
/// Of the feet, in m.
const RADIUS: f64 = 0.05;

/// The forces of the feet in N, from the left.
pub fn forces() -> [f64; 5] {
    let count = FEET.len() as f64;
    let mean = FEET.iter().sum::<f64>() / count;
    let spread: f64 = FEET.iter().map(|x| (x - mean) * (x - mean)).sum();
    FEET.map(|x| WEIGHT / count + WEIGHT * (CENTRE - mean) * (x - mean) / spread)
}

/// Feet of 1 kg each and a board bring the centre of mass to its place.
fn scene(setting: &ProblemSetting, duration: f64) -> String {
    let clock = setting.clock(duration);
    let board = MASS - FEET.len() as f64;
    let middle = (MASS * CENTRE - FEET.iter().sum::<f64>()) / board;
    let (mut feet, mut posts) = (String::new(), String::new());
    for (number, x) in FEET.into_iter().enumerate() {
        let _ = write!(feet, "Disc(at: ({x:?}, 0), radius: {RADIUS:?}, mass: 1),");
        let _ = write!(
            posts,
            "(name: \"post_{number}\", at: ({x:?}, {:?}), fixed: true, material: \"hard\", shape: Rectangle(width: 0.1, height: 1)),",
            -RADIUS - 0.5
        );
    }
    format!(
        "Scene({clock}, gravity: (0, -{GRAVITY:?}), contacts: Penalty(normal: Dashpot, tangential: None, start: AsPlaced),
        materials: {{ \"soft\": (stiffness: {STIFFNESS:?}, restitution: 0.2), \"hard\": (stiffness: 1e300, restitution: 0.2) }},
        bodies: [(name: \"plank\", at: (0, 0), datum: Origin, material: \"soft\",
                  shape: Compound([Rectangle(at: ({middle:?}, 0), width: 2.6, height: 0.04, mass: {board:?}, collides: false), {feet}])),
                 {posts}])"
    )
}

/// The greatest of a foot's force by its overlap, over the weight.
fn error(simulation: &Simulation, _: f64, _: f64) -> f64 {
    let bodies = simulation.bodies();
    let (height, slope) = (bodies.position[0].y, libm::sin(bodies.angle[0]));
    let found = FEET.map(|x| -STIFFNESS * (height + (x - CENTRE) * slope));
    greatest(found.iter().zip(forces()).map(|(found, exact)| (found - exact) / WEIGHT))
}
