//! What threads must not change: their number, as the command line takes it, and what they run meanwhile.

use std::process::Command;

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
