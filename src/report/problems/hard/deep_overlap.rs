//! Discs that overlap deeply at rest at the start: two whose centres almost coincide, and a heap of sixty. They part
//! with the energy of their springs and no more. SI units, no gravity.
//!
//! Two part with `m v^2 = k (1 - mu) d^2` (reduced mass `m`, overlap `d`), for every initial depth. An elastic heap
//! flies apart with the sum of `k d^2/2` over all pairs.

use std::error::Error;
use std::fmt::Write;

use super::{Case, Extent, Readings, golden, kinetic, load};
use crate::problems::overlap_release::{INELASTICITY, MASSES, STIFFNESS, rate};

/// The case.
pub const CASE: Case = Case {
    name: "deep_overlap",
    what: "discs that overlap by up to 99 % of a diameter at the start, and a heap of sixty on one place",
    source: "conservation of energy; truth file H04",
    cheap: true,
    short: "",
    run,
};

/// Radius of each of two, in m.
const RADIUS: f64 = 0.5;
/// Of runs of two, in s.
const TICK: f64 = 1e-4;

fn run(_: Extent, readings: &mut Readings) -> Result<(), Box<dyn Error>> {
    for depth in [0.1, 0.5, 0.9, 0.99] {
        for (method, events) in [("VelocityVerlet", "PerTick"), ("Dop853", "Located")] {
            two(depth, method, events, readings)?;
        }
    }
    heap(readings)
}

fn two(depth: f64, method: &str, events: &str, readings: &mut Readings) -> Result<(), Box<dyn Error>> {
    let (overlap, stiffness) = (2.0 * RADIUS * depth, 2.0 * STIFFNESS);
    let total = MASSES[0] + MASSES[1];
    let disc = |name: &str, share: f64, mass: f64| {
        let x = share * (2.0 * RADIUS - overlap);
        format!(
            "(name: \"{name}\", at: ({x:?}, 0), material: \"clay\", atoms: Disc(radius: {RADIUS:?}, mass: {mass:?}))"
        )
    };
    let mut simulation = load(&format!(
        "Scene(format: 1, clock: (duration: 0.01, tick: {TICK:?}, method: {method}, events: {events}),
        materials: {{ \"clay\": (stiffness: {stiffness:?}, inelasticity: {INELASTICITY:?}) }},
        bodies: [{}, {}])",
        disc("light", -MASSES[1] / total, MASSES[0]),
        disc("heavy", MASSES[0] / total, MASSES[1])
    ))?;
    simulation.run_to_end()?;
    let velocity = &simulation.bodies().velocity;
    let step = rate() * TICK;
    let (bound, why) = if method == "Dop853" {
        (10.0 * step.powi(8) + 200.0 * f64::EPSILON, "ten times (rate dt)^8, and rounding of 100 ticks")
    } else {
        (step * step, "(rate dt)^2: the kink where they part changes the speed by up to a quarter of it")
    };
    let percent = 100.0 * depth;
    readings.at_most(
        format!("overlap of {percent} %, {method}: error of the speed with which they part, of itself"),
        ((velocity[1].x - velocity[0].x) / (rate() * overlap) - 1.0).abs(),
        bound,
        why,
    );
    readings.at_most(
        format!("overlap of {percent} %, {method}: momentum over that of one of them"),
        ((MASSES[0] * velocity[0].x + MASSES[1] * velocity[1].x) / (MASSES[0] * velocity[0].x)).abs(),
        100.0 * f64::EPSILON,
        "opposite forces: each of 100 ticks rounds each momentum once",
    );
    Ok(())
}

fn heap(readings: &mut Readings) -> Result<(), Box<dyn Error>> {
    const COUNT: usize = 60;
    let (stiffness, tick) = (1e4_f64, 1e-4);
    let mut chance = golden();
    let mut next = || chance.next().unwrap_or_default();
    let mut places: Vec<(f64, f64)> = Vec::new();
    let mut bodies = String::new();
    for number in 0..COUNT {
        let (x, y) = (0.3 * next(), 0.3 * (number as f64 + 0.5) / COUNT as f64);
        places.push((x, y));
        let _ = write!(
            bodies,
            "(name: \"disc_{number}\", at: ({x:?}, {y:?}), material: \"rubber\", atoms: Disc(radius: {RADIUS:?}, mass: 1)),"
        );
    }
    let own = 2.0 * stiffness;
    let mut simulation = load(&format!(
        "Scene(format: 1, clock: (duration: 0.5, tick: {tick:?}, method: VelocityVerlet), contacts: Penalty(tangential: None),
        materials: {{ \"rubber\": (stiffness: {own:?}) }}, bodies: [{bodies}])"
    ))?;
    let pairs = (0..COUNT).flat_map(|a| (0..a).map(move |b| (a, b)));
    let held: f64 = pairs
        .map(|(a, b)| {
            let overlap = 2.0 * RADIUS - f64::hypot(places[a].0 - places[b].0, places[a].1 - places[b].1);
            0.5 * stiffness * overlap * overlap
        })
        .sum();
    simulation.run_to_end()?;
    // Each disc is pushed by up to 59 others, each of which it pushes back.
    let squared = 2.0 * COUNT as f64 * stiffness * tick * tick;
    readings.at_most(
        "heap of sixty: kinetic energy once they have parted, over that of the springs at the start, away from 1",
        (kinetic(simulation.bodies()) / held - 1.0).abs(),
        squared / 4.0,
        "the energy of springs swings by (omega dt/2)^2, omega^2 = 2 n k/m at most",
    );
    let closest = simulation
        .bodies()
        .position
        .iter()
        .enumerate()
        .flat_map(|(place, a)| simulation.bodies().position[..place].iter().map(move |b| a.distance(*b)));
    readings.at_least(
        "heap of sixty: least distance of two at the end, m",
        closest.fold(f64::INFINITY, f64::min),
        2.0 * RADIUS,
        "all have parted, so all energy is kinetic",
    );
    Ok(())
}
