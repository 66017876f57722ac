//! A mass on a spring and a damper, released at rest: `m x'' + c x' + k x = 0`. Damping ratios `zeta = c/(2 sqrt(k m))`
//! run from far below to far above 1 (textbook). SI units.
//!
//! The springs have a length of 1 m: the force is that of the lengthening.

use std::fmt::Write;

use super::{Class, Constant, Problem, ProblemSetting, Truth, rounding_of};
use jostle_engine::Simulation;

/// The problem.
pub const PROBLEM: Problem = Problem {
    name: "damped_oscillator",
    law: "a damped mass on a spring swings less and less, or creeps back",
    source: "textbook; truth file O02",
    class: Class::VelocityDependent,
    tick: 0.05 / 64.0,
    samples: &[0.05, 0.2, 0.5, 1.0],
    unit: "1",
    always_located: false,
    scene,
    error,
    leading_error: Some(leading_error),
    constants: CONSTANTS,
    // Places are 1 m beside displacements of 0.1 m: an ulp of them is ten of the displacement.
    rounding: |tick| rounding_of(1.0 / tick, 20.0),
};

/// Measured at finer ticks.
const CONSTANTS: &[Constant] = &[
    Constant::located("ExplicitEuler", 1, 2.505e1),
    Constant::per_tick("SemiImplicitEuler", 1, 4.663e0),
    Constant::located("SemiImplicitEuler", 1, 4.663e0),
    Constant::per_tick("VelocityVerlet", 2, 2.437e1),
    Constant::located("VelocityVerlet", 2, 1.634e1),
    Constant::located("ImplicitMidpoint", 2, 3.114e1),
    Constant::located("RungeKutta4", 4, 3.474e2),
];

/// The reference values.
pub const TRUTH: &str = include_str!("../../../assets/truths/O02_damped_oscillator.json");
/// Damping ratios, and names of their observables in the truth file.
pub const RATIOS: [(f64, &str); 4] =
    [(0.05, "x,v zeta=0.05"), (0.5, "x,v zeta=0.5"), (1.0, "x,v zeta=1.0"), (5.0, "x,v zeta=5.0")];
/// In rad/s.
const OMEGA: f64 = 10.0;
/// In m.
const START: f64 = 0.1;

fn scene(setting: &ProblemSetting, duration: f64) -> String {
    let clock = setting.clock(duration);
    let (mut bodies, mut springs) = (String::new(), String::new());
    for (index, (ratio, _)) in RATIOS.into_iter().enumerate() {
        let damping = 2.0 * ratio * OMEGA;
        let _ = write!(
            bodies,
            "(name: \"mass_{index}\", at: ({START:?}, {index}), collides: false, atoms: Disc(radius: 0.01, mass: 1)),"
        );
        let _ = write!(
            springs,
            "Spring(a: \"mass_{index}\", b: World, anchor_b: (-1, {index}), stiffness: 100, damping: {damping:?}, length: 1),"
        );
    }
    format!("Scene({clock}, forces: [{springs}], bodies: [{bodies}])")
}

/// The greatest, over the displacement at the start.
fn error(simulation: &Simulation, time: f64, _: f64) -> f64 {
    let truth = Truth::read(TRUTH);
    let of = |(index, (_, name)): (usize, (f64, &str))| {
        let exact = truth.row(name, time).map_or(f64::NAN, |row| row[0]);
        (simulation.bodies().position[index].x - exact).abs() / START
    };
    RATIOS.into_iter().enumerate().map(of).fold(0.0, |most, error| if error <= most { most } else { error })
}

/// A tick of velocity Verlet has the error `dt^3/6 x'''` in the position. In the velocity it has `dt^3/12 x''''` of the
/// trapezoidal rule and `c/(4 m) dt^3 x'''` of the velocity estimate. An error of the position at most persists. An
/// error of the velocity becomes at most `1/w` of it as a position. So all errors together are the integrals of
/// `|x'''|` and `|x''''|` times these factors.
///
/// The derivatives begin with at most `w^3 (1 + 2 zeta)` and `w^4 (1 + 2 zeta)^2`, in units of the start. They last
/// `1/(zeta w)` seconds or to the end of the run. For `zeta` of 1 and more there is no swing. Then their integrals are
/// at most twice the initial derivative of one order less, `w^2` and `2 zeta w^3`. Semi-implicit Euler has errors
/// `dt^2/2 x''` and `dt^2/2 x'''`. The constants of higher orders are not known here, so these methods are held to the
/// bound of order 2.
fn leading_error(order: u32, tick: f64) -> f64 {
    let of = |(ratio, _): (f64, &str)| {
        let lasts = PROBLEM.duration().min(1.0 / (ratio * OMEGA));
        let first = OMEGA * (1.0 + 2.0 * ratio);
        let (second, third, fourth) = if ratio < 1.0 {
            (OMEGA * OMEGA * lasts, OMEGA * OMEGA * first * lasts, OMEGA * OMEGA * first * first * lasts)
        } else {
            (2.0 * 2.0 * OMEGA, 2.0 * OMEGA * OMEGA, 4.0 * ratio * OMEGA * OMEGA * OMEGA)
        };
        let damping = 2.0 * ratio * OMEGA;
        if order >= 2 {
            tick * tick * (third / 6.0 + (damping / 4.0 * third + fourth / 12.0) / OMEGA)
        } else {
            tick / 2.0 * (second + third / OMEGA)
        }
    };
    RATIOS.into_iter().map(of).fold(0.0, f64::max)
}
