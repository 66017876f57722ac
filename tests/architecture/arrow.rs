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

/// The modules of the library, in the order in which `lib.rs` lists them.
fn listed() -> Vec<String> {
    let text = fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("src/lib.rs")).unwrap();
    let names = text.lines().filter_map(|line| line.split_once("mod ")?.1.strip_suffix(';').map(str::to_owned));
    names.collect()
}

/// The code of a file without comments, and without tests that stand at its end.
fn code(text: &str) -> String {
    let own = text.split("#[cfg(test)]\nmod tests {").next().unwrap();
    own.lines().map(|line| line.split("//").next().unwrap()).collect::<Vec<_>>().join("\n")
}

/// The modules that code names by `crate::`, alone and in braces.
fn named(code: &str) -> Vec<String> {
    let word = |text: &str| text.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect::<String>();
    let mut found = Vec::new();
    for after in code.split("crate::").skip(1) {
        let Some(inside) = after.strip_prefix('{') else {
            found.push(word(after));
            continue;
        };
        let mut depth = 1;
        found.push(word(inside.trim_start()));
        for (at, c) in inside.char_indices() {
            match c {
                '{' => depth += 1,
                '}' => depth -= 1,
                ',' if depth == 1 => found.push(word(inside[at + 1..].trim_start())),
                _ => {}
            }
            if depth == 0 {
                break;
            }
        }
    }
    // What `lib.rs` hands on under a name of its own.
    found.iter_mut().filter(|name| *name == "Simulation").for_each(|name| *name = "simulation".to_owned());
    found.retain(|name| !name.is_empty());
    found
}

/// Arrows between modules that point to one listed later. Each is a file and what it names.
fn arrows_back(files: &[(String, String)], listed: &[String]) -> Vec<String> {
    let rank = |name: &str| listed.iter().position(|known| known == name);
    let mut back = Vec::new();
    for (file, text) in files {
        let module = file.split('/').next().unwrap().trim_end_matches(".rs");
        let Some(own) = rank(module) else { continue };
        for name in named(&code(text)) {
            if rank(&name).is_some_and(|other| other > own) {
                back.push(format!("{file} uses crate::{name}"));
            }
        }
    }
    back
}

/// No module uses one that is listed after it: so there is no ring of them.
#[test]
fn nothing_points_back() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let files: Vec<(String, String)> = rust_files(&root)
        .into_iter()
        .map(|path| (path.strip_prefix(&root).unwrap().to_str().unwrap().to_owned(), path))
        .filter(|(file, _)| !file.split('/').any(|part| part == "tests" || part == "tests.rs"))
        .map(|(file, path)| (file, fs::read_to_string(path).unwrap()))
        .collect();
    let listed = listed();
    assert!(listed.len() > 20 && files.len() > 300, "{listed:?}, {} files: the test looks at too little", files.len());
    assert_eq!(arrows_back(&files, &listed), Vec::<String>::new());
}

/// The test can fail: it sees names alone, in braces and in paths, and passes over comments and tests.
#[test]
fn an_arrow_back_is_seen() {
    let listed = ["low", "middle", "high"].map(str::to_owned);
    let files = [
        ("low/a.rs", "use crate::high::B;"),
        ("low/b.rs", "use crate::{\n    low::{x, high},\n    middle,\n};"),
        ("middle.rs", "fn f() { crate::high::g() }\nuse crate::low;"),
        ("low/c.rs", "// crate::high\n#[cfg(test)]\nmod tests { use crate::high; }"),
    ]
    .map(|(file, text)| (file.to_owned(), text.to_owned()));
    let back = ["low/a.rs uses crate::high", "low/b.rs uses crate::middle", "middle.rs uses crate::high"];
    assert_eq!(arrows_back(&files, &listed), back);
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
