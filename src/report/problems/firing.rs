//! Four balls are aimed at one target, on the low and the high arc, without drag and with linear drag. The velocities
//! of the aim agree with the firing angles to 22 digits (external ballistics, any textbook). SI units.
//!
//! The whole way is compared with the closed form for the angle of the truth file. It ends at the target.

use std::fmt::Write;

use glam::DVec2;

use super::{Class, Constant, Problem, ProblemSetting, Truth, rounding_of};
use jostle_engine::Simulation;

/// The problem.
pub const PROBLEM: Problem = Problem {
    name: "firing",
    law: "an aimed shot flies through its aim, on two arcs",
    source: "closed form; with drag roots of the hit equation to 40 digits; truth file P06",
    class: Class::VelocityDependent,
    tick: 1.0 / 64.0,
    samples: &[0.5, 1.0, 2.0, 4.0],
    unit: "1",
    always_located: false,
    scene,
    error,
    leading_error: Some(leading_error),
    constants: CONSTANTS,
    // Angles are found to a part in 1e12, at ways of up to 2.5 times the distance.
    rounding: |tick| rounding_of(4.0 / tick, 4.0) + 2.5e-12,
};

/// Measured at finer ticks.
const CONSTANTS: &[Constant] = &[
    Constant::located("ExplicitEuler", 1, 4.867e-1),
    Constant::per_tick("SemiImplicitEuler", 1, 5.403e-1),
    Constant::located("SemiImplicitEuler", 1, 5.403e-1),
    Constant::per_tick("VelocityVerlet", 2, 6.230e-3),
    Constant::located("VelocityVerlet", 2, 2.152e-3),
    Constant::located("ImplicitMidpoint", 2, 3.709e-3),
];

/// The reference values.
pub const TRUTH: &str = include_str!("../../../assets/truths/P06_firing_solution.json");
/// The aim in m, from the start.
pub const TARGET: DVec2 = DVec2::new(40.0, 5.0);
/// In m/s.
pub const SPEED: f64 = 25.0;
const GRAVITY: DVec2 = DVec2::new(0.0, -9.81);
/// `c/m` in 1/s.
const RATE: f64 = 0.05;
/// Name, arc, rate, and observable of the angle.
const SHOTS: [(&str, &str, f64, &str); 4] = [
    ("low", "Low", 0.0, "angle_low"),
    ("high", "High", 0.0, "angle_high"),
    ("low_drag", "Low", RATE, "linear_drag angle_low"),
    ("high_drag", "High", RATE, "linear_drag angle_high"),
];

/// Place in m at `time` of a shot at an angle in rad, with `c/m` in 1/s.
pub fn place(angle: f64, rate: f64, time: f64) -> DVec2 {
    let (sin, cos) = libm::sincos(angle);
    let velocity = DVec2::new(cos, sin) * SPEED;
    if rate == 0.0 {
        return velocity * time + GRAVITY * (0.5 * time * time);
    }
    let terminal = GRAVITY / rate;
    terminal * time - (velocity - terminal) * (libm::expm1(-rate * time) / rate)
}

fn scene(setting: &ProblemSetting, duration: f64) -> String {
    let clock = setting.clock(duration);
    let (mut bodies, mut aims) = (String::new(), String::new());
    for (name, arc, ..) in SHOTS {
        let _ = write!(bodies, "(name: \"{name}\", at: (0, 0), collides: false, atoms: Disc(radius: 0.1, mass: 2)),");
        let (x, y) = (TARGET.x, TARGET.y);
        let _ = write!(aims, "Aim(of: \"{name}\", at: ({x:?}, {y:?}), speed: {SPEED:?}, arc: {arc}),");
    }
    let damping = 2.0 * RATE;
    format!(
        "Scene({clock}, gravity: (0, -9.81), forces: [{aims} Drag(linear: {damping:?}, of: \"*_drag\")],
        bodies: [{bodies}])"
    )
}

/// The greatest, over the distance of the aim.
fn error(simulation: &Simulation, time: f64, _: f64) -> f64 {
    let truth = Truth::read(TRUTH);
    let off = SHOTS.into_iter().zip(&simulation.bodies().position).map(|((.., rate, angle), position)| {
        (*position - place(truth.number(angle), rate, time)).length() / TARGET.length()
    });
    off.fold(0.0, |most, error| if error <= most { most } else { error })
}

/// As for linear drag: `a t r^(p-1) (1 + r t) dt^p`, with the acceleration at the start, at most `g + r v`. Order 1
/// errs without drag too, by `g t dt/2`.
fn leading_error(order: u32, tick: f64) -> f64 {
    let (time, acceleration) = (PROBLEM.duration(), GRAVITY.length() + RATE * SPEED);
    let power = RATE.powi(order as i32 - 1) * tick.powi(order as i32);
    acceleration * time * (1.0 + RATE * time) * power / TARGET.length()
}
