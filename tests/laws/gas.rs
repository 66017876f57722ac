//! Law: a gas of elastic discs keeps its energy, comes to the distribution of Maxwell and Boltzmann, and presses on the walls
//! with `p = n k T Z`, `Z` the virial series. Source: Clisby and McCoy 2006 (virial coefficients); truth file M02.
//!
//! The box is hard, not periodic, so its known correction is applied: near a wall discs are denser than inside, and `N` discs
//! in a box of area `A` and perimeter `P` have inside the share of area `eta` given by (scaled particle theory: Reiss, Frisch,
//! Lebowitz 1959, in two dimensions) `N = n A - P Gamma`, `Gamma = (2/(pi s)) eta (1 - eta)/(1 + eta)`, with `s` the diameter and
//! `n = 4 eta/(pi s^2)`: the derivative of the line tension `k T 2 eta/((1 - eta) pi s)` with respect to the chemical
//! potential. The box is made so wide that `eta` is that of the truth file. That tension `gamma` pulls at the walls, too: moving
//! one of width `L` out changes the grand potential by `-(p L - 2 gamma)`, so `p = (F + 2 gamma)/L` with `F` the mean force on it. The discs are soft: in all places their diameter is
//! smaller by `sqrt(pi k T/(2 k))` (Barker and Henderson 1967), for a wall with the stiffness of one disc.
//!
//! Tolerances: pressure is a mean over blocks; four times the error of their mean, the truth's own error, and corrections
//! that are left out: of corners, `(s/L)^2` relative, of the number of discs, `1/N`, and of softness in second order,
//! `(1 percent)^2` of `Z` a few times. The distribution: Kolmogorov and Smirnov's distance at a significance of 1e-4.
//! Energy: each of the two kinks of a collision changes the energy of a pair, some `k T`, by up to a share `(w dt)^2/2`, up or
//! down by chance, so after `n` collisions the whole has gone by `sqrt(2 n)` of that.
//!
//! Not tested: the rate of collisions (contacts that overlap in time are no collisions), transport.

use std::f64::consts::PI;
use std::fmt::Write;

use jostle::Simulation;
use jostle::problems::Truth;

use super::support::{assert_near, contact_forces, kinetic, load};

const COUNT: usize = 256;
const MASS: f64 = 1.0;
/// `k T` in J.
const TEMPERATURE: f64 = 1.0;
/// Of a pair, in N/m.
const STIFFNESS: f64 = 1e8;
/// Effective, in m.
const DIAMETER: f64 = 0.01;
const TICK: f64 = 2e-5;

/// The width in m of a square box in which `COUNT` discs have the share `eta` inside.
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

fn scene(eta: f64, duration: f64) -> Simulation {
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
    load(&format!(
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
    ))
}

/// What a run has shown.
struct Shown {
    /// Mean of `p A/(N k T)` of the bulk and the error of the mean.
    compressibility: (f64, f64),
    /// Speeds at moments some collisions apart, over `sqrt(k T/m)`.
    speeds: Vec<f64>,
    /// Fourth moment of a velocity component over the square of its second.
    kurtosis: f64,
    /// Greatest deviation of the energy, relative.
    deviation: f64,
}

/// Runs a gas for some blocks after one for settling. Between two samples of speeds `pause` ticks pass.
fn show(eta: f64, blocks: usize, pause: u64, samples: usize) -> Shown {
    let length = pause * samples as u64;
    let mut simulation = scene(eta, TICK * (length * (blocks as u64 + 1) + 1) as f64);
    let whole = kinetic(simulation.bodies());
    assert_near("energy at the start", whole, COUNT as f64 * TEMPERATURE, 1e-9 * whole);
    let number = 4.0 * eta / (PI * DIAMETER * DIAMETER);
    let (mut means, mut speeds, mut moments) = (Vec::new(), Vec::new(), (0.0, 0.0, 0.0));
    let mut deviation = 0.0_f64;
    for block in 0..=blocks {
        let (mut push, mut heat) = (0.0, 0.0);
        for _ in 0..samples {
            for _ in 0..pause {
                let next = simulation.clock().ticks + 1;
                simulation.run_to_tick(next).expect("numbers stay finite");
                push += contact_forces(&simulation).on_wall.iter().map(|force| force.length()).fold(0.0, |a, b| a + b);
                let bodies = simulation.bodies();
                heat += bodies.velocity.iter().map(|velocity| velocity.length_squared()).fold(0.0, |a, b| a + b);
            }
            let energy = simulation.card().energy;
            deviation = deviation.max((energy.residual / whole).abs());
            if block > 0 {
                for velocity in &simulation.bodies().velocity {
                    speeds.push(velocity.length());
                    for component in [velocity.x, velocity.y] {
                        moments.0 += 1.0;
                        moments.1 += component.powi(2);
                        moments.2 += component.powi(4);
                    }
                }
            }
        }
        if block > 0 {
            let force = push / length as f64 / 4.0;
            let pressure = (force + 2.0 * TEMPERATURE * tension(eta)) / width(eta);
            let temperature = 0.5 * MASS * heat / (length as f64 * COUNT as f64);
            means.push(pressure / (number * temperature));
        }
    }
    let mean = means.iter().sum::<f64>() / blocks as f64;
    let variance = means.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / (blocks as f64 - 1.0);
    let scale = (moments.1 / moments.0).sqrt();
    speeds.iter_mut().for_each(|speed| *speed /= scale);
    speeds.sort_by(f64::total_cmp);
    Shown {
        compressibility: (mean, (variance / blocks as f64).sqrt()),
        speeds,
        kurtosis: moments.2 / moments.0 / (moments.1 / moments.0).powi(2),
        deviation,
    }
}

#[test]
fn a_gas_of_discs_is_that_of_the_virial_series_and_of_maxwell() {
    let truth = Truth::read(include_str!("../../assets/truths/M02_disc_gas.json"));
    // Shares, ticks between samples (about four collisions per disc), samples in a block.
    for (eta, pause, samples) in [(0.1, 4000, 4), (0.3, 1000, 8)] {
        let shown = show(eta, 12, pause, samples);
        let exact = truth.number(&format!("Z=pA/(NkT) virial to B10, eta={eta}"));
        let (found, error) = shown.compressibility;
        let left_out = exact * ((DIAMETER / width(eta)).powi(2) + 1.0 / COUNT as f64 + 5e-4);
        println!(
            "eta {eta}: Z {found} +- {error}, exact {exact}; kurtosis {}; energy {:e}",
            shown.kurtosis, shown.deviation
        );
        assert!(error < 0.01 * exact, "a longer run is needed: {error}");
        assert_near("compressibility", found, exact, 4.0 * error + left_out);
        // Maxwell's distribution in two dimensions: P(speed < v) = 1 - exp(-v^2/2).
        let count = shown.speeds.len() as f64;
        let distance = |(place, speed): (usize, &f64)| {
            let expected = 1.0 - libm::exp(-0.5 * speed * speed);
            (expected - place as f64 / count).abs().max((expected - (place as f64 + 1.0) / count).abs())
        };
        let distance = shown.speeds.iter().enumerate().map(distance).fold(0.0, f64::max);
        println!("Kolmogorov-Smirnov {distance:e} of {:e}", 2.23 / count.sqrt());
        assert!(distance < 2.23 / count.sqrt(), "speeds are not Maxwell's: {distance:e}");
        // A component has 3 less a share of the number of velocities, and 3 times sqrt(8/3 / count) of chance (24/n).
        let gaussian = 3.0 * (1.0 - 2.0 / (2.0 * COUNT as f64 + 2.0));
        assert_near("kurtosis", shown.kurtosis, gaussian, 4.0 * (24.0 / (2.0 * count)).sqrt());
        let step = (2.0 * STIFFNESS / MASS).sqrt() * TICK;
        let seconds = TICK * (pause * samples as u64 * 13) as f64;
        let collisions = 0.5 * COUNT as f64 * truth.number(&format!("collision rate per disc, eta={eta}")) * seconds;
        let allowed = (2.0 * collisions).sqrt() * step * step / 2.0 / COUNT as f64;
        assert!(shown.deviation < allowed, "energy is off by {:e} > {allowed:e}", shown.deviation);
    }
}
