//! A disc strikes an elastic wall at a slant. A tangential spring with a Coulomb limit grips the wall (Maw, Barber and
//! Fawcett 1976; Schaefer, Dippel and Wolf 1996). SI units, no gravity.
//!
//! `psi1` is the tangential speed of the point of contact over the normal speed before, `psi2` after the impact. At small
//! `psi1` the contact sticks first and rebounds backwards; at large ones it slips throughout and `psi2 = psi1 - 3 mu (1 + e)`.
//!
//! The disc is so slow that its overlap is 1e-8 of its radius. As in the reference, the arm of friction is the radius.

use super::{Class, Constant, Problem, ProblemSetting, Truth, rounding_of};
use jostle_engine::Simulation;

/// The problem.
pub const PROBLEM: Problem = Problem {
    name: "tangential_impact",
    law: "a contact that grips rebounds along its tangent too",
    source: "piecewise closed form (Maw, Barber, Fawcett, Wear 38, 1976, for the regimes); truth file C08",
    class: Class::Kink,
    tick: CONTACT_TIME / 80.0,
    samples: &[1.3 * CONTACT_TIME],
    unit: "1",
    always_located: false,
    scene: |setting, duration| scene(setting, duration, 1.0),
    error: |simulation, _, _| error_of(simulation, 1.0),
    leading_error: Some(leading_error),
    constants: CONSTANTS,
    rounding,
};

/// Measured at finer ticks.
const CONSTANTS: &[Constant] = &[
    Constant::located("ExplicitEuler", 1, 4.026e2),
    Constant::per_tick("SemiImplicitEuler", 2, 8.152e3),
    Constant::located("SemiImplicitEuler", 2, 1.269e4),
    Constant::per_tick("VelocityVerlet", 2, 8.152e3),
    Constant::located("VelocityVerlet", 2, 4.426e3),
    Constant::located("ImplicitMidpoint", 2, 4.079e2),
];

/// The reference values.
pub const TRUTH: &str = include_str!("../../../assets/truths/C08_disc_tangential_spring.json");
/// Normal speed before the impact in m/s.
pub const SPEED: f64 = 3e-7;
/// Radius in m.
pub const RADIUS: f64 = 0.1;
/// `pi sqrt(m/k)` in s.
pub const CONTACT_TIME: f64 = 0.009_934_588_265_796_101;
/// Normal stiffness in N/m; the mass is 1 kg.
pub const STIFFNESS: f64 = 1e5;
/// Tangential over normal stiffness.
pub const RATIO: f64 = 0.5;
/// Friction coefficient.
pub const FRICTION: f64 = 0.3;
/// The contact begins this share of half a period after the start of the run.
const LEAD: f64 = 0.1;

/// `psi1` and `psi2` of the truth file.
pub fn sweep() -> Vec<(f64, f64)> {
    let truth = Truth::read(TRUTH);
    let observable = "psi2 = u_out/v_n for psi1 = u_in/v_n";
    truth.times(observable).into_iter().zip(truth.numbers(observable)).collect()
}

/// The impact at any `psi1`. A shift lets the disc start that much earlier on its straight way.
pub fn scene(setting: &ProblemSetting, duration: f64, psi1: f64) -> String {
    let clock = setting.clock(duration);
    let gap = SPEED * (LEAD * CONTACT_TIME + setting.shift);
    let (height, along) = (RADIUS + gap, psi1 * SPEED);
    format!(
        "Scene({clock}, contacts: Penalty(tangential: Spring(ratio: {RATIO:?})),
        materials: {{ \"rubber\": (stiffness: {STIFFNESS:?}, friction: {FRICTION:?}) }},
        walls: [(name: \"floor\", left: (1, 0), right: (0, 0), material: \"rubber\")],
        bodies: [(name: \"disc\", at: (0, {height:?}), velocity: ({along:?}, -{SPEED:?}), material: \"rubber\",
                  atoms: Disc(radius: {RADIUS:?}, mass: 1))])"
    )
}

/// `psi2` and the velocity along the wall over the normal speed before.
pub fn outcome(simulation: &Simulation) -> (f64, f64) {
    let bodies = simulation.bodies();
    let along = bodies.velocity[0].x;
    ((along + bodies.spin[0] * RADIUS) / SPEED, along / SPEED)
}

/// The greater error of `psi2` and of the velocity along the wall, over the normal speed.
pub fn error_of(simulation: &Simulation, psi1: f64) -> f64 {
    let psi2 = sweep().into_iter().find(|row| row.0 == psi1).map_or(f64::NAN, |row| row.1);
    let (found, along) = outcome(simulation);
    (found - psi2).abs().max((along - psi1 + (psi1 - psi2) / 3.0).abs())
}

/// Four kinks (touch, slip, stick, parting). Inside a tick each changes velocities by up to a share `(w dt)^2/4` (see
/// the elastic bounce). The rate is the faster of the two. The speeds are up to `psi1` and 1. Forces of one end of a
/// tick change them by up to `(pi/2) w dt` in the whole contact.
pub fn leading_error(order: u32, tick: f64) -> f64 {
    let step = (3.0 * RATIO * STIFFNESS).sqrt() * tick;
    if order >= 2 { step * step } else { std::f64::consts::FRAC_PI_2 * step }
}

/// Rounding, and what an arm that is shorter by the overlap changes.
fn rounding(tick: f64) -> f64 {
    let overlap = SPEED / STIFFNESS.sqrt();
    // An overlap is a difference of numbers of the size of the radius.
    rounding_of(1.3 * CONTACT_TIME / tick, 4.0) + RADIUS * f64::EPSILON / overlap + 3.0 * overlap / RADIUS
}
