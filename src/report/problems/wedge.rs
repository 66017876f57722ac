//! Discs lie in grooves between two wedges. At half an opening angle `a` each side bears `m g/(2 sin a)`. A disc swings
//! vertically with `sqrt(2 k/m) sin a` and sideways with `sqrt(2 k/m) cos a`, whatever the amplitude. SI units, no friction.
//!
//! Each disc starts at rest off its equilibrium by less than would part it from a side. The wedges are fixed polygons.

use std::fmt::Write;

use glam::DVec2;

use super::linkage::greatest;
use super::{Class, Constant, Problem, ProblemSetting};
use jostle_engine::Simulation;

/// The problem.
pub const PROBLEM: Problem = Problem {
    name: "wedge",
    law: "a disc between two wedges swings along and across the groove",
    source: "statics; truth file S04",
    class: Class::Smooth,
    tick: 1.0 / 16_384.0,
    samples: &[0.03125, 0.0625],
    unit: "1",
    always_located: false,
    scene,
    error,
    leading_error: None,
    constants: CONSTANTS,
    // A position of up to 1.5 m counts as a share of the least sinking, 9.81e-5 m. It counts for itself, for the
    // overlaps on both sides, and in the reference.
    rounding: |_| 4.0 * f64::EPSILON * 1.5 / 9.81e-5,
};

/// Measured at finer ticks.
const CONSTANTS: &[Constant] = &[
    Constant::located("ExplicitEuler", 1, 1.125e3),
    Constant::per_tick("SemiImplicitEuler", 1, 7.172e1),
    Constant::located("SemiImplicitEuler", 1, 7.172e1),
    Constant::per_tick("VelocityVerlet", 2, 3.691e4),
    Constant::located("VelocityVerlet", 2, 3.691e4),
    Constant::located("RungeKutta4", 4, 7.342e8),
    Constant::located("ImplicitMidpoint", 2, 7.382e4),
];

/// The reference values.
pub const TRUTH: &str = include_str!("../../../assets/truths/S04_wedge.json");
/// Angles between the sides of grooves and the vertical in degrees, and the places of the grooves in m.
pub const GROOVES: [(u32, f64); 3] = [(45, 1.5), (10, -1.5), (2, 0.0)];
/// Of the contact of a disc and a wedge, in N/m.
const STIFFNESS: f64 = 1e5;
/// Of the discs, in m.
const RADIUS: f64 = 0.1;
/// In m/s2.
const GRAVITY: f64 = 9.81;
/// A disc starts off its equilibrium upwards and to the right. This is its share of the way that would part it from a
/// side.
const OFF: f64 = 0.4;

/// The force of a side in N, overlap and sinking in m, frequency of the vertical swing in rad/s. The angle is half of the
/// opening, in degrees.
pub fn statics(degrees: u32) -> [f64; 4] {
    let sin = libm::sin(f64::from(degrees).to_radians());
    let force = GRAVITY / (2.0 * sin);
    let overlap = force / STIFFNESS;
    [force, overlap, overlap / sin, (2.0 * STIFFNESS).sqrt() * sin]
}

/// The middle of a disc of 1 kg from the bottom of its groove at `time`, in m.
fn place(degrees: u32, time: f64) -> DVec2 {
    let (sin, cos) = libm::sincos(f64::from(degrees).to_radians());
    let [_, overlap, sinking, swing] = statics(degrees);
    let across = OFF * overlap / cos * libm::cos((2.0 * STIFFNESS).sqrt() * cos * time);
    let up = OFF * sinking * libm::cos(swing * time);
    DVec2::new(across, (RADIUS - overlap) / sin + up)
}

fn scene(setting: &ProblemSetting, duration: f64) -> String {
    let clock = setting.clock(duration);
    let (mut discs, mut wedges) = (String::new(), String::new());
    for (degrees, middle) in GROOVES {
        let at = place(degrees, 0.0) + DVec2::new(middle, 0.0);
        let _ = write!(
            discs,
            "(name: \"disc_{degrees}\", at: ({:?}, {:?}), mass: 1, material: \"soft\", shape: Disc(radius: {RADIUS:?})),",
            at.x, at.y
        );
        // The side is twice as long as the way from the bottom to the contact.
        let (sin, cos) = libm::sincos(f64::from(degrees).to_radians());
        let top = DVec2::new(sin, cos) * 2.0 * RADIUS * cos / sin;
        for (side, sign) in [("left", -1.0), ("right", 1.0)] {
            let _ = write!(
                wedges,
                "(name: \"{side}_{degrees}\", at: ({middle:?}, 0), datum: Origin, fixed: true, material: \"hard\",
                  shape: Polygon(points: [(0, 0), ({:?}, {:?}), ({:?}, 0)])),",
                sign * top.x,
                top.y,
                sign * (top.x + 0.2)
            );
        }
    }
    format!(
        "Scene({clock}, gravity: (0, -{GRAVITY:?}), contacts: Penalty(tangential: None),
        materials: {{ \"soft\": (stiffness: {STIFFNESS:?}, restitution: 1), \"hard\": (stiffness: 1e300, restitution: 1) }},
        bodies: [{discs}{wedges}])"
    )
}

/// The greatest of the discs, over its sinking.
fn error(simulation: &Simulation, time: f64, _: f64) -> f64 {
    greatest(GROOVES.into_iter().enumerate().map(|(disc, (degrees, middle))| {
        let found = simulation.bodies().position[disc] - DVec2::new(middle, 0.0);
        found.distance(place(degrees, time)) / statics(degrees)[2]
    }))
}
