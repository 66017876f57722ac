//! A mass on a massless rod: `theta'' = -(g/l) sin theta`, solved by Jacobi's elliptic functions. SI units.
//!
//! Two of them are released at 10 and 90 degrees. One that begins near its upper equilibrium is a hard case,
//! `upright_pendulum`.

use std::fmt::Write;

use super::linkage::{greatest, hanging};
use super::{Class, Constant, Problem, ProblemSetting, Truth, rounding_of};
use jostle_engine::Simulation;

/// The problem.
pub const PROBLEM: Problem = Problem {
    name: "pendulum",
    law: "a mass on a rod swings as an elliptic function, from any angle",
    source: "Jacobi's elliptic functions; truth file J01",
    class: Class::Smooth,
    tick: 1.0 / 4096.0,
    samples: &[0.5, 1.0, 5.0],
    unit: "1",
    always_located: false,
    scene,
    error,
    leading_error: None,
    constants: CONSTANTS,
    // From 90 degrees the period grows by 0.54 s with the amplitude. So an error of the amplitude counts `0.54/2.37 t`
    // times 4.4 rad/s. A tick rounds by half a unit in the last place, and on average half of the time remains.
    rounding: |tick| rounding_of(5.0 / tick, 5.0 * 0.54 / 2.37 * 4.4 / 4.0),
};

/// Measured at finer ticks.
const CONSTANTS: &[Constant] = &[
    Constant::located("ExplicitEuler", 1, 1.481e2),
    Constant::per_tick("SemiImplicitEuler", 1, 2.125e0),
    Constant::located("SemiImplicitEuler", 1, 2.125e0),
    Constant::per_tick("VelocityVerlet", 2, 1.724e1),
    Constant::located("VelocityVerlet", 2, 6.894e0),
    Constant::located("ImplicitMidpoint", 2, 6.890e0),
];

/// The reference values.
pub const TRUTH: &str = include_str!("../../../assets/truths/J01_pendulum_exact.json");
/// Angles at the start in degrees from the downward vertical.
pub const STARTS: [u32; 2] = [10, 90];

/// The scene of pendulums that begin at angles in degrees.
pub fn scene_of(clock: &str, starts: &[u32]) -> String {
    let (mut bodies, mut joints) = (String::new(), String::new());
    for degrees in starts {
        let at = hanging(f64::from(*degrees).to_radians());
        let _ = write!(
            bodies,
            "(name: \"bob_{degrees}\", at: ({:?}, {:?}), mass: 1, inertia: 1, atoms: Disc(radius: 0.1)),",
            at.x, at.y
        );
        let _ = write!(
            joints,
            "Distance(name: \"rod_{degrees}\", a: World, anchor_a: (0, 0), b: \"bob_{degrees}\", length: 1),"
        );
    }
    format!("Scene({clock}, gravity: (0, -9.81), contacts: None, bodies: [{bodies}], joints: [{joints}])")
}

fn scene(setting: &ProblemSetting, duration: f64) -> String {
    scene_of(&setting.clock(duration), &STARTS)
}

/// The observable of the truth file that has angle, rate and tension of the pendulum that starts at `degrees`.
pub fn observable(degrees: u32) -> String {
    format!("theta,omega,tension (theta0={degrees} deg)")
}

/// The greatest distance of a bob from its place, over the length of the rod.
fn error(simulation: &Simulation, time: f64, _: f64) -> f64 {
    let truth = Truth::read(TRUTH);
    greatest(STARTS.into_iter().enumerate().map(|(bob, degrees)| {
        let Some(row) = truth.row(&observable(degrees), time) else { return f64::NAN };
        simulation.bodies().position[bob].distance(hanging(row[0]))
    }))
}
