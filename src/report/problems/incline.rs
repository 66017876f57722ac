//! Blocks on inclines (Coulomb 1785). Below the angle of friction they stay, and above it they slide with `g (sin a -
//! mu cos a)`. A block that is thrown uphill turns and comes back slower. SI units.
//!
//! Each block has a separate incline: a level floor and a tilted weight, `m g (sin a, -cos a)`. Its inertia keeps it
//! from turning, and its overlap is that of its weight. Friction sticks without compliance. Between the events
//! accelerations are constant, so that methods of order 2 are exact.

use std::fmt::Write;

use super::{Class, Constant, EventTiming, Problem, ProblemSetting, rounding_of};
use jostle_engine::Simulation;

/// The problem.
pub const PROBLEM: Problem = Problem {
    name: "incline",
    law: "a block slides only on inclines that are steeper than the angle of friction",
    source: "textbook (Coulomb 1785); truth file F01",
    class: Class::ConstantAcceleration,
    tick: 1.0 / 128.0,
    samples: &[0.5, 1.0, 2.0],
    unit: "m",
    always_located: true,
    scene,
    error,
    leading_error: None,
    constants: CONSTANTS,
    // The uphill block's turn is known to an ulp of time. Its speed changes by 11.8 m/s2 before it.
    rounding: |tick| rounding_of(2.0 / tick, 16.0),
};

/// Measured at finer ticks.
const CONSTANTS: &[Constant] =
    &[Constant::located("ExplicitEuler", 1, 3.139e0), Constant::located("SemiImplicitEuler", 1, 3.139e0)];

/// The reference values.
pub const TRUTH: &str = include_str!("../../../assets/truths/F01_incline_stick_slip.json");
/// Angles in degrees, and velocities along the incline at the start in m/s.
pub const BLOCKS: [(f64, f64); 5] = [(15.0, 0.0), (21.7, 0.0), (21.9, 0.0), (35.0, 0.0), (30.0, -4.0)];
/// Mean of the coefficients of block and floor, 0.3 and 0.5.
pub const FRICTION: f64 = 0.4;
const GRAVITY: f64 = 9.81;
const STIFFNESS: f64 = 1e4;
const RADIUS: f64 = 0.1;

/// Way down the incline in m and velocity in m/s at `time`.
pub fn state(degrees: f64, velocity: f64, time: f64) -> (f64, f64) {
    let (sin, cos) = libm::sincos(degrees.to_radians());
    let (pull, friction) = (GRAVITY * sin, FRICTION * GRAVITY * cos);
    let turns = -velocity / (pull + friction);
    if time < turns {
        let slows = pull + friction;
        return (velocity * time + 0.5 * slows * time * time, velocity + slows * time);
    }
    let (since, falls) = (time - turns, (pull - friction).max(0.0));
    (0.5 * velocity * turns + 0.5 * falls * since * since, falls * since)
}

/// The incline of the blocks given.
pub fn scene_of(setting: &ProblemSetting, duration: f64, blocks: &[(f64, f64)]) -> String {
    let clock = ProblemSetting { events: EventTiming::Located, ..*setting }.clock(duration);
    let (mut bodies, mut weights) = (String::new(), String::new());
    for (index, (degrees, velocity)) in blocks.iter().enumerate() {
        let (sin, cos) = libm::sincos(degrees.to_radians());
        let height = RADIUS - GRAVITY * cos / STIFFNESS;
        let _ = write!(
            bodies,
            "(name: \"block_{index}\", at: ({:?}, {height:?}), velocity: ({velocity:?}, 0), material: \"wood\", inertia: 1e300,
              atoms: Disc(radius: {RADIUS:?}, mass: 1)),",
            16.0 * index as f64
        );
        let (along, down) = (GRAVITY * sin, GRAVITY * cos);
        let _ = write!(
            weights,
            "Drive(of: \"block_{index}\", force: ({along:?}, -{down:?}), course: Piecewise([(0, 1)])),"
        );
    }
    format!(
        "Scene({clock}, contacts: Penalty(tangential: Exact), forces: [{weights}],
        materials: {{ \"wood\": (stiffness: {STIFFNESS:?}, friction: 0.3, inelasticity: 0.3),
                      \"stone\": (stiffness: {STIFFNESS:?}, friction: 0.5, inelasticity: 0.3) }},
        walls: [(name: \"floor\", left: (1, 0), right: (0, 0), material: \"stone\")], bodies: [{bodies}])"
    )
}

fn scene(setting: &ProblemSetting, duration: f64) -> String {
    scene_of(setting, duration, &BLOCKS)
}

/// The greatest of the blocks, in m.
fn error(simulation: &Simulation, time: f64, _: f64) -> f64 {
    let of = |(index, (degrees, velocity)): (usize, (f64, f64))| {
        let way = simulation.bodies().position[index].x - 16.0 * index as f64;
        (way - state(degrees, velocity, time).0).abs()
    };
    BLOCKS.into_iter().enumerate().map(of).fold(0.0, |most, error| if error <= most { most } else { error })
}
