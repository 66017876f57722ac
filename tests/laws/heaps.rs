//! Promise: heaps of hundreds of bodies come to rest exactly, as single bodies do. No small speed counts as rest. The
//! search for rest finds forces within the bounds of the contact laws, or the heap moves on
//! (`constraints/rest_solver`).
//!
//! Grains without restitution fall from a loose grid into a box. What they lose as they meet is lost for good: a search that ends
//! too early lets contacts sink in under forces below their springs', which stores energy that no body gave. The bound on that, 1e-3 of
//! the loss, is what docs/limits.md promises, and follows from no order. Plain sweeps miss it, and the rest.
//!
//! Not tested: the time of rest, except for the given one; grains that roll on, which no law of contact stops.

use jostle::{Simulation, SimulationExt};

use super::support::{load, run_to};

/// A heap of `columns` by `rows` grains made of `atoms`.
fn heap(atoms: &str, (columns, rows): (usize, usize), stiffness: f64, tick: f64, friction: f64) -> Simulation {
    let width = 0.25 * columns as f64;
    load(&format!(
        "Scene(format: 1, clock: (duration: 100, tick: {tick:?}, method: VelocityVerlet), gravity: (0, -9.81),
        materials: {{ \"grain\": (stiffness: {stiffness:?}, friction: {friction:?}, restitution: 0) }},
        walls: [(name: \"floor\", left: ({width:?}, 0), right: (0, 0), material: \"grain\"),
                (name: \"left\", left: (0, 0), right: (0, 1), material: \"grain\"),
                (name: \"right\", left: ({width:?}, 1), right: ({width:?}, 0), material: \"grain\")],
        bodies: [Repeat(count: ({columns}, {rows}), make: (name: \"grain_{{i}}_{{j}}\", material: \"grain\", atoms: {atoms},
            at: (\"0.15 + 0.249 * i + 0.004 * mod(7 * i + 3 * j, 5)\", \"0.15 + 0.23 * j\")))])"
    ))
}

/// Runs until a time by which it rests; says how much lost energy came back at the most, as a share of what was lost.
fn rests(mut simulation: Simulation, time: f64) -> f64 {
    let (mut most, mut back) = (0.0_f64, 0.0_f64);
    let mut now = 0.0;
    while now < time {
        now += 0.1;
        run_to(&mut simulation, now);
        let lost = simulation.card().energy.inelasticity;
        most = most.max(lost);
        back = back.max(most - lost);
    }
    let bodies = simulation.bodies();
    let moving =
        (0..bodies.len()).filter(|&body| bodies.velocity[body] != glam::DVec2::ZERO || bodies.spin[body] != 0.0);
    assert_eq!(moving.count(), 0, "of {} grains", bodies.len());
    let resting = simulation.bodies().position.clone();
    run_to(&mut simulation, time + 1.0);
    assert_eq!(simulation.bodies().position, resting, "what rests stays to the last bit");
    back / most
}

const DISC: &str = "Disc(radius: 0.1, mass: 1)";
const DUMBBELL: &str = "List([(radius: 0.06, at: (-0.05, 0), mass: 0.5), (radius: 0.06, at: (0.05, 0), mass: 0.5)])";

#[test]
fn heaps_of_discs_come_to_rest_exactly() {
    for (grid, friction) in [((20, 8), 0.4), ((30, 12), 0.2), ((25, 25), 0.6)] {
        let back = rests(heap(DISC, grid, 2e4, 3e-3, friction), 8.0);
        assert!(back < 1e-3, "{grid:?}: {back:e} of what was lost came back");
    }
}

#[test]
fn stiffer_heaps_do_so_at_finer_ticks() {
    let back = rests(heap(DISC, (15, 12), 3.2e5, 0.75e-3, 0.4), 8.0);
    assert!(back < 1e-3, "{back:e} of what was lost came back");
}

#[test]
fn heaps_of_bodies_with_several_atoms_come_to_rest_exactly() {
    let back = rests(heap(DUMBBELL, (20, 12), 2e4, 2e-3, 0.4), 8.0);
    assert!(back < 1e-3, "{back:e} of what was lost came back");
}
