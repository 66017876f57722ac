//! `fmt`: the standard layout changes the look of a scene, never its meaning.

use std::path::{Path, PathBuf};
use std::process::Stdio;

use jostle::scene::Source;
use jostle::simulation::Overrides;
use jostle::{Simulation, SimulationExt};

use super::harness::{FALL, Folder};

/// All scenes below a folder of the repository.
fn scenes_below(folder: &str) -> Vec<PathBuf> {
    let mut found = Vec::new();
    let mut folders = vec![Path::new(env!("CARGO_MANIFEST_DIR")).join(folder)];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|ending| ending == "ron") {
                found.push(path);
            }
        }
    }
    found.sort();
    found
}

/// The words, numbers and texts of a scene as a bag: what a layout may move, but neither lose nor change.
fn pieces(text: &str) -> Vec<String> {
    let mut spread = String::new();
    for letter in text.chars() {
        match letter {
            ',' => spread.push(' '),
            '(' | ')' | '[' | ']' | '{' | '}' | ':' => spread.extend([' ', letter, ' ']),
            _ => spread.push(letter),
        }
    }
    let mut pieces: Vec<String> = spread.split_whitespace().map(str::to_owned).collect();
    pieces.sort();
    pieces
}

/// The comments in lines of their own or at the ends of lines, in order.
fn comments(text: &str) -> Vec<String> {
    text.lines().filter_map(|line| line.find("//").map(|start| line[start..].trim_end().to_owned())).collect()
}

/// The first ten ticks, with what they end in and what the scene expects.
fn state(source: &Source) -> String {
    // A tolerance would be tried: a layout cannot change only that.
    let overrides = Overrides { untried: true, ..Overrides::default() };
    match Simulation::load_with(source, &overrides, |_| {}) {
        Ok(mut simulation) => {
            let run = simulation.run_to_tick(10);
            let outcomes = simulation.outcomes().len();
            format!("{run:?} {} {outcomes} {:?}", simulation.card().hash, simulation.header().title)
        }
        Err(errors) => {
            let mut messages: Vec<&str> = errors.errors().iter().map(|error| error.message.as_str()).collect();
            messages.sort_unstable();
            format!("{messages:?}")
        }
    }
}

/// All shipped scenes, and all wrong ones whose brackets are in order: their mistakes stay the same.
#[test]
fn a_layout_changes_no_meaning_and_nothing_twice() {
    let folder = Folder::new("fmt_all");
    let mut tried = 0;
    for path in scenes_below("scenes").into_iter().chain(scenes_below("tests")) {
        let Ok(source) = Source::read(&path) else { continue };
        std::fs::write(folder.path("a.ron"), &source.text).unwrap();
        let code = folder.jostle("fmt a.ron").code;
        let text = String::from_utf8(folder.read("a.ron")).unwrap();
        if code != Some(0) {
            assert_eq!(text, source.text, "{} could not be read and was changed", path.display());
            continue;
        }
        tried += 1;
        let after = Source { text: text.clone(), ..source.clone() };
        assert_eq!(state(&after), state(&source), "{}", path.display());
        assert_eq!(pieces(&text), pieces(&source.text), "{}", path.display());
        let (mut before, mut now) = (comments(&source.text), comments(&text));
        before.sort();
        now.sort();
        assert_eq!(now, before, "{}", path.display());
        folder.jostle("fmt --check a.ron").code(0);
    }
    assert!(tried > 100, "{tried}");
}

#[test]
fn shipped_scenes_are_in_the_standard_layout() {
    let folder = Folder::new("fmt_shipped");
    for path in scenes_below("scenes").into_iter().chain(scenes_below("assets/templates")) {
        let ended = folder.jostle(&format!("fmt --check {}", path.display())).code(0);
        assert_eq!(ended.out, "");
    }
}

#[test]
fn a_file_that_is_in_order_is_not_written() {
    let folder = Folder::new("fmt_untouched").with("fall.ron", FALL).with("crooked.ron", FALL.replace("    ", "\t"));
    folder.jostle("fmt fall.ron crooked.ron").code(0);
    assert_eq!(folder.read("fall.ron"), folder.read("crooked.ron"));
    let before = std::fs::metadata(folder.path("fall.ron")).unwrap().modified().unwrap();
    folder.jostle("fmt fall.ron").code(0);
    assert_eq!(std::fs::metadata(folder.path("fall.ron")).unwrap().modified().unwrap(), before);
    assert_eq!(folder.names(), ["crooked.ron", "fall.ron"]);
}

#[test]
fn what_is_not_in_order_is_named() {
    let crooked = FALL.replace("gravity: (0, -9.81)", "gravity:(0,-9.81 )");
    let folder = Folder::new("fmt_check").with("crooked.ron", &crooked).with("wrong.ron", "Scene(format: 1");
    let ended = folder.jostle("fmt --check crooked.ron").code(1);
    assert_eq!(ended.out, "crooked.ron:5: not in the standard layout\n");
    assert_eq!(folder.read("crooked.ron"), crooked.as_bytes());
    folder.jostle("fmt wrong.ron").code(1).says("wrong.ron:1:");
    folder.jostle("fmt nowhere.ron").code(2).says("there is no file");
    folder.jostle("fmt").code(2);
    folder.jostle("fmt - crooked.ron").code(2).says("takes no files beside it");
}

#[cfg(unix)]
#[test]
fn links_and_permissions_stay() {
    use std::os::unix::fs::PermissionsExt;
    let folder = Folder::new("fmt_links").with("real/fall.ron", FALL.replace("    ", "  "));
    std::os::unix::fs::symlink("real/fall.ron", folder.path("link.ron")).unwrap();
    std::fs::set_permissions(folder.path("real/fall.ron"), std::fs::Permissions::from_mode(0o640)).unwrap();
    folder.jostle("fmt link.ron").code(0);
    assert!(std::fs::symlink_metadata(folder.path("link.ron")).unwrap().is_symlink());
    let real = std::fs::metadata(folder.path("real/fall.ron")).unwrap();
    assert_eq!(real.permissions().mode() & 0o777, 0o640);
    assert!(String::from_utf8(folder.read("real/fall.ron")).unwrap().contains("\n    format: 1,"));
}

#[test]
fn standard_input_goes_to_standard_output() {
    let folder = Folder::new("fmt_stdin");
    let mut child = folder.command("fmt -").stdin(Stdio::piped()).stdout(Stdio::piped()).spawn().unwrap();
    std::io::Write::write_all(&mut child.stdin.take().unwrap(), b"Scene(format:1,\n\n\nclock:(duration:2))").unwrap();
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(0));
    assert_eq!(String::from_utf8(output.stdout).unwrap(), "Scene(\n    format: 1,\n\n    clock: (duration: 2),\n)\n");
}
