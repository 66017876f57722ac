//! A disc that is set down sliding begins to roll, and keeps about two thirds of its speed. SI units.
//!
//! The point of contact moves by `q`, with `q'' = -T (1/m + b^2/I)`, where `b` is the radius minus the overlap. At
//! first the tangential spring is stretched, `T = k_t q`. Then it slips with `T = mu m g` until the point of contact is
//! at rest. Then the full spring swings forever without damping, so the disc rolls and sways. All three phases have
//! closed forms.

use super::{Class, Constant, Problem, ProblemSetting, rounding_of};
use jostle_engine::Simulation;

/// The problem.
pub const PROBLEM: Problem = Problem {
    name: "slide_to_roll",
    law: "a sliding disc begins to roll",
    source: "closed form (any textbook for the ideal law, truth file F05)",
    class: Class::Kink,
    tick: 4e-4,
    samples: &[0.1, 0.2, 0.4],
    unit: "m",
    always_located: false,
    scene,
    error,
    leading_error: Some(leading_error),
    constants: CONSTANTS,
    rounding: |tick| rounding_of(0.4 / tick, 10.0),
};

/// Measured at finer ticks.
const CONSTANTS: &[Constant] = &[
    Constant::located("ExplicitEuler", 1, 1.743e0),
    Constant::per_tick("SemiImplicitEuler", 2, 1.078e2),
    Constant::located("SemiImplicitEuler", 2, 1.049e2),
    Constant::per_tick("VelocityVerlet", 2, 1.078e2),
    Constant::located("VelocityVerlet", 2, 2.296e0),
    Constant::located("ImplicitMidpoint", 2, 2.878e0),
];

/// The reference values of the ideal law.
pub const TRUTH: &str = include_str!("../../../assets/truths/F05_rolling_disc.json");
const FRICTION: f64 = 0.4;
const SPEED: f64 = 3.0;
const GRAVITY: f64 = 9.81;
const STIFFNESS: f64 = 1000.0;
const TANGENTIAL: f64 = 800.0;
const RADIUS: f64 = 0.1;
/// Arm of friction in m.
const ARM: f64 = RADIUS - GRAVITY / STIFFNESS;
const INERTIA: f64 = RADIUS * RADIUS / 2.0;

/// The effect of friction until some time: impulse in N s and its integral in N s2.
fn friction(time: f64) -> (f64, f64) {
    let mobility = 1.0 + ARM * ARM / INERTIA;
    let rate = (TANGENTIAL * mobility).sqrt();
    let (limit, stretch) = (FRICTION * GRAVITY, FRICTION * GRAVITY / TANGENTIAL);
    let full = libm::asin(stretch * rate / SPEED) / rate;
    let drawn = |time: f64| {
        let (sin, cos) = libm::sincos(rate * time);
        (SPEED / mobility * (1.0 - cos), SPEED / mobility * (time - sin / rate))
    };
    if time <= full {
        return drawn(time);
    }
    let (impulse, sum) = drawn(full);
    let slips = SPEED * libm::cos(rate * full) / (limit * mobility);
    let since = (time - full).min(slips);
    let (impulse, sum) = (impulse + limit * since, sum + impulse * since + 0.5 * limit * since * since);
    let rolls = time - full - since;
    let (sin, cos) = libm::sincos(rate * rolls);
    (impulse + limit / rate * sin, sum + impulse * rolls + limit / (rate * rate) * (1.0 - cos))
}

/// The way in m and the angle in rad at `time`.
pub fn state(time: f64) -> (f64, f64) {
    let (_, sum) = friction(time);
    (SPEED * time - sum, -ARM / INERTIA * sum)
}

fn scene(setting: &ProblemSetting, duration: f64) -> String {
    let clock = setting.clock(duration);
    format!(
        "Scene({clock}, gravity: (0, -{GRAVITY:?}), contacts: Penalty(tangential: Spring(ratio: {:?})),
        materials: {{ \"rubber\": (stiffness: {STIFFNESS:?}, friction: {FRICTION:?}) }},
        walls: [(name: \"floor\", left: (1, 0), right: (0, 0), material: \"rubber\")],
        bodies: [(name: \"disc\", at: (0, {ARM:?}), velocity: ({SPEED:?}, 0), material: \"rubber\",
                  atoms: Disc(radius: {RADIUS:?}, mass: 1))])",
        TANGENTIAL / STIFFNESS
    )
}

/// The greater of the error of the way and of that of a point of the rim. The problem has no shift, because its events
/// have different phases in other ticks anyway.
fn error(simulation: &Simulation, time: f64, _: f64) -> f64 {
    let bodies = simulation.bodies();
    let (way, angle) = state(time);
    (bodies.position[0].x - way).abs().max(RADIUS * (bodies.angle[0] - angle).abs())
}

/// Order 2: the spring is stretched at most at the speed `v`. So when it is full, the trapezium of a tick is off by up
/// to `k_t v dt^2/8`. The oscillator before that, and the kink at the end of slipping, are off by less than that again.
/// The velocity of the disc, or of the rim by `m R b/I`, is off by that for 0.4 s. Order 1: half a tick of friction.
fn leading_error(order: u32, tick: f64) -> f64 {
    let rim = RADIUS * ARM / INERTIA;
    if order >= 2 { rim * TANGENTIAL * SPEED / 4.0 * tick * tick * 0.4 } else { rim * FRICTION * GRAVITY * tick * 0.4 }
}
