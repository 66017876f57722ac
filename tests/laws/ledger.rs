//! Law: what the bodies gain in energy is work of drives less losses. The card's residual is "the error of the
//! integration", so it must fall with the order of the method. Source: energy balance.
//!
//! Tolerance: the slope of a least-squares fit over five halvings, less 0.25 (see `convergence`). A term that is booked
//! twice or not at all leaves a residual that does not fall.
//!
//! An overlap at the start is elastic energy that is there; nothing has been lost on the way to it.
//!
//! Not tested: the order with contacts, whose kinks and jumps limit it; their losses are exact (see `restitution`).

use jostle::SimulationExt;
use std::f64::consts::PI;

use jostle::problems;
use jostle::tick::FailureKind;

use super::support::{METHODS, assert_near, fitted_order_above, load, run, table};

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
        // Sums of some ten joules: a hundred times their rounding over 6400 ticks.
        let Some(order) = fitted_order_above(1e-11, &points) else {
            println!("{}: rounding;{}", method.name, table(&points));
            continue;
        };
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

/// A disc of 1 kg, 1 cm deep in a floor of 10 kN/m, which lost a share of `mu_e` of the half joule on the way out and nothing
/// on the way in. The account is exact; `(w dt)^2/4` of the energy is the error of the methods, `w dt/2` that of the first
/// kick of semi-implicit Euler.
#[test]
fn an_overlap_at_the_start_has_lost_nothing() {
    for method in METHODS {
        let simulation = run(&format!(
            "Scene(format: 1, clock: (duration: 0.1, tick: 1e-4, method: {method}),
            materials: {{ \"m\": (stiffness: 1e4, inelasticity: 0.6) }},
            walls: [(name: \"floor\", left: (1, 0), right: (0, 0), material: \"m\")],
            bodies: [(name: \"disc\", at: (0.5, 0.09), material: \"m\", atoms: Disc(radius: 0.1, mass: 1))])"
        ));
        let (energy, step) = (simulation.card().energy, 100.0 * 1e-4_f64);
        assert_near("lost on the way out", energy.inelasticity, 0.6 * 0.5, 1e-12);
        let error = if method == METHODS[0] { step / 2.0 } else { step * step / 4.0 };
        assert_near("left", energy.kinetic, 0.4 * 0.5, 0.5 * error);
    }
}

#[test]
fn what_stands_in_balance_at_the_start_loses_nothing() {
    for normal in ["Inelasticity", "Dashpot"] {
        let simulation = run(&format!(
            "Scene(format: 1, clock: (duration: 0.1, tick: 1e-4), gravity: (0, -10), contacts: Penalty(normal: {normal}),
            materials: {{ \"m\": (stiffness: 1e4, inelasticity: 0.6) }},
            walls: [(name: \"floor\", left: (1, 0), right: (0, 0), material: \"m\")],
            bodies: [(name: \"disc\", at: (0.5, 0.099), material: \"m\", atoms: Disc(radius: 0.1, mass: 1))])"
        ));
        let energy = simulation.card().energy;
        // A potential of 1 J, and rounding.
        assert!(energy.residual.abs() <= 1e-15 && energy.inelasticity.abs() <= 1e-15, "{normal}: {energy:?}");
    }
}

/// A drive that swings puts in and takes out, and by chance nothing is left when somebody looks. What went round is what it
/// worked either way: no less than the `2 A^2/w^2` of the first swing of 1 kg from rest. Velocity Verlet books it with an error
/// of `(A dt)^2/8` at most, and twice that for the velocities that it estimates: together a share below `(w dt)^2/4`. With
/// `w dt = 1.5` nothing small is left of that, but the run goes on.
#[test]
fn a_drive_that_swings_is_no_energy_out_of_nowhere() {
    let swings = |push: &str, rate: f64, phase: &str, tick: f64| {
        run(&format!(
            "Scene(format: 1, clock: (duration: 10, tick: {tick:?}, method: VelocityVerlet),
            bodies: [(name: \"disc\", at: (0, 0), inertia: 1, mass: 1, atoms: Disc(radius: 0.5))],
            forces: [Drive(of: \"disc\", {push}, course: Sine(angular_frequency: {rate:?}, phase: {phase}))])"
        ))
        .card()
    };
    for push in ["force: (3, 0)", "torque: 3"] {
        for (rate, phase) in [(7.3, "0"), (7.3, "\"180 deg\""), (2.454369, "\"90 deg\"")] {
            let card = swings(push, rate, phase, 0.01);
            let share = (rate * 0.01).powi(2) / 4.0;
            assert!(card.energy_error() < share, "{push}, {rate}, {phase}: {:e}", card.energy_error());
        }
        let fast = 2.0 * PI * 240.0;
        let card = swings(push, fast, "0", 1e-4);
        assert!(card.energy_error() < (fast * 1e-4).powi(2) / 4.0, "{push}: {:e}", card.energy_error());
        assert!(card.energy_error() < 0.05 && card.warnings.is_empty(), "{push}: {card}");
        assert!(swings(push, fast, "0", 1e-3).energy_error() < 1.0);
    }
}

/// A disc between two walls that press it, of `w = sqrt(2 k/m)`, is unstable above a tick of `2/w = 14 ms`, and above 20 ms still
/// when it has left one of them. Its energy grows without bound, and the run is stopped however much work is done to and fro
/// meanwhile: that grows with the speed alone.
#[test]
fn what_explodes_is_stopped_though_drives_work() {
    for forces in
        ["", "Drive(of: \"disc\", force: (0, 50), course: Sine(frequency: 20))", "Thrust(of: \"disc\", force: (0, 90))"]
    {
        for method in METHODS {
            let mut simulation = load(&format!(
                "Scene(format: 1, clock: (duration: 20, tick: 0.021, method: {method}), forces: [{forces}],
                materials: {{ \"m\": (stiffness: 1e4) }},
                walls: [(name: \"floor\", left: (1, 0), right: (0, 0), material: \"m\"),
                        (name: \"ceiling\", left: (0, 0.19), right: (1, 0.19), material: \"m\")],
                bodies: [(name: \"disc\", at: (0.5, 0.0951), material: \"m\", atoms: Disc(radius: 0.1, mass: 1))])"
            ));
            let failure = simulation.run_to_end().expect_err(forces);
            assert!(matches!(failure.wrong, FailureKind::Energy(_)), "{method}, {forces}: {failure}");
        }
    }
}

/// A disc that begins pressed into the floor, and slides: its spring of friction is drawn over the first steps, and then slips. Tolerance: `Dop853`
/// leaves rounding of the 0.6 J of the motion, `RungeKutta4` the share `(w h)^4` of it, `w = sqrt(k/m)`.
#[test]
fn friction_of_a_contact_that_begins_pressed_is_booked_from_the_first_step() {
    let frequency: f64 = 2e4_f64.sqrt();
    for tick in [1e-3, 5e-4, 1.25e-4] {
        for (method, tolerance) in [("Dop853", 1e-13), ("RungeKutta4", (frequency * tick).powi(4))] {
            let simulation = run(&format!(
                "Scene(format: 1, clock: (duration: 0.004, tick: {tick:?}, method: {method}),
                 materials: {{ \"default\": (stiffness: 2e4, friction: 0.4, restitution: 1) }},
                 walls: [(name: \"floor\", left: (1, 0), right: (0, 0))],
                 bodies: [(name: \"disc\", at: (0, 0.098), velocity: (1, 0), mass: 1, shape: Disc(radius: 0.1))])"
            ));
            let energy = simulation.card().energy;
            assert!(energy.friction > 0.04, "{energy:?}");
            assert!(energy.residual.abs() < 0.6 * tolerance, "{method}, tick {tick}: {energy:?}");
        }
    }
}
