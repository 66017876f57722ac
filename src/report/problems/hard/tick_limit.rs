//! Ticks at 0.9, 1.0 and 1.1 of the longest stable one. Below it energy stays bounded. At it swings grow in proportion
//! to the number of ticks. Above it they explode, and the engine reports it. SI units.
//!
//! A mass on a spring allows ticks of `2/omega` under velocity Verlet and semi-implicit Euler. Under Runge-Kutta 4 it allows
//! `2.83/omega`. Three contacts of 1e5, 1e5 and 4e4 N/m clamp a body off its centre. The body has 2 kg and 0.05 kg m2. Its largest
//! eigenvalue of `K phi = omega^2 M phi` is 555.3 rad/s, 1.6 times `sqrt(sum k/m)`.

use crate::SimulationExt;
use std::error::Error;
use std::f64::consts::SQRT_2;

use super::{Case, Extent, METHODS, Reading, Readings, Threshold, kinetic, load};
use crate::problems::Truth;

/// The case.
pub const CASE: Case = Case {
    name: "tick_limit",
    what: "ticks of 0.9, 1.0 and 1.1 of the longest stable one: bounded, marginal, blown up and told",
    source: "Hairer, Lubich and Wanner 2006, I.5; truth files O01 and O05",
    cheap: true,
    short: "",
    run,
};

/// The critical tick of the clamped body, in s.
pub const CRITICAL: f64 = 0.003_601_770_036_134_956;
/// The naive limit `2 sqrt(m/sum k)`, in s.
pub const NAIVE: f64 = 0.005_773_502_691_896_258;
const RADIUS: f64 = 0.03;
/// Of the spring, in rad/s, its stretch and its speed at the start.
const OMEGA: f64 = 10.0;
const START: (f64, f64) = (0.1, 0.5);

/// The body in equilibrium: the floor bears 10 N twice, the wall 10 N, and it turns slightly.
pub fn clamped(method: &str, tick: f64, ticks: u64) -> String {
    let (sunk, pressed) = (1e-4, 2.5e-4);
    let up = -0.1 + RADIUS - sunk;
    let back = 0.3 - RADIUS + pressed;
    let duration = tick * ticks as f64;
    format!(
        "Scene(format: 1, clock: (duration: {duration:?}, tick: {tick:?}, method: {method}), gravity: (5, -10),
        walls: [
            (name: \"floor\", left: (1, 0), right: (0, 0)),
            (name: \"right\", left: (0.3, 1), right: (0.3, 0)),
        ],
        bodies: [(name: \"block\", at: (0, 0.1), spin: 1e-6, mass: 2, inertia: 0.05, atoms: List([
            (at: (0, 0), radius: 0.01, mass: 1),
            (at: (-0.3, {up:?}), radius: {RADIUS:?}, stiffness: 1e5, mass: 1e-12),
            (at: (0.25, {up:?}), radius: {RADIUS:?}, stiffness: 1e5, mass: 1e-12),
            (at: ({back:?}, 0.05), radius: {RADIUS:?}, stiffness: 4e4, mass: 1e-12),
        ]))])"
    )
}

fn sprung(method: &str, tick: f64) -> String {
    let (stiffness, (x, v)) = (OMEGA * OMEGA, START);
    format!(
        "Scene(format: 1, clock: (duration: {:?}, tick: {tick:?}, method: {method}),
        forces: [Spring(a: \"mass\", b: World, stiffness: {stiffness:?}, length: 0)],
        bodies: [(name: \"mass\", at: ({x:?}, 0), velocity: ({v:?}, 0), atoms: Disc(radius: 0.1, mass: 1))])",
        1e5 * tick
    )
}

/// `sqrt(x^2 + (v/omega)^2)` over that at the start after each tick, until the run ends or is ended; and with which words.
fn amplitudes(method: &str, tick: f64, ticks: u64) -> Result<(Vec<f64>, Option<String>), Box<dyn Error>> {
    let mut simulation = load(&sprung(method, tick))?;
    let mut found = Vec::new();
    for tick in 1..=ticks {
        if let Err(failure) = simulation.run_to_tick(tick) {
            return Ok((found, Some(failure.to_string())));
        }
        let bodies = simulation.bodies();
        found.push(
            f64::hypot(bodies.position[0].x, bodies.velocity[0].x / OMEGA) / f64::hypot(START.0, START.1 / OMEGA),
        );
    }
    Ok((found, None))
}

/// The greatest kinetic energy of the clamped body in `ticks` ticks, over the initial one. Then the failure that ended the run,
/// if there was one.
fn growth(method: &str, tick: f64, ticks: u64) -> Result<(f64, Option<String>), Box<dyn Error>> {
    let mut simulation = load(&clamped(method, tick, ticks))?;
    let start = kinetic(simulation.bodies());
    let mut greatest = 0.0_f64;
    for tick in 1..=ticks {
        if let Err(failure) = simulation.run_to_tick(tick) {
            return Ok((greatest, Some(failure.to_string())));
        }
        greatest = greatest.max(kinetic(simulation.bodies()) / start);
    }
    Ok((greatest, None))
}

/// A reading: the number of runs on which the engine is silent.
fn told(readings: &mut Readings, what: String, message: Option<String>, why: &'static str) {
    let (value, threshold) = (f64::from(message.is_none()), Threshold::AtMost(0.0));
    readings.0.push(Reading { what, value, threshold, why, told: message });
}

/// The reason for which a run above the limit is ended.
const ENDED: &str = "energy out of nowhere ends a run with a message that names body and time";

fn run(_: Extent, readings: &mut Readings) -> Result<(), Box<dyn Error>> {
    let truth = Truth::read(crate::problems::spring_mass::TRUTH);
    for method in METHODS {
        spring(method, &truth, readings)?;
        block(method, readings)?;
    }
    runge_kutta(&truth, readings)
}

fn spring(method: &str, truth: &Truth, readings: &mut Readings) -> Result<(), Box<dyn Error>> {
    let critical = truth.number("dt_crit[symplectic_euler,verlet]");
    let what = |share: &str, what: &str| format!("spring, {method}, {share} of the limit: {what}");
    let (swings, ended) = amplitudes(method, 0.9 * critical, 100_000)?;
    let half = 0.9_f64;
    let (bound, why) = if method == METHODS[0] {
        (((1.0 + half) / (1.0 - half)).sqrt(), "its ellipse has the axes (1 + z/2)/(1 - z/2), z = omega dt")
    } else {
        ((1.0 / (1.0 - half * half)).sqrt(), "its ellipse has the axes 1/(1 - z^2/4), z = omega dt")
    };
    let greatest = if ended.is_none() { swings.into_iter().fold(0.0, f64::max) } else { f64::NAN };
    readings.at_most(
        what("0.9", "greatest amplitude in 1e5 ticks over the first"),
        greatest,
        bound * (1.0 + 1e-9),
        why,
    );

    // The map is -(1 - n N) with N N = 0: growth by the same each tick.
    let ticks = 10;
    let (found, _) = amplitudes(method, critical, ticks)?;
    let (x, v) = (START.0, START.1 / OMEGA);
    let exact = |n: f64| {
        if method == METHODS[0] {
            f64::hypot(x - n * (2.0 * v - 2.0 * x), v - n * (2.0 * v - 2.0 * x))
        } else {
            f64::hypot(x - 2.0 * n * v, v)
        }
    };
    let worst = found
        .iter()
        .enumerate()
        .map(|(index, found)| (found * f64::hypot(x, v) / exact(index as f64 + 1.0) - 1.0).abs());
    readings.at_most(
        what("1.0", "distance of 10 amplitudes from growth in proportion to the ticks, of themselves"),
        if found.len() as u64 == ticks { worst.fold(0.0, f64::max) } else { f64::NAN },
        10.0 * 10.0 * 8.0 * f64::EPSILON,
        "a few roundings a tick, each of which grows in proportion to the ticks that follow",
    );

    let z = 1.1 * critical * OMEGA;
    let half = 0.5 * z * z - 1.0;
    let factor = truth.number("growth per step at 1.1 dt_crit (symplectic euler/verlet)");
    readings.at_most(
        what("1.1", "error of the eigenvalue of the method's map, of itself"),
        ((half + (half * half - 1.0).sqrt()) / factor - 1.0).abs(),
        16.0 * f64::EPSILON,
        "a few units in the last place",
    );
    let (found, ended) = amplitudes(method, 1.1 * critical, 1000)?;
    let (mut x, mut v, mut worst) = (START.0, START.1 / OMEGA, 0.0_f64);
    for found in &found {
        (x, v) = map(method, z, (x, v));
        worst = worst.max((found * f64::hypot(START.0, START.1 / OMEGA) / f64::hypot(x, v) - 1.0).abs());
    }
    readings.at_most(
        what("1.1", "distance of the amplitudes until the run is ended from those of the map, of themselves"),
        if found.is_empty() { f64::NAN } else { worst },
        16.0 * (found.len() + 1) as f64 * f64::EPSILON,
        "a few roundings a tick, which grow as the amplitude does",
    );
    let last = found.last().copied().unwrap_or_default();
    let ended_at = "amplitude where the run is ended, over the first";
    readings.at_least(what("1.1", ended_at), last, 10.0, "it blows up");
    readings.at_most(
        what("1.1", ended_at),
        last,
        // The largest swing of both methods at 0.9 of the limit bounds the energy of an amplitude.
        (1e3 * 19.0_f64).sqrt() * 2.0 * factor,
        "ended beyond a thousandfold energy, which is looked at whenever the way of a tick has doubled",
    );
    told(readings, what("1.1", "runs of 1000 ticks that are not ended"), ended, ENDED);
    Ok(())
}

/// Place and velocity over omega after a tick of `z/omega`.
fn map(method: &str, z: f64, (x, v): (f64, f64)) -> (f64, f64) {
    if method == METHODS[0] {
        let v = v - z * x;
        (x + z * v, v)
    } else {
        let next = x + z * v - 0.5 * z * z * x;
        (next, v - 0.5 * z * (x + next))
    }
}

fn runge_kutta(truth: &Truth, readings: &mut Readings) -> Result<(), Box<dyn Error>> {
    let critical = truth.number("dt_crit[rk4]");
    readings.at_most(
        "RungeKutta4: error of the limit 2 sqrt(2)/omega, s",
        (critical - 2.0 * SQRT_2 / OMEGA).abs(),
        4.0 * f64::EPSILON,
        "a few units in the last place",
    );
    for (share, observable) in
        [(0.9, "decay per step at 0.9 dt_crit (rk4)"), (1.1, "growth per step at 1.1 dt_crit (rk4)")]
    {
        let (found, ended) = amplitudes("RungeKutta4", share * critical, 1000)?;
        let exact = truth.number(observable);
        let until = found.len().min(10);
        let off = found[..until].windows(2).map(|pair| (pair[1] / pair[0] / exact - 1.0).abs()).fold(0.0, f64::max);
        readings.at_most(
            format!("spring, RungeKutta4, {share} of the limit: factor of the amplitude in a tick, of what it should be, away from 1"),
            if until > 2 { off } else { f64::NAN },
            64.0 * f64::EPSILON,
            "the modulus of its stability function at i omega dt; four stages are rounded",
        );
        if share > 1.0 {
            let what = format!("spring, RungeKutta4, {share} of the limit: runs of 1000 ticks that are not ended");
            told(readings, what, ended, ENDED);
        }
    }
    Ok(())
}

fn block(method: &str, readings: &mut Readings) -> Result<(), Box<dyn Error>> {
    let what = |share: &str, what: &str| format!("clamped body, {method}, {share}: {what}");
    let grown = "kinetic energy over the first";
    let (borne, ended) = growth(method, 0.9 * CRITICAL, 20_000)?;
    readings.at_most(
        what("0.9 of the limit, 20 000 ticks", grown),
        if ended.is_none() { borne } else { f64::NAN },
        3.0 * 5.3,
        "each of three modes swings by up to 1/(1 - (omega dt/2)^2)",
    );
    let (marginal, _) = growth(method, CRITICAL, 20)?;
    readings.at_most(
        what("1.0 of the limit, 20 ticks", grown),
        marginal,
        // The limit is known to a part in a thousand, because turning contacts are a little stiffer.
        3.0 * 41.0_f64.powi(2) * libm::exp(2.0 * 20.0 * 2.0 * (2.0 * 1e-3_f64).sqrt()),
        "amplitudes grow by at most twice the first each tick, and exp(2 sqrt(2 x)) where omega dt = 2 (1 + x), x = 1e-3",
    );
    let (not, _) = growth(method, 1.1 * CRITICAL, 8)?;
    readings.at_least(
        what("1.1 of the limit, 8 ticks", grown),
        not,
        1e4,
        "an amplitude grows by 2.4 a tick, until contacts open",
    );
    for (share, tick) in [("1.1 of the limit", 1.1 * CRITICAL), ("2 sqrt(m/sum k)", NAIVE)] {
        let mut simulation = load(&clamped(method, tick, 1000))?;
        let ended = simulation.run_to_end().err().map(|failure| failure.to_string());
        let warned = simulation.card().warnings.into_iter().find(|warning| warning.contains("critical"));
        // Contacts that open may bound the energy: then a warning on the card will do.
        told(
            readings,
            what(share, "runs of 1000 ticks that are neither ended nor warned of"),
            ended.or(warned),
            "the card names the tick, the critical one and the body; energy out of nowhere ends the run",
        );
    }
    Ok(())
}
