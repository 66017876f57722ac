//! Two arms of two uniform rods, 0.5 and 0.4 m long. One swings freely. Controllers on both joints move the other, each
//! with the torque `kp (target - angle) - kd rate`. Full equations of both links. SI units.

use super::linkage::{Chain, ChainLink, chain, greatest, turned_off};
use super::{Class, Constant, Problem, ProblemSetting, Truth, rounding_of};
use jostle_engine::Simulation;

/// The problem.
pub const PROBLEM: Problem = Problem {
    name: "two_link_arm",
    law: "an arm of two links swings, and follows its controllers",
    source: "Lagrange's equations against bodies with multipliers; truth file J05",
    class: Class::VelocityDependent,
    tick: 1.0 / 1024.0,
    samples: &[0.25, 0.5, 1.0, 2.0],
    unit: "1",
    always_located: false,
    scene,
    error,
    leading_error: None,
    constants: CONSTANTS,
    // The free arm is as sensitive as a double pendulum. Its links swing twice as fast as those of 1 m. The reference is known to
    // 1e-13.
    rounding: |tick| rounding_of(2.0 / tick, 100.0) + 1e-13,
};

/// Measured at finer ticks.
const CONSTANTS: &[Constant] = &[
    Constant::located("ExplicitEuler", 1, 5.969e1),
    Constant::per_tick("SemiImplicitEuler", 1, 3.186e0),
    Constant::located("SemiImplicitEuler", 1, 3.186e0),
    Constant::per_tick("VelocityVerlet", 2, 2.115e1),
    Constant::located("VelocityVerlet", 2, 1.171e1),
    Constant::located("ImplicitMidpoint", 2, 2.425e1),
];

/// The reference values.
pub const TRUTH: &str = include_str!("../../../assets/truths/J05_two_link_arm.json");
/// Masses in kg, lengths in m and angles at the start in degrees from the downward vertical.
const LINKS: [(f64, f64, f64); 2] = [(1.0, 0.5, 30.0), (0.8, 0.4, 75.0)];

fn scene(setting: &ProblemSetting, duration: f64) -> String {
    let clock = setting.clock(duration);
    let links = LINKS.map(|(mass, length, degrees)| ChainLink { mass, length, angle: degrees.to_radians() });
    let [free, driven] = ["free", "driven"].map(|name| chain(name, &links));
    let (Chain { bodies, joints, .. }, Chain { bodies: more_bodies, joints: more_joints, .. }) = (free, driven);
    // The angle of the first joint counts from the x axis: 60 degrees from the downward vertical are -30.
    format!(
        "Scene({clock}, gravity: (0, -9.81), contacts: None, bodies: [{bodies} {more_bodies}], joints: [{joints} {more_joints}],
        controllers: [Servo(name: \"shoulder\", of: \"driven_pin0\", target: \"-30 deg\", kp: 60, kd: 3),
                      Servo(name: \"elbow\", of: \"driven_pin1\", target: \"45 deg\", kp: 30, kd: 1)])"
    )
}

/// The greatest of the angles, in rad.
fn error(simulation: &Simulation, time: f64, _: f64) -> f64 {
    let truth = Truth::read(TRUTH);
    let observables = ["free swing theta..omega (t<=2)", "PD theta..omega (t<=2)"];
    greatest(observables.into_iter().enumerate().map(|(arm, observable)| {
        let Some(row) = truth.row(observable, time) else { return f64::NAN };
        turned_off(simulation, 2 * arm, &row[..2])
    }))
}
