//! A run that is interrupted: no half file carries the final name.

use std::process::Stdio;
use std::time::{Duration, Instant};

use super::harness::{FALL, Folder};

#[test]
fn an_interrupted_film_does_not_carry_its_name() {
    // A fixed camera: the film begins at once.
    let long = FALL.replace("film:", "camera: Look(center: (0, 0), height: 4), film:");
    let folder = Folder::new("interrupted").with("fall.ron", &long);
    let mut child = folder
        .command("render fall.ron --duration 5e4 --tick 0.05 --size 256x144 --fps 10")
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    let start = Instant::now();
    let begun = || {
        let parts = folder.parts("fall.gif");
        parts.iter().any(|part| std::fs::metadata(folder.path(part)).is_ok_and(|part| part.len() > 0))
    };
    while !begun() && start.elapsed() < Duration::from_secs(20) {
        std::thread::sleep(Duration::from_millis(10));
    }
    child.kill().unwrap();
    assert!(!child.wait().unwrap().success(), "it was still running");
    assert_eq!(folder.without_parts("fall.gif").len(), 1);
    assert_eq!(folder.names(), ["fall.ron"]);
}
