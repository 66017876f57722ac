//! Law: elastic frictionless discs in a box keep their energy. A symplectic method nearly keeps it forever (Hairer,
//! Lubich, Wanner, *Geometric Numerical Integration*, IX.8): errors are bounded and do not add up.
//!
//! Tolerance: with 40 ticks per contact `w dt = pi/40`. A contact that begins at the share `p` of a tick and ends at the
//! share `q` of another changes the energy of its normal motion by a share `(w dt)^2 (p (1 - p) - q (1 - q))`, at most
//! 1.5e-3. All contacts of equal discs and walls last 40 ticks here, so that `p` and `q` are nearly the same and errors
//! nearly cancel; contacts off centre last longer by a share of about `v^2/(2 r w) / v`, 0.05 ticks, which leaves an
//! error of 0.03 `(w dt)^2`, 2e-4 of a twentieth of all energy. Some 700 contacts in the run make, as a random walk,
//! 2.6e-4 of the energy; four times that is the 1e-3 allowed. No trend: the means of the first and the last fifth differ
//! by no more than twice that walk (scatter inside a fifth is part of it). A steady loss of a four-hundredth of
//! `(w dt)^2` at each contact would show.
//!
//! The card's residual is compared with a sum made here from positions, velocities and the spring law: rounding.
//!
//! Not tested: losses (see `restitution`), forces that are not conservative.

use std::f64::consts::PI;
use std::fmt::Write;

use jostle::{Simulation, SimulationExt};

use super::support::{kinetic, load, phases};

const RADIUS: f64 = 0.1;
const SIDE: f64 = 2.4;
/// Stiff: discs sink in by a third of a millimetre.
const STIFFNESS: f64 = 1e7;

/// 20 discs of 1 kg in a box. A pair has half the stiffness and half the mass, a wall the whole of both: each contact
/// has the rate `sqrt(k/m)`.
fn scene(gravity: &str) -> String {
    let tick = PI / STIFFNESS.sqrt() / 40.0;
    let mut bodies = String::new();
    for (number, (a, b)) in phases(40).step_by(2).zip(phases(40).skip(1).step_by(2)).enumerate() {
        let (x, y) = (0.3 + 0.45 * (number % 5) as f64, 0.4 + 0.5 * (number / 5) as f64);
        let (vx, vy) = (2.0 * a - 1.0, 2.0 * b - 1.0);
        let _ = write!(
            bodies,
            "(name: \"disc_{number}\", at: ({x:?}, {y:?}), velocity: ({vx:?}, {vy:?}), material: \"ivory\",
              atoms: Disc(radius: {RADIUS:?}, mass: 1)),"
        );
    }
    format!(
        "Scene(format: 1, clock: (duration: 1000, tick: {tick:?}, method: VelocityVerlet), {gravity}
        materials: {{ \"ivory\": (stiffness: {STIFFNESS:?}) }},
        walls: [
            (name: \"floor\", left: ({SIDE:?}, 0), right: (0, 0)),
            (name: \"ceiling\", left: (0, {SIDE:?}), right: ({SIDE:?}, {SIDE:?})),
            (name: \"left\", left: (0, 0), right: (0, {SIDE:?})),
            (name: \"right\", left: ({SIDE:?}, {SIDE:?}), right: ({SIDE:?}, 0)),
        ],
        bodies: [{bodies}])"
    )
}

/// Kinetic and elastic energy in J, from positions, velocities and the spring law alone.
fn energy(simulation: &Simulation) -> f64 {
    let bodies = simulation.bodies();
    let mut elastic = 0.0;
    for (number, a) in bodies.position.iter().enumerate() {
        for b in &bodies.position[number + 1..] {
            let overlap = (2.0 * RADIUS - a.distance(*b)).max(0.0);
            elastic += 0.5 * (STIFFNESS / 2.0) * overlap * overlap;
        }
        for gap in [a.x, a.y, SIDE - a.x, SIDE - a.y] {
            let overlap = (RADIUS - gap).max(0.0);
            elastic += 0.5 * STIFFNESS * overlap * overlap;
        }
    }
    kinetic(bodies) + elastic
}

/// What errors of unrelated contacts add up to in the run, as a share of the energy; see above.
const WALK: f64 = 2.6e-4;

#[test]
fn twenty_elastic_discs_keep_their_energy_over_a_million_ticks() {
    let mut simulation = load(&scene(""));
    let start = energy(&simulation);
    let mut errors = Vec::new();
    let (mut contacts, mut greatest_difference) = (0, 0.0_f64);
    for thousands in 1..=1000 {
        simulation.run_to_tick(1000 * thousands).expect("numbers stay finite");
        let change = energy(&simulation) - start;
        let card = simulation.card();
        greatest_difference = greatest_difference.max((card.energy.residual - change).abs() / start);
        contacts += usize::from(card.energy.elastic > 0.0);
        errors.push(change / start);
    }
    let worst = errors.iter().fold(0.0_f64, |worst, error| worst.max(error.abs()));
    let mean = |errors: &[f64]| errors.iter().sum::<f64>() / errors.len() as f64;
    let (first, last) = (mean(&errors[..200]), mean(&errors[800..]));
    println!("worst {worst:.2e}; fifths {first:.2e}, {last:.2e}; {contacts} samples in contact");
    assert!(contacts > 10, "samples should see contacts, {contacts} did");
    assert!(worst < 1e-3, "{worst:e}");
    assert!((last - first).abs() < 2.0 * WALK, "{first:e} {last:e}");
    // Sums of some 60 terms, each rounded a few times; overlaps are differences of numbers up to 2.4.
    assert!(greatest_difference < 1e-12, "card and sum differ by {greatest_difference:e}");
}

/// The card knows potential energy too.
#[test]
fn the_card_counts_potential_energy() {
    let mut simulation = load(&scene("gravity: (0.5, -9.81),"));
    let potential = |simulation: &Simulation| {
        simulation.bodies().position.iter().map(|position| 9.81 * position.y - 0.5 * position.x).sum::<f64>()
    };
    let start = energy(&simulation) + potential(&simulation);
    for thousands in 1..=20 {
        simulation.run_to_tick(1000 * thousands).expect("numbers stay finite");
        let card = simulation.card().energy;
        let change = energy(&simulation) + potential(&simulation) - start;
        assert!((card.residual - change).abs() < 1e-12 * start, "{} {change}", card.residual);
        assert!((card.potential - potential(&simulation)).abs() < 1e-12 * start);
    }
}
