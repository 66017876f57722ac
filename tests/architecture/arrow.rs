//! The arrow: nothing points back.

use std::fs;
use std::path::{Path, PathBuf};

fn rust_files(folder: &Path) -> Vec<PathBuf> {
    let mut files = Vec::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            files.extend(rust_files(&path));
        } else if path.extension().is_some_and(|ending| ending == "rs") {
            files.push(path);
        }
    }
    files
}

/// Lines of code (comments left out) below `folder` that hold one of `words`.
fn lines_with(folder: &str, words: &[&str]) -> Vec<String> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("src").join(folder);
    let files = rust_files(&folder);
    assert!(!files.is_empty(), "{} holds no code: the test looks at nothing", folder.display());
    let mut found = Vec::new();
    for file in files {
        for line in fs::read_to_string(&file).unwrap().lines() {
            if !line.trim_start().starts_with("//") && words.iter().any(|word| line.contains(word)) {
                found.push(format!("{}: {line}", file.display()));
            }
        }
    }
    found
}

#[test]
fn pictures_and_files_know_no_ecs() {
    for folder in ["raster", "output"] {
        let found = lines_with(folder, &["bevy_", "crate::world", "crate::tick", "crate::simulation"]);
        assert_eq!(found, Vec::<String>::new());
    }
}

#[test]
fn physical_models_know_no_pictures() {
    for folder in ["forces", "contacts", "integrate", "tick", "sensors"] {
        let found = lines_with(folder, &["crate::raster", "crate::output", "crate::record", "crate::cli"]);
        assert_eq!(found, Vec::<String>::new());
    }
}

#[test]
fn nobody_uses_the_command_line() {
    for folder in ["scene", "world", "shapes", "record", "report", "expect"] {
        assert_eq!(lines_with(folder, &["crate::cli"]), Vec::<String>::new());
    }
}

#[test]
fn no_file_is_longer_than_six_hundred_lines() {
    for folder in ["src", "tests"] {
        for file in rust_files(&Path::new(env!("CARGO_MANIFEST_DIR")).join(folder)) {
            let lines = fs::read_to_string(&file).unwrap().lines().count();
            assert!(lines <= 600, "{} has {lines} lines", file.display());
        }
    }
}
