//! Scenes that ask for too much end in a sentence within seconds, and nothing comes back by the megabyte.

use std::time::{Duration, Instant};

use super::harness::Folder;

const CLOCK: &str = "format: 1, clock: (duration: 0.001, tick: 0.001)";
const BALL: &str = "(name: \"ball\", at: (0, 0), atoms: Disc(radius: 0.1))";

/// Runs `check --run` with 6 GB of memory; standard error of what has to end with 1.
fn refused(name: &str, scene: &str) -> String {
    refused_within(name, scene, 6_000_000)
}

/// The same with so many kB.
fn refused_within(name: &str, scene: &str, memory: u32) -> String {
    let folder = Folder::new(&format!("budget_{name}")).with("scene.ron", scene);
    let script = format!("ulimit -v {memory}; exec {} check --run scene.ron", env!("CARGO_BIN_EXE_jostle"));
    let start = Instant::now();
    let output =
        std::process::Command::new("bash").args(["-c", &script]).current_dir(folder.path("")).output().unwrap();
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(1), "{name}: {said:.2000}");
    assert!(start.elapsed() < Duration::from_secs(30), "{name}: {:?}", start.elapsed());
    assert!(said.starts_with("error: ") && said.len() < 50_000, "{name}: {} bytes: {said:.300}", said.len());
    said
}

#[cfg(target_os = "linux")]
#[test]
fn a_heap_of_more_pairs_than_memory_holds_is_refused() {
    let bodies = "Repeat(count: 30000, make: (name: \"b_{i}\", at: (0, 0), atoms: Disc(radius: 0.1)))";
    let said = refused("heap", &format!("Scene({CLOCK}, bodies: [{bodies}])"));
    assert!(said.contains("pairs of atoms overlap: so many contacts do not fit into memory"), "{said}");
}

/// Discs that all come to one place in a tick: nothing is known of it at the start.
#[cfg(target_os = "linux")]
#[test]
fn a_heap_that_comes_together_in_a_run_ends_it_before_memory_does() {
    let bodies = "Repeat(count: (100, 30), grid: (from: (-5, -2), step: (0.1, 0.1)), make: (name: \"b_{i}_{j}\", at: (\"x\", \"y\"),
        velocity: (\"-10 * x\", \"-10 * y\"), atoms: Disc(radius: 0.04)))";
    for method in ["VelocityVerlet", "SemiImplicitEuler", "RungeKutta4", "Dop853"] {
        let clock = format!("format: 1, clock: (duration: 1, tick: 0.1, method: {method}, events: PerTick)");
        let scene = format!("Scene({clock}, bodies: [{bodies}])");
        let folder = Folder::new(&format!("budget_cloud_{method}")).with("scene.ron", scene);
        let script = format!("ulimit -v 1500000; exec {} run --no-estimate scene.ron", env!("CARGO_BIN_EXE_jostle"));
        let start = Instant::now();
        let output =
            std::process::Command::new("bash").args(["-c", &script]).current_dir(folder.path("")).output().unwrap();
        let said = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(3), "{method}: {said:.2000}");
        assert!(start.elapsed() < Duration::from_secs(30), "{method}: {:?}", start.elapsed());
        let why = "error: scene.ron: the run went wrong: more than 524288 pairs of atoms lie near each other, most of them of `b_";
        assert!(said.contains(why) && said.contains("help: use fewer bodies"), "{method}: {said}");
    }
}

#[cfg(target_os = "linux")]
#[test]
fn a_run_that_would_be_tried_for_days_is_refused() {
    let pair =
        "(name: \"a\", at: (0, 0), atoms: Disc(radius: 0.1, mass: 1)), (name: \"b\", at: (1, 0), velocity: (0, 1),
        atoms: Disc(radius: 0.1, mass: 1))";
    let long =
        "format: 1, clock: (duration: 4294967296, tolerance: 1e-3), forces: [Attraction(constant: 1, softening: 0.1)]";
    let said = refused("endless", &format!("Scene({long}, bodies: [{pair}])"));
    assert!(said.contains("clock.duration") && said.contains("runs these"), "{said}");
}

#[cfg(target_os = "linux")]
#[test]
fn more_patterns_than_can_be_compared_are_refused() {
    let gas = "fill: [(name: \"g\", atoms: Disc(radius: 0.001), count: 20000, within: ((0, 0), (6, 6)), seed: 7)]";
    for (name, pattern) in [("fitting", "g_*N*"), ("strange", "p_N*_x_*")] {
        let patterns: Vec<String> = (0..2000).map(|n| format!("{:?}", pattern.replace('N', &n.to_string()))).collect();
        let forces = format!("forces: [Drag(linear: 0.1, of: [{}])]", patterns.join(", "));
        let said = refused(name, &format!("Scene({CLOCK}, {gas}, {forces})"));
        assert!(
            said.contains("names are compared with patterns more than 50000000 times") || name == "strange",
            "{said}"
        );
    }
}

/// Each entry of `fill` may ask for as many bodies as there may be in all.
#[cfg(target_os = "linux")]
#[test]
fn names_of_more_bodies_than_there_may_be_are_not_made() {
    for count in ["1e9", "1000000"] {
        let fill = format!(
            "fill: [Repeat(count: 100, make: (name: \"ball_{{i}}\", count: {count}, seed: 1, atoms: Disc(radius: 0.1),
                within: ((0, 0), (1, 1))))], sensors: [Pose(of: \"ball_99_*\")]"
        );
        let said = refused_within(&format!("names_{count}"), &format!("Scene({CLOCK}, {fill})"), 1_500_000);
        assert!(said.contains("1000000"), "{said}");
    }
}

#[cfg(target_os = "linux")]
#[test]
fn a_region_too_narrow_for_chance_is_refused() {
    // A thousandth of the box about it.
    let strip = "((0, 0), (1000, 1000), (999.5, 1000), (0, 0.5))";
    let fill = format!("fill: [(name: \"g\", atoms: Disc(radius: 0.0001), count: 1000000, within: {strip}, seed: 7)]");
    let said = refused("sliver", &format!("Scene({CLOCK}, {fill})"));
    assert!(said.contains("Chance hardly meets so narrow a region: use a wider one"), "{said}");
}

#[cfg(target_os = "linux")]
#[test]
fn what_stands_in_a_scene_does_not_come_back_by_the_megabyte() {
    let long = "x".repeat(3_000_000);
    for (name, sections) in [
        ("material", format!("bodies: [(name: \"b\", at: (0, 0), atoms: Disc(radius: 1), material: \"{long}\")]")),
        ("section", format!("{long}: 1, bodies: [{BALL}]")),
        ("name", format!("bodies: [(name: \"{long}\", at: (0, 0), atoms: Disc(radius: 1))]")),
        ("number", format!("bodies: [(name: \"b\", at: (0, 0), atoms: Disc(radius: \"{long}\"))]")),
        ("kind", format!("bodies: [(name: \"b\", at: (0, 0), atoms: {long}(radius: 1))]")),
        ("file", format!("include: [(file: \"{long}\", prefix: \"a\")], bodies: [{BALL}]")),
        ("theme", format!("look: (theme: \"{long}.ron\"), bodies: [{BALL}]")),
        ("channel", format!("bodies: [{BALL}], expect: [Channel(name: \"{long}\", below: 1)]")),
        ("pattern", format!("bodies: [{BALL}], forces: [Drag(linear: 1, of: [\"{long}\"])]")),
        ("template", format!("instances: [(of: \"{long}\", name: \"a\")], bodies: [{BALL}]")),
    ] {
        let scene = format!("Scene({CLOCK}, {sections})");
        refused(&format!("echo_{name}"), &scene);
        let folder = Folder::new(&format!("budget_echo_{name}_json")).with("scene.ron", scene);
        let ended = folder.jostle("check --json scene.ron").code(1);
        assert!(
            ended.out.len() + ended.err.len() < 50_000,
            "{name}: {} and {} bytes",
            ended.out.len(),
            ended.err.len()
        );
    }
}
