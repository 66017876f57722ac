//! A disc slides without friction from the top of a fixed cylinder. It leaves the cylinder at `cos a = (v0^2/s + 2
//! g)/(3 g)`, `s = R + r`. There its weight is too small for its circle. SI units.
//!
//! The disc starts with the overlap that carries the force of a rigid contact. With a contact of stiffness `k` the error of the ideal
//! falls as `1/k`. In the air the way is a parabola.

use glam::DVec2;

use super::{Class, Constant, Problem, ProblemSetting, Truth, rounding_of};
use jostle_engine::Simulation;

/// The problem.
pub const PROBLEM: Problem = Problem {
    name: "leaving_cylinder",
    law: "a slider leaves a cylinder where its weight no longer bends its way",
    source: "textbook; truth file C12, with a contact of finite stiffness",
    class: Class::Kink,
    tick: 1.0 / 1024.0,
    samples: &[0.85, 0.95],
    unit: "m",
    always_located: false,
    scene: |setting, duration| scene(setting, duration, STIFFNESS),
    error,
    leading_error: None,
    constants: CONSTANTS,
    rounding: |tick| rounding_of(0.95 / tick, 2.0),
};

/// Measured at finer ticks.
const CONSTANTS: &[Constant] = &[
    Constant::located("ExplicitEuler", 1, 4.365e0),
    Constant::per_tick("SemiImplicitEuler", 1, 9.151e-3),
    Constant::located("SemiImplicitEuler", 1, 9.273e-3),
    Constant::per_tick("VelocityVerlet", 2, 1.686e0),
    Constant::located("VelocityVerlet", 2, 1.837e0),
    Constant::located("RungeKutta4", 4, 1.718e3),
    Constant::located("ImplicitMidpoint", 2, 1.731e0),
    Constant::located("Symplectic4", 4, 1.095e1),
];

/// The reference values for rigid bodies.
pub const TRUTH: &str = include_str!("../../../assets/truths/C12_leaves_cylinder.json");
/// Those for a contact of [`STIFFNESS`].
pub const SOFT: &str = include_str!("../../../assets/truths/C12_soft_cylinder.json");
/// In N/m.
pub const STIFFNESS: f64 = 1e4;
/// Of cylinder and disc, in m.
pub const RADII: [f64; 2] = [1.0, 0.1];
/// In m/s2.
pub const GRAVITY: f64 = 9.81;
/// On top, in m/s.
const SPEED: f64 = 0.5;

/// The disc of 1 kg on the cylinder, with a contact of a stiffness in N/m.
pub fn scene(setting: &ProblemSetting, duration: f64, stiffness: f64) -> String {
    let clock = setting.clock(duration);
    let far = RADII[0] + RADII[1];
    let height = far - (GRAVITY - SPEED * SPEED / far) / stiffness;
    format!(
        "Scene({clock}, gravity: (0, -{GRAVITY:?}), contacts: Penalty(tangential: None),
        materials: {{ \"soft\": (stiffness: {stiffness:?}, restitution: 1), \"hard\": (stiffness: 1e300, restitution: 1) }},
        bodies: [(name: \"slider\", at: (0, {height:?}), velocity: ({SPEED:?}, 0), mass: 1, material: \"soft\",
                  shape: Disc(radius: {:?})),
                 (name: \"cylinder\", fixed: true, at: (0, 0), material: \"hard\", shape: Disc(radius: {:?}))])",
        RADII[1], RADII[0]
    )
}

/// The position in m at `time` of a body that flew off at `left` seconds. It had a position in m and a velocity in m/s.
pub fn parabola(left: f64, from: DVec2, velocity: DVec2, time: f64) -> DVec2 {
    let flies = time - left;
    from + velocity * flies - DVec2::new(0.0, 0.5 * GRAVITY * flies * flies)
}

/// Of the middle of the disc in the air.
fn error(simulation: &Simulation, time: f64, _: f64) -> f64 {
    let truth = Truth::read(SOFT);
    let at = DVec2::from_slice(&truth.numbers("x, y from the centre of the cylinder at that time"));
    let velocity = DVec2::from_slice(&truth.numbers("vx, vy at that time"));
    simulation.bodies().position[0].distance(parabola(truth.number("detach time"), at, velocity, time))
}
