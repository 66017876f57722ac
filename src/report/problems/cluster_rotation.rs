//! A free rigid cluster of three atoms at 1e4 rad/s. Its centre moves uniformly, its rotation is uniform, and its size
//! is constant. SI units.
//!
//! A relative error `eps` of `omega t` moves an atom by `r omega t eps`. No smaller error is possible.

use glam::DVec2;

use super::{Class, Constant, Problem, ProblemSetting};
use jostle_engine::Simulation;

/// The problem.
pub const PROBLEM: Problem = Problem {
    name: "cluster_rotation",
    law: "a free rigid body keeps velocity, spin and shape",
    source: "rigid body kinematics; truth file P05",
    class: Class::Free,
    tick: 1e-4,
    samples: &[1e-4, 1e-2, 1.0, 10.0],
    unit: "m",
    always_located: false,
    scene,
    error,
    leading_error: Some(|_, _| 0.0),
    constants: CONSTANTS,
    rounding: |_| FLOOR,
};

const CONSTANTS: &[Constant] = &[];

/// The reference values.
pub const TRUTH: &str = include_str!("../../../assets/truths/P05_cluster_rotation.json");
/// In rad/s.
pub const SPIN: f64 = 1e4;
/// Of the centre of mass, in m/s.
pub const VELOCITY: DVec2 = DVec2::new(0.7, -0.4);
/// Mass, radius, x and y of each atom.
pub const ATOMS: [[f64; 4]; 3] = [[1.0, 0.1, 0.0, 0.0], [2.0, 0.12, 0.3, 0.0], [0.5, 0.08, 0.1, 0.25]];
/// `r omega t eps` at the end, with r = 0.3 m, twice: once for the angle, once for the clock's own product `n dt`.
pub const FLOOR: f64 = 2.0 * 0.3 * SPIN * 10.0 * f64::EPSILON;

/// Centre of mass in m at the start.
pub fn center() -> DVec2 {
    let mass: f64 = ATOMS.iter().map(|atom| atom[0]).sum();
    ATOMS.iter().map(|[mass, _, x, y]| *mass * DVec2::new(*x, *y)).sum::<DVec2>() / mass
}

/// Positions of the atoms in m at `time`.
pub fn atoms(time: f64) -> [DVec2; 3] {
    let (sin, cos) = libm::sincos(SPIN * time);
    let rotation = DVec2::new(cos, sin);
    ATOMS.map(|[_, _, x, y]| center() + VELOCITY * time + rotation.rotate(DVec2::new(x, y) - center()))
}

fn scene(setting: &ProblemSetting, duration: f64) -> String {
    let clock = setting.clock(duration);
    let atom = |[mass, radius, x, y]: &[f64; 4]| format!("(at: ({x:?}, {y:?}), radius: {radius:?}, mass: {mass:?})");
    let atoms: Vec<String> = ATOMS.iter().map(atom).collect();
    format!(
        "Scene({clock}, bodies: [(name: \"cluster\", datum: Origin, at: (0, 0), velocity: ({:?}, {:?}), spin: {SPIN:?},
        atoms: List([{}]))])",
        VELOCITY.x,
        VELOCITY.y,
        atoms.join(", ")
    )
}

/// The greatest distance of an atom from its exact position, in m.
fn error(simulation: &Simulation, time: f64, _: f64) -> f64 {
    let found = |atom: usize| simulation.bodies().atom_place(atom);
    atoms(time).iter().enumerate().map(|(atom, exact)| (*exact - found(atom)).length()).fold(0.0, f64::max)
}
