//! Blocks on a belt, each held by a spring (den Hartog, *Mechanical Vibrations*, 1956, 7). The belt carries them until
//! the spring pulls with the static friction. Then they slip as oscillators about the point of the dynamic friction,
//! until they have the belt's velocity again. SI units.
//!
//! Let `x_s`, `x_k` be the points of static and dynamic friction, and `tan phi = (x_s - x_k) w/V`. A round lasts `2
//! (pi - phi)/w + 2 (x_s - x_k)/V`. If both coefficients are equal, the block slips forever. Once in a period it
//! touches the velocity of the belt without crossing it. Friction jumps at the beginning of slip (if the static one is
//! greater) and reverses there and at its end.

use std::f64::consts::PI;
use std::fmt::Write;

use super::{Class, Constant, EventTiming, Problem, ProblemSetting, rounding_of};
use jostle_engine::Simulation;

/// The problem.
pub const PROBLEM: Problem = Problem {
    name: "stick_slip",
    law: "a block on a belt, held by a spring, sticks and slips in turn",
    source: "piecewise closed form (den Hartog 1956, 7); truth file F04",
    class: Class::Jump,
    tick: 4e-3,
    samples: &[0.4, 0.9, 1.4, 1.9, 2.4],
    unit: "1",
    always_located: true,
    scene,
    error,
    leading_error: None,
    constants: CONSTANTS,
    rounding: |tick| rounding_of(2.4 / tick, 20.0),
};

/// Measured at finer ticks.
const CONSTANTS: &[Constant] = &[
    Constant::located("ExplicitEuler", 1, 1.151e1),
    Constant::located("SemiImplicitEuler", 1, 2.458e0),
    Constant::located("VelocityVerlet", 2, 4.404e0),
    Constant::located("ImplicitMidpoint", 2, 1.122e1),
    Constant::located("RungeKutta4", 4, 5.551e1),
];

/// The reference values.
pub const TRUTH: &str = include_str!("../../../assets/truths/F04_belt_stick_slip.json");
/// Static coefficients of the blocks.
pub const STATIC: [f64; 2] = [0.5, 0.3];
const DYNAMIC: f64 = 0.3;
const GRAVITY: f64 = 9.81;
/// Of the springs, in N/m; the mass is 1 kg.
const STIFFNESS: f64 = 50.0;
/// Velocity of the belt in m/s.
const BELT: f64 = 0.2;
const FLOOR: f64 = 1e5;
const RADIUS: f64 = 0.1;

/// The times in s of slipping and of sticking in a round, and the greatest place in m.
pub fn round(friction: f64) -> (f64, f64, f64) {
    let (rate, away) = (STIFFNESS.sqrt(), (friction - DYNAMIC) * GRAVITY / STIFFNESS);
    let phase = libm::atan(away * rate / BELT);
    let highest = DYNAMIC * GRAVITY / STIFFNESS + away.hypot(BELT / rate);
    (2.0 * (PI - phase) / rate, 2.0 * away / BELT, highest)
}

/// Position in m and velocity in m/s at `time`. At the start the spring is slack and the block has the belt's velocity.
pub fn state(friction: f64, time: f64) -> (f64, f64) {
    let to_slip = friction * GRAVITY / STIFFNESS;
    let (slips, sticks, _) = round(friction);
    if time <= to_slip / BELT {
        return (BELT * time, BELT);
    }
    let since = (time - to_slip / BELT) % (slips + sticks);
    let about = DYNAMIC * GRAVITY / STIFFNESS;
    if since <= slips {
        let rate = STIFFNESS.sqrt();
        let (sin, cos) = libm::sincos(rate * since);
        let away = to_slip - about;
        return (about + away * cos + BELT / rate * sin, BELT * cos - away * rate * sin);
    }
    // It is caught as far on the other side as it was let go.
    (2.0 * about - to_slip + BELT * (since - slips), BELT)
}

fn scene(setting: &ProblemSetting, duration: f64) -> String {
    let clock = ProblemSetting { events: EventTiming::Located, ..*setting }.clock(duration);
    let height = RADIUS - GRAVITY / FLOOR;
    let (mut bodies, mut springs, mut materials) = (String::new(), String::new(), String::new());
    for (index, friction) in STATIC.into_iter().enumerate() {
        let (x, velocity) = state(friction, setting.shift);
        let _ = write!(
            bodies,
            "(name: \"block_{index}\", at: ({:?}, {height:?}), velocity: ({velocity:?}, 0), material: \"wood_{index}\",
              inertia: 1e300, atoms: Disc(radius: {RADIUS:?}, mass: 1)),",
            index as f64 + x
        );
        let _ = write!(
            springs,
            "Spring(a: \"block_{index}\", b: World, anchor_b: ({index}, {height:?}), stiffness: {STIFFNESS:?}, length: 0),"
        );
        let _ = write!(
            materials,
            "\"wood_{index}\": (stiffness: {FLOOR:?}, friction: (static: {friction:?}, dynamic: {DYNAMIC:?}),
                                inelasticity: 0.3),"
        );
    }
    let pairs = STATIC.into_iter().enumerate().fold(String::new(), |mut pairs, (index, friction)| {
        let _ = write!(
            pairs,
            "(between: (\"wood_{index}\", \"belt\"), friction: (static: {friction:?}, dynamic: {DYNAMIC:?})),"
        );
        pairs
    });
    format!(
        "Scene({clock}, gravity: (0, -{GRAVITY:?}), contacts: Penalty(tangential: Exact),
        materials: {{ {materials} \"belt\": (stiffness: {FLOOR:?}, inelasticity: 0.3) }}, pairs: [{pairs}],
        walls: [(name: \"belt\", left: (1, 0), right: (0, 0), material: \"belt\", surface_velocity: ({BELT:?}, 0))],
        bodies: [{bodies}], forces: [{springs}])"
    )
}

/// The greater of both blocks, over the greatest place of the first.
fn error(simulation: &Simulation, time: f64, shift: f64) -> f64 {
    let of = |(index, friction): (usize, f64)| {
        let found = simulation.bodies().position[index].x - index as f64;
        (found - state(friction, time + shift).0).abs() / round(STATIC[0]).2
    };
    STATIC.into_iter().enumerate().map(of).fold(0.0, |most, error| if error <= most { most } else { error })
}
