//! Every scene in `scenes/` loads, runs, stays finite and meets its expectations.

use jostle::SimulationExt;
use std::path::{Path, PathBuf};

use jostle::{Simulation, scene::Source};

fn scenes() -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes");
    let entries = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let mut scenes: Vec<PathBuf> =
        entries.filter(|path| path.extension().is_some_and(|ending| ending == "ron")).collect();
    scenes.sort();
    scenes
}

/// What is wrong with a scene; nothing if all is well.
pub(super) fn complaints(path: &Path) -> Vec<String> {
    let mut simulation = match Source::read(path).and_then(|source| Simulation::load(&source)) {
        Ok(simulation) => simulation,
        Err(errors) => return vec![errors.to_string()],
    };
    if let Err(failure) = simulation.run_to_end() {
        return vec![failure.to_string()];
    }
    let mut complaints = Vec::new();
    let bodies = simulation.bodies();
    let finite = (0..bodies.len()).all(|index| {
        bodies.position[index].is_finite()
            && bodies.velocity[index].is_finite()
            && bodies.angle[index].is_finite()
            && bodies.spin[index].is_finite()
    });
    if !finite {
        complaints.push("a body is not finite in the end".to_owned());
    }
    if !simulation.card().energy.residual.is_finite() {
        complaints.push("the energy residual is not finite".to_owned());
    }
    let outcomes = simulation.outcomes();
    if outcomes.is_empty() {
        complaints.push("the scene expects nothing".to_owned());
    }
    if simulation.header().title.is_none() {
        complaints.push("the scene has no title".to_owned());
    }
    let broken = outcomes.into_iter().filter(|outcome| !outcome.holds);
    complaints.extend(broken.map(|outcome| format!("{}: {}", outcome.text, outcome.measured)));
    complaints
}

/// Each scene states where the tolerances of its expectations come from. What is not tested here: that an
/// expectation fails when the engine is wrong.
#[test]
fn every_shipped_scene_runs_and_holds_what_it_expects() {
    let scenes = scenes();
    assert!(scenes.len() >= 7, "{scenes:?}");
    let found: Vec<Vec<String>> = std::thread::scope(|scope| {
        let runs: Vec<_> = scenes.iter().map(|path| scope.spawn(|| complaints(path))).collect();
        runs.into_iter().map(|run| run.join().unwrap()).collect()
    });
    let wrong: Vec<_> = scenes.iter().zip(found).filter(|(_, complaints)| !complaints.is_empty()).collect();
    assert!(wrong.is_empty(), "{wrong:#?}");
}
