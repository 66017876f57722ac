//! Laws of runs with a tolerance, and of `Reference`. Their steps begin, and lead to the end of the run. References are solutions of
//! one degree of freedom, from event to event.

use std::fmt::Write;

use jostle::Simulation;
use jostle::scene::Source;
use jostle::simulation::Overrides;

fn run(text: &str, overrides: &Overrides) -> Simulation {
    let source = Source::new("first_steps.ron", text);
    let mut simulation =
        Simulation::load_with(&source, overrides, |_| {}).unwrap_or_else(|errors| panic!("{errors}\n{text}"));
    simulation.run_to_end().unwrap_or_else(|failure| panic!("{failure}\n{text}"));
    simulation
}

fn scene(name: &str) -> String {
    let path = format!("{}/assets/defects/{name}.ron", env!("CARGO_MANIFEST_DIR"));
    std::fs::read_to_string(&path).unwrap_or_else(|wrong| panic!("{path}: {wrong}"))
}

fn tolerance(tolerance: f64) -> Overrides {
    Overrides { tolerance: Some(tolerance), ..Overrides::default() }
}

fn method(name: &str, tick: Option<f64>) -> Overrides {
    Overrides { method: Some(name.to_owned()), tick, ..Overrides::default() }
}

/// The place of a body along x. The first one that moves by forces counts.
fn place(simulation: &Simulation) -> f64 {
    let bodies = simulation.bodies();
    let moves = (0..bodies.len()).find(|&body| bodies.dynamic[body]).unwrap_or_default();
    bodies.position[moves].x
}

/// The error of a run is at most three times the tolerance, a share of how far its body goes.
fn assert_place(wrong: &mut String, what: &str, found: f64, exact: f64, allowed: f64) {
    if (found - exact).abs() > allowed || found.is_nan() {
        let _ = writeln!(wrong, "{what}: {found} instead of {exact}, {allowed:e} allowed");
    }
}

/// At the start no body moves, and no force acts. Only the support begins to move, and draws the spring of friction. Later, points
/// of its path end steps. The spring has four fifths of the normal stiffness. The place was solved from event to event to 1e-9 m.
#[test]
fn a_support_that_starts_under_a_body_at_rest_lets_steps_begin() {
    let text = scene("slider_on_table");
    let exact = 0.032_904_17;
    let mut wrong = String::new();
    assert_place(&mut wrong, "Reference", place(&run(&text, &method("Reference", None))), exact, 1e-8);
    for share in [1e-4, 1e-6, 1e-8] {
        let found = place(&run(&text, &tolerance(share)));
        assert_place(&mut wrong, &format!("{share:e}"), found, exact, 3.0 * share * 0.2 + 1e-8);
    }
    assert!(wrong.is_empty(), "{wrong}");
}

/// The same with other springs, tables, and bodies, also at the origin. Fixed ticks of a tenth of a millisecond with located
/// events have errors of rounding. A spring swings by less than a hundredth of a turn in one.
#[test]
fn first_steps_do_not_depend_on_where_a_body_rests() {
    let mut wrong = String::new();
    for (number, (stiffness, height, half)) in
        [(5e3, 0.0, 0.3), (2e4, 0.25, 0.21), (8e4, -3.0, 0.47)].into_iter().enumerate()
    {
        let text = format!(
            "Scene(format: 1, clock: (duration: 1), gravity: (0, -9.81),
            contacts: Penalty(normal: Dashpot, damping: 35),
            materials: {{ \"m\": (stiffness: {stiffness:?}, friction: 0.5) }},
            bodies: [
                (name: \"table\", at: (0, {:?}), kinematic: (path: [(time: {half:?}, by: (0.1, 0)), (time: {:?}, by: (0, 0))],
                 repeat: true), material: \"m\", shape: Rectangle(width: 40, height: 1)),
                (name: \"b\", at: (0, {height:?}), material: \"m\", atoms: Disc(radius: 0.18, mass: 1.2))],
            joints: [Prismatic(name: \"p\", a: World, b: \"b\", axis: (1, 0))])",
            height - 0.677,
            2.2 * half
        );
        let exact = place(&run(&text, &method("Dop853", Some(1e-4))));
        let found = place(&run(&text, &tolerance(1e-7)));
        assert_place(&mut wrong, &format!("scene {number}"), found, exact, 3e-7 * 0.2 + 1e-9);
    }
    assert!(wrong.is_empty(), "{wrong}");
}

/// The disc falls on the belt and slides at once. It comes to rest along the normal, slides on, stops, and rides with the belt. In the
/// end it yields to the spring of the scene. The place was found from event to event by the laws of the manual, with steps of Runge and
/// Kutta's. The disc cannot turn there. Here it turns by a hundred millionth of its way.
#[test]
fn a_disc_that_falls_on_a_belt_slides_stops_and_yields() {
    let text = scene("belt_friction");
    let (exact, turns) = (0.171_761_440_2, 3e-9);
    let mut wrong = String::new();
    assert_place(&mut wrong, "Reference", place(&run(&text, &method("Reference", None))), exact, turns);
    for share in [1e-4, 1e-6, 1e-8] {
        let found = place(&run(&text, &tolerance(share)));
        assert_place(&mut wrong, &format!("{share:e}"), found, exact, 3.0 * share + turns);
    }
    assert!(wrong.is_empty(), "{wrong}");
}

/// A wheel of spokes walks down a slope. Two corners rest on it for moments. The search for steps comes to its end at coarse
/// tolerances as at fine ones, after some hundred thousand evaluations. Places are compared with those of a fine run.
#[test]
fn a_wheel_of_spokes_walks_to_the_end_under_any_tolerance() {
    let text = scene("rimless_wheel");
    let mut wrong = String::new();
    for (stiffness, spin) in [("20 MN/m", 2.0), ("1 MN/m", 2.0), ("5 MN/m", 1.3)] {
        let text = text.replace("20 MN/m", stiffness).replace("\"w\": 2", &format!("\"w\": {spin:?}"));
        let exact = place(&run(&text, &tolerance(1e-8)));
        for share in [1e-2, 1e-3, 1e-4, 1e-6] {
            let simulation = run(&text, &tolerance(share));
            let evaluations = simulation.state().evaluation().count;
            assert!(evaluations < 200_000, "{stiffness} {spin} {share:e}: {evaluations} evaluations");
            // It goes by six metres.
            assert_place(
                &mut wrong,
                &format!("{stiffness} {spin} {share:e}"),
                place(&simulation),
                exact,
                3.0 * share * 6.0,
            );
        }
    }
    assert!(wrong.is_empty(), "{wrong}");
}
