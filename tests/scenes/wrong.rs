//! Every wrong scene in `tests/wrong_scenes` is refused with exactly the message in the file beside it.
//!
//! Each file holds one mistake (some hold several, to show their common message) and is named by it. `NAME.txt` is what
//! `jostle check` prints for `NAME.ron`. Tolerance: none. Not tested: files that cannot be read as text, which the
//! tests of the command line cover. Mistakes in sections of plugins are covered by `src/engine/scene/tests`.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use jostle::scene::{SceneErrors, Source};
use jostle::simulation::Simulation;

/// Set to anything, it makes the test write the messages down in place of comparing them.
const REWRITE: &str = "JOSTLE_REWRITE_MESSAGES";

fn tree() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/wrong_scenes")
}

/// All files of the tree with this ending, without it.
fn files(ending: &str) -> BTreeSet<PathBuf> {
    let mut found = BTreeSet::new();
    let mut folders = vec![tree()];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|found| found == ending) {
                found.insert(path.with_extension(""));
            }
        }
    }
    found
}

/// What is wrong with a scene of the tree; `None` if it is taken as good.
fn refused(scene: &Path) -> Option<SceneErrors> {
    let path = scene.with_extension("ron");
    let name = path.file_name().unwrap().to_str().unwrap();
    Simulation::load(&Source::new(name, std::fs::read_to_string(&path).unwrap())).err()
}

/// The name of a scene within the tree.
fn short(scene: &Path) -> String {
    scene.strip_prefix(tree()).unwrap().display().to_string()
}

#[test]
fn wrong_scenes_are_refused_with_the_messages_that_are_written_down() {
    let scenes = files("ron");
    assert!(scenes.len() >= 200, "only {} wrong scenes are left", scenes.len());
    let mut wrong = BTreeMap::new();
    for scene in &scenes {
        let Some(errors) = refused(scene) else {
            wrong.insert(short(scene), "is taken as good".to_owned());
            continue;
        };
        let (told, beside) = (errors.to_string(), scene.with_extension("txt"));
        if std::env::var_os(REWRITE).is_some() {
            std::fs::write(beside, told).unwrap();
            continue;
        }
        let written = std::fs::read_to_string(beside).unwrap_or_default();
        if told != written {
            wrong.insert(short(scene), format!("--- written down\n{written}\n--- now\n{told}"));
        }
    }
    for alone in files("txt").symmetric_difference(&scenes) {
        wrong
            .entry(short(alone))
            .or_insert_with(|| "is a message without a scene, or a scene without a message".into());
    }
    let list: String = wrong.iter().map(|(scene, what)| format!("\n== {scene}: {what}\n")).collect();
    assert!(
        list.is_empty(),
        "{list}\nIf that is meant, write the messages down, read them as a newcomer would, and explain the change in the \
         commit that makes it:\n\n  {REWRITE}=1 cargo test --test main wrong_scenes\n"
    );
}

/// What a newcomer needs of a message: where (line and column, and the path unless it is the scene as a whole), what is
/// wrong, and what would be right: a help, or an expectation in the message itself.
#[test]
fn wrong_scenes_are_told_with_place_and_remedy() {
    let remedied = ["must ", "expected "];
    let mut poor = Vec::new();
    for scene in files("ron") {
        for error in refused(&scene).iter().flat_map(|errors| errors.errors().to_vec()) {
            let placed = error.line.is_some() && error.column.is_some();
            if !placed || error.help.is_none() && !remedied.iter().any(|words| error.message.contains(words)) {
                poor.push(format!("{}: {}: {}", short(&scene), error.path, error.message));
            }
        }
    }
    assert!(poor.is_empty(), "no place or no remedy in\n  {}", poor.join("\n  "));
}
