//! A damped mass on a spring that is driven from rest: `m x'' + c x' + k x = F cos(W t)`. The drive is at resonance, at
//! half and at twice the natural frequency (textbook). SI units.
//!
//! The drive has to be sampled at the stages of an integrator, or every method falls to order 1.

use std::f64::consts::FRAC_PI_2;
use std::fmt::Write;

use super::{Class, Constant, Problem, ProblemSetting, Truth, rounding_of};
use jostle_engine::Simulation;

/// The problem.
pub const PROBLEM: Problem = Problem {
    name: "driven_oscillator",
    law: "a driven mass on a spring ends in a steady swing",
    source: "textbook; truth file O03",
    class: Class::VelocityDependent,
    tick: 1.0 / 512.0,
    samples: &[1.0, 5.0, 20.0, 60.0],
    unit: "1",
    always_located: false,
    scene,
    error,
    leading_error: Some(leading_error),
    constants: CONSTANTS,
    // Transient and steady swing together are up to four amplitudes. Off resonance forces are up to eight times the
    // force that moves the mass.
    rounding: |tick| rounding_of(60.0 / tick, 32.0),
};

/// Measured at finer ticks.
const CONSTANTS: &[Constant] = &[
    Constant::located("ExplicitEuler", 1, 5.849e1),
    Constant::per_tick("SemiImplicitEuler", 1, 5.231e0),
    Constant::located("SemiImplicitEuler", 1, 5.231e0),
    Constant::per_tick("VelocityVerlet", 2, 2.348e1),
    Constant::located("VelocityVerlet", 2, 1.675e1),
    Constant::located("ImplicitMidpoint", 2, 3.885e1),
];

/// The reference values.
pub const TRUTH: &str = include_str!("../../../assets/truths/O03_driven_resonance.json");
/// Natural frequency in rad/s.
const OMEGA: f64 = 5.0;
/// `c/m` in 1/s.
const DAMPING: f64 = 0.4;
/// Angular frequencies in rad/s, and observables of the truth file: the place, and the amplitude in the end.
const DRIVES: [(f64, &str, &str); 3] = [
    (4.991_993_589_739_474, "x at resonance (Omega=4.991993589739474)", "steady amplitude at resonance"),
    (2.5, "x at 0.5*w0 (Omega=2.5)", "steady amplitude at 0.5*w0"),
    (10.0, "x at 2*w0 (Omega=10.0)", "steady amplitude at 2*w0"),
];

fn scene(setting: &ProblemSetting, duration: f64) -> String {
    let clock = setting.clock(duration);
    let (mut bodies, mut forces) = (String::new(), String::new());
    for (index, (frequency, ..)) in DRIVES.into_iter().enumerate() {
        let _ = write!(
            bodies,
            "(name: \"mass_{index}\", at: (0, {index}), collides: false, atoms: Disc(radius: 0.01, mass: 1)),"
        );
        let _ = write!(
            forces,
            "Spring(a: \"mass_{index}\", b: World, anchor_b: (0, {index}), stiffness: 25, damping: {DAMPING:?}, length: 0),
             Drive(of: \"mass_{index}\", force: (2, 0),
                   course: Sine(angular_frequency: {frequency:?}, phase: {FRAC_PI_2:?})),"
        );
    }
    format!("Scene({clock}, forces: [{forces}], bodies: [{bodies}])")
}

/// The greatest, each over its steady amplitude.
fn error(simulation: &Simulation, time: f64, _: f64) -> f64 {
    let truth = Truth::read(TRUTH);
    let of = |(index, (_, x, amplitude)): (usize, (f64, &str, &str))| {
        let exact = truth.row(x, time).map_or(f64::NAN, |row| row[0]);
        (simulation.bodies().position[index].x - exact).abs() / truth.number(amplitude)
    };
    DRIVES.into_iter().enumerate().map(of).fold(0.0, |most, error| if error <= most { most } else { error })
}

/// As for the damped oscillator, errors are `dt^3/6 x'''` of the position, and `dt^3/12 x''''` and `c/(4 m) dt^3 x'''`
/// of the velocity. The latter become `1/w` of that as a position, and decay after `2 m/c` seconds. The units are the
/// steady amplitude. There the `n`-th derivative is at most `W^n` of the steady swing and `(1 + W/w) w^n` of the
/// transient from rest. The constants of higher orders are not known here, so these methods are held to the bound of
/// order 2.
fn leading_error(order: u32, tick: f64) -> f64 {
    let lasts = 2.0 / DAMPING;
    let of = |(frequency, ..): (f64, &str, &str)| {
        let derivative = |n: i32| frequency.powi(n) + (1.0 + frequency / OMEGA) * OMEGA.powi(n);
        if order >= 2 {
            let velocity = DAMPING / 4.0 * derivative(3) + derivative(4) / 12.0;
            tick * tick * lasts * (derivative(3) / 6.0 + velocity / OMEGA)
        } else {
            tick / 2.0 * lasts * (derivative(2) + derivative(3) / OMEGA)
        }
    };
    DRIVES.into_iter().map(of).fold(0.0, f64::max)
}
