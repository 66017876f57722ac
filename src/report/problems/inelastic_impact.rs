//! A disc meets a dissipative wall (the idea of Walton and Braun 1986). While it approaches `N = k d (1 + mu)`, and
//! while it parts `N = k d (1 - mu)`. SI units, no gravity.
//!
//! Loading is a quarter period of `w1 = sqrt(k (1 + mu)/m)`, and unloading one of `w2 = sqrt(k (1 - mu)/m)`. The
//! deepest overlap is `v/w1`. The disc leaves with `e v`, `e = sqrt((1 - mu)/(1 + mu))`. The force jumps at its turn,
//! so a method that does not locate it has order 1. With `mu = 0` this is the elastic impact of `pi sqrt(m/k)`.

use std::f64::consts::FRAC_PI_2;

use super::{Class, Constant, Problem, ProblemSetting, rounding_of};
use jostle_engine::Simulation;

/// The problem.
pub const PROBLEM: Problem = Problem {
    name: "inelastic_impact",
    law: "restitution of the inelasticity law, whatever the speed",
    source: "work balance of the law; truth file C02",
    class: Class::Jump,
    tick: 1e-3,
    samples: &[0.05, 0.08],
    unit: "1",
    always_located: false,
    scene: |setting, duration| scene(setting, duration, INELASTICITY),
    error,
    leading_error: Some(leading_error),
    constants: CONSTANTS,
    rounding: |tick| rounding_of(0.08 / tick, 10.0),
};

/// Measured at finer ticks.
const CONSTANTS: &[Constant] = &[
    Constant::located("ExplicitEuler", 1, 5.048e1),
    Constant::per_tick("SemiImplicitEuler", 1, 6.376e0),
    Constant::located("SemiImplicitEuler", 2, 3.947e2),
    Constant::per_tick("VelocityVerlet", 1, 5.324e0),
    Constant::located("VelocityVerlet", 2, 6.201e2),
    Constant::located("ImplicitMidpoint", 2, 4.129e2),
    Constant::located("RungeKutta4", 4, 4.947e5),
    Constant::located("Symplectic4", 4, 1.000e4),
];

/// The reference values.
pub const TRUTH: &str = include_str!("../../../assets/truths/C02_inelastic_restitution.json");
/// `mu` of [`PROBLEM`].
pub const INELASTICITY: f64 = 0.5;
/// Speed before the impact in m/s.
pub const SPEED: f64 = 2.0;
/// Gap at the start in m.
pub const GAP: f64 = 0.05;
/// `sqrt(k/m)` in 1/s.
pub const OMEGA: f64 = 100.0;
/// Radius in m.
pub const RADIUS: f64 = 0.1;

/// Speed after over speed before.
pub fn restitution(inelasticity: f64) -> f64 {
    ((1.0 - inelasticity) / (1.0 + inelasticity)).sqrt()
}

/// The duration of the contact, in s.
pub fn contact_time(inelasticity: f64) -> f64 {
    FRAC_PI_2 / OMEGA * (1.0 / (1.0 + inelasticity).sqrt() + 1.0 / (1.0 - inelasticity).sqrt())
}

/// The deepest overlap in m.
pub fn deepest(inelasticity: f64) -> f64 {
    SPEED / (OMEGA * (1.0 + inelasticity).sqrt())
}

/// Gap in m at `time`, with the first touch at `GAP / SPEED`.
pub fn gap(time: f64, inelasticity: f64) -> f64 {
    let touching = time - GAP / SPEED;
    let (loading, unloading) = (OMEGA * (1.0 + inelasticity).sqrt(), OMEGA * (1.0 - inelasticity).sqrt());
    let turning = touching - FRAC_PI_2 / loading;
    let leaving = touching - contact_time(inelasticity);
    if touching <= 0.0 {
        -SPEED * touching
    } else if turning <= 0.0 {
        -SPEED / loading * libm::sin(loading * touching)
    } else if leaving <= 0.0 {
        -deepest(inelasticity) * libm::cos(unloading * turning)
    } else {
        restitution(inelasticity) * SPEED * leaving
    }
}

/// The impact with any inelasticity of the pair. A shift moves the start along the approach.
pub fn scene(setting: &ProblemSetting, duration: f64, inelasticity: f64) -> String {
    let clock = setting.clock(duration);
    let (height, stiffness) = (RADIUS + gap(setting.shift, inelasticity), OMEGA * OMEGA);
    format!(
        "Scene({clock}, materials: {{ \"clay\": (stiffness: {stiffness:?}, inelasticity: {inelasticity:?}) }},
        walls: [(name: \"floor\", left: (1, 0), right: (0, 0), material: \"clay\")],
        bodies: [(name: \"ball\", at: (0.5, {height:?}), velocity: (0, -{SPEED:?}), material: \"clay\",
                  atoms: Disc(radius: {RADIUS:?}, mass: 1))])"
    )
}

/// Over the way that the disc would have made in the time of contact.
fn error(simulation: &Simulation, time: f64, shift: f64) -> f64 {
    let exact = gap(time + shift, INELASTICITY);
    (simulation.bodies().position[0].y - RADIUS - exact).abs() / (SPEED * contact_time(INELASTICITY))
}

/// The force changes up to one tick late. In that tick it is off by `2 mu k d`, which shifts the phase of unloading by
/// `2 mu/(1 - mu)` ticks. Together with the tick itself, the disc leaves up to `1 + 2 mu/(1 - mu)` ticks off.
fn leading_error(_: u32, tick: f64) -> f64 {
    let late = tick * (1.0 + 2.0 * INELASTICITY / (1.0 - INELASTICITY));
    restitution(INELASTICITY) * late / contact_time(INELASTICITY)
}
