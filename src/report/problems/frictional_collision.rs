//! Discs strike a wall, and each other, with Coulomb friction and without compliance along the surface. They slip until
//! the points of contact move together, if the impact lasts long enough. Then they stick without a force (Walton 1993;
//! Foerster et al. 1994). SI units, no gravity.
//!
//! An impact has the normal impulse `J = (1 + e) m v_n`. It sticks if `mu J` reaches the impulse that stops the slip
//! `u`, `u/(1/m + r^2/I)` (summed over both discs). Otherwise the impulse along the surface is `mu J`. The normal force
//! follows the law of inelasticity. It jumps at the turn of the disc, and friction jumps when it sticks.
//!
//! The discs are so slow that their overlap is 1e-8 of their radius. As in the reference, the arm of friction is the
//! radius, and the normal does not turn.

use std::fmt::Write;

use glam::DVec2;

use super::{Class, Constant, EventTiming, Problem, ProblemSetting, Truth, rounding_of};
use jostle_engine::Simulation;

/// The problem.
pub const PROBLEM: Problem = Problem {
    name: "frictional_collision",
    law: "an impact with friction slips throughout or ends sticking",
    source: "Walton 1993; Foerster et al., Physics of Fluids 6, 1994; truth file C07",
    class: Class::Jump,
    tick: CONTACT_TIME / 80.0,
    samples: &[1.5 * CONTACT_TIME],
    unit: "1",
    always_located: true,
    scene,
    error,
    leading_error: None,
    constants: CONSTANTS,
    rounding,
};

/// Measured at finer ticks.
const CONSTANTS: &[Constant] = &[
    Constant::located("ExplicitEuler", 1, 3.290e2),
    Constant::located("SemiImplicitEuler", 2, 3.217e4),
    Constant::located("VelocityVerlet", 2, 5.807e3),
];

/// The reference values.
pub const TRUTH: &str = include_str!("../../../assets/truths/C07_disc_friction_collision.json");
/// Angles of incidence upon the wall in degrees.
pub const ANGLES: [u32; 5] = [10, 30, 45, 60, 80];
/// Angles between velocity and line of centres in degrees, and spins in rad/s at the speed of the truth file.
pub const PAIRS: [(u32, [i32; 2]); 3] = [(20, [0, 0]), (60, [0, 0]), (40, [15, -5])];
/// Speed before in m/s; all else scales with it.
pub const SPEED: f64 = 3e-7;
/// Speed of the truth file over this one.
const SCALE: f64 = 3.0 / SPEED;
/// Radii in m; the second is that of the struck disc.
const RADII: [f64; 2] = [0.1, 0.15];
const STIFFNESS: f64 = 1e5;
const FRICTION: f64 = 0.3;
const INELASTICITY: f64 = 0.36;
/// That of the wall's impacts, `pi/2 (1/sqrt(1 + mu) + 1/sqrt(1 - mu)) sqrt(m/k)`, in s; those of two discs are shorter.
const CONTACT_TIME: f64 = 0.010_468_8;
/// The way to the contact, in contact times.
const LEAD: f64 = 0.1;

/// A shift lets the discs start that much earlier on their way.
fn scene(setting: &ProblemSetting, duration: f64) -> String {
    let clock = ProblemSetting { events: EventTiming::Located, ..*setting }.clock(duration);
    let lead = LEAD * CONTACT_TIME + setting.shift;
    let mut bodies = String::new();
    let mut disc = |name: &str, at: DVec2, velocity: DVec2, spin: f64, material: &str, which: usize| {
        let (radius, mass) = (RADII[which], [1.0, 2.0][which]);
        let _ = write!(
            bodies,
            "(name: \"{name}\", at: ({:?}, {:?}), velocity: ({:?}, {:?}), spin: {spin:?}, material: \"{material}\",
              atoms: Disc(radius: {radius:?}, mass: {mass:?})),",
            at.x, at.y, velocity.x, velocity.y
        );
    };
    for (index, degrees) in ANGLES.into_iter().enumerate() {
        let (sin, cos) = libm::sincos(f64::from(degrees).to_radians());
        let velocity = DVec2::new(SPEED * sin, -SPEED * cos);
        let at = DVec2::new(index as f64, RADII[0] - velocity.y * lead);
        disc(&format!("on_wall_{degrees}"), at, velocity, 0.0, "soft", 0);
    }
    for (index, (degrees, spins)) in PAIRS.into_iter().enumerate() {
        // The first arrives along x; the line of centres points down to the right.
        let (sin, cos) = libm::sincos(f64::from(degrees).to_radians());
        let (at, velocity) = (DVec2::new(index as f64 - 1.0, 1.0), DVec2::new(SPEED, 0.0));
        let normal = DVec2::new(cos, -sin);
        let first = at - normal * (RADII[0] + RADII[1] + SPEED * cos * lead);
        disc(&format!("striking_{index}"), first, velocity, f64::from(spins[0]) / SCALE, "hard", 0);
        disc(&format!("struck_{index}"), at, DVec2::ZERO, f64::from(spins[1]) / SCALE, "hard", 1);
    }
    let stiff = 2.0 * STIFFNESS;
    format!(
        "Scene({clock}, contacts: Penalty(tangential: Exact),
        materials: {{ \"soft\": (stiffness: {STIFFNESS:?}, friction: {FRICTION:?}, inelasticity: {INELASTICITY:?}),
                      \"hard\": (stiffness: {stiff:?}, friction: {FRICTION:?}, inelasticity: {INELASTICITY:?}) }},
        walls: [(name: \"floor\", left: (1, 0), right: (0, 0), material: \"soft\")], bodies: [{bodies}])"
    )
}

/// Velocities in m/s and velocities of rims in m/s after the impacts, in the order of the bodies.
fn after() -> Vec<(DVec2, f64)> {
    let truth = Truth::read(TRUTH);
    let mut states = Vec::new();
    for degrees in ANGLES {
        let row = truth.numbers(&format!("wall, {degrees} deg: v_t, v_n, omega after"));
        states.push((DVec2::new(row[0], row[1]) / SCALE, RADII[0] * row[2] / SCALE));
    }
    for (degrees, [first, second]) in PAIRS {
        let name = format!("discs hard, angle {degrees} deg, w=({first},{second}): v1x,v1y,w1,v2x,v2y,w2 after");
        let row = truth.numbers(&name);
        for (disc, numbers) in row.chunks(3).enumerate() {
            states.push((DVec2::new(numbers[0], numbers[1]) / SCALE, RADII[disc] * numbers[2] / SCALE));
        }
    }
    states
}

/// The greatest error of a velocity of a centre or a rim, over the speed before.
fn error(simulation: &Simulation, _: f64, _: f64) -> f64 {
    let bodies = simulation.bodies();
    let of = |(body, (velocity, rim)): (usize, (DVec2, f64))| {
        let radius = bodies.atom_radius[body];
        (bodies.velocity[body] - velocity).length().max((radius * bodies.spin[body] - rim).abs()) / SPEED
    };
    after().into_iter().enumerate().map(of).fold(0.0, |most, error| if error <= most { most } else { error })
}

/// Rounding: an overlap is a difference of coordinates of up to 1 m. Arms are shorter by the overlap, and the normal
/// turns by the way along the surface over the distance.
fn rounding(tick: f64) -> f64 {
    let overlap = SPEED / STIFFNESS.sqrt();
    rounding_of(1.5 * CONTACT_TIME / tick, 4.0)
        + f64::EPSILON / overlap
        + 3.0 * overlap / RADII[0]
        + SPEED * CONTACT_TIME / (RADII[0] + RADII[1])
}
