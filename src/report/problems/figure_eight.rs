//! Three equal masses chase each other along a figure of eight (Moore 1993; Chenciner and Montgomery 2000), `G = m = 1`. SI
//! units.
//!
//! The orbit is stable to first order, so errors grow linearly with time: a wrong energy gives a wrong period.

use std::fmt::Write;

use glam::DVec2;

use super::{Class, Constant, Problem, ProblemSetting, Truth, rounding_of};
use jostle_engine::Simulation;

/// The problem.
pub const PROBLEM: Problem = Problem {
    name: "figure_eight",
    law: "three equal masses follow each other along one closed curve",
    source: "Chenciner and Montgomery 2000; initial data of Simo 2002, refined; truth file P08",
    class: Class::Smooth,
    tick: PERIOD / 1024.0,
    samples: &[0.25 * PERIOD, 0.5 * PERIOD, PERIOD],
    unit: "m",
    always_located: false,
    scene,
    error,
    leading_error: Some(leading_error),
    constants: CONSTANTS,
    // A rounding error of the energy makes a phase error that grows with time: see below. The reference closes to 1e-13
    // after the first period.
    rounding: |tick| rounding_of(PERIOD / tick, PHASE_GROWTH) + 1e-13,
};

/// Measured at finer ticks.
const CONSTANTS: &[Constant] = &[
    Constant::located("ExplicitEuler", 1, 1.715e2),
    Constant::per_tick("SemiImplicitEuler", 1, 2.534e0),
    Constant::located("SemiImplicitEuler", 1, 2.534e0),
    Constant::per_tick("VelocityVerlet", 2, 6.402e0),
    Constant::located("VelocityVerlet", 2, 6.402e0),
    Constant::located("ImplicitMidpoint", 2, 1.042e1),
    Constant::located("RungeKutta4", 4, 5.595e0),
    Constant::located("Symplectic4", 4, 3.091e-1),
];

/// The reference values.
pub const TRUTH: &str = include_str!("../../../assets/truths/P08_figure_eight.json");
/// In s.
pub const PERIOD: f64 = 6.325_913_982_926_218_5;
/// `delta E/E` delays the masses by `1.5 t delta E/E`, at up to 1.27 m/s. That is the third law, as for any force that
/// falls with the square.
const PHASE_GROWTH: f64 = 1.5 * PERIOD * 1.27;
/// The least distance of two masses in m, at an isosceles triangle of all three: 0.69.
const NEAREST: f64 = 0.69;

fn scene(setting: &ProblemSetting, duration: f64) -> String {
    let clock = setting.clock(duration);
    let start = Truth::read(TRUTH).numbers("initial state[x1,y1,x2,y2,x3,y3,vx1..vy3]");
    let mut bodies = String::new();
    for body in 0..3 {
        let (place, velocity) = (&start[2 * body..2 * body + 2], &start[6 + 2 * body..8 + 2 * body]);
        let _ = write!(
            bodies,
            "(name: \"star_{body}\", at: ({:?}, {:?}), velocity: ({:?}, {:?}), collides: false,
              atoms: Disc(radius: 0.01, mass: 1)),",
            place[0], place[1], velocity[0], velocity[1]
        );
    }
    format!("Scene({clock}, forces: [Attraction(constant: 1)], bodies: [{bodies}])")
}

/// The greatest distance of a mass from its exact position, in m.
fn error(simulation: &Simulation, time: f64, _: f64) -> f64 {
    let Some(row) = Truth::read(TRUTH).row("state at samples", time) else { return f64::NAN };
    let off = simulation.bodies().position.iter().zip(row.chunks(2));
    off.map(|(found, exact)| (*found - DVec2::new(exact[0], exact[1])).length()).fold(0.0, f64::max)
}

/// Two masses at the least distance `r` attract each other with the rate `sqrt(4 G m/r^3)`. Kinetic energy is at most
/// the total. So the energy is off by a share of `(rate dt)^p`, and the phase by the delay above.
fn leading_error(order: u32, tick: f64) -> f64 {
    let rate = (4.0 / NEAREST.powi(3)).sqrt();
    PHASE_GROWTH * (rate * tick).powi(order as i32)
}
