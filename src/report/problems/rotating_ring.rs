//! A ring of twelve masses on springs that turns steadily: `m w^2 R = 2 k (l - l0) sin(pi/N)` with `l = 2 R sin(pi/N)`.
//! So the ring is wider than at rest (statics in the turning frame). SI units.

use std::f64::consts::PI;
use std::fmt::Write;

use glam::DVec2;

use super::{Class, Constant, Problem, ProblemSetting, rounding_of};
use jostle_engine::Simulation;

/// The problem.
pub const PROBLEM: Problem = Problem {
    name: "rotating_ring",
    law: "a turning ring of springs keeps the radius at which tension and inertia balance",
    source: "closed form; truth file O04",
    class: Class::Smooth,
    tick: TURN / 256.0,
    samples: &[TURN, 2.0 * TURN, 3.0 * TURN, 4.0 * TURN, 5.0 * TURN, 6.0 * TURN, 7.0 * TURN, 8.0 * TURN, 100.0 * TURN],
    unit: "1",
    always_located: false,
    scene,
    error,
    leading_error: Some(leading_error),
    constants: CONSTANTS,
    // Two springs pull at each mass, with ten times the force that is left over.
    rounding: |tick| rounding_of(100.0 * TURN / tick, 20.0),
};

/// Measured at finer ticks.
const CONSTANTS: &[Constant] = &[
    Constant::per_tick("SemiImplicitEuler", 1, 8.169e-1),
    Constant::located("SemiImplicitEuler", 1, 8.169e-1),
    Constant::per_tick("VelocityVerlet", 2, 1.319e0),
    Constant::located("VelocityVerlet", 2, 1.319e0),
    Constant::located("ImplicitMidpoint", 2, 1.309e1),
    Constant::located("RungeKutta4", 4, 1.562e3),
];

/// The reference values.
pub const TRUTH: &str = include_str!("../../../assets/truths/O04_rotating_ring.json");
/// Number of masses.
pub const COUNT: usize = 12;
/// In rad/s.
pub const SPIN: f64 = 8.0;
/// A turn in s.
const TURN: f64 = 2.0 * PI / SPIN;
/// Of each, in kg.
pub const MASS: f64 = 0.1;
/// In N/m.
const STIFFNESS: f64 = 500.0;
/// Length of a spring without force in m.
const LENGTH: f64 = 0.2;

/// The radius in m.
pub fn radius() -> f64 {
    let sin = libm::sin(PI / COUNT as f64);
    2.0 * STIFFNESS * LENGTH * sin / (4.0 * STIFFNESS * sin * sin - MASS * SPIN * SPIN)
}

/// Angular frequency in rad/s with which the radius swings about that, the angular momentum being kept: from
/// `m r'' = L^2/(m r^3) - 2 k (l - l0) sin(pi/N)`.
pub fn breathing() -> f64 {
    let sin = libm::sin(PI / COUNT as f64);
    (3.0 * SPIN * SPIN + 4.0 * STIFFNESS * sin * sin / MASS).sqrt()
}

fn scene(setting: &ProblemSetting, duration: f64) -> String {
    let clock = setting.clock(duration);
    let radius = radius();
    let (mut bodies, mut springs) = (String::new(), String::new());
    for index in 0..COUNT {
        let (sin, cos) = libm::sincos(2.0 * PI * index as f64 / COUNT as f64);
        let at = DVec2::new(cos, sin) * radius;
        let velocity = at.perp() * SPIN;
        let _ = write!(
            bodies,
            "(name: \"m{index}\", at: ({:?}, {:?}), velocity: ({:?}, {:?}), collides: false,
              atoms: Disc(radius: 0.01, mass: {MASS:?})),",
            at.x, at.y, velocity.x, velocity.y
        );
        let next = (index + 1) % COUNT;
        let _ =
            write!(springs, "Spring(a: \"m{index}\", b: \"m{next}\", stiffness: {STIFFNESS:?}, length: {LENGTH:?}),");
    }
    format!("Scene({clock}, forces: [{springs}], bodies: [{bodies}])")
}

/// The greatest difference of a mass's distance from the middle, over the radius.
fn error(simulation: &Simulation, _: f64, _: f64) -> f64 {
    let radius = radius();
    let off = simulation.bodies().position.iter().map(|position| (position.length() / radius - 1.0).abs());
    off.fold(0.0, |most, error| if error <= most { most } else { error })
}

/// Let `z = w dt`. The first tick of velocity Verlet ends `R z^4/8` too far out, as if `R w^2 z^2/4` pulled outwards.
/// So the ring swings about a radius that is larger by that over the square of the breathing frequency `b`. The
/// amplitude has the same size. In all that is `z^2/2 (w/b)^2`, and a share `(b dt)^2` more for the next term.
/// Semi-implicit Euler is velocity Verlet with a velocity that points inwards by `R w z/2`. That is an amplitude of
/// `z/2 (w/b)`, and the second order beside it. The constants of higher orders are not known here, so these methods are
/// held to the bound of order 2.
fn leading_error(order: u32, tick: f64) -> f64 {
    let (z, share) = (SPIN * tick, SPIN / breathing());
    let second = 0.5 * z * z * share * share * (1.0 + (breathing() * tick).powi(2));
    if order >= 2 { second } else { 0.5 * z * share + z * z / 2.0 + second }
}
