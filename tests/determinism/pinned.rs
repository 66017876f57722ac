//! The state hash at the end of each shipped scene stands in `pinned.txt`. So no change of a result goes unnoticed, and
//! a commit explains the change of each hash.
//!
//! Tolerance: none. Not tested: whether a result is right, which the laws and the expectations of the scenes do.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use jostle::scene::Source;
use jostle::{Simulation, world::hash::state_hash};

use crate::part;

/// Set to anything, it makes the test write the hashes down in place of comparing them.
const REWRITE: &str = "JOSTLE_REWRITE_HASHES";

pub(super) fn in_repository(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(path)
}

/// Name and final hash of each scene that comes with the program.
fn present() -> BTreeMap<String, String> {
    let entries = std::fs::read_dir(in_repository("scenes")).unwrap().map(|entry| entry.unwrap().path());
    let scenes: Vec<PathBuf> = entries.filter(|path| path.extension().is_some_and(|ending| ending == "ron")).collect();
    std::thread::scope(|scope| {
        let run = |path: &PathBuf| {
            let mut simulation = Simulation::load(&Source::read(path).unwrap()).unwrap();
            simulation.run_to_end().unwrap();
            format!("{:016x}", state_hash(simulation.bodies()))
        };
        let name = |path: &PathBuf| path.file_stem().unwrap().to_str().unwrap().to_owned();
        let runs: Vec<_> = scenes.iter().map(|path| (name(path), scope.spawn(move || run(path)))).collect();
        runs.into_iter().map(|(name, run)| (name, run.join().unwrap())).collect()
    })
}

fn written(text: &str) -> BTreeMap<String, String> {
    let words = text.lines().filter_map(|line| line.split_once(' '));
    words.map(|(name, hash)| (name.to_owned(), hash.trim().to_owned())).collect()
}

/// The scenes whose hashes differ, a line each; empty if none do.
fn differences(old: &BTreeMap<String, String>, new: &BTreeMap<String, String>) -> String {
    let names: std::collections::BTreeSet<&String> = old.keys().chain(new.keys()).collect();
    let of = |hashes: &BTreeMap<String, String>, name: &String| hashes.get(name).map_or("-", |hash| hash).to_owned();
    let changed = names.into_iter().filter(|name| old.get(*name) != new.get(*name));
    changed.map(|name| format!("  {name:32}{:>18}{:>18}\n", of(old, name), of(new, name))).collect()
}

/// Compares hashes with those written down in a file of this folder, or writes them down. `run`: whether a name is among those that
/// were run.
pub(super) fn compare(file: &str, new: &BTreeMap<String, String>, run: impl Fn(&str) -> bool) {
    let path = in_repository(&format!("tests/determinism/{file}.txt"));
    if std::env::var_os(REWRITE).is_some() {
        assert!(part::is_all(), "only all hashes together are written down");
        let lines: String = new.iter().map(|(name, hash)| format!("{name:32}{hash}\n")).collect();
        std::fs::write(path, lines).unwrap();
        return;
    }
    let mut old = written(&std::fs::read_to_string(path).unwrap());
    old.retain(|name, _| run(name));
    let differing = differences(&old, new);
    assert!(
        differing.is_empty(),
        "these scenes no longer end in the same state:\n\n  {:32}{:>18}{:>18}\n{differing}\n\
         If that is meant, write the new hashes down, and explain the change in the commit that makes it:\n\n  \
         {REWRITE}=1 cargo test --test main pinned\n",
        "scene",
        "written down",
        "now"
    );
}

#[test]
fn shipped_scenes_end_in_the_hashes_that_are_written_down() {
    compare("pinned", &present(), |_| true);
}

/// The comparison must be able to fail: for another hash, a scene without one, and a hash without its scene.
#[test]
fn a_changed_a_new_and_a_lost_scene_are_told() {
    let old = written("bounce  0001\nkepler  0002\nlost    0003\n");
    let new = written("bounce  0001\nkepler  000f\nfound   0004\n");
    let told = differences(&old, &new);
    let words: Vec<Vec<&str>> = told.lines().map(|line| line.split_whitespace().collect()).collect();
    assert_eq!(words, [["found", "-", "0004"], ["kepler", "0002", "000f"], ["lost", "0003", "-"]]);
}
