//! A ball falls on an elastic floor and bounces forever (Cundall and Strack 1979). Free flight alternates with half a
//! period (and a bit) of a shifted oscillator. Its equation is `m d'' = m g - k d` while the overlap `d` is positive.
//! SI units.
//!
//! With `w = sqrt(k/m)` and the impact speed `v = sqrt(2 g h)` contact lasts `(2/w) (pi - atan(v w/g))`. The force has
//! kinks at the beginning and end of contact. Methods that do not locate them show at most order 2.

use super::{Class, Constant, Problem, ProblemSetting, rounding_of};
use jostle_engine::Simulation;

/// The problem.
pub const PROBLEM: Problem = Problem {
    name: "elastic_bounce",
    law: "an elastic ball comes back to where it was let go",
    source: "closed form; truth file C01",
    class: Class::Kink,
    tick: PERIOD / 1000.0,
    samples: &[0.3 * PERIOD, 0.499 * PERIOD, 0.8 * PERIOD, 1.3 * PERIOD],
    unit: "1",
    always_located: false,
    scene,
    error,
    leading_error: Some(leading_error),
    constants: CONSTANTS,
    rounding: |tick| rounding_of(1.3 * PERIOD / tick, 4.0),
};

/// Measured at finer ticks.
const CONSTANTS: &[Constant] = &[
    Constant::located("ExplicitEuler", 1, 5.417e2),
    Constant::per_tick("SemiImplicitEuler", 1, 2.072e0),
    Constant::located("SemiImplicitEuler", 1, 2.951e0),
    Constant::per_tick("VelocityVerlet", 2, 1.689e3),
    Constant::located("VelocityVerlet", 2, 8.059e1),
    Constant::located("ImplicitMidpoint", 2, 1.051e2),
    Constant::located("RungeKutta4", 5, 5.755e8),
    Constant::located("Symplectic4", 4, 8.802e2),
];

/// The reference values.
pub const TRUTH: &str = include_str!("../../../assets/truths/C01_wall_bounce_elastic.json");
/// From the highest point back to it, in s.
pub const PERIOD: f64 = 0.6705929970222035;
/// Gap in m from which the ball is let go.
pub const HEIGHT: f64 = 0.5;
/// In m.
pub const RADIUS: f64 = 0.1;
/// `sqrt(k/m)` in 1/s.
pub const OMEGA: f64 = 100.0;
const GRAVITY: f64 = 9.81;

/// Gap between ball and floor in m (negative: overlap) and velocity in m/s, `time` after the highest point.
pub fn state(time: f64) -> (f64, f64) {
    let impact = (2.0 * GRAVITY * HEIGHT).sqrt();
    let fall = impact / GRAVITY;
    let time = time.rem_euclid(PERIOD);
    // The motion is symmetric about the deepest point.
    let (time, sign) = if time > PERIOD / 2.0 { (PERIOD - time, -1.0) } else { (time, 1.0) };
    let since = time - fall;
    if since <= 0.0 {
        return (HEIGHT - 0.5 * GRAVITY * time * time, -sign * GRAVITY * time);
    }
    let (sin, cos) = libm::sincos(OMEGA * since);
    let rest = GRAVITY / (OMEGA * OMEGA);
    let overlap = rest * (1.0 - cos) + impact / OMEGA * sin;
    (-overlap, -sign * (rest * OMEGA * sin + impact * cos))
}

/// The ball's own stiffness is that of the contact: walls are infinitely stiff.
fn scene(setting: &ProblemSetting, duration: f64) -> String {
    let clock = setting.clock(duration);
    let (gap, velocity) = state(setting.shift);
    let (height, stiffness) = (RADIUS + gap, OMEGA * OMEGA);
    format!(
        "Scene({clock}, gravity: (0, -{GRAVITY:?}), materials: {{ \"rubber\": (stiffness: {stiffness:?}) }},
        walls: [(name: \"floor\", left: (1, 0), right: (0, 0))],
        bodies: [(name: \"ball\", at: (0.5, {height:?}), velocity: (0, {velocity:?}), material: \"rubber\",
                  atoms: Disc(radius: {RADIUS:?}, mass: 1))])"
    )
}

/// Over the height of the fall.
fn error(simulation: &Simulation, time: f64, shift: f64) -> f64 {
    (simulation.bodies().position[0].y - RADIUS - state(time + shift).0).abs() / HEIGHT
}

/// Order 2: a kink inside a tick changes the velocity by up to a share `(w dt)^2/4`. A ball that is faster by a share
/// `s` comes back later by `2 v s/g` and is then off by `4 h s`. Order 1: the force of one end of a tick replaces its
/// mean. In a contact of half a period it changes the velocity by up to a share `(pi/2) w dt`.
fn leading_error(order: u32, tick: f64) -> f64 {
    let step = OMEGA * tick;
    let share = if order >= 2 { step * step / 4.0 } else { std::f64::consts::FRAC_PI_2 * step };
    4.0 * share
}
