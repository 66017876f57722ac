//! Tells the program what it is built from: the commit that is checked out, if that can be seen, and the compiler.

use std::path::{Path, PathBuf};
use std::process::Command;

fn main() {
    println!("cargo:rerun-if-changed=build.rs");
    println!("cargo:rerun-if-env-changed=JOSTLE_COMMIT");
    let commit = std::env::var("JOSTLE_COMMIT").ok().or_else(commit).unwrap_or_else(|| "unknown".to_owned());
    println!("cargo:rustc-env=JOSTLE_COMMIT={commit}");
    println!("cargo:rustc-env=JOSTLE_RUSTC={}", compiler().unwrap_or_else(|| "unknown".to_owned()));
}

/// The version of the compiler.
fn compiler() -> Option<String> {
    let told = Command::new(std::env::var_os("RUSTC")?).arg("--version").output().ok()?;
    Some(String::from_utf8(told.stdout).ok()?.trim().trim_start_matches("rustc ").to_owned())
}

/// The commit that is checked out, read from the files of Git. What is not committed it does not know.
fn commit() -> Option<String> {
    let root = PathBuf::from(std::env::var_os("CARGO_MANIFEST_DIR")?);
    let folder = git_folder(&root.join(".git"))?;
    let head = watched(&folder.join("HEAD"))?;
    let Some(name) = head.strip_prefix("ref: ") else { return Some(short(&head)) };
    // In a second working tree references lie in the folder of the first.
    let shared = std::fs::read_to_string(folder.join("commondir")).map_or(folder.clone(), |at| folder.join(at.trim()));
    if let Some(commit) = watched(&shared.join(name)) {
        return Some(short(&commit));
    }
    let packed = watched(&shared.join("packed-refs"))?;
    let line = packed.lines().find(|line| line.ends_with(name))?;
    Some(short(line))
}

/// The folder itself, or the one that a file names.
fn git_folder(at: &Path) -> Option<PathBuf> {
    if at.is_dir() {
        return Some(at.to_owned());
    }
    let told = std::fs::read_to_string(at).ok()?;
    Some(at.parent()?.join(told.strip_prefix("gitdir: ")?.trim()))
}

/// The text of a file, on whose change this is built anew.
fn watched(path: &Path) -> Option<String> {
    let text = std::fs::read_to_string(path).ok()?;
    println!("cargo:rerun-if-changed={}", path.display());
    Some(text.trim().to_owned())
}

fn short(commit: &str) -> String {
    commit.chars().take(12).collect()
}
