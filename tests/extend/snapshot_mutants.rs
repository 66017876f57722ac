//! Snapshots whose bytes a stranger changed and whose checksum was repaired.
//!
//! Not tested: whether a run that goes on is the one that was saved. Places, velocities and springs of contacts are
//! free. `tools/fuzz --kind snapshots` looks for panics, hangs and memory.

use std::path::PathBuf;

use jostle::Simulation;
use jostle::scene::Source;
use jostle::simulation::Snapshot;

/// Flights; contacts, joints and sensors; a belt.
const SCENES: [&str; 3] = ["newtons_cradle", "pendulum_clock", "conveyor"];

/// Mutants of each scene: a bit turns around at so many places, which lie evenly.
const MUTANTS: usize = 60;

/// Behind the first bytes, the format and the length of the header.
const HEAD: usize = 28;

fn repair(bytes: &mut [u8]) {
    let (whole, sum) = bytes.split_last_chunk_mut::<4>().expect("a snapshot ends with its sum");
    *sum = crc32fast::hash(whole).to_le_bytes();
}

/// Law: a snapshot that is refused leaves no trace in the run that reads it.
#[test]
fn a_refused_snapshot_leaves_no_trace() {
    for name in SCENES {
        let source = Source::read(&PathBuf::from(format!("scenes/{name}.ron"))).unwrap();
        let load = || Simulation::load(&source).unwrap();
        let (mut saved, mut run) = (load(), load());
        saved.run_to_tick((saved.ticks() / 5).min(2000)).unwrap();
        run.run_to_tick(7).unwrap();
        let (bytes, before) = (saved.snapshot().unwrap().to_bytes(), run.future_hash());
        let mut refused = 0;
        for number in 0..MUTANTS {
            let mut mutant = bytes.clone();
            mutant[HEAD + number * (bytes.len() - HEAD - 4) / MUTANTS] ^= 1 << (number % 8);
            repair(&mut mutant);
            let restored = Snapshot::from_bytes(&mutant).is_ok_and(|snapshot| run.restore(&snapshot).is_ok());
            if restored {
                run = load();
                run.run_to_tick(7).unwrap();
            } else {
                refused += 1;
            }
            assert_eq!(run.future_hash(), before, "{name}: mutant {number}");
        }
        assert!(refused > MUTANTS / 10, "{name}: only {refused} of {MUTANTS} are refused");
    }
}

/// Law: masses follow from the scene. A file cannot bring others, nor places that are no numbers.
#[test]
fn other_masses_and_places_that_are_no_numbers_are_refused() {
    let source = Source::read(&PathBuf::from("scenes/newtons_cradle.ron")).unwrap();
    let mut run = Simulation::load(&source).unwrap();
    run.run_to_tick(10).unwrap();
    let bytes = run.snapshot().unwrap().to_bytes();
    let (mass, place) = (run.bodies().mass[1], run.bodies().position[1].x);
    for (number, other, part) in [(mass, 1.5 * mass, "masses"), (place, f64::NAN, "no finite numbers")] {
        let found = bytes.windows(8).position(|window| window == number.to_le_bytes()).expect("it is saved");
        let mut mutant = bytes.clone();
        mutant[found..found + 8].copy_from_slice(&other.to_le_bytes());
        repair(&mut mutant);
        let why = run.restore(&Snapshot::from_bytes(&mutant).unwrap()).unwrap_err().to_string();
        assert!(why.contains(part) && why.contains("Write the snapshot again"), "{why}");
    }
}
