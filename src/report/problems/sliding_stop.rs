//! A body that cannot turn slides on the floor, is decelerated by `mu g`, stops and stays. SI units.
//!
//! At first the tangential spring is stretched, `x = (v/w) sin(w t)` with `w^2 = k_t/m`, until it pulls with `mu m g`.
//! Then friction is constant (Coulomb 1785) until the velocity is zero. From then on friction keeps the velocity zero.
//! The spring is soft, so that the tick resolves the beginning. The force has a kink at its end. At the stop the
//! velocity becomes exactly zero. So the way is off by at most a tick of the last velocity.

use super::{Class, Constant, Problem, ProblemSetting, rounding_of};
use jostle_engine::Simulation;

/// The problem.
pub const PROBLEM: Problem = Problem {
    name: "sliding_stop",
    law: "a sliding body stops after v^2/(2 mu g) and stays",
    source: "closed form (any textbook for the ideal law, truth file F02)",
    class: Class::Kink,
    tick: 2e-3,
    samples: &[0.2, 0.5, 1.0],
    unit: "m",
    always_located: false,
    scene,
    error,
    leading_error: Some(leading_error),
    constants: CONSTANTS,
    rounding: |tick| rounding_of(1.0 / tick, 4.0),
};

/// Measured at finer ticks.
const CONSTANTS: &[Constant] = &[
    Constant::located("ExplicitEuler", 1, 2.981e0),
    Constant::per_tick("SemiImplicitEuler", 2, 1.677e1),
    Constant::located("SemiImplicitEuler", 2, 1.546e1),
    Constant::per_tick("VelocityVerlet", 2, 1.721e1),
    Constant::located("VelocityVerlet", 2, 6.073e-1),
    Constant::located("ImplicitMidpoint", 2, 2.438e-1),
    Constant::located("RungeKutta4", 4, 1.951e0),
];

/// The reference values of the ideal law.
pub const TRUTH: &str = include_str!("../../../assets/truths/F02_sliding_stop.json");
/// Friction coefficient.
pub const FRICTION: f64 = 0.4;
/// Speed at the start in m/s.
pub const SPEED: f64 = 3.0;
/// In m/s2.
pub const GRAVITY: f64 = 9.81;
/// Stiffness of the tangential spring in N/m; the mass is 1 kg.
pub const TANGENTIAL: f64 = 80.0;
const STIFFNESS: f64 = 100.0;
const RADIUS: f64 = 1.0;

/// The way in m and the velocity in m/s at `time`.
pub fn state(time: f64) -> (f64, f64) {
    let rate = TANGENTIAL.sqrt();
    let stretch = FRICTION * GRAVITY / TANGENTIAL;
    let full = libm::asin(stretch * rate / SPEED) / rate;
    if time <= full {
        let (sin, cos) = libm::sincos(rate * time);
        return (SPEED / rate * sin, SPEED * cos);
    }
    let speed = SPEED * libm::cos(rate * full);
    let since = (time - full).min(speed / (FRICTION * GRAVITY));
    (stretch + speed * since - 0.5 * FRICTION * GRAVITY * since * since, speed - FRICTION * GRAVITY * since)
}

fn scene(setting: &ProblemSetting, duration: f64) -> String {
    let clock = setting.clock(duration);
    let height = RADIUS - GRAVITY / STIFFNESS;
    format!(
        "Scene({clock}, gravity: (0, -{GRAVITY:?}), contacts: Penalty(tangential: Spring(ratio: {:?})),
        materials: {{ \"rubber\": (stiffness: {STIFFNESS:?}, friction: {FRICTION:?}, inelasticity: 0.3) }},
        walls: [(name: \"floor\", left: (1, 0), right: (0, 0), material: \"rubber\")],
        bodies: [(name: \"sled\", at: (0, {height:?}), velocity: ({SPEED:?}, 0), material: \"rubber\", inertia: 1e15,
                  atoms: Disc(radius: {RADIUS:?}, mass: 1))])",
        TANGENTIAL / STIFFNESS
    )
}

/// The problem has no shift: its events fall on other places of other ticks anyway.
fn error(simulation: &Simulation, time: f64, _: f64) -> f64 {
    (simulation.bodies().position[0].x - state(time).0).abs()
}

/// Order 2: the spring is stretched at most at the speed `v`. So when it is full, the trapezium of a tick is off by up
/// to `k_t v dt^2/8`. The oscillator before that is off by less than that again. The velocity is then off for the 0.8 s
/// to the stop. The last tick is off by up to `mu g dt^2`. Order 1: `mu g dt/2` for that time, and the last tick.
fn leading_error(order: u32, tick: f64) -> f64 {
    let (friction, lasts) = (FRICTION * GRAVITY, 0.8);
    if order >= 2 { tick * tick * (TANGENTIAL * SPEED / 4.0 * lasts + friction) } else { friction * tick * lasts }
}
