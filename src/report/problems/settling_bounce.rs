//! A ball falls on a floor that dissipates, bounces a dozen times and stays. Free flight alternates with loading and
//! unloading. Each is a part of a period of a shifted oscillator, `m d'' = m g - k (1 +- mu) d`. SI units.
//!
//! At a turn with an overlap between `m g/(k (1 + mu))` and `m g/(k (1 - mu))` the law, set-valued there, holds the
//! ball forever. The force jumps at each turn, so a method that does not locate it has order 1.

use std::f64::consts::PI;

use super::{Class, Constant, Problem, ProblemSetting, rounding_of};
use jostle_engine::Simulation;

/// The problem.
pub const PROBLEM: Problem = Problem {
    name: "settling_bounce",
    law: "a ball that loses energy bounces lower and lower",
    source: "piecewise closed form; truth file C05",
    class: Class::Jump,
    tick: 5e-4,
    // In the flights after the first and the second impact.
    samples: &[0.8, 1.4],
    unit: "1",
    always_located: false,
    scene,
    error,
    leading_error: Some(leading_error),
    constants: CONSTANTS,
    // An ulp of the impact speed grows like the tick's own error: by the length of the flights after it.
    rounding: |tick| rounding_of(1.4 / tick, 20.0),
};

/// Measured at finer ticks.
const CONSTANTS: &[Constant] = &[
    Constant::located("ExplicitEuler", 1, 6.075e2),
    Constant::per_tick("SemiImplicitEuler", 2, 1.273e4),
    Constant::located("SemiImplicitEuler", 2, 1.188e4),
    Constant::per_tick("VelocityVerlet", 2, 1.932e4),
    Constant::located("VelocityVerlet", 2, 1.103e4),
    Constant::located("ImplicitMidpoint", 2, 4.558e1),
    Constant::located("RungeKutta4", 5, 1.122e11),
    Constant::located("Symplectic4", 4, 2.458e6),
];

/// The reference values.
pub const TRUTH: &str = include_str!("../../../assets/truths/C05_zeno_bounce.json");
/// Gap in m from which the ball is let go.
pub const HEIGHT: f64 = 1.0;
/// `mu` of the pair.
pub const INELASTICITY: f64 = 0.3;
/// In N/m.
pub const STIFFNESS: f64 = 1e5;
/// In m/s2.
pub const GRAVITY: f64 = 9.81;
/// In m.
pub const RADIUS: f64 = 0.1;

/// A part of the motion: `gap = center + cosine cos(w t) + sine sin(w t)`, or a parabola where `w` is zero.
#[derive(Clone, Copy, Debug)]
pub struct BouncePart {
    /// When it begins, in s.
    pub begin: f64,
    /// Gap in m at its beginning, negative for an overlap.
    pub gap: f64,
    /// Velocity in m/s at its beginning.
    pub velocity: f64,
    /// Angular frequency in rad/s; zero in flight.
    pub rate: f64,
}

impl BouncePart {
    /// Gap in m and velocity in m/s at `time`.
    fn state(&self, time: f64) -> (f64, f64) {
        let since = time - self.begin;
        if self.rate == 0.0 {
            let gap = self.gap + self.velocity * since - 0.5 * GRAVITY * since * since;
            return (gap, self.velocity - GRAVITY * since);
        }
        let center = -GRAVITY / (self.rate * self.rate);
        let (sin, cos) = libm::sincos(self.rate * since);
        let (cosine, sine) = (self.gap - center, self.velocity / self.rate);
        (center + cosine * cos + sine * sin, self.rate * (sine * cos - cosine * sin))
    }
}

/// All parts of the motion, and the overlap in m and the time in s at which it ends.
pub fn history() -> (Vec<BouncePart>, f64, f64) {
    let (loading, unloading) = rates();
    let sinking = |rate: f64| GRAVITY / (rate * rate);
    let mut parts = vec![BouncePart { begin: 0.0, gap: HEIGHT, velocity: 0.0, rate: 0.0 }];
    let mut time = (2.0 * HEIGHT / GRAVITY).sqrt();
    let mut speed = GRAVITY * time;
    loop {
        parts.push(BouncePart { begin: time, gap: 0.0, velocity: -speed, rate: loading });
        time += (PI - libm::atan(speed * loading / GRAVITY)) / loading;
        let mut deepest = sinking(loading) + sinking(loading).hypot(speed / loading);
        // As long as it does not get off, it swings until it turns inside the band.
        while deepest <= 2.0 * sinking(unloading) {
            if deepest <= sinking(unloading) {
                return (parts, deepest, time);
            }
            parts.push(BouncePart { begin: time, gap: -deepest, velocity: 0.0, rate: unloading });
            time += PI / unloading;
            let highest = 2.0 * sinking(unloading) - deepest;
            if highest >= sinking(loading) {
                return (parts, highest, time);
            }
            parts.push(BouncePart { begin: time, gap: -highest, velocity: 0.0, rate: loading });
            time += PI / loading;
            deepest = 2.0 * sinking(loading) - highest;
        }
        parts.push(BouncePart { begin: time, gap: -deepest, velocity: 0.0, rate: unloading });
        let swing = deepest - sinking(unloading);
        let leaving = libm::acos(-sinking(unloading) / swing);
        time += leaving / unloading;
        speed = unloading * swing * libm::sin(leaving);
        parts.push(BouncePart { begin: time, gap: 0.0, velocity: speed, rate: 0.0 });
        time += 2.0 * speed / GRAVITY;
    }
}

/// Angular frequencies of loading and of unloading in rad/s.
fn rates() -> (f64, f64) {
    ((STIFFNESS * (1.0 + INELASTICITY)).sqrt(), (STIFFNESS * (1.0 - INELASTICITY)).sqrt())
}

/// Gap in m and velocity in m/s, `time` after it was let go.
pub fn state(time: f64) -> (f64, f64) {
    let (parts, overlap, end) = history();
    if time >= end {
        return (-overlap, 0.0);
    }
    let under_way = parts.iter().rfind(|part| part.begin <= time).unwrap_or(&parts[0]);
    under_way.state(time)
}

fn scene(setting: &ProblemSetting, duration: f64) -> String {
    let clock = setting.clock(duration);
    let (gap, velocity) = state(setting.shift);
    let height = RADIUS + gap;
    format!(
        "Scene({clock}, gravity: (0, -{GRAVITY:?}),
        materials: {{ \"clay\": (stiffness: {STIFFNESS:?}, inelasticity: {INELASTICITY:?}) }},
        walls: [(name: \"floor\", left: (1, 0), right: (0, 0), material: \"clay\")],
        bodies: [(name: \"ball\", at: (0.5, {height:?}), velocity: (0, {velocity:?}), material: \"clay\",
                  atoms: Disc(radius: {RADIUS:?}, mass: 1))])"
    )
}

/// Over the height of the fall.
fn error(simulation: &Simulation, time: f64, shift: f64) -> f64 {
    (simulation.bodies().position[0].y - RADIUS - state(time + shift).0).abs() / HEIGHT
}

/// As for the inelastic impact, each of two impacts delays the ball by up to `1 + 2 mu/(1 - mu)` ticks. Its speed is then at most
/// `v` after the first impact. Each also changes restitution by up to `2 mu (w dt)^2/e`. Each flight of up to 0.7 s after it then
/// ends off by that share of `v` times 0.7 s. Semi-implicit Euler falls by `g t dt/2` more in each of three flights.
fn leading_error(_: u32, tick: f64) -> f64 {
    let restitution = ((1.0 - INELASTICITY) / (1.0 + INELASTICITY)).sqrt();
    let speed = restitution * (2.0 * GRAVITY * HEIGHT).sqrt();
    let late = tick * (1.0 + 2.0 * INELASTICITY / (1.0 - INELASTICITY));
    let step = STIFFNESS.sqrt() * tick;
    let slower = 2.0 * INELASTICITY * step * step / restitution;
    (2.0 * speed * (late + 0.7 * slower) + 3.0 * GRAVITY * 0.7 * tick / 2.0) / HEIGHT
}
