//! Law: what the bodies gain in energy is work of drives less losses. The card's residual is "the error of the
//! integration", so it must fall with the order of the method. Source: energy balance.
//!
//! Tolerance: the slope of a least-squares fit over five halvings, less 0.25 (see `convergence`). A term that is booked
//! twice or not at all leaves a residual that does not fall.
//!
//! Not tested: contacts, whose kinks and jumps limit the order; their losses are exact (see `restitution`).

use jostle::problems;

use super::support::{fitted_order, run, table};

const GRAVITY: &str = "gravity: (0, -9.81),";
const DRAG: &str = "Drag(linear: 0.3), Drag(quadratic: 0.05),";
const DRIVES: &str =
    "Thrust(of: \"rocket\", at: (0.1, 0.2), force: (1, 4), frame: Body), Torque(of: \"rocket\", value: -0.4),";

#[track_caller]
fn assert_that_the_ledger_closes(gravity: &str, forces: &str) {
    for method in problems::methods() {
        let points: Vec<(f64, f64)> = (0..6)
            .map(|halving| {
                let tick = 0.01 / f64::from(1 << halving);
                let simulation = run(&format!(
                    "Scene(format: 1, clock: (duration: 2, tick: {tick:?}, method: {}), {gravity} forces: [{forces}],
                    bodies: [(name: \"rocket\", at: (0, 0), velocity: (3, 2), spin: 1,
                              atoms: Disc(radius: 0.5, mass: 2))])",
                    method.name
                ));
                (tick, simulation.card().energy.residual.abs())
            })
            .collect();
        let order = fitted_order(&points);
        println!("{}: order {order:.2};{}", method.name, table(&points));
        let expected = f64::from(method.order);
        assert!(order >= expected - 0.25, "{}: order {order:.2}, expected {expected};{}", method.name, table(&points));
    }
}

#[test]
fn the_ledger_closes_with_drag() {
    assert_that_the_ledger_closes(GRAVITY, DRAG);
}

#[test]
fn the_ledger_closes_with_drives() {
    assert_that_the_ledger_closes(GRAVITY, DRIVES);
}

#[test]
fn the_ledger_closes_with_drag_and_drives() {
    assert_that_the_ledger_closes(GRAVITY, &format!("{DRAG}{DRIVES}"));
}
