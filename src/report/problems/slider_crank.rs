//! Crank, rod and piston, whose crank a motor turns at 100 rad/s: `x = r cos wt + sqrt(l^2 - r^2 sin^2 wt)`. The torque
//! follows from the power balance. SI units.

use glam::DVec2;

use super::linkage::bar;
use super::{Class, Constant, Problem, ProblemSetting, rounding_of};
use jostle_engine::Simulation;

/// The problem.
pub const PROBLEM: Problem = Problem {
    name: "slider_crank",
    law: "crank and rod decide how a piston moves",
    source: "closed form, power balance; truth file J08",
    class: Class::Smooth,
    tick: 1e-3 / 16.0,
    samples: &[0.005, 0.013, 0.02, 0.05],
    unit: "1",
    always_located: false,
    scene,
    error,
    leading_error: None,
    constants: CONSTANTS,
    // The crank's angle counts up to 5 rad; the piston moves by at most 1.03 r for each.
    rounding: |tick| rounding_of(0.05 / tick, 5.2),
};

/// Measured at finer ticks.
const CONSTANTS: &[Constant] = &[
    Constant::located("ExplicitEuler", 1, 3.700e1),
    Constant::per_tick("SemiImplicitEuler", 1, 3.681e1),
    Constant::located("SemiImplicitEuler", 1, 3.720e1),
    Constant::per_tick("VelocityVerlet", 2, 7.503e3),
    Constant::located("VelocityVerlet", 2, 7.719e3),
    Constant::located("ImplicitMidpoint", 2, 3.750e3),
];

/// The reference values.
pub const TRUTH: &str = include_str!("../../../assets/truths/J08_slider_crank.json");
/// Length of the crank in m.
const CRANK: f64 = 0.05;
/// Length of the rod in m.
const ROD: f64 = 0.2;
/// In rad/s.
const SPEED: f64 = 100.0;

/// The place of the piston in m at `time`.
pub fn piston(time: f64) -> f64 {
    let (sin, cos) = libm::sincos(SPEED * time);
    CRANK * cos + (ROD * ROD - CRANK * CRANK * sin * sin).sqrt()
}

fn scene(setting: &ProblemSetting, duration: f64) -> String {
    let clock = setting.clock(duration);
    let ends = [0.0, CRANK, CRANK + ROD].map(|x| DVec2::new(x, 0.0));
    let (crank, rod) = (bar("crank", ends[0], ends[1], 0.4), bar("rod", ends[1], ends[2], 0.3));
    let (half_crank, half_rod) = (0.5 * CRANK, 0.5 * ROD);
    format!(
        "Scene({clock}, contacts: None,
        bodies: [{crank} {rod} (name: \"piston\", at: ({:?}, 0), mass: 0.5, inertia: 1, atoms: Disc(radius: 0.005))],
        joints: [Revolute(name: \"hub\", a: World, anchor_a: (0, 0), b: \"crank\", anchor_b: (-{half_crank:?}, 0)),
                 Revolute(a: \"crank\", anchor_a: ({half_crank:?}, 0), b: \"rod\", anchor_b: (-{half_rod:?}, 0)),
                 Revolute(a: \"rod\", anchor_a: ({half_rod:?}, 0), b: \"piston\", anchor_b: (0, 0)),
                 Prismatic(name: \"slide\", a: World, anchor_a: (0, 0), b: \"piston\", anchor_b: (0, 0), axis: (1, 0))],
        controllers: [Motor(name: \"drive\", of: \"hub\", speed: {SPEED:?})],
        sensors: [Motor(of: \"drive\"), Joint(of: \"slide\")])",
        ends[2].x
    )
}

/// Over the length of the crank.
fn error(simulation: &Simulation, time: f64, _: f64) -> f64 {
    (simulation.bodies().position[2].x - piston(time)).abs() / CRANK
}
