//! Scenes at the edges of the range of numbers, as the fuzzer found them. Each run continues with finite numbers, or
//! ends with a failure that names a body. It never panics, and never fails in silence.
//!
//! Not tested: whether what such scenes compute is of any use.

use jostle::scene::Source;
use jostle::simulation::Simulation;
use jostle::tick::{Failure, FailureKind};

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

/// Overlaps near the root of the largest number: the bounds of a held contact's force are infinite.
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
        let failure = run(sections, 12, at_once).expect_err("no law holds with infinite forces");
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
    let first =
        (1..=40).find_map(|ticks| run(sections, ticks, true).err()).expect("it becomes infinite within two ticks");
    assert!(first.body == "brick" && matches!(first.wrong, FailureKind::NotFinite(_)), "{first}");
    let step_by_step = run(sections, 40, false).expect_err("likewise");
    assert_eq!(first, step_by_step);
}
