//! Threads change no result: neither their number on the command line, nor their other work.

use std::process::Command;

use glam::DVec2;
use jostle::Simulation;
use jostle::scene::Source;
use jostle::simd::Level;
use jostle::simulation::Overrides;
use jostle::tick::Ledger;
use jostle::tick::ledger::momentum;

use super::{clumps, hash, load, run, scene};

/// State hash that the program prints for the pile of this folder's other tests.
fn told(path: &std::path::Path, threads: &str) -> String {
    let mut command = Command::new(env!("CARGO_BIN_EXE_jostle"));
    let output = command.arg("run").arg(path).args(["--json", "--threads", threads]).output().unwrap();
    assert!(output.status.success(), "{output:?}");
    let told: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    told["card"]["hash"].as_str().unwrap_or_else(|| panic!("no hash in {told}")).to_owned()
}

#[test]
fn the_number_of_threads_does_not_matter() {
    let path = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join("threads.ron");
    std::fs::write(&path, scene("VelocityVerlet", "", &clumps())).unwrap();
    let one = told(&path, "1");
    for threads in ["2", "3", "16"] {
        assert_eq!(told(&path, threads), one, "{threads} threads");
    }
}

/// Simulations that run at the same time share nothing.
#[test]
fn it_does_not_matter_what_runs_at_the_same_time() {
    let text = scene("VelocityVerlet", "", &clumps());
    let run_it = || {
        let mut simulation = load(&text, |_| {});
        run(&mut simulation, 2000);
        hash(&simulation)
    };
    let alone = run_it();
    let together: Vec<u64> = std::thread::scope(|scope| {
        let runs: Vec<_> = (0..3).map(|_| scope.spawn(run_it)).collect();
        runs.into_iter().map(|run| run.join().unwrap()).collect()
    });
    assert_eq!(together, [alone; 3]);
}

/// Forty thousand atoms in a heap without walls: enough for several parts of bodies and of contacts. `body` is what stands at
/// each place of a lattice.
fn many(contacts: &str, body: &str, more: &str) -> String {
    format!(
        "Scene(format: 1, clock: (duration: 0.006, tick: 0.001), contacts: {contacts}, {more}
        materials: {{ \"stone\": (stiffness: 20000, friction: (static: 0.6, dynamic: 0.4), restitution: 0.4, density: 10) }},
        bodies: [
            Repeat(count: (200, 100), grid: (from: (0, 0), step: (0.098, 0.196)), make: [{body}]),
            (name: \"post\", at: (7, -0.11), fixed: true, atoms: Disc(radius: 0.1), material: \"stone\"),
        ])"
    )
}

const DISCS: &str = "(name: \"a_{i}_{j}\", at: (\"x\", \"y\"), atoms: Disc(radius: \"0.05 + 0.001 * sin(3 * i + 7 * j)\"), material: \"stone\"),
    (name: \"b_{i}_{j}\", at: (\"x\", \"y + 0.098\"), velocity: (0.1, \"0.2 * sin(i)\"), atoms: Disc(radius: 0.05), material: \"stone\")";
const CLUMPS: &str =
    "(name: \"c_{i}_{j}\", at: (\"x\", \"y\"), angle: \"0.1 * i + 0.4 * j\", spin: 3, material: \"stone\",
    atoms: List([(at: (-0.02, 0), radius: 0.05), (at: (0.02, 0.06), radius: 0.04)]))";

/// Hash, accounts and momentum of the end.
fn end_of(text: &str, threads: usize, level: Level) -> (u64, Ledger, DVec2) {
    let overrides = Overrides { threads: Some(threads), level: Some(level), ..Overrides::default() };
    let mut simulation = Simulation::load_with(&Source::new("many", text), &overrides, |_| {}).unwrap();
    simulation.run_to_end().unwrap();
    let (bodies, ledger) = (simulation.bodies(), simulation.state().ledger().clone());
    (hash(&simulation), ledger, momentum(bodies))
}

#[test]
fn threads_that_share_the_work_change_no_bit() {
    let gauge = "sensors: [ContactForce(on: \"post\")], gravity: (0, -9.81),";
    for (contacts, body, more) in [
        ("Penalty(tangential: None)", DISCS, ""),
        ("Penalty(normal: Dashpot)", DISCS, gauge),
        ("Penalty(normal: Dashpot, rolling: Spring(friction: 0.1))", CLUMPS, gauge),
    ] {
        let text = many(contacts, body, more);
        let (hash, ledger, _) = end_of(&text, 1, Level::best());
        assert!(ledger.friction.value() + ledger.inelasticity.value() > 0.0, "{contacts}: nothing happened");
        for (threads, level) in [(2, Level::best()), (5, Level::Baseline)] {
            let other = end_of(&text, threads, level);
            assert_eq!((other.0, other.1), (hash, ledger.clone()), "{contacts}, {threads} threads, {level}");
        }
    }
}

/// Law: what bodies of one part do to those of another comes back. Tolerance: momentum is a sum of forces that cancel in pairs,
/// each rounded by a share of 1e-16 of what a body has; a push that is lost is that of one pair of eighty thousand.
#[test]
fn parts_that_are_pushed_by_others_push_back() {
    let text = many("Penalty(normal: Dashpot)", DISCS, "").replace("fixed: true", "fixed: false");
    let still = text.replace("duration: 0.006", "duration: 0.001");
    let (first, last) = (end_of(&still, 2, Level::best()).2, end_of(&text, 2, Level::best()).2);
    let drift = (last - first).length() / last.length();
    assert!(drift < 1e-11, "momentum changed by a share of {drift}");
}
