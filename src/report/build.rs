//! Passes the version of the compiler to the report.

use std::process::Command;

fn main() {
    println!("cargo:rerun-if-changed=build.rs");
    println!("cargo:rustc-env=JOSTLE_RUSTC={}", compiler().unwrap_or_else(|| "unknown".to_owned()));
}

/// The version of the compiler.
fn compiler() -> Option<String> {
    let told = Command::new(std::env::var_os("RUSTC")?).arg("--version").output().ok()?;
    Some(String::from_utf8(told.stdout).ok()?.trim().trim_start_matches("rustc ").to_owned())
}
