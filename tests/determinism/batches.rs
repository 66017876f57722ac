//! Batches, sensors, layers and frames change no bit of a run.
//!
//! Law: a run is a function of its scene. Tolerance: none, hashes are compared. All shipped scenes are run, for as many ticks as six
//! thousand visits of bodies take. With `JOSTLE_WHOLE_BATCHES` set they are run to their ends.
//!
//! Not tested: batches whose lengths depend on what a reader of the world writes.

use std::path::{Path, PathBuf};

use jostle::Simulation;
use jostle::record::layers::WORDS;
use jostle::scene::Source;
use jostle::simulation::{Overrides, Recorder};
use jostle::world::hash::state_hash;

use super::pinned::in_repository;

/// Set to anything, it makes the test run each scene to its end.
const WHOLE: &str = "JOSTLE_WHOLE_BATCHES";
/// Visits of bodies in a run, and the fewest and most ticks.
const VISITS: u64 = 6_000;
const TICKS: std::ops::RangeInclusive<u64> = 12..=120;

/// Scenes with more bodies have sensors of one kind.
const CROWD: u64 = 300;

/// Sensors of each kind that looks at ticks or at contacts, for all bodies of a scene.
const SENSORS: [&str; 6] = [
    "Contacts(of: \"*\")",
    "Counter(name: \"k_touch\", of: \"*\", touching: \"*\")",
    "Counter(name: \"k_gate\", of: \"*\", gate: ((-0.1, 0.05), (0.1, 0.06)))",
    "Flow(name: \"k_flow\", of: \"*\", gate: ((-0.1, 0.05), (0.1, 0.06)))",
    "Period(name: \"k_period\", of: \"energy.kinetic\", crossing: 0.1)",
    "Mean(name: \"k_mean\", of: \"*\", quantity: \"contacts\")",
];

/// Uniform numbers from a seed (Marsaglia 2003, xorshift).
struct Draw(u64);

impl Draw {
    fn up_to(&mut self, most: u64) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        1 + self.0 % most
    }
}

/// How a run is cut.
#[derive(Clone, Copy, Debug)]
enum Cut {
    Whole,
    Even(u64),
    Random(u64),
    /// Frames with all layers, at random moments that lie on no tick.
    Frames(u64),
}

fn with_sensors(text: &str, sensors: &str) -> String {
    if sensors.is_empty() {
        return text.to_owned();
    }
    match text.find("sensors: [") {
        Some(at) => format!("{}{sensors}, {}", &text[..at + 10], &text[at + 10..]),
        None => text.replacen("Scene(", &format!("Scene(sensors: [{sensors}],"), 1),
    }
}

fn run(source: &Source, overrides: &Overrides, ticks: Option<u64>, cut: Cut) -> Result<u64, String> {
    let layers = matches!(cut, Cut::Frames(_)).then(|| WORDS.iter().map(|(word, _)| (*word).to_owned()).collect());
    let overrides = Overrides { layers, ..overrides.clone() };
    let mut simulation = Simulation::load_with(source, &overrides, |_| {}).map_err(|errors| errors.to_string())?;
    let end = ticks.unwrap_or(u64::MAX).min(simulation.ticks());
    let failed = |failure: jostle::tick::Failure| failure.to_string();
    let (mut recorder, dt) = (Recorder::default(), simulation.clock().dt);
    while simulation.clock().ticks < end {
        let now = simulation.clock().ticks;
        let next = match cut {
            Cut::Whole => end,
            Cut::Even(length) => now + length,
            Cut::Random(seed) | Cut::Frames(seed) => now + Draw(seed + now * 2_654_435_761).up_to(37),
        };
        if matches!(cut, Cut::Frames(_)) && next < end {
            recorder.frame(&mut simulation, (next as f64 - 0.4) * dt).map_err(failed)?;
        }
        simulation.run_to_tick(next.min(end)).map_err(failed)?;
    }
    Ok(state_hash(simulation.bodies()))
}

fn demand_same(name: &str, text: &str, folder: &Path, overrides: &Overrides) -> usize {
    let source = |sensors: &str| {
        let text = with_sensors(text, sensors);
        Source { folder: Some(folder.to_owned()), ..Source::new(name, text) }
    };
    let plain = source("");
    let first = Simulation::load_with(&plain, overrides, |_| {}).unwrap_or_else(|errors| panic!("{name}: {errors}"));
    let bodies = first.bodies().len() as u64;
    let ticks = (VISITS / bodies.max(1)).clamp(*TICKS.start(), *TICKS.end());
    let ticks = std::env::var_os(WHOLE).is_none().then_some(ticks);
    let expected = run(&plain, overrides, ticks, Cut::Whole);
    for cut in [Cut::Even(1), Cut::Even(7), Cut::Random(99), Cut::Frames(7)] {
        assert_eq!(run(&plain, overrides, ticks, cut), expected, "{name}, {cut:?}");
    }
    let mut fitting = Vec::new();
    // Reading a large scene takes longer than its ticks.
    let kinds = if bodies > CROWD { &SENSORS[..1] } else { &SENSORS };
    for (number, sensors) in kinds.iter().copied().enumerate() {
        let seen = source(sensors);
        // A scene without a contact law has no contacts to ask for.
        if Simulation::load_with(&seen, overrides, |_| {}).is_err() {
            continue;
        }
        fitting.push(sensors);
        let cut = Cut::Random(5 + number as u64);
        assert_eq!(run(&seen, overrides, ticks, cut), expected, "{name}, {sensors}, {cut:?}");
    }
    let all = source(&fitting.join(", "));
    for cut in [Cut::Whole, Cut::Even(1)] {
        assert_eq!(run(&all, overrides, ticks, cut), expected, "{name}, all sensors, {cut:?}");
    }
    fitting.len()
}

#[test]
fn every_shipped_scene_is_the_same_in_any_batches_and_with_any_sensor() {
    let entries = std::fs::read_dir(in_repository("scenes")).unwrap().map(|entry| entry.unwrap().path());
    let mut scenes: Vec<PathBuf> = entries.filter(|path| path.extension().is_some_and(|end| end == "ron")).collect();
    scenes.sort();
    let fitting: usize = std::thread::scope(|scope| {
        let run = |path: &PathBuf| {
            let text = std::fs::read_to_string(path).unwrap();
            let name = path.file_name().unwrap().to_str().unwrap().to_owned();
            demand_same(&name, &text, path.parent().unwrap(), &Overrides::default())
        };
        let runs: Vec<_> = scenes.iter().map(|path| scope.spawn(move || run(path))).collect();
        runs.into_iter().map(|run| run.join().unwrap()).sum()
    });
    assert!(fitting > 2 * scenes.len(), "{fitting} sensors fit {} scenes", scenes.len());
}

/// Discs that fall, settle and fly: flights end where contacts begin, never where a batch ends.
#[test]
fn discs_in_flight_are_the_same_in_any_batches_and_with_any_sensor() {
    let path = in_repository("assets/defects/bits.ron");
    let text = std::fs::read_to_string(&path).unwrap();
    for (count, radius, restitution) in [(150, 0.01, 0.1), (90, 0.012, 0.6)] {
        let text = text
            .replace("count: 150", &format!("count: {count}"))
            .replace("radius: 0.01", &format!("radius: {radius:?}"))
            .replace("restitution: 0.1", &format!("restitution: {restitution:?}"));
        let overrides = Overrides { duration: Some(0.02), tick: Some(2e-5), ..Overrides::default() };
        assert!(demand_same("bits.ron", &text, path.parent().unwrap(), &overrides) == SENSORS.len());
    }
}

/// A thrust changes forces at the begin of a tick, when the last kick of the tick before may still wait. It waits while no contact can come
/// to rest, as those of elastic discs.
#[test]
fn a_thrust_that_ends_is_the_same_in_any_batches_and_with_any_sensor() {
    let text = "Scene(format: 1, clock: (duration: 0.32, tick: 0.0004), gravity: (0, -9.81),
        materials: {\"m\": (stiffness: 37090, friction: 0.3259, density: 73.33)},
        walls: [(name: \"floor\", left: (1, 0), right: (0, 0), material: \"m\")],
        bodies: [(name: \"a\", at: (0.1078, 0.5987), spin: -1.404, material: \"m\", atoms: Disc(radius: 0.5987)),
                 (name: \"b\", at: (-0.0173, 1.2365), material: \"m\", mass: 2.229, shape: Disc(radius: 0.05127, at: (0.2311, 0)))],
        forces: [Thrust(of: \"a\", force: (9.747, 8.78), frame: Body, to: 0.04387)])";
    assert!(demand_same("thrust.ron", text, &in_repository("scenes"), &Overrides::default()) > 0);
}
