//! A gas of a thousand elastic discs for 1e5 collisions. It keeps energy and momentum, reaches the speeds of Maxwell
//! and Boltzmann, and presses on its walls with `p = n k T Z`. SI units.
//!
//! `Z` is Henderson's equation of state of hard discs (Molecular Physics 30, 1975). It is `(1 + eta^2/8)/(1 - eta)^2` with `eta`
//! the share of the area. Its distance from the virial series is allowed (Clisby and McCoy 2006; truth file M02).
//!
//! The box is hard, not periodic, so its known correction is applied. It is scaled particle theory (Reiss, Frisch,
//! Lebowitz 1959, in two dimensions). Near a wall discs are denser than inside. `N` discs are in a box of area `A` and
//! perimeter `P`, and `eta` is the share of area inside. Then `N = n A - P Gamma`, `Gamma = (2/(pi s)) eta (1 -
//! eta)/(1 + eta)`, with `s` the diameter and `n = 4 eta/(pi s^2)`. `Gamma` is the derivative of the line tension `k T
//! 2 eta/((1 - eta) pi s)` with respect to the chemical potential. The width of the box gives the wanted `eta`. That
//! tension `gamma` pulls at the walls, too. To move one of width `L` outwards changes the grand potential by `-(p L - 2
//! gamma)`. So `p = (F + 2 gamma)/L` with `F` the mean force on it.
//!
//! The discs are soft, so everywhere their effective diameter is smaller by `sqrt(pi k T/(2 k))` (Barker and Henderson
//! 1967). That is a hundredth here, for a wall with the stiffness of one disc. They are made larger by that amount, and
//! the rest is of second order.

use crate::SimulationExt;
use std::error::Error;
use std::f64::consts::PI;
use std::fmt::Write;

use super::{Case, Extent, Readings, kinetic, load};
use crate::problems::Truth;
use jostle_engine::contacts::events::{ContactEvents, watch};
use jostle_engine::tick::State;

/// The case.
pub const CASE: Case = Case {
    name: "gas",
    what: "a thousand elastic discs, 1e5 collisions: energy, momentum, speeds, pressure",
    source: "Henderson 1975; Clisby and McCoy 2006; Maxwell 1860; truth file M02",
    cheap: false,
    short: "one density of two",
    run,
};

/// The reference values.
pub const TRUTH: &str = include_str!("../../../../assets/truths/M02_disc_gas.json");
const COUNT: usize = 1000;
const MASS: f64 = 1.0;
/// `k T` in J.
const TEMPERATURE: f64 = 1.0;
/// Of a pair, in N/m.
const STIFFNESS: f64 = 1e8;
/// Effective, in m.
const DIAMETER: f64 = 0.01;
const TICK: f64 = 2e-5;
/// Of discs that have to meet.
const COLLISIONS: f64 = 1e5;
const BLOCKS: usize = 12;

/// The width in m of a square box in which the discs have the share `eta` inside.
fn width(eta: f64) -> f64 {
    let number = 4.0 * eta / (PI * DIAMETER * DIAMETER);
    let excess = 2.0 / (PI * DIAMETER) * eta * (1.0 - eta) / (1.0 + eta);
    // n L^2 - 4 Gamma L - N = 0.
    (2.0 * excess + (4.0 * excess * excess + number * COUNT as f64).sqrt()) / number
}

/// Line tension of a hard wall in N, in units of `k T`.
fn tension(eta: f64) -> f64 {
    2.0 * eta / ((1.0 - eta) * PI * DIAMETER)
}

/// By how much a spring of stiffness `stiffness` in N/m shortens the distance of two that collide, in m.
fn soft(stiffness: f64) -> f64 {
    (PI * TEMPERATURE / (2.0 * stiffness)).sqrt()
}

/// `p A/(N k T)` of hard discs.
fn henderson(eta: f64) -> f64 {
    (1.0 + eta * eta / 8.0) / ((1.0 - eta) * (1.0 - eta))
}

fn scene(eta: f64, duration: f64) -> String {
    let own = 2.0 * STIFFNESS;
    let radius = 0.5 * (DIAMETER + soft(STIFFNESS));
    // A wall stops a centre at the radius less what its own contact gives; wanted is half the effective diameter.
    let outset = radius - soft(own) - 0.5 * DIAMETER;
    let (low, high) = (-outset, width(eta) + outset);
    let speed = (2.0 * TEMPERATURE / MASS).sqrt();
    let mut sensors = String::new();
    for wall in ["floor", "roof", "left", "right"] {
        let _ = write!(sensors, "ContactForce(on: \"{wall}\"),");
    }
    format!(
        "Scene(format: 1, clock: (duration: {duration:?}, tick: {TICK:?}, method: VelocityVerlet),
        contacts: Penalty(tangential: None), materials: {{ \"disc\": (stiffness: {own:?}) }},
        walls: [
            (name: \"floor\", left: ({high:?}, {low:?}), right: ({low:?}, {low:?})),
            (name: \"roof\", left: ({low:?}, {high:?}), right: ({high:?}, {high:?})),
            (name: \"left\", left: ({low:?}, {low:?}), right: ({low:?}, {high:?})),
            (name: \"right\", left: ({high:?}, {high:?}), right: ({high:?}, {low:?})),
        ],
        fill: [(name: \"gas\", atoms: Disc(radius: {radius:?}, mass: {MASS:?}), material: \"disc\", count: {COUNT},
                within: (({low:?}, {low:?}), ({high:?}, {high:?})), speed: {speed:?}, seed: 7)],
        sensors: [{sensors}])"
    )
}

/// The results of a run.
#[derive(Default)]
struct Shown {
    /// Of the blocks, `p A/(N k T)` of the bulk.
    compressibilities: Vec<f64>,
    /// Speeds at moments some collisions apart.
    speeds: Vec<f64>,
    /// Number, sum of squares and of fourth powers of velocity components.
    moments: (f64, f64, f64),
    /// Greatest deviation of the energy, relative.
    energy: f64,
    /// Momentum that is missing, N s.
    momentum: f64,
    /// Discs that met.
    collisions: f64,
}

/// Runs a gas for some blocks after one for settling. Between two samples of speeds `pause` ticks pass.
fn show(eta: f64, pause: u64, samples: usize) -> Result<Shown, Box<dyn Error>> {
    let length = pause * samples as u64;
    let mut simulation = load(&scene(eta, TICK * (length * (BLOCKS as u64 + 1) + 1) as f64))?;
    watch(simulation.world_mut());
    let whole = kinetic(simulation.bodies());
    let number = 4.0 * eta / (PI * DIAMETER * DIAMETER);
    let mut shown = Shown { energy: (whole / (COUNT as f64 * TEMPERATURE) - 1.0).abs(), ..Shown::default() };
    for block in 0..=BLOCKS {
        let (mut push, mut heat) = (0.0, 0.0);
        for _ in 0..samples {
            for _ in 0..pause {
                let next = simulation.clock().ticks + 1;
                simulation.run_to_tick(next)?;
                let world = simulation.unpublished_world();
                let forces = world.resource::<State>().contact_forces().ok_or("no contact forces")?;
                push += forces.on_wall.iter().map(|force| force.length()).sum::<f64>();
                heat += simulation.bodies().velocity.iter().map(|velocity| velocity.length_squared()).sum::<f64>();
                let (events, bodies) = (world.resource::<ContactEvents>(), world.resource::<State>().bodies());
                let walls = |pair: &&jostle_engine::contacts::events::Touching| {
                    bodies.walls.iter().any(|wall| wall.entity == pair.b)
                };
                shown.collisions += (events.begun.len() - events.begun.iter().filter(walls).count()) as f64;
            }
            let card = simulation.card();
            shown.energy = shown.energy.max((card.energy.residual / whole).abs());
            shown.momentum = card.momentum_residual.into_iter().map(f64::abs).fold(shown.momentum, f64::max);
            if block > 0 {
                for velocity in &simulation.bodies().velocity {
                    shown.speeds.push(velocity.length());
                    for component in [velocity.x, velocity.y] {
                        shown.moments.0 += 1.0;
                        shown.moments.1 += component.powi(2);
                        shown.moments.2 += component.powi(4);
                    }
                }
            }
        }
        if block > 0 {
            let force = push / length as f64 / 4.0;
            let pressure = (force + 2.0 * TEMPERATURE * tension(eta)) / width(eta);
            let temperature = 0.5 * MASS * heat / (length as f64 * COUNT as f64);
            shown.compressibilities.push(pressure / (number * temperature));
        }
    }
    Ok(shown)
}

fn run(extent: Extent, readings: &mut Readings) -> Result<(), Box<dyn Error>> {
    // Shares, ticks between samples (about five collisions per disc), samples in a block.
    for &(eta, pause, samples) in extent.pick(&[(0.3, 1000, 4)][..], &[(0.1, 4000, 4), (0.3, 1000, 8)][..]) {
        density(eta, pause, samples, readings)?;
    }
    Ok(())
}

fn density(eta: f64, pause: u64, samples: usize, readings: &mut Readings) -> Result<(), Box<dyn Error>> {
    let truth = Truth::read(TRUTH);
    let shown = show(eta, pause, samples)?;
    let what = |what: &str| format!("eta {eta}: {what}");
    readings.at_least(what("collisions of discs"), shown.collisions, COLLISIONS, "as many as the case asks for");

    let step = (2.0 * STIFFNESS / MASS).sqrt() * TICK;
    readings.at_most(
        what("energy that is missing, of itself"),
        shown.energy,
        (2.0 * shown.collisions).sqrt() * step * step / 2.0 / COUNT as f64,
        "each of the two kinks of a collision changes k T by up to (omega dt)^2/2, up or down by chance",
    );
    let ticks = (pause as usize * samples * (BLOCKS + 1)) as f64;
    readings.at_most(
        what("momentum that is missing, N s"),
        shown.momentum,
        6.0 * (2.0 * ticks * COUNT as f64 / 12.0).sqrt() * 4.0 * f64::EPSILON,
        "a walk of two roundings a tick and disc at speeds below 8 m/s, six standard deviations",
    );

    let blocks = BLOCKS as f64;
    let mean = shown.compressibilities.iter().sum::<f64>() / blocks;
    let variance = shown.compressibilities.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / (blocks - 1.0);
    let error = (variance / blocks).sqrt();
    let (exact, virial) = (henderson(eta), truth.number(&format!("Z=pA/(NkT) virial to B10, eta={eta}")));
    let left_out = exact * ((DIAMETER / width(eta)).powi(2) + 1.0 / COUNT as f64 + 5e-4);
    readings.at_most(
        what("pressure over Henderson's, away from 1"),
        (mean / exact - 1.0).abs(),
        (4.0 * error + left_out + (exact - virial).abs()) / exact,
        "four errors of the mean of 12 blocks; corners (s/L)^2, 1/N and (1 %)^2 of softness, times a few; Henderson's own error",
    );
    readings.at_most(what("error of that mean, of itself"), error / exact, 0.01, "else a longer run would be needed");

    let scale = (shown.moments.1 / shown.moments.0).sqrt();
    let mut speeds: Vec<f64> = shown.speeds.iter().map(|speed| speed / scale).collect();
    speeds.sort_by(f64::total_cmp);
    let count = speeds.len() as f64;
    // Maxwell's distribution in two dimensions: P(speed < v) = 1 - exp(-v^2/2).
    let distance = |(index, speed): (usize, &f64)| {
        let expected = 1.0 - libm::exp(-0.5 * speed * speed);
        (expected - index as f64 / count).abs().max((expected - (index as f64 + 1.0) / count).abs())
    };
    readings.at_most(
        what("distance of the speeds from Maxwell's (Kolmogorov and Smirnov)"),
        speeds.iter().enumerate().map(distance).fold(0.0, f64::max),
        2.23 / count.sqrt(),
        "significance 1e-4: 2.23/sqrt(n)",
    );
    // Among velocities of one energy a component has less than 3 by a share of their number.
    let gaussian = 3.0 * (1.0 - 2.0 / (2.0 * COUNT as f64 + 2.0));
    let kurtosis = shown.moments.2 / shown.moments.0 / (shown.moments.1 / shown.moments.0).powi(2);
    readings.at_most(
        what("kurtosis of a component of velocity, away from Gauss's at one energy"),
        (kurtosis - gaussian).abs(),
        4.0 * (24.0 / (2.0 * count)).sqrt(),
        "four errors of the mean, sqrt(24/n)",
    );
    Ok(())
}
