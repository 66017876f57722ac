//! Law: steps that follow their error keep the tolerance at three places. A run begins without any force, bodies meet
//! within a step on curved ways, and a body is at rest before it moves.
//!
//! Tolerances: three times the one asked for, of the size of the motion, as everywhere (`tolerance.rs`); where no exact answer
//! is known it is a run with equal short steps, whose error falls with the eighth power of the step.
//!
//! Not tested: bodies smaller than the error of the ways that lead to them.

use jostle::Simulation;

use super::support::run;

fn position(simulation: &Simulation) -> glam::DVec2 {
    simulation.bodies().position[0]
}

/// `x = A/(m w) (t - sin(w t)/w)` from rest, where the force begins at zero.
#[test]
fn a_force_that_begins_at_zero_moves_a_body_at_rest() {
    let (rate, end) = (7.3_f64, 10.0);
    let exact = 3.0 / rate * (end - libm::sin(rate * end) / rate);
    for tolerance in [1e-3, 1e-6, 1e-9] {
        let simulation = run(&format!(
            "Scene(format: 1, clock: (duration: {end}, tolerance: {tolerance:e}),
                bodies: [(name: \"b\", at: (0, 0), atoms: Disc(radius: 0.1, mass: 1))],
                forces: [Drive(of: \"b\", force: (1, 0), course: Sine(amplitude: 3, angular_frequency: {rate}))])"
        ));
        let error = (position(&simulation).x - exact).abs() / exact;
        assert!(error <= 3.0 * tolerance, "{tolerance:e}: {error:e}");
    }
}

fn circle(clock: &str, angle: f64) -> Simulation {
    let (sin, cos) = libm::sincos(angle);
    run(&format!(
        "Scene(format: 1, clock: (duration: 6, {clock}), materials: {{\"m\": (stiffness: 1e5)}},
            bodies: [
                (name: \"b\", at: (1, 0), velocity: (0, 1), material: \"m\", atoms: Disc(radius: 0.01, mass: 1)),
                (name: \"peg\", at: ({cos:?}, {sin:?}), material: \"m\", fixed: true, atoms: Disc(radius: 0.01, mass: 1)),
            ],
            forces: [Spring(a: \"b\", b: World, anchor_b: (0, 0), stiffness: 1, length: 0)])"
    ))
}

/// A body goes round in a circle and meets a peg on its way, which a step of a third of a turn has left behind.
#[test]
fn a_peg_on_a_circle_is_met() {
    for angle in [1.6, 2.4, 3.1, 4.7, 5.5] {
        let exact = position(&circle("tick: 0.002, method: Dop853", angle));
        for clock in ["tolerance: 1e-3", "tolerance: 1e-6", "method: Reference"] {
            let simulation = circle(clock, angle);
            let (events, error) = (simulation.state().located().count, (position(&simulation) - exact).length());
            // Ways of at most 2 m.
            let allowed = 3.0 * 2.0 * if clock == "tolerance: 1e-3" { 1e-3 } else { 1e-6 };
            assert!(events == 2 && error <= allowed, "{angle} rad, {clock}: {events} events, {error:e}");
        }
    }
}

/// A block on a belt begins to slide at once, though it stands: `x = v t - v^2/(2 mu g)` after it has the speed of the belt.
#[test]
fn a_standing_block_is_taken_along_by_a_belt() {
    let exact = 2.0 * 2.0 - 2.0 * 2.0 / (2.0 * 0.5 * 10.0);
    for clock in ["tolerance: 1e-3", "tolerance: 1e-6", "method: Reference"] {
        let simulation = run(&format!(
            "Scene(format: 1, clock: (duration: 2, {clock}), gravity: (0, -10),
                materials: {{\"m\": (stiffness: 1e6, friction: 0.5)}}, contacts: Penalty(tangential: Exact),
                walls: [(name: \"belt\", left: (50, 0), right: (-50, 0), material: \"m\", surface_velocity: (2, 0))],
                bodies: [(name: \"b\", at: (0, 0.099995), material: \"m\", atoms: List([
                    (at: (-0.5, 0), radius: 0.1, mass: 0.5), (at: (0.5, 0), radius: 0.1, mass: 0.5),
                ]))])"
        ));
        let error = (position(&simulation).x - exact).abs() / exact;
        let allowed = if clock == "tolerance: 1e-3" { 3e-3 } else { 3e-6 };
        assert!(error <= allowed, "{clock}: {} m instead of {exact} m", position(&simulation).x);
    }
}
