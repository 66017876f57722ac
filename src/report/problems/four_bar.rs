//! Four bars in a loop, whose crank a motor turns at 10 rad/s. The angles of coupler and rocker follow from the loop
//! (Freudenstein 1955), and the torque from the power balance. SI units.

use glam::DVec2;

use super::linkage::{bar, greatest};
use super::{Class, Constant, Problem, ProblemSetting, Truth, rounding_of};
use jostle_engine::Simulation;

/// The problem.
pub const PROBLEM: Problem = Problem {
    name: "four_bar",
    law: "the loop decides how coupler and rocker move with the crank",
    source: "Freudenstein's equation, power balance; truth file J07",
    class: Class::Smooth,
    tick: 0.01 / 8.0,
    samples: &[0.05, 0.2, 0.35, 0.5, 0.61],
    unit: "1",
    always_located: false,
    scene,
    error,
    leading_error: None,
    constants: CONSTANTS,
    // The crank's angle counts up to 6.1 rad, and the rocker moves up to 0.4 times as fast.
    rounding: |tick| rounding_of(0.61 / tick, 6.1),
};

/// Measured at finer ticks.
const CONSTANTS: &[Constant] = &[
    Constant::located("ExplicitEuler", 1, 2.273e0),
    Constant::per_tick("SemiImplicitEuler", 1, 2.272e0),
    Constant::located("SemiImplicitEuler", 1, 2.268e0),
    Constant::per_tick("VelocityVerlet", 2, 1.002e2),
    Constant::located("VelocityVerlet", 2, 9.897e1),
    Constant::located("RungeKutta4", 4, 8.508e1),
    Constant::located("ImplicitMidpoint", 2, 5.013e1),
    Constant::located("Symplectic4", 4, 5.859e0),
];

/// The reference values.
pub const TRUTH: &str = include_str!("../../../assets/truths/J07_four_bar.json");
/// Lengths of crank, coupler, rocker and of the distance of the fixed pins, in m.
const LENGTHS: [f64; 4] = [0.1, 0.35, 0.3, 0.4];
/// Masses of crank, coupler and rocker, in kg.
const MASSES: [f64; 3] = [0.2, 0.7, 0.6];
/// In rad/s.
const SPEED: f64 = 10.0;

fn scene(setting: &ProblemSetting, duration: f64) -> String {
    let clock = setting.clock(duration);
    let [crank, coupler, rocker, ground] = LENGTHS;
    let (first, last) = (DVec2::new(crank, 0.0), DVec2::new(ground, 0.0));
    // Coupler and rocker meet where circles about the ends of crank and ground cross.
    let base = ground - crank;
    let along = (coupler * coupler - rocker * rocker + base * base) / (2.0 * base);
    let top = first + DVec2::new(along, (coupler * coupler - along * along).sqrt());
    let bodies = [
        bar("crank", DVec2::ZERO, first, MASSES[0]),
        bar("coupler", first, top, MASSES[1]),
        bar("rocker", last, top, MASSES[2]),
    ]
    .concat();
    let [crank, coupler, rocker] = [0.5 * crank, 0.5 * coupler, 0.5 * rocker];
    format!(
        "Scene({clock}, gravity: (0, -9.81), contacts: None, bodies: [{bodies}],
        joints: [Revolute(name: \"hub\", a: World, anchor_a: (0, 0), b: \"crank\", anchor_b: (-{crank:?}, 0)),
                 Revolute(a: \"crank\", anchor_a: ({crank:?}, 0), b: \"coupler\", anchor_b: (-{coupler:?}, 0)),
                 Revolute(a: \"coupler\", anchor_a: ({coupler:?}, 0), b: \"rocker\", anchor_b: ({rocker:?}, 0)),
                 Revolute(a: World, anchor_a: ({ground:?}, 0), b: \"rocker\", anchor_b: (-{rocker:?}, 0))],
        controllers: [Motor(name: \"drive\", of: \"hub\", speed: {SPEED:?})], sensors: [Motor(of: \"drive\")])"
    )
}

/// The greatest of the angles, in rad.
fn error(simulation: &Simulation, time: f64, _: f64) -> f64 {
    let Some(row) = Truth::read(TRUTH).row("angles crank,coupler,rocker", time) else { return f64::NAN };
    greatest(simulation.bodies().angle.iter().zip(row).map(|(found, exact)| found - exact))
}
