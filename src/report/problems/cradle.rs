//! Newton's cradle of five touching soft discs: the first comes in, and more than the last one goes out. SI units.
//!
//! A row of equal masses on linear springs without tension, `m u'' = k (overlap differences)`. The pulse disperses, so
//! the outcome depends on the contact law, not on the tick (Herrmann and Seitz 1982).

use std::fmt::Write;

use super::{Class, Constant, Problem, ProblemSetting, Truth, rounding_of};
use jostle_engine::Simulation;

/// The problem.
pub const PROBLEM: Problem = Problem {
    name: "cradle",
    law: "a pulse through touching soft discs disperses",
    source: "modal solution (Herrmann and Seitz, Am. J. Phys. 50, 1982, for the dispersion); truth file M01",
    class: Class::Kink,
    tick: 5e-4,
    samples: &[0.07],
    unit: "1",
    always_located: false,
    scene: |setting, duration| scene(setting, duration, 5, 1),
    error: |simulation, _, _| error_of(simulation, 5, 1),
    leading_error: Some(leading_error),
    constants: CONSTANTS,
    rounding: |tick| rounding_of(0.07 / tick, 4.0),
};

/// Measured at finer ticks.
const CONSTANTS: &[Constant] = &[
    Constant::located("ExplicitEuler", 1, 2.464e2),
    Constant::per_tick("SemiImplicitEuler", 2, 1.229e3),
    Constant::located("SemiImplicitEuler", 2, 2.545e3),
    Constant::per_tick("VelocityVerlet", 2, 1.229e3),
    Constant::located("VelocityVerlet", 2, 1.180e3),
    Constant::located("ImplicitMidpoint", 2, 2.353e3),
    Constant::located("RungeKutta4", 4, 9.695e6),
    Constant::located("Symplectic4", 4, 1.600e4),
];

/// The reference values.
pub const TRUTH: &str = include_str!("../../../assets/truths/M01_newton_cradle.json");
/// Speed before in m/s.
pub const SPEED: f64 = 1.0;
/// `sqrt(k/m)` in 1/s, with the stiffness of a pair.
pub const OMEGA: f64 = 100.0;
/// In m: multiples of it are exact.
const RADIUS: f64 = 0.5;

/// `count` discs, of which the first `incoming` come in, in touch with the others. A shift lets them start that much
/// earlier on their way.
pub fn scene(setting: &ProblemSetting, duration: f64, count: usize, incoming: usize) -> String {
    let clock = setting.clock(duration);
    let stiffness = 2.0 * OMEGA * OMEGA;
    let mut bodies = String::new();
    for index in 0..count {
        let comes = if index < incoming { SPEED } else { 0.0 };
        let x = 2.0 * RADIUS * index as f64 - comes * setting.shift;
        let _ = write!(
            bodies,
            "(name: \"disc_{index}\", at: ({x:?}, 0), velocity: ({comes:?}, 0), material: \"ivory\",
              atoms: Disc(radius: {RADIUS:?}, mass: 1)),"
        );
    }
    format!("Scene({clock}, materials: {{ \"ivory\": (stiffness: {stiffness:?}) }}, bodies: [{bodies}])")
}

/// Velocities after over the speed before.
pub fn after(count: usize, incoming: usize) -> Vec<f64> {
    Truth::read(TRUTH).numbers(&format!("soft final velocities / v, N={count}, {incoming} incoming"))
}

/// The time for which the discs touch, in s.
pub fn interaction_time(count: usize, incoming: usize) -> f64 {
    Truth::read(TRUTH).number(&format!("soft total interaction time sqrt(k/m), N={count}, {incoming} incoming")) / OMEGA
}

/// The greatest error of a velocity, over the speed before.
pub fn error_of(simulation: &Simulation, count: usize, incoming: usize) -> f64 {
    let found = simulation.bodies().velocity.iter().map(|velocity| velocity.x / SPEED);
    after(count, incoming).iter().zip(found).map(|(exact, found)| (exact - found).abs()).fold(0.0, f64::max)
}

/// The row has rates up to `2 w`. Kinks inside ticks change velocities by up to a share `(2 w dt)^2/4` each, two a
/// contact; four contacts follow each other. Forces of one end of a tick: `(pi/2) (2 w dt)` in the whole.
pub fn leading_error(order: u32, tick: f64) -> f64 {
    let step = 2.0 * OMEGA * tick;
    if order >= 2 { 2.0 * step * step } else { std::f64::consts::FRAC_PI_2 * step }
}
