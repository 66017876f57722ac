//! The tour, `docs/tour.md`: ten steps, each a scene in `scenes/tour`.

use std::path::{Path, PathBuf};

use super::shipped::complaints;

/// A picture of the tour is at most this large, in bytes.
const LARGEST_PICTURE: u64 = 48_000;

fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

fn steps() -> Vec<PathBuf> {
    let entries = std::fs::read_dir(root().join("scenes/tour")).unwrap().map(|entry| entry.unwrap().path());
    let mut steps: Vec<PathBuf> = entries.collect();
    steps.sort();
    steps
}

fn text() -> String {
    std::fs::read_to_string(root().join("docs/tour.md")).unwrap()
}

/// The lines without the blanks around them; empty ones are left out.
fn lines(text: &str) -> Vec<&str> {
    text.lines().map(str::trim).filter(|line| !line.is_empty()).collect()
}

#[test]
fn every_step_of_the_tour_runs_and_holds_what_it_expects() {
    let steps = steps();
    assert_eq!(steps.len(), 10, "{steps:?}");
    let found: Vec<Vec<String>> = std::thread::scope(|scope| {
        let runs: Vec<_> = steps.iter().map(|path| scope.spawn(|| complaints(path))).collect();
        runs.into_iter().map(|run| run.join().unwrap()).collect()
    });
    let wrong: Vec<_> = steps.iter().zip(found).filter(|(_, complaints)| !complaints.is_empty()).collect();
    assert!(wrong.is_empty(), "{wrong:#?}");
}

/// Each piece of a scene in the text of a step stands in its file, line for line; what is not tested is whether the
/// words around it are true.
#[test]
fn the_text_of_each_step_shows_what_stands_in_its_scene() {
    let text = text();
    let parts: Vec<&str> = text.split("\n## ").skip(1).collect();
    let steps = steps();
    assert_eq!(parts.len(), steps.len());
    for (number, (part, file)) in parts.iter().zip(&steps).enumerate() {
        let name = file.file_name().unwrap().to_str().unwrap();
        assert!(name.starts_with(&format!("{:02}_", number + 1)), "{name}");
        assert!(part.starts_with(&format!("{} ", number + 1)), "{part}");
        assert!(part.contains(&format!("](../scenes/tour/{name})")), "{name} is not linked");
        assert!(part.contains(&format!(" scenes/tour/{name}")), "{name} is in no command");
        let scene = std::fs::read_to_string(file).unwrap();
        let scene = lines(&scene);
        let pieces: Vec<&str> = part.split("```ron\n").skip(1).filter_map(|rest| rest.split("```").next()).collect();
        assert!(!pieces.is_empty(), "{name} shows nothing");
        for piece in pieces {
            let wanted = lines(piece);
            assert!(scene.windows(wanted.len()).any(|window| window == wanted), "{name} has not\n{piece}");
        }
    }
}

#[test]
fn the_pictures_of_the_tour_are_there_and_small() {
    let text = text();
    let pictures: Vec<&str> = text.split("](tour/").skip(1).filter_map(|rest| rest.split(')').next()).collect();
    assert!(pictures.len() >= 7, "{pictures:?}");
    let folder = root().join("docs/tour");
    for picture in &pictures {
        let size = std::fs::metadata(Path::new(&folder).join(picture)).unwrap_or_else(|_| panic!("no {picture}")).len();
        assert!(size <= LARGEST_PICTURE, "{picture} has {size} bytes");
    }
    assert_eq!(std::fs::read_dir(folder).unwrap().count(), pictures.len(), "a picture is not shown");
}
