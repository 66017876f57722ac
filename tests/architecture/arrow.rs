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

/// A file of the room of that name; `.` is the package itself.
fn read(room: &str, file: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(room).join(file);
    fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// The crates that a manifest names as dependencies of the library.
fn dependencies(manifest: &str) -> Vec<&str> {
    let own = manifest.split("\n[dependencies]\n").nth(1).unwrap();
    let own = own.split("\n[").next().unwrap();
    own.lines().filter_map(|line| line.split(['.', ' ', '=']).next()).filter(|name| !name.is_empty()).collect()
}

/// The compiler keeps the arrow between rooms; here stands which arrows there may be.
#[test]
fn each_room_uses_those_below_it() {
    for (room, below) in [
        ("simd", &[][..]),
        ("language", &[]),
        ("frames", &["language"]),
        ("shapes", &[]),
        ("engine", &["frames", "language", "shapes", "simd"]),
        ("film", &["frames", "language"]),
        ("report", &["engine", "film", "frames", "language", "simd"]),
    ] {
        let manifest = read("src", &format!("{room}/Cargo.toml"));
        let used: Vec<&str> =
            dependencies(&manifest).into_iter().filter_map(|name| name.strip_prefix("jostle_")).collect();
        assert_eq!(used, below, "{room}");
        let knows_ecs = dependencies(&manifest).iter().any(|name| name.starts_with("bevy_"));
        assert_eq!(knows_ecs, ["engine", "report"].contains(&room), "{room}");
    }
}

/// The modules of a room, in the order in which its `lib.rs` lists them.
fn listed(room: &str) -> Vec<String> {
    let text = read("src", &format!("{room}/lib.rs"));
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

/// No module of a room uses one that is listed after it: so there is no ring of them.
#[test]
fn nothing_points_back() {
    for (room, modules, most) in [("engine", 15, 200), ("film", 2, 40)] {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src").join(room);
        let files: Vec<(String, String)> = rust_files(&root)
            .into_iter()
            .map(|path| (path.strip_prefix(&root).unwrap().to_str().unwrap().to_owned(), path))
            .filter(|(file, _)| !file.split('/').any(|part| part == "tests" || part == "tests.rs"))
            .map(|(file, path)| (file, fs::read_to_string(path).unwrap()))
            .collect();
        let listed = listed(room);
        assert!(
            listed.len() >= modules && files.len() > most,
            "{listed:?}, {}: the test looks at too little",
            files.len()
        );
        assert_eq!(arrows_back(&files, &listed), Vec::<String>::new());
    }
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
