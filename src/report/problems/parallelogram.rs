//! A bar on parallel cranks moves on a circle without turning. All parts swing as one pendulum of length `l
//! (m_cranks/3 + M)/(m_cranks/2 + M)`, solved by elliptic functions. SI units.
//!
//! Two of them: on two cranks, and on three, of which one is redundant. Its rows follow from those of the others.

use std::fmt::Write;

use glam::DVec2;

use super::linkage::{bar, greatest, hanging};
use super::{Class, Constant, Problem, ProblemSetting, Truth, rounding_of};
use jostle_engine::Simulation;

/// The problem.
pub const PROBLEM: Problem = Problem {
    name: "parallelogram",
    law: "a bar on parallel cranks swings as a pendulum, with a redundant crank too",
    source: "elliptic functions; truth file J12",
    class: Class::Smooth,
    tick: 1.0 / 256.0,
    samples: &[0.5, 1.0, 2.0, 4.0],
    unit: "1",
    always_located: false,
    scene,
    error,
    leading_error: None,
    constants: CONSTANTS,
    // A wrong amplitude gives a wrong period. So errors grow by the passed angle, at up to 3.3 rad/s.
    rounding: |tick| rounding_of(4.0 / tick, 4.0 * 3.3),
};

/// Measured at finer ticks.
const CONSTANTS: &[Constant] = &[
    Constant::located("ExplicitEuler", 1, 2.016e1),
    Constant::per_tick("SemiImplicitEuler", 1, 1.643e0),
    Constant::located("SemiImplicitEuler", 1, 1.642e0),
    Constant::per_tick("VelocityVerlet", 2, 5.762e0),
    Constant::located("VelocityVerlet", 2, 3.071e0),
    Constant::located("RungeKutta4", 4, 4.292e0),
    Constant::located("ImplicitMidpoint", 2, 4.323e0),
    Constant::located("Symplectic4", 4, 2.038e-1),
];

/// The reference values.
pub const TRUTH: &str = include_str!("../../../assets/truths/J12_parallelogram.json");
/// Numbers of cranks.
pub const CRANKS: [usize; 2] = [2, 3];
/// Length of a crank in m.
const LENGTH: f64 = 1.0;
/// At the start, in degrees from the downward vertical.
const START: f64 = 60.0;

fn scene(setting: &ProblemSetting, duration: f64) -> String {
    let clock = setting.clock(duration);
    let (mut bodies, mut joints) = (String::new(), String::new());
    let along = hanging(START.to_radians()) * LENGTH;
    for cranks in CRANKS {
        for crank in 0..cranks {
            let (name, x) = (format!("crank_{cranks}_{crank}"), crank as f64);
            let top = DVec2::new(x, 0.0);
            bodies += &bar(&name, top, top + along, 0.5);
            let _ = write!(
                joints,
                "Revolute(a: World, anchor_a: ({x:?}, 0), b: \"{name}\", anchor_b: (-0.5, 0)),
                Revolute(a: \"{name}\", anchor_a: (0.5, 0), b: \"coupler_{cranks}\", anchor_b: ({:?}, 0)),",
                x - 1.0
            );
        }
        let _ = write!(
            bodies,
            "(name: \"coupler_{cranks}\", at: ({:?}, {:?}), mass: 2, inertia: 0.7, atoms: Disc(radius: 0.02)),",
            1.0 + along.x,
            along.y
        );
    }
    format!("Scene({clock}, gravity: (0, -9.81), contacts: None, bodies: [{bodies}], joints: [{joints}])")
}

/// The greatest of the angles of cranks and couplers, in rad.
fn error(simulation: &Simulation, time: f64, _: f64) -> f64 {
    let truth = Truth::read(TRUTH);
    let (mut first, mut most) = (0, 0.0);
    for cranks in CRANKS {
        let Some(row) = truth.row(&format!("theta,omega with {cranks} cranks"), time) else { return f64::NAN };
        let angles = &simulation.bodies().angle[first..=first + cranks];
        let cranked = angles[..cranks].iter().map(|angle| angle + std::f64::consts::FRAC_PI_2 - row[0]);
        most = greatest(cranked.chain([angles[cranks], most]));
        first += cranks + 1;
    }
    most
}
