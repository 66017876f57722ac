//! Scenes that ask for too much end in a sentence within seconds, and nothing comes back by the megabyte.

use std::time::{Duration, Instant};

use super::harness::Folder;

const CLOCK: &str = "format: 1, clock: (duration: 0.001, tick: 0.001)";
const BALL: &str = "(name: \"ball\", at: (0, 0), atoms: Disc(radius: 0.1))";

/// Runs `check --run` with 6 GB of memory; standard error of what has to end with 1.
fn refused(name: &str, scene: &str) -> String {
    let folder = Folder::new(&format!("budget_{name}")).with("scene.ron", scene);
    let script = format!("ulimit -v 6000000; exec {} check --run scene.ron", env!("CARGO_BIN_EXE_jostle"));
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
    assert!(said.contains("pairs of atoms or more overlap: so many contacts do not fit into memory"), "{said}");
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
            said.contains("here patterns and names have become too many to be compared") || name == "strange",
            "{said}"
        );
    }
}

#[cfg(target_os = "linux")]
#[test]
fn a_region_too_narrow_for_chance_is_refused() {
    // A thousandth of the box about it.
    let strip = "((0, 0), (1000, 1000), (999.5, 1000), (0, 0.5))";
    let fill = format!("fill: [(name: \"g\", atoms: Disc(radius: 0.0001), count: 1000000, within: {strip}, seed: 7)]");
    let said = refused("sliver", &format!("Scene({CLOCK}, {fill})"));
    assert!(said.contains("So little is hard to meet by chance: use a wider region"), "{said}");
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
