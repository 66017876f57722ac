//! The hashes of scenes in `pinned_methods.txt` are those under methods of several stages, with located events and
//! under a tolerance. So no change of a result goes unnoticed under any of them.
//!
//! Tolerance: none. Not tested: whether a result is right, which the laws do. Scenes of many bodies are run for a short time.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use jostle::scene::Source;
use jostle::simulation::Overrides;
use jostle::{Simulation, world::hash::state_hash};

use super::pinned::{compare, in_repository};
use crate::part;

/// Ways in which each scene is run: a word, method and tolerance.
pub(super) const WAYS: [(&str, Option<&str>, Option<f64>); 4] = [
    ("rk4", Some("RungeKutta4"), None),
    ("dop853", Some("Dop853"), None),
    ("midpoint", Some("ImplicitMidpoint"), None),
    ("1e-3", None, Some(1e-3)),
];

/// Seconds of scenes with at most so many atoms.
const TIMES: [(usize, f64); 3] = [(30, 1.0), (300, 0.1), (3000, 0.001)];
/// A tolerance and an implicit method are for few bodies.
const FEW: usize = 30;
/// A tick in s that is short.
const SHORT: f64 = 4e-5;

pub(super) fn scenes() -> Vec<PathBuf> {
    let of = |folder: &str| std::fs::read_dir(in_repository(folder)).unwrap().map(|entry| entry.unwrap().path());
    let benchmarks = ["clumps", "dense_1k", "few_awake", "gas_1k", "pyramid"];
    let all = of("scenes").chain(of("scenes/tour"));
    let mut all: Vec<PathBuf> = all.filter(|path| path.extension().is_some_and(|ending| ending == "ron")).collect();
    all.extend(benchmarks.map(|name| in_repository(&format!("scenes/benchmarks/{name}.ron"))));
    all.sort();
    all
}

/// Whether a scene asks for a tolerance, under which a method of order 2 takes minutes to find its tick where balls collide.
fn asks_for_tolerance(source: &Source) -> bool {
    source.text.contains("tolerance:")
}

/// How a scene is run in one of the ways, for a short time; not at all if it has too many bodies for it.
pub(super) fn overrides(path: &Path, method: Option<&str>, tolerance: Option<f64>) -> Option<Overrides> {
    let source = Source::read(path).unwrap();
    let plain = Simulation::load_with(&source, &Overrides { untried: true, ..Overrides::default() }, |_| {}).unwrap();
    let atoms = plain.bodies().atom_count();
    let implicit = method == Some("ImplicitMidpoint");
    if (tolerance.is_some() || implicit) && atoms > FEW || implicit && asks_for_tolerance(&source) {
        return None;
    }
    let long = TIMES.iter().find(|(most, _)| atoms <= *most)?.1;
    // Stiff heaps whose rest is solved for at each evaluation of a short tick.
    let time = if atoms > FEW && plain.clock().dt < SHORT { 0.1 * long } else { long };
    let duration = Some(time.min(plain.ticks() as f64 * plain.clock().dt));
    Some(Overrides { method: method.map(str::to_owned), tolerance, duration, ..Overrides::default() })
}

/// How a scene is run in its own way for so many seconds at most; less if it has many bodies.
pub(super) fn short(path: &Path, most: f64) -> Overrides {
    let source = Source::read(path).unwrap();
    let plain = Simulation::load_with(&source, &Overrides { untried: true, ..Overrides::default() }, |_| {}).unwrap();
    let time = if plain.bodies().atom_count() > 3000 { 0.05 } else { most };
    let duration = Some(time.min(plain.ticks() as f64 * plain.clock().dt));
    Overrides { duration, ..Overrides::default() }
}

/// The hash of a run, or why there is none.
fn hash(path: &Path, method: Option<&str>, tolerance: Option<f64>) -> Option<String> {
    let (source, overrides) = (Source::read(path).unwrap(), overrides(path, method, tolerance)?);
    let mut simulation = match Simulation::load_with(&source, &overrides, |_| {}) {
        Ok(simulation) => simulation,
        Err(_) => return Some("refused".to_owned()),
    };
    Some(match simulation.run_to_end() {
        Ok(()) => format!("{:016x}", state_hash(simulation.bodies())),
        Err(_) => "failed".to_owned(),
    })
}

#[test]
fn scenes_end_in_the_hashes_that_are_written_down_under_every_kind_of_method() {
    let scenes = part::of(scenes());
    let mut new = BTreeMap::new();
    for path in &scenes {
        let name = path.file_stem().unwrap().to_str().unwrap();
        for (word, method, tolerance) in WAYS {
            if let Some(hash) = hash(path, method, tolerance) {
                new.insert(format!("{name}/{word}"), hash);
            }
        }
    }
    assert!(new.values().filter(|hash| hash.len() == 16).count() > part::least(60), "{new:?}");
    let names: Vec<&str> = scenes.iter().map(|path| path.file_stem().unwrap().to_str().unwrap()).collect();
    compare("pinned_methods", &new, |name| name.split('/').next().is_some_and(|scene| names.contains(&scene)));
}
