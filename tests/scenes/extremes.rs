//! Scenes at the edges of what numbers can be, as the fuzzer found them: each run goes on with finite numbers, or ends
//! with a failure that names a body. It never panics, and never goes on in silence.
//!
//! Not tested: whether what such scenes compute is of any use.

use jostle::scene::Source;
use jostle::simulation::{Overrides, Simulation};
use jostle::tick::{Failure, Wrong};

/// Runs some ticks, one at a time or all at once, and sees that the state is finite as long as nothing is said.
fn run(sections: &str, ticks: u64, at_once: bool) -> Result<(), Failure> {
    let scene = format!("Scene(format: 1, clock: (duration: 20, tick: \"1 ms\"), {sections})");
    let source = Source::new("edge.ron", scene);
    let mut simulation = Simulation::load(&source).unwrap_or_else(|errors| panic!("{errors}"));
    for tick in if at_once { ticks..=ticks } else { 1..=ticks } {
        simulation.run_to_tick(tick)?;
        let bodies = simulation.bodies();
        for body in 0..bodies.len() {
            let finite = bodies.position[body].is_finite() && bodies.velocity[body].is_finite();
            assert!(finite && bodies.angle[body].is_finite() && bodies.spin[body].is_finite(), "tick {tick}");
        }
    }
    Ok(())
}

/// Overlaps near the root of the largest number: the bounds of a held contact's force are no numbers.
#[test]
fn a_body_behind_a_wall_at_the_end_of_numbers() {
    let sections = r#"
        materials: { "room": (friction: 0.3, inelasticity: 0.2) },
        walls: [(name: "ceiling", left: (0, 6), right: (1, 6), material: "room")],
        bodies: [
            (name: "I", at: (3.5, 5.5), spin: 4, material: "room", atoms: Picture(spacing: 0.1, rows: [".########"])),
            (name: "far", at: (1.5, 1e154), spin: -4, atoms: Picture(spacing: 0.1, mass: 0.01, rows: [".####"])),
        ]"#;
    for at_once in [false, true] {
        let failure = run(sections, 12, at_once).expect_err("no law holds with forces that are no numbers");
        assert_eq!(failure.body, "far");
    }
}

/// A drag that no tick can follow: the velocity leaves the numbers in the last kick of a batch, which no position has
/// seen yet.
#[test]
fn a_velocity_that_leaves_the_numbers_in_the_last_kick() {
    let sections = r#"
        gravity: (0, 9.81),
        bodies: [(name: "brick", at: (2, 0.8), angle: "20 deg", atoms: Picture(spacing: 0.05, rows: [".####"]))],
        forces: [Drag(linear: 1e300)]"#;
    let first = (1..=40)
        .find_map(|ticks| run(sections, ticks, true).err())
        .expect("it grows beyond all numbers within two ticks");
    assert!(first.body == "brick" && matches!(first.wrong, Wrong::NotFinite(_)), "{first}");
    let step_by_step = run(sections, 40, false).expect_err("likewise");
    assert_eq!(first, step_by_step);
}

/// The plan of a tolerance that was not tried yet may let bodies meet in a way they never would, and then takes steps without end:
/// here two cradles that stand in one place.
#[test]
fn a_plan_that_was_not_tried_ends_soon() {
    let ball = |name: String, x: f64, y: f64| {
        format!("(name: \"{name}\", at: ({x:?}, {y:?}), material: \"steel\", atoms: Disc(radius: 0.08, mass: 1)),")
    };
    let rod = |name: String, x: f64| {
        format!("Distance(name: \"rod_{name}\", a: World, anchor_a: ({x:?}, 0), b: \"{name}\", length: 1),")
    };
    let (mut bodies, mut joints) = (String::new(), String::new());
    for (cradle, begin, coming) in [("one", -0.9, 1), ("two", 1e-18, 2)] {
        for number in 0..5 {
            let (name, x) = (format!("{cradle}_{number}"), begin + 0.162 * f64::from(number - 2));
            let angle: f64 = if number < coming { 0.7 } else { 0.0 };
            bodies += &ball(name.clone(), x - angle.sin(), -angle.cos());
            joints += &rod(name, x);
        }
    }
    let scene = format!(
        "Scene(format: 1, clock: (duration: 8, tolerance: 1e-5, method: Dop853), gravity: (0, -9.81),
        materials: {{ \"steel\": (stiffness: 1e7, restitution: 1) }}, bodies: [{bodies}], joints: [{joints}])"
    );
    let overrides = Overrides { untried: true, ..Overrides::default() };
    let mut simulation = Simulation::load_with(&Source::new("cradles.ron", scene), &overrides, |_| {})
        .unwrap_or_else(|errors| panic!("{errors}"));
    let _ = simulation.run_to_tick(12);
    let evaluations = simulation.state().evaluation().count;
    assert!(evaluations < 1_000_000, "{evaluations} evaluations");
}
