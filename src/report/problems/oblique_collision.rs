//! Two discs of different mass, size and stiffness meet off centre without friction. The force is central, `k (R1 +
//! R2 - r)` with the stiffnesses in series, while the normal turns. SI units.
//!
//! The velocities after the collision are those of the scattering integral; the truth file has them to 15 digits.
//! A shift lets the first disc start that much earlier on its straight way.

use glam::DVec2;

use super::{Class, Constant, Problem, ProblemSetting, Truth, rounding_of};
use jostle_engine::Simulation;

/// The problem.
pub const PROBLEM: Problem = Problem {
    name: "oblique_collision",
    law: "elastic scattering of two soft discs",
    source: "scattering integral (Landau and Lifshitz, Mechanics, 18); truth file C06",
    class: Class::Kink,
    tick: 5e-4,
    samples: &[0.04],
    unit: "1",
    always_located: false,
    scene,
    error,
    leading_error: Some(leading_error),
    constants: CONSTANTS,
    rounding: |tick| rounding_of(0.04 / tick, 4.0),
};

/// Measured at finer ticks.
const CONSTANTS: &[Constant] = &[
    Constant::located("ExplicitEuler", 1, 9.953e1),
    Constant::per_tick("SemiImplicitEuler", 2, 3.300e2),
    Constant::located("SemiImplicitEuler", 2, 1.102e3),
    Constant::per_tick("VelocityVerlet", 2, 3.300e2),
    Constant::located("VelocityVerlet", 2, 3.979e1),
    Constant::located("ImplicitMidpoint", 2, 1.041e2),
    Constant::located("RungeKutta4", 4, 1.282e5),
    Constant::located("Symplectic4", 4, 4.570e1),
];

/// The reference values.
pub const TRUTH: &str = include_str!("../../../assets/truths/C06_disc_oblique_frictionless.json");
/// Speed before the collision in m/s.
pub const SPEED: f64 = 3.0;
/// Distance in m by which the centres would miss each other.
pub const OFFSET: f64 = 0.1;
/// Sum of the radii in m.
pub const REACH: f64 = 0.25;

/// Velocities of both discs after the collision in m/s.
pub fn after() -> [DVec2; 2] {
    let numbers = Truth::read(TRUTH).numbers("soft: v1,v2 after separation");
    [DVec2::new(numbers[0], numbers[1]), DVec2::new(numbers[2], numbers[3])]
}

fn scene(setting: &ProblemSetting, duration: f64) -> String {
    let clock = setting.clock(duration);
    let x = -(REACH * REACH - OFFSET * OFFSET).sqrt() - SPEED * setting.shift;
    format!(
        "Scene({clock}, materials: {{ \"soft\": (stiffness: 10000), \"hard\": (stiffness: 30000) }}, bodies: [
            (name: \"first\", at: ({x:?}, {OFFSET:?}), velocity: ({SPEED:?}, 0), material: \"soft\",
             atoms: Disc(radius: 0.1, mass: 1)),
            (name: \"second\", at: (0, 0), material: \"hard\", atoms: Disc(radius: 0.15, mass: 2)),
        ])"
    )
}

/// Of the velocities, over the speed before.
fn error(simulation: &Simulation, _: f64, _: f64) -> f64 {
    let found = &simulation.bodies().velocity;
    after().iter().zip(found).map(|(exact, found)| (*exact - *found).length() / SPEED).fold(0.0, f64::max)
}

/// Let `w = sqrt(k/m)` of series stiffness and reduced mass. A kink inside a tick changes the relative velocity by up
/// to a share `(w dt)^2`. Forces of one end of a tick change it by up to `w dt` (see the elastic bounce).
fn leading_error(order: u32, tick: f64) -> f64 {
    let omega = (7500.0_f64 / (2.0 / 3.0)).sqrt();
    (omega * tick).powi(order as i32)
}
