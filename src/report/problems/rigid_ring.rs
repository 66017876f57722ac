//! A ring of twelve masses on massless rods turns steadily while it falls. The rods keep the radius `l/(2 sin(pi/N))`
//! and bear `m w^2 R/(2 sin(pi/N))`. SI units.
//!
//! The ring is a loop that could fold in nine ways; the pull in its rods keeps it round.

use std::f64::consts::PI;
use std::fmt::Write;

use glam::DVec2;

use super::linkage::greatest;
use super::{Class, Constant, Problem, ProblemSetting, rounding_of};
use jostle_engine::Simulation;

/// The problem.
pub const PROBLEM: Problem = Problem {
    name: "rigid_ring",
    law: "a turning ring of rods stays round and turns evenly while it falls",
    source: "closed form; truth file O04",
    class: Class::Smooth,
    tick: TURN / 2048.0,
    samples: &[0.5 * TURN, TURN],
    unit: "1",
    always_located: false,
    scene,
    error,
    leading_error: Some(leading_error),
    constants: CONSTANTS,
    // A tick rounds the spin by half a unit in the last place. That counts for half a turn, which remains on average.
    rounding: |tick| rounding_of(TURN / tick, 0.5 * PI),
};

/// Measured at finer ticks.
const CONSTANTS: &[Constant] = &[
    Constant::located("ExplicitEuler", 1, 8.918e1),
    Constant::per_tick("SemiImplicitEuler", 1, 9.980e0),
    Constant::located("SemiImplicitEuler", 1, 9.977e0),
    Constant::per_tick("VelocityVerlet", 2, 6.702e1),
    Constant::located("VelocityVerlet", 2, 1.676e1),
    Constant::located("ImplicitMidpoint", 2, 3.351e1),
];

/// The reference values.
pub const TRUTH: &str = include_str!("../../../assets/truths/O04_rotating_ring.json");
/// Number of masses.
pub const COUNT: usize = 12;
/// In rad/s.
const SPIN: f64 = 8.0;
/// A turn in s.
const TURN: f64 = 2.0 * PI / SPIN;
/// Of each, in kg.
const MASS: f64 = 0.1;
/// In m/s2.
const GRAVITY: f64 = 9.81;
/// Of a rod, in m.
const LENGTH: f64 = 0.2;

/// The radius in m.
pub fn radius() -> f64 {
    0.5 * LENGTH / libm::sin(PI / COUNT as f64)
}

/// The pull in a rod in N.
pub fn tension() -> f64 {
    0.5 * MASS * SPIN * SPIN * radius() / libm::sin(PI / COUNT as f64)
}

/// The position of a mass at `time`, in m.
fn place(mass: usize, time: f64) -> DVec2 {
    let (sin, cos) = libm::sincos(2.0 * PI * mass as f64 / COUNT as f64 + SPIN * time);
    DVec2::new(cos, sin) * radius() + DVec2::new(0.0, -0.5 * GRAVITY * time * time)
}

fn scene(setting: &ProblemSetting, duration: f64) -> String {
    let clock = setting.clock(duration);
    let (mut bodies, mut joints) = (String::new(), String::new());
    for mass in 0..COUNT {
        let at = place(mass, 0.0);
        let velocity = at.perp() * SPIN;
        let _ = write!(
            bodies,
            "(name: \"m{mass}\", at: ({:?}, {:?}), velocity: ({:?}, {:?}), atoms: Disc(radius: 0.01, mass: {MASS:?})),",
            at.x, at.y, velocity.x, velocity.y
        );
        let next = (mass + 1) % COUNT;
        let _ = write!(joints, "Distance(name: \"rod{mass}\", a: \"m{mass}\", b: \"m{next}\", length: {LENGTH:?}),");
    }
    format!("Scene({clock}, gravity: (0, -{GRAVITY:?}), contacts: None, bodies: [{bodies}], joints: [{joints}])")
}

/// The greatest distance of a mass from its place, over the radius.
fn error(simulation: &Simulation, time: f64, _: f64) -> f64 {
    let found = simulation.bodies().position.iter().enumerate();
    greatest(found.map(|(mass, found)| found.distance(place(mass, time)) / radius()))
}

/// Under RATTLE a mass advances by `asin(w dt)` in a tick, and not by `w dt`. Its way across the radius is that of its
/// velocity. So it is ahead by `(w dt)^2/6` of the passed angle, and a share `(w dt)^2` more for the next term.
/// Semi-implicit Euler also falls by `g t dt/2` further. Methods of higher orders are held to the bound of order 2.
fn leading_error(order: u32, tick: f64) -> f64 {
    let (z, time) = (SPIN * tick, TURN);
    let ahead = SPIN * time * z * z / 6.0 * (1.0 + z * z);
    if order >= 2 { ahead } else { GRAVITY * time * tick / 2.0 / radius() + ahead }
}
