//! A straight rope of ten uniform links of 10 g is released at 30 degrees. Its load at the end is 100 kg. It is a
//! pendulum whose light links vibrate under tension with up to 2340 rad/s. The reference solves Lagrange's equations,
//! and independently the equations of bodies with multipliers. SI units.

use super::linkage::{Chain, ChainLink, chain, turned_off};
use super::{Class, Constant, Problem, ProblemSetting, Truth, rounding_of};
use jostle_engine::Simulation;

/// The problem.
pub const PROBLEM: Problem = Problem {
    name: "loaded_rope",
    law: "a light rope bears a load of ten thousand links",
    source: "Lagrange's equations against bodies with multipliers; truth file S06",
    class: Class::Smooth,
    // The fastest mode has `w dt` = 0.23. Under semi-implicit Euler with located events it grows by `e` in about a
    // tenth of a second. The problem ends before that counts. Other methods run on in the hard case `heavy_load`. No
    // multiple of eight ticks ends with the run, because with `w dt` = 1.8 a tick is not small.
    tick: 0.2 / 2044.0,
    samples: &[0.2],
    unit: "1",
    always_located: false,
    scene,
    error,
    leading_error: None,
    constants: CONSTANTS,
    // Each tick rounds angles and rates once; links tremble without damping and keep what that sets going. The reference is known to
    // 1e-13.
    rounding: |tick| rounding_of(0.2 / tick, 2.0) + 1e-13,
};

/// Measured at finer ticks.
const CONSTANTS: &[Constant] = &[
    Constant::per_tick("SemiImplicitEuler", 1, 2.571e-1),
    Constant::located("SemiImplicitEuler", 1, 2.519e-1),
    Constant::per_tick("VelocityVerlet", 2, 1.133e2),
    Constant::located("VelocityVerlet", 2, 1.091e2),
    Constant::located("RungeKutta4", 4, 7.482e7),
    Constant::located("ImplicitMidpoint", 2, 2.159e2),
    Constant::located("Symplectic4", 4, 1.234e5),
];

/// The reference values.
pub const TRUTH: &str = include_str!("../../../assets/truths/S06_rope_heavy_load.json");
/// Number of links.
pub const COUNT: usize = 10;
/// At the start, in degrees from the downward vertical.
const START: f64 = 30.0;

/// The scene with other masses of a link and of the load in kg. It begins at an angle in degrees from the vertical.
pub fn scene_of(clock: &str, (link, load): (f64, f64), start: f64) -> String {
    let links = [ChainLink { mass: link, length: 0.2, angle: start.to_radians() }; COUNT];
    let Chain { bodies, joints, end } = chain("link", &links);
    let last = COUNT - 1;
    format!(
        "Scene({clock}, gravity: (0, -9.81), contacts: None,
        bodies: [{bodies} (name: \"load\", at: ({:?}, {:?}), mass: {load:?}, inertia: 1, atoms: Disc(radius: 0.1))],
        joints: [{joints} Revolute(name: \"hook\", a: \"link{last}\", anchor_a: (0.1, 0), b: \"load\", anchor_b: (0, 0))])",
        end.x, end.y
    )
}

fn scene(setting: &ProblemSetting, duration: f64) -> String {
    scene_of(&setting.clock(duration), (0.01, 100.0), START)
}

/// The greatest of the angles, in rad.
fn error(simulation: &Simulation, time: f64, _: f64) -> f64 {
    let Some(row) = Truth::read(TRUTH).row("link angles after release of the straight rope", time) else {
        return f64::NAN;
    };
    turned_off(simulation, 0, &row)
}
