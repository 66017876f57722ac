//! Snapshots whose bytes a stranger changed and whose checksum was repaired: each is refused with a remedy, or the run
//! goes on or ends with its message. None panics.
//!
//! Not tested: whether a run that goes on is the one that was saved. Places, velocities and springs of contacts are
//! free. `tools/fuzz --kind snapshots` tries more mutants, with bounds on memory and time.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::PathBuf;

use jostle::Simulation;
use jostle::scene::Source;
use jostle::simulation::Snapshot;

/// Contacts, flights, joints, motors, hulls, belts, rolling, sensors, and methods that locate events.
const SCENES: [&str; 8] =
    ["tetris", "newtons_cradle", "slider_crank", "conveyor", "rolling_shapes", "plinko", "pendulum_clock", "cow"];

/// Mutants of each scene.
const MUTANTS: usize = 100;

/// Behind the first bytes, the format and the length of the header.
const HEAD: usize = 28;

/// The checksum of snapshots: CRC-32 of IEEE 802.3.
fn checksum(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(!0_u32, |sum, byte| {
        (0..8).fold(sum ^ u32::from(*byte), |sum, _| if sum & 1 == 1 { sum >> 1 ^ 0xEDB8_8320 } else { sum >> 1 })
    })
}

fn repair(bytes: &mut [u8]) {
    let end = bytes.len() - 4;
    let sum = checksum(&bytes[..end]);
    bytes[end..].copy_from_slice(&sum.to_le_bytes());
}

/// Marsaglia's generator of 64 bits, 2003.
struct Chance(u64);

impl Chance {
    fn below(&mut self, bound: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as usize % bound
    }
}

/// One change of the payload: a bit, a step up or down, an edge of a byte, a number, a length, or a shorter file.
fn mutant(bytes: &[u8], chance: &mut Chance) -> Vec<u8> {
    let mut bytes = bytes.to_vec();
    let place = HEAD + chance.below(bytes.len() - HEAD - 16);
    match chance.below(7) {
        0 => bytes[place] ^= 1 << chance.below(8),
        1 => bytes[place] = bytes[place].wrapping_add(1),
        2 => bytes[place] = bytes[place].wrapping_sub(1),
        3 => bytes[place] = [0, 127, 128, 255][chance.below(4)],
        4 => {
            let number = [f64::NAN, f64::INFINITY, -1.0, 1e300][chance.below(4)];
            bytes[place..place + 8].copy_from_slice(&number.to_le_bytes());
        }
        // As a length: 2^60 and more.
        5 => bytes[place..place + 9].copy_from_slice(&[255, 255, 255, 255, 255, 255, 255, 255, 31]),
        _ => bytes.truncate(place + 4),
    }
    repair(&mut bytes);
    bytes
}

#[test]
fn changed_snapshots_are_refused_or_go_on() {
    let mut panicked = Vec::new();
    for name in SCENES {
        let source = Source::read(&PathBuf::from(format!("scenes/{name}.ron"))).unwrap();
        let load = || Simulation::load(&source).unwrap();
        let mut saved = load();
        saved.run_to_tick((saved.ticks() / 5).min(2000)).unwrap();
        let bytes = saved.snapshot().unwrap().to_bytes();
        let (mut run, mut chance) = (load(), Chance(0x9E37_79B9_7F4A_7C15 ^ bytes.len() as u64));
        let mut refused = 0;
        for number in 0..MUTANTS {
            let mutant = mutant(&bytes, &mut chance);
            let ended = catch_unwind(AssertUnwindSafe(|| {
                let Ok(snapshot) = Snapshot::from_bytes(&mutant) else { return true };
                if run.restore(&snapshot).is_err() {
                    return true;
                }
                let _ = run.run_to_tick(run.clock().ticks + 50);
                false
            }));
            match ended {
                Ok(one) => refused += usize::from(one),
                Err(_) => {
                    panicked.push(format!("{name}: mutant {number}"));
                    run = load();
                }
            }
        }
        assert!(refused > MUTANTS / 10, "{name}: only {refused} of {MUTANTS} are refused");
        // The refused ones have left no trace.
        run.restore(&Snapshot::from_bytes(&bytes).unwrap()).unwrap();
        assert_eq!(run.future_hash(), saved.future_hash(), "{name}");
    }
    assert_eq!(panicked, Vec::<String>::new());
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
