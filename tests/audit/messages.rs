//! Messages name the place, the cause and short numbers.
//!
//! Laws of texts, without a tolerance. Mistakes of films that turn out after reading stand at their place in the file.
//! Steps that end where a servo samples are blamed on the servo, at any rate and by any method with steps. No message
//! shows a number of dozens of digits, whatever a scene holds. Nor does the error card of its first ticks.

use std::path::PathBuf;
use std::process::Command;

use jostle::scene::Source;
use jostle::simulation::Overrides;
use jostle::{Simulation, SimulationExt};

const REST: &str = "bodies: [(name: \"a\", at: (0, 0), mass: 1, atoms: Disc(radius: 0.1))],";

#[test]
fn mistakes_of_a_film_stand_at_their_place() {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("messages");
    std::fs::create_dir_all(&folder).unwrap();
    // The value with the mistake stands behind `@`.
    for (entry, path) in [
        ("film: (fps: 1000, to: 0.05, freeze: [(at: 0.01, for: @1e12)])", "film.freeze[0].for"),
        ("film: (freeze: [(at: 0.01, for: 1), (at: 0.02, for: @3e9)])", "film.freeze[1].for"),
        ("film: (from: @7)", "film.from"),
        ("film: (freeze: [(at: @7, for: 1)])", "film.freeze[0].at"),
        ("film: @(speed: 1e-9)", "film"),
        ("look: (theme: @\"no.ron\")", "look.theme"),
        ("look: (theme: @\"film.ron\")", "look.theme"),
    ] {
        let text = format!("Scene(format: 1, clock: (duration: 0.1, tick: 0.001),\n{REST}\n    {entry})");
        let line = text.split('\n').next_back().unwrap();
        let column = line.find('@').unwrap() + 1;
        std::fs::write(folder.join("film.ron"), text.replace('@', "")).unwrap();
        let output = Command::new(env!("CARGO_BIN_EXE_jostle"))
            .current_dir(&folder)
            .args(["check", "film.ron"])
            .output()
            .unwrap();
        let told = String::from_utf8(output.stderr).unwrap();
        assert!(told.contains(&format!("error: {path}: ")), "{entry}: {told}");
        assert!(told.contains(&format!("--> film.ron:3:{column}\n")), "{entry}: expected column {column}: {told}");
        assert_eq!(output.status.code(), Some(1), "{entry}");
    }
}

#[test]
fn short_steps_between_samples_are_blamed_on_the_servo() {
    for method in ["RungeKutta4", "Dop853"] {
        for (rate, delay) in [(1e12, 0.5), (3e11, 0.0), (1e15, 1e-3)] {
            let text = format!(
                "Scene(format: 1, clock: (duration: 1, tick: 0.001, method: {method}), gravity: (0, -9.81), {REST} \
                 joints: [Revolute(name: \"j\", a: World, b: \"a\", anchor_b: (0.3, 0))], \
                 controllers: [Servo(of: \"j\", target: 1, kp: 1, rate: {rate:e}, delay: {delay:e})])"
            );
            let mut simulation = Simulation::load(&Source::new("servo.ron", text)).unwrap();
            let failure = simulation.run_to_end().expect_err("samples without an end").to_string();
            assert!(failure.contains("`controllers[0]` jumps"), "{method}, {rate:e} Hz: {failure}");
            assert!(!failure.contains("acceleration"), "{method}, {rate:e} Hz: {failure}");
        }
    }
}

#[test]
fn no_message_shows_dozens_of_digits() {
    let entries = [
        "walls: [(name: \"w\", line: [(0, 0), (@, 0), (0, @)])]",
        "walls: [(name: \"w\", heights: [(0, 0), (@, 0), (0, @)])]",
        "walls: [(name: \"w\", left: (0, 0), right: (@, @))]",
        "walls: [(name: \"w\", left: (@, 0), right: (@, 0))]",
        "walls: [(name: \"w\", from: (0, 0), to: (1, 0), thickness: @)]",
        "camera: Look(center: (0, 0), height: @)",
        "film: (from: @, to: @, freeze: [(at: @, for: @)])",
        "materials: { \"m\": (stiffness: @, friction: (static: 0.1, dynamic: @)) }",
        "forces: [Thrust(of: \"a\", force: (1, 0), from: @, to: @)]",
        "forces: [Thrust(of: \"a\", force: (1, 0), from: 1, to: @)]",
        "fill: [(name: \"f\", count: 3, within: ((0, 0), (@, 1)), radius: Uniform(@, 0.1))]",
        "fill: [(name: \"f\", count: 9, within: ((2, 2), (3, 3)), radius: @)]",
        "plots: [(channels: [\"a.position.x\"], range: (@, @))]",
        "expect: [Position(of: \"a\", at: @, is: (1, 1), within: @)]",
        "sensors: [Flow(name: \"n\", of: \"a\", gate: ((@, 0), (@, 0)), window: @)]",
        "controllers: [Servo(of: \"j\", target: @, kp: @, rate: @)]",
        "walls: [(name: \"w\", left: (1, @), right: (0, @))]",
        "gravity: (0, @)",
        "forces: [Spring(a: \"a\", b: World, stiffness: @)]",
    ];
    let bodies = ["Disc(radius: @)", "Disc(radius: 0.1, mass: @)"].map(|atoms| format!("atoms: {atoms}"));
    let shapes =
        ["Rectangle(width: @, height: 1)", "Polygon([(0, 0), (@, 0), (0, @)])", "Ellipse(width: 1, height: @)"];
    let bodies = bodies.into_iter().chain(shapes.map(|shape| format!("shape: {shape}, mass: 1")));
    let bodies = bodies.map(|body| format!("bodies: [(name: \"a\", at: (0, 0), {body})]"));
    let first_ticks = Overrides {
        method: Some("VelocityVerlet".to_owned()),
        tick: Some(1e-3),
        duration: Some(3e-3),
        ..Overrides::default()
    };
    let (mut refused, mut ran) = (0, 0);
    for entry in entries.into_iter().map(|entry| format!("{REST} {entry}")).chain(bodies) {
        for value in ["1e200", "-1e200", "1e-200", "-1e-200", "1e300", "-3.3e40"] {
            let text = format!("Scene(format: 1, clock: (duration: 1), {})", entry.replace('@', value));
            let told = match Simulation::load_with(&Source::new("digits.ron", text), &first_ticks, |_| {}) {
                Err(errors) => {
                    refused += 1;
                    errors.to_string()
                }
                Ok(mut simulation) => {
                    // A failure stands on the card.
                    let _ = simulation.run_to_end();
                    ran += 1;
                    simulation.card().to_string()
                }
            };
            let longest = told.split(|letter: char| !letter.is_ascii_digit()).map(str::len).max().unwrap_or(0);
            assert!(longest < 25, "{entry} with {value}: {told}");
        }
    }
    assert!(refused >= 60, "only {refused} of the scenes are refused, so few messages were seen");
    assert!(ran >= 30, "only {ran} of the scenes run, so few cards were seen");
}

/// All bodies behind a wall were pushed out of it. Its points are the remedy, not the places of bodies.
#[test]
fn a_wall_with_all_bodies_behind_it_is_told_to_be_turned() {
    for (left, right, turned) in [("(-5, 0)", "(5, 0)", true), ("(5, 0)", "(-5, 0)", false)] {
        let text = format!(
            "Scene(format: 1, clock: (duration: 0.2), walls: [(name: \"floor\", left: {left}, right: {right})],
                bodies: [(name: \"a\", at: (0, 0.1), atoms: Disc(radius: 0.1)), (name: \"b\", at: (0, 0.2), atoms: Disc(radius: 0.1))])"
        );
        let mut simulation = Simulation::load(&Source::new("wall.ron", text)).unwrap();
        simulation.run_to_end().unwrap();
        let verdict = simulation.card().verdict;
        assert!(verdict.contains("overlap at the start"), "{verdict}");
        assert_eq!(verdict.contains("the points of `floor` in the other order"), turned, "{verdict}");
    }
}

/// Bodies with one centre have no direction in which contacts push, so places become NaN. No joint is blamed for that: the overlap is named.
#[test]
fn bodies_in_each_other_are_named_and_not_their_joints() {
    for clock in ["method: Dop853, tick: 1e-3", "method: Dop853, tick: 0.02", "method: RungeKutta4, tick: 5e-3"] {
        let text = format!(
            "Scene(format: 1, clock: (duration: 1, {clock}), gravity: (0, -9.81), contacts: Penalty(tangential: Exact),
                materials: {{ \"m\": (friction: (static: 0.5, dynamic: 0.3), restitution: 0) }},
                walls: [(name: \"f\", left: (20, 0), right: (-20, 0), material: \"m\")],
                bodies: [(name: \"c\", at: (0, 0.1), mass: 1, inertia: 0.01, atoms: Disc(radius: 0.02)),
                         (name: \"h\", at: (0, 0.1), mass: 0.5, inertia: 0.005, atoms: Disc(radius: 0.02)),
                         (name: \"w\", at: (0, 0.1), mass: 1, atoms: Disc(radius: 0.1), material: \"m\")],
                joints: [Prismatic(name: \"p\", a: World, b: \"c\", axis: (1, 0)),
                         Prismatic(name: \"q\", a: \"c\", b: \"h\", axis: (0, 1)), Revolute(name: \"r\", a: \"h\", b: \"w\", friction: 0.02)])"
        );
        let mut simulation = Simulation::load(&Source::new("joints.ron", text)).unwrap();
        simulation.run_to_end().unwrap_err();
        let verdict = simulation.card().verdict;
        assert!(verdict.contains("`c` and `w` overlap at the start"), "{clock}: {verdict}");
        assert!(!verdict.contains("does not close"), "{clock}: {verdict}");
    }
}
