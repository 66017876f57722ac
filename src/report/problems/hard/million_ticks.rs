//! An oscillator for a million ticks, a hundred a period. One is a disc that gravity presses so deep into the floor
//! that it never parts. The other is a mass on a spring. SI units.
//!
//! Rounding errors add up like a random walk, with the square root of the number of ticks (Brouwer 1937). A symplectic
//! method lets energy swing, not drift. The truth file has the exact solution of both discrete methods after a million
//! ticks.

use crate::SimulationExt;
use std::error::Error;

use super::{Case, Extent, METHODS, Readings, load};
use crate::problems::Truth;
use jostle_engine::Simulation;

/// The case.
pub const CASE: Case = Case {
    name: "million_ticks",
    what: "an oscillator arrives after a million ticks where exact arithmetic does; energy and momentum walk, not drift",
    source: "Hairer, McLachlan and Razakarivony 2008; truth file O06",
    cheap: false,
    short: "",
    run,
};

/// The reference values.
pub const TRUTH: &str = include_str!("../../../../assets/truths/O06_million_steps.json");
const STIFFNESS: f64 = 39.0;
const AMPLITUDE: f64 = 0.5;
/// Overlap about which the disc swings, in m: deeper than the amplitude.
const MEAN: f64 = 0.6;
const RADIUS: f64 = 2.0;
const TICKS: u64 = 1_000_000;

/// The disc on the floor.
fn pressed(method: &str, tick: f64) -> String {
    let (gravity, height) = (STIFFNESS * MEAN, RADIUS - MEAN + AMPLITUDE);
    format!(
        "Scene(format: 1, clock: (duration: {:?}, tick: {tick:?}, method: {method}), gravity: (0, -{gravity:?}),
        materials: {{ \"rubber\": (stiffness: {STIFFNESS:?}) }},
        walls: [(name: \"floor\", left: (1, 0), right: (0, 0))],
        bodies: [(name: \"disc\", at: (0, {height:?}), material: \"rubber\", atoms: Disc(radius: {RADIUS:?}, mass: 1))])",
        2.0 * TICKS as f64 * tick
    )
}

/// The same oscillator as a mass on a spring of zero length.
fn sprung(method: &str, tick: f64) -> String {
    format!(
        "Scene(format: 1, clock: (duration: {:?}, tick: {tick:?}, method: {method}),
        forces: [Spring(a: \"mass\", b: World, stiffness: {STIFFNESS:?}, length: 0)],
        bodies: [(name: \"mass\", at: ({AMPLITUDE:?}, 0), atoms: Disc(radius: 0.1, mass: 1))])",
        2.0 * TICKS as f64 * tick
    )
}

/// Displacement of the disc in m and its velocity in m/s.
fn state(simulation: &Simulation) -> (f64, f64) {
    let bodies = simulation.bodies();
    (bodies.position[0].y - (RADIUS - MEAN), bodies.velocity[0].y)
}

fn run(_: Extent, readings: &mut Readings) -> Result<(), Box<dyn Error>> {
    let truth = Truth::read(TRUTH);
    let tick = truth.number("dt");
    let observables =
        ["symplectic euler (v then x) discrete-exact x,v after n steps", "verlet discrete-exact x,v after n steps"];
    for (method, observable) in METHODS.into_iter().zip(observables) {
        let exact = truth.numbers(observable);
        let mut arrives = |what: &str, (x, v): (f64, f64)| {
            readings.at_most(
                format!("{what}, {method}: error of place and velocity, of the amplitude"),
                (x - exact[0]).abs().max((v - exact[1]).abs() / STIFFNESS.sqrt()) / AMPLITUDE,
                3e-7,
                "n roundings as a walk, each of which changes the phase of the ticks that follow: 3 n^(3/2) eps",
            );
        };
        let mut simulation = load(&sprung(method, tick))?;
        simulation.run_to_tick(TICKS)?;
        arrives("spring", (simulation.bodies().position[0].x, simulation.bodies().velocity[0].x));
        let mut simulation = load(&pressed(method, tick))?;
        simulation.run_to_tick(TICKS)?;
        arrives("floor", state(&simulation));
        for ticks in [1_000, 30_000, TICKS] {
            residuals(method, tick, ticks, readings)?;
        }
    }
    Ok(())
}

/// The largest of the residuals at ten times up to `ticks`.
fn residuals(method: &str, tick: f64, ticks: u64, readings: &mut Readings) -> Result<(), Box<dyn Error>> {
    let mut simulation = load(&pressed(method, tick))?;
    // The exact remainder of `v^2/2 + w^2 x^2/2` of an oscillator after a tick of this length.
    let z = STIFFNESS * tick * tick;
    let euler = method == METHODS[0];
    let invariant = |simulation: &Simulation| {
        let (x, v) = state(simulation);
        let correction = if euler { STIFFNESS * tick * x * v } else { 0.25 * z * STIFFNESS * x * x };
        0.5 * (v * v + STIFFNESS * x * x - correction)
    };
    let start = invariant(&simulation);
    let (mut energy, mut momentum, mut swing) = (0.0_f64, 0.0_f64, 0.0_f64);
    for part in 1..=10 {
        simulation.run_to_tick(ticks * part / 10)?;
        energy = energy.max((invariant(&simulation) / start - 1.0).abs());
        let card = simulation.card();
        momentum = momentum.max(card.momentum_residual[1].abs());
        swing = swing.max(card.energy.residual.abs() / (0.5 * STIFFNESS * AMPLITUDE * AMPLITUDE));
    }
    // Two roundings a tick, each of half an ulp at most: six standard deviations of the walk. Speeds up to 3.1 m/s have
    // an ulp of 2 eps. Heights, up to 2 m, have one of eps, and they enter with w.
    let walk = 6.0 * (2.0 * ticks as f64 / 12.0).sqrt() * 2.0 * f64::EPSILON;
    let what = |what: &str| format!("floor, {method}, {ticks} ticks: {what}");
    let why = "a walk of two roundings a tick, six standard deviations of sqrt(2 n) ulp/sqrt(12)";
    readings.at_most(what("momentum that is missing, N s"), momentum, walk, why);
    let speed = AMPLITUDE * STIFFNESS.sqrt();
    readings.at_most(what("drift of the method's own invariant, of itself"), energy, walk * 3.0 / speed, why);
    readings.at_most(
        what("swing of the energy, of itself"),
        swing,
        if euler { 0.5 * z.sqrt() / (1.0 - 0.5 * z.sqrt()) } else { 0.25 * z } * (1.0 + 1e-9),
        "the error of the method: (omega dt)^2/4, with the first order omega dt/2",
    );
    Ok(())
}
