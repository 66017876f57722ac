//! Law: the search for events changes nothing if there are none. Events within a tick are found however far bodies fly
//! in it.
//!
//! Tolerances: none; the same operations give the same bits.
//!
//! Not tested: how fast what was hit moves. A contact that begins and ends within a tick is seen, but steps of methods without
//! an estimate of their error do not resolve it, and the card says so.

use super::support::{load, run_to};
use jostle::SimulationExt;

fn scene(method: &str, events: &str, (speed, target): (f64, f64)) -> String {
    format!(
        "Scene(format: 1, clock: (duration: 1, tick: 0.001, method: {method}, events: {events}), gravity: (0, 0),
            bodies: [
                (name: \"bullet\", at: (0, 0), velocity: ({speed}, 0), atoms: Disc(radius: 0.01, mass: 1, stiffness: 1e6)),
                (name: \"target\", at: ({target}, 0.001), atoms: Disc(radius: 0.01, mass: 1, stiffness: 1e6)),
            ])"
    )
}

/// In each tick the bullet goes five times as far as both discs are wide.
#[test]
fn a_bullet_does_not_pass_unseen_between_two_ticks() {
    for method in ["VelocityVerlet", "SemiImplicitEuler", "RungeKutta4", "Dop853", "Symplectic4", "ImplicitMidpoint"] {
        for target in [0.05, 2.05, 2.01, 2.09, 10.05] {
            let mut simulation = load(&scene(method, "Located", (100.0, target)));
            run_to(&mut simulation, 0.12);
            let events = simulation.state().located().count;
            let warnings = simulation.card().warnings;
            assert!(events >= 1 && !warnings.is_empty(), "{method}, {target} m: {events} events, {warnings:?}");
        }
    }
}

#[test]
fn ticks_without_events_are_those_that_look_for_none() {
    for method in ["VelocityVerlet", "SemiImplicitEuler"] {
        let [located, per_tick] = ["Located", "PerTick"].map(|events| {
            let text = scene(method, events, (1.0, 50.0)).replace("gravity: (0, 0)", "gravity: (0.3, -9.81)");
            let mut simulation = load(&text);
            run_to(&mut simulation, 0.3);
            simulation.bodies().position.clone()
        });
        assert_eq!(located, per_tick, "{method}");
    }
}
