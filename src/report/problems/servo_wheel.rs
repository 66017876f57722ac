//! A wheel on a hinge under a controller: `I q'' = kp (target - q) - kd q'`, a damped oscillator about its target. SI units.

use super::{Class, Constant, Problem, ProblemSetting, rounding_of};
use jostle_engine::Simulation;

/// The problem.
pub const PROBLEM: Problem = Problem {
    name: "servo_wheel",
    law: "a wheel under proportional and derivative control is a damped oscillator",
    source: "textbook (Astrom and Murray, Feedback Systems); truth file J06",
    class: Class::VelocityDependent,
    tick: 0.02 / 16.0,
    samples: &[0.02, 0.1, 0.3, 1.0],
    unit: "1",
    always_located: false,
    scene,
    error,
    leading_error: None,
    constants: CONSTANTS,
    // The oscillator is damped. The rate is at most 10 rad/s. Its rounding error moves the wheel by less than this error over
    // `w = 20/s`.
    rounding: |tick| rounding_of(1.0 / tick, 2.0),
};

/// Measured at finer ticks.
const CONSTANTS: &[Constant] = &[
    Constant::located("ExplicitEuler", 1, 1.368e1),
    Constant::per_tick("SemiImplicitEuler", 1, 8.101e0),
    Constant::located("SemiImplicitEuler", 1, 8.101e0),
    Constant::per_tick("VelocityVerlet", 2, 5.539e1),
    Constant::located("VelocityVerlet", 2, 2.984e1),
    Constant::located("RungeKutta4", 4, 9.295e2),
    Constant::located("ImplicitMidpoint", 2, 2.690e1),
    Constant::located("Symplectic4", 4, 1.376e1),
];

/// The reference values.
pub const TRUTH: &str = include_str!("../../../assets/truths/J06_pd_joint.json");
/// In kg m2.
const INERTIA: f64 = 0.2;
/// `kp` in N m/rad and `kd` in N m s/rad.
const GAINS: (f64, f64) = (80.0, 2.0);
/// In rad.
const TARGET: f64 = 1.0;

/// The angle in rad at `time`.
pub fn angle(time: f64) -> f64 {
    let decay = 0.5 * GAINS.1 / INERTIA;
    let rate = (GAINS.0 / INERTIA - decay * decay).sqrt();
    let (sin, cos) = libm::sincos(rate * time);
    TARGET * (1.0 - libm::exp(-decay * time) * (cos + decay / rate * sin))
}

fn scene(setting: &ProblemSetting, duration: f64) -> String {
    let clock = setting.clock(duration);
    let (kp, kd) = GAINS;
    format!(
        "Scene({clock}, contacts: None,
        bodies: [(name: \"wheel\", at: (0, 0), mass: 1, inertia: {INERTIA:?}, atoms: Disc(radius: 0.1))],
        joints: [Revolute(name: \"hub\", a: World, b: \"wheel\")],
        controllers: [Servo(of: \"hub\", target: {TARGET:?}, kp: {kp:?}, kd: {kd:?})])"
    )
}

/// Over the way to the target.
fn error(simulation: &Simulation, time: f64, _: f64) -> f64 {
    (simulation.bodies().angle[0] - angle(time)).abs() / TARGET
}
