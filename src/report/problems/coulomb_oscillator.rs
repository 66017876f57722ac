//! A sled on a spring with dry friction (Coulomb 1785). Its half swings have centres on alternating sides. Each is
//! shorter by the same length, until one ends where friction can hold it. SI units.
//!
//! Let `w = sqrt(k/m)` and `a = mu m g/k`. A half swing has its centre at `+a` or `-a`, on its starting side. It turns
//! `2 a` nearer to the middle. The first turn within `a` is the last, after a finite time. Friction jumps at each turn,
//! so a method that does not locate it has order 1. The sled sticks without compliance, so events are always located.
//! Its inertia keeps it from turning.

use std::f64::consts::PI;

use super::{Class, Constant, EventTiming, Problem, ProblemSetting, rounding_of};
use jostle_engine::Simulation;

/// The problem.
pub const PROBLEM: Problem = Problem {
    name: "coulomb_oscillator",
    law: "dry friction takes as much from each half swing, and ends it in finite time",
    source: "piecewise closed form (Coulomb 1785); truth file F03",
    class: Class::Jump,
    tick: 4e-3,
    samples: &[0.66, 1.17, 1.7, 2.83],
    unit: "1",
    always_located: true,
    scene,
    error,
    leading_error: Some(leading_error),
    constants: CONSTANTS,
    rounding: |tick| rounding_of(2.83 / tick, 10.0),
};

/// Measured at finer ticks.
const CONSTANTS: &[Constant] = &[
    Constant::located("ExplicitEuler", 1, 4.928e1),
    Constant::located("SemiImplicitEuler", 1, 1.586e0),
    Constant::located("VelocityVerlet", 2, 1.496e1),
    Constant::located("ImplicitMidpoint", 2, 2.974e1),
    Constant::located("RungeKutta4", 4, 3.017e2),
    Constant::located("Symplectic4", 4, 5.063e-1),
];

/// The reference values.
pub const TRUTH: &str = include_str!("../../../assets/truths/F03_spring_coulomb.json");
/// Friction coefficient.
pub const FRICTION: f64 = 0.1;
/// In m/s2.
pub const GRAVITY: f64 = 9.81;
/// The position of its release, in m.
pub const BEGIN: f64 = 0.115;
/// Stiffness of the spring in N/m; the mass is 1 kg.
pub const STIFFNESS: f64 = 100.0;
const FLOOR: f64 = 1e5;
const RADIUS: f64 = 0.1;

/// Place in m and velocity in m/s at `time`, and the number of half swings that were begun.
pub fn state(time: f64) -> (f64, f64, u32) {
    let rate = STIFFNESS.sqrt();
    let held = FRICTION * GRAVITY / STIFFNESS;
    let (mut from, mut begin, mut swings) = (BEGIN, 0.0, 0);
    while from.abs() > held {
        swings += 1;
        let center = held.copysign(from);
        let since = time - begin;
        if since < PI / rate {
            let (sin, cos) = libm::sincos(rate * since);
            return (center + (from - center) * cos, -rate * (from - center) * sin, swings);
        }
        from = 2.0 * center - from;
        begin += PI / rate;
    }
    (from, 0.0, swings)
}

fn scene(setting: &ProblemSetting, duration: f64) -> String {
    let clock = ProblemSetting { events: EventTiming::Located, ..*setting }.clock(duration);
    let (place, velocity, _) = state(setting.shift);
    let height = RADIUS - GRAVITY / FLOOR;
    format!(
        "Scene({clock}, gravity: (0, -{GRAVITY:?}), contacts: Penalty(tangential: Exact),
        materials: {{ \"steel\": (stiffness: {FLOOR:?}, friction: {FRICTION:?}, inelasticity: 0.3) }},
        walls: [(name: \"floor\", left: (1, 0), right: (-1, 0), material: \"steel\")],
        bodies: [(name: \"sled\", at: ({place:?}, {height:?}), velocity: ({velocity:?}, 0), material: \"steel\", inertia: 1e300,
                  atoms: Disc(radius: {RADIUS:?}, mass: 1))],
        forces: [Spring(a: \"sled\", b: World, anchor_b: (0, {height:?}), stiffness: {STIFFNESS:?}, length: 0)])"
    )
}

/// Over the position of its release.
fn error(simulation: &Simulation, time: f64, shift: f64) -> f64 {
    (simulation.bodies().position[0].x - state(time + shift).0).abs() / BEGIN
}

/// Order 2: the frequency of velocity Verlet is off by a share `(w dt)^2/24`. The position is off by at most that times
/// `w t` for the 1.9 s in which it moves. Steps of another length locate each of six turns, which are off by `(w
/// dt)^2/8` of the swing. Order 1: the energy of semi-implicit Euler swings by a share `w dt/2`, so each turn is off by
/// that.
pub fn leading_error(order: u32, tick: f64) -> f64 {
    let step = STIFFNESS.sqrt() * tick;
    if order >= 2 { step * step * (STIFFNESS.sqrt() * 1.9 / 24.0 + 6.0 / 8.0) } else { 6.0 * step / 2.0 }
}
