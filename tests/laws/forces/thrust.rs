//! Laws of the force `Thrust` of scenes; each test says its law and its tolerance.

use jostle::scene::Source;
use jostle::{Simulation, SimulationExt};

/// A disc of 1 kg pushed with 1000 N in ticks of 1 ms: its speed after 1 s, and what the card warns of.
fn pushed(times: &str, clock: &str) -> (f64, Vec<String>) {
    let scene = format!(
        "Scene(format: 1, clock: (duration: 1, tick: \"1 ms\", {clock}),
        bodies: [(name: \"b\", at: (0, 0), mass: 1, atoms: Disc(radius: 0.1))],
        forces: [Drag(linear: 0, quadratic: 1e-300), Thrust(of: \"b\", force: (1000, 0), {times})])"
    );
    let mut simulation = Simulation::load(&Source::new("thrust.ron", scene)).unwrap_or_else(|e| panic!("{e}"));
    simulation.run_to_end().unwrap();
    let warnings = simulation.card().warnings.into_iter().filter(|warning| warning.contains("whole ticks")).collect();
    (simulation.bodies().velocity[0].x, warnings)
}

/// `v = F t/m` with the time of the ticks whose middles lie in the schedule. Tolerance: rounding of a thousand kicks.
#[test]
fn the_card_says_what_comes_of_times_between_ticks() {
    let close = |speed: f64, exact: f64| (speed - exact).abs() < 1000.0 * f64::EPSILON * exact.max(1.0);
    let cases = [
        ("from: 0.5001, to: 0.5004", 0.0, "Its whole impulse is lost"),
        ("from: 0.5001, to: 0.5016", 2.0, "acts from 0.5 s to 0.502 s: its impulse is 33.3 % too large"),
        ("from: 0.5, to: 0.5014", 1.0, "acts from 0.5 s to 0.501 s: 28.6 % of its impulse is lost"),
        ("from: 0.5004, to: 0.6004", 100.0, "acts from 0.5 s to 0.6 s: its impulse is right, but its time is not"),
        ("from: 0.5004", 500.0, "to act from 0.5004 s on. In whole ticks it acts from 0.5 s to 1 s"),
    ];
    for (times, exact, says) in cases {
        for method in ["VelocityVerlet", "SemiImplicitEuler"] {
            let (speed, warnings) = pushed(times, &format!("method: {method}"));
            assert!(close(speed, exact), "{times}: {speed}");
            assert_eq!(warnings.len(), 1, "{times}: {warnings:?}");
            assert!(warnings[0].starts_with("`forces[1]` ") && warnings[0].contains(says), "{}", warnings[0]);
        }
        for clock in ["events: Located, method: VelocityVerlet", "method: RungeKutta4"] {
            assert_eq!(pushed(times, clock).1, Vec::<String>::new(), "{clock}");
        }
    }
    let (speed, _) = pushed(cases[0].0, "method: RungeKutta4");
    assert!(close(speed, 0.3), "{speed}");
}

/// `v = F t/m` from one tick to another, by a force that nothing else accompanies: each tick in it has both of its half kicks, and no
/// other one has any. Tolerance: rounding of a thousand kicks. Not tested: a kick that waits, as beside contacts (`determinism/batches`).
#[test]
fn a_thrust_acts_in_its_ticks_and_in_no_half_more() {
    // No frame of a film ends at these times, where a run may be cut.
    for (from, to) in [(0.303_f64, 0.707_f64), (0.0, 0.707), (0.001, 0.002), (0.411, 9.0)] {
        for method in ["VelocityVerlet", "SemiImplicitEuler", "RungeKutta4", "Dop853"] {
            let scene = format!(
                "Scene(format: 1, clock: (duration: 1, tick: \"1 ms\", method: {method}),
                bodies: [(name: \"b\", at: (0, 0), mass: 1, atoms: Disc(radius: 0.1))],
                forces: [Thrust(of: \"b\", force: (1000, 0), from: {from:?}, to: {to:?})])"
            );
            let mut simulation = Simulation::load(&Source::new("thrust.ron", scene)).unwrap_or_else(|e| panic!("{e}"));
            simulation.run_to_end().unwrap();
            let acted = to.min(1.0) - from;
            let (speed, way) = (simulation.bodies().velocity[0].x, simulation.bodies().position[0].x);
            assert!((speed - 1000.0 * acted).abs() < 1e-9, "{method}, {from} to {to}: {speed}");
            let exact = 1000.0 * acted * (0.5 * acted + (1.0 - to).max(0.0));
            let whole_kicks = if method == "SemiImplicitEuler" { 0.5 * acted } else { 1e-9 };
            assert!((way - exact).abs() <= whole_kicks + 1e-9, "{method}, {from} to {to}: {way} for {exact}");
        }
    }
}

/// Times on ticks, as far as decimal fractions can be, and times that the run does not come to.
#[test]
fn times_on_ticks_are_not_warned_of() {
    for times in ["from: 0.3, to: 0.7", "from: 0.001, to: 0.999", "to: 0.123", "from: 0.5, to: 3.0004", "from: 2.00035"]
    {
        assert_eq!(pushed(times, "method: VelocityVerlet").1, Vec::<String>::new(), "{times}");
    }
}
