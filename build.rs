//! Tells the program the files in which Git keeps the commit that is checked out.
//!
//! The program reads these files itself. A change that starts this script anew would build the package anew too.

use std::path::{Path, PathBuf};

fn main() {
    println!("cargo:rerun-if-changed=build.rs");
    let root = PathBuf::from(std::env::var_os("CARGO_MANIFEST_DIR").expect("cargo sets it"));
    let made = PathBuf::from(std::env::var_os("OUT_DIR").expect("cargo sets it"));
    let folder = git_folder(&root.join(".git"));
    // Git writes this file once. Without it there is no folder of Git any more.
    if let Some(sign) = folder.as_ref().map(|folder| folder.join("description")).filter(|sign| sign.exists()) {
        println!("cargo:rerun-if-changed={}", sign.display());
    }
    for (variable, file) in [("JOSTLE_GIT_HEAD", "HEAD"), ("JOSTLE_GIT_LOG", "logs/HEAD")] {
        let found = folder.as_ref().map(|folder| folder.join(file)).filter(|path| path.exists());
        let path = found.unwrap_or_else(|| empty(&made.join("nothing")));
        println!("cargo:rustc-env={variable}={}", path.display());
    }
}

/// The folder itself, or the one that a file names.
fn git_folder(at: &Path) -> Option<PathBuf> {
    if at.is_dir() {
        return Some(at.to_owned());
    }
    let told = std::fs::read_to_string(at).ok()?;
    Some(at.parent()?.join(told.strip_prefix("gitdir: ")?.trim()))
}

/// Makes an empty file, which takes the place of one that Git does not keep.
fn empty(path: &Path) -> PathBuf {
    std::fs::write(path, "").expect("cargo's folder can be written");
    path.to_owned()
}
