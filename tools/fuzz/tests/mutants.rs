//! Short hunts, as tests. Not tested: what a long one finds.
#![cfg(target_os = "linux")]

use std::path::Path;
use std::process::Command;

/// Hunts for so many seconds among mutants of one kind.
fn hunt(kind: &str, seconds: u64) {
    let findings = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("findings_{kind}"));
    if findings.exists() {
        std::fs::remove_dir_all(&findings).expect("the findings of the last time go");
    }
    let mut hunt = Command::new(env!("CARGO_BIN_EXE_jostle_fuzz"));
    let hunt = hunt.args(["--kind", kind, "--seconds", &seconds.to_string(), "--out"]).arg(&findings);
    let ended = hunt.status().expect("the hunt begins");
    assert!(ended.success(), "the mutants are in {}", findings.display());
}

#[test]
fn mutated_scenes_break_no_promise() {
    hunt("scenes", 10);
}

#[test]
fn mutated_files_beside_a_scene_break_no_promise() {
    ["svg", "csv", "png"].into_iter().for_each(|kind| hunt(kind, 2));
}

#[test]
fn mutated_snapshots_break_no_promise() {
    hunt("snapshots", 4);
}
