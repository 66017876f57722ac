//! A uniform rod falls over its hinge, released at 5 degrees beside the upward vertical: `I theta'' = m g (l/2) sin
//! theta`. Its angle is compared at the time at which it is level (elliptic integral). SI units.

use glam::DVec2;

use super::linkage::bar;
use super::{Class, Constant, Problem, ProblemSetting, rounding_of};
use jostle_engine::Simulation;

/// The problem.
pub const PROBLEM: Problem = Problem {
    name: "falling_rod",
    law: "a rod that falls over its hinge is level after a time known by an elliptic integral",
    source: "textbook; truth file J10",
    class: Class::Smooth,
    tick: LEVEL / 256.0,
    samples: &[LEVEL],
    unit: "1",
    always_located: false,
    scene,
    error,
    leading_error: None,
    constants: CONSTANTS,
    // An error of the angle of 5 degrees grows until the rod is level as the angle does: by 18.
    rounding: |tick| rounding_of(LEVEL / tick, 18.0),
};

/// Measured at finer ticks.
const CONSTANTS: &[Constant] = &[
    Constant::located("ExplicitEuler", 1, 8.536e0),
    Constant::per_tick("SemiImplicitEuler", 1, 2.706e0),
    Constant::located("SemiImplicitEuler", 1, 2.706e0),
    Constant::per_tick("VelocityVerlet", 2, 1.354e-1),
    Constant::located("VelocityVerlet", 2, 1.824e0),
    Constant::located("Symplectic4", 4, 1.269e-1),
    Constant::located("RungeKutta4", 4, 6.340e0),
    Constant::located("ImplicitMidpoint", 2, 4.968e0),
];

/// The reference values.
pub const TRUTH: &str = include_str!("../../../assets/truths/J10_hinged_rod_fall.json");
/// When it is level, in s.
pub const LEVEL: f64 = 0.948_316_677_295_506_1;

fn scene(setting: &ProblemSetting, duration: f64) -> String {
    let clock = setting.clock(duration);
    let (sin, cos) = libm::sincos(5.0_f64.to_radians());
    let rod = bar("rod", DVec2::ZERO, DVec2::new(sin, cos), 1.0);
    format!(
        "Scene({clock}, gravity: (0, -9.81), contacts: None, bodies: [{rod}],
        joints: [Revolute(name: \"hinge\", a: World, anchor_a: (0, 0), b: \"rod\", anchor_b: (-0.5, 0))])"
    )
}

/// In rad.
fn error(simulation: &Simulation, _: f64, _: f64) -> f64 {
    simulation.bodies().angle[0].abs()
}
