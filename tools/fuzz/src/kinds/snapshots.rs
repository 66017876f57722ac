//! Snapshots with a repaired checksum: each is refused with a remedy, or the run goes on or ends with its message.
//!
//! Contacts, flights, joints, motors, hulls, belts, rolling, sensors and controllers, each from tick to tick and under a
//! method that locates events.

use std::path::{Path, PathBuf};

use jostle::Simulation;
use jostle::scene::Source;
use jostle::simulation::{Overrides, Snapshot};

use super::Kind;
use crate::bytes;
use crate::worker::{broken, mark, run_on};

const SCENES: [&str; 12] = [
    "tetris",
    "newtons_cradle",
    "slider_crank",
    "conveyor",
    "rolling_shapes",
    "plinko",
    "pendulum_clock",
    "cow",
    "car_on_terrain",
    "two_link_arm",
    "rope_bridge",
    "cogs",
];
const METHODS: [Option<&str>; 2] = [None, Some("Dop853")];
/// So many mutants of one run follow each other: to begin a run takes longer than to try a mutant.
const TURN: u64 = 100;
/// Ticks after which a run is saved. A scene of fewer ticks is saved after the last.
const SAVED_AFTER: u64 = 400;
/// Behind the first bytes, the format and the length of the header.
const HEAD: usize = 28;

/// The run of one turn, and its snapshot.
struct Run {
    turn: u64,
    simulation: Simulation,
    bytes: Vec<u8>,
}

#[derive(Default)]
struct Snapshots(Option<Run>);

pub fn make(_: &[PathBuf]) -> std::io::Result<Box<dyn Kind>> {
    Ok(Box::new(Snapshots::default()))
}

fn turns() -> u64 {
    (SCENES.len() * METHODS.len()) as u64
}

impl Snapshots {
    fn run(&mut self, turn: u64) -> &mut Run {
        let turn = turn % turns();
        let run = self.0.take().filter(|run| run.turn == turn).unwrap_or_else(|| Run::begin(turn));
        self.0.insert(run)
    }
}

impl Run {
    fn begin(turn: u64) -> Self {
        let (scene, method) = (turn as usize % SCENES.len(), turn as usize / SCENES.len());
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../../scenes/{}.ron", SCENES[scene]));
        let source = Source::read(&path).expect("a shipped scene can be read");
        let method = METHODS[method].map(str::to_owned);
        let overrides = Overrides { method, untried: true, ..Overrides::default() };
        let mut simulation = Simulation::load_with(&source, &overrides, |_| {}).expect("a shipped scene is good");
        let saved_after = simulation.ticks().min(SAVED_AFTER);
        simulation.run_to_tick(saved_after).expect("a shipped scene runs");
        let bytes = simulation.snapshot().expect("a shipped scene can be saved").to_bytes();
        Self { turn, simulation, bytes }
    }
}

impl Kind for Snapshots {
    fn ending(&self) -> &'static str {
        "snapshot"
    }

    fn mutant(&mut self, seed: u64, number: u64) -> Vec<u8> {
        let run = self.run(number / TURN);
        bytes::checked(&run.bytes, HEAD, seed, number)
    }

    fn is_text(&self) -> bool {
        false
    }

    fn attempt(&mut self, mutant: &[u8], number: u64, _: &Path) {
        // A mutant that is tried alone has no number: the runs of all scenes read it.
        let turns = if number == 0 { 0..turns() } else { number / TURN..number / TURN + 1 };
        for turn in turns {
            let run = self.run(turn);
            mark(number, "reading");
            let snapshot = Snapshot::from_bytes(mutant);
            let restored = snapshot
                .map_err(|why| why.to_string())
                .and_then(|snapshot| run.simulation.restore(&snapshot).map_err(|why| why.to_string()));
            match restored {
                Err(why) if why.is_empty() => broken("a snapshot is refused without a word"),
                Err(_) => mark(number, "refused"),
                Ok(()) => run_on(&mut run.simulation, number).mark(number),
            }
        }
    }
}
