//! Two discs that overlap at rest at the start push each other apart. That is a quarter of a period of unloading, `N =
//! k (1 - mu) d`. SI units, no gravity.
//!
//! The energy is that of the springs alone: `m v^2 = k (1 - mu) d^2` with the reduced mass.

use glam::DVec2;

use super::{Class, Constant, Problem, ProblemSetting, rounding_of};
use jostle_engine::Simulation;

/// The problem.
pub const PROBLEM: Problem = Problem {
    name: "overlap_release",
    law: "discs that overlap at the start part with the energy of the spring",
    source: "closed form; truth file H04",
    class: Class::Kink,
    tick: 1e-4,
    samples: &[0.002, 0.004, 0.007],
    unit: "1",
    always_located: false,
    scene,
    error,
    leading_error: Some(leading_error),
    constants: CONSTANTS,
    rounding: |tick| rounding_of(0.007 / tick, 4.0),
};

/// Measured at finer ticks.
const CONSTANTS: &[Constant] = &[
    Constant::located("ExplicitEuler", 1, 1.923e2),
    Constant::per_tick("SemiImplicitEuler", 1, 1.232e2),
    Constant::located("SemiImplicitEuler", 1, 1.229e2),
    Constant::per_tick("VelocityVerlet", 2, 8.572e3),
    Constant::located("VelocityVerlet", 2, 1.000e4),
    Constant::located("ImplicitMidpoint", 2, 1.043e4),
    Constant::located("RungeKutta4", 4, 1.118e8),
    Constant::located("Symplectic4", 4, 1.193e6),
];

/// The reference values.
pub const TRUTH: &str = include_str!("../../../assets/truths/H04_initial_overlap.json");
/// Masses in kg.
pub const MASSES: [f64; 2] = [1.0, 3.0];
/// Stiffness of the pair in N/m.
pub const STIFFNESS: f64 = 1e5;
/// Overlap at the start in m.
pub const OVERLAP: f64 = 0.05;
/// `mu` of the pair.
pub const INELASTICITY: f64 = 0.2;
/// Radius of each in m.
const RADIUS: f64 = 0.5;

/// Rate of unloading in 1/s.
pub fn rate() -> f64 {
    let reduced = MASSES[0] * MASSES[1] / (MASSES[0] + MASSES[1]);
    (STIFFNESS * (1.0 - INELASTICITY) / reduced).sqrt()
}

/// The distance of the centres in m, and their speed apart in m/s.
pub fn distance(time: f64) -> (f64, f64) {
    let leaving = std::f64::consts::FRAC_PI_2 / rate();
    let speed = rate() * OVERLAP;
    if time >= leaving {
        return (2.0 * RADIUS + speed * (time - leaving), speed);
    }
    let (sin, cos) = libm::sincos(rate() * time);
    (2.0 * RADIUS - OVERLAP * cos, speed * sin)
}

/// Positions in m and velocities in m/s of both; their centre of mass is at the origin.
pub fn state(time: f64) -> [(DVec2, DVec2); 2] {
    let (distance, speed) = distance(time);
    let total = MASSES[0] + MASSES[1];
    let along = |share: f64| (DVec2::X * (share * distance), DVec2::X * (share * speed));
    [along(-MASSES[1] / total), along(MASSES[0] / total)]
}

/// A shift starts so much later on the way apart.
fn scene(setting: &ProblemSetting, duration: f64) -> String {
    let clock = setting.clock(duration);
    let stiffness = 2.0 * STIFFNESS;
    let disc = |name: &str, index: usize| {
        let (position, velocity) = state(setting.shift)[index];
        format!(
            "(name: \"{name}\", at: ({:?}, 0), velocity: ({:?}, 0), material: \"clay\",
              atoms: Disc(radius: {RADIUS:?}, mass: {:?}))",
            position.x, velocity.x, MASSES[index]
        )
    };
    format!(
        "Scene({clock}, materials: {{ \"clay\": (stiffness: {stiffness:?}, inelasticity: {INELASTICITY:?}) }},
        bodies: [{}, {}])",
        disc("light", 0),
        disc("heavy", 1)
    )
}

/// The greatest of the errors of positions over the overlap and of velocities over the greatest speed.
fn error(simulation: &Simulation, time: f64, shift: f64) -> f64 {
    let bodies = simulation.bodies();
    let speed = rate() * OVERLAP;
    let of = |(index, (position, velocity)): (usize, (DVec2, DVec2))| {
        let off = (bodies.position[index] - position).length() / OVERLAP;
        off.max((bodies.velocity[index] - velocity).length() / speed)
    };
    state(time + shift).into_iter().enumerate().map(of).fold(0.0, f64::max)
}

/// The kink at the parting changes the speed by up to a share `(w dt)^2/4`. The rate itself is off by `(w dt)^2/24` over a
/// quarter of a period. Later the way is off by 1.5 times the share. Order 1: forces of one end of a tick, up to `w dt`.
fn leading_error(order: u32, tick: f64) -> f64 {
    let step = rate() * tick;
    if order >= 2 { step * step } else { step * std::f64::consts::FRAC_PI_2 }
}
