//! A short hunt, as a test. Not tested: what a long one finds.
#![cfg(target_os = "linux")]

use std::path::Path;
use std::process::Command;

#[test]
fn mutants_of_ten_seconds_break_no_promise() {
    let findings = Path::new(env!("CARGO_TARGET_TMPDIR")).join("findings");
    if findings.exists() {
        std::fs::remove_dir_all(&findings).expect("the findings of the last time go");
    }
    let mut hunt = Command::new(env!("CARGO_BIN_EXE_jostle_fuzz"));
    let ended = hunt.args(["--seconds", "10", "--out"]).arg(&findings).status().expect("the hunt begins");
    assert!(ended.success(), "the scenes are in {}", findings.display());
}
