//! A run that is interrupted: no half file carries the final name. Ctrl-C keeps all that was reached.

use std::process::{Child, Command, Output, Stdio};
use std::time::{Duration, Instant};

use super::harness::{FALL, Folder};

/// A scene of hours, whose fixed camera lets its film begin at once.
const LONG: &str = "fall.ron --duration 5e4 --tick 0.05";

/// Waits until a program has begun to write a file.
fn wait_for_part(folder: &Folder, name: &str) {
    let start = Instant::now();
    let begun = || {
        let parts = folder.parts(name);
        parts.iter().any(|part| std::fs::metadata(folder.path(part)).is_ok_and(|part| part.len() > 0))
    };
    while !begun() && start.elapsed() < Duration::from_secs(60) {
        std::thread::sleep(Duration::from_millis(10));
    }
}

#[test]
fn an_interrupted_film_does_not_carry_its_name() {
    let folder = Folder::new("interrupted").with("fall.ron", fixed());
    let mut child =
        folder.command(&format!("render {LONG} --size 256x144 --fps 10")).stderr(Stdio::null()).spawn().unwrap();
    wait_for_part(&folder, "fall.gif");
    child.kill().unwrap();
    assert!(!child.wait().unwrap().success(), "it was still running");
    assert_eq!(folder.without_parts("fall.gif").len(), 1);
    assert_eq!(folder.names(), ["fall.ron"]);
}

fn fixed() -> String {
    FALL.replace("film:", "camera: Look(center: (0, 0), height: 4), film:")
}

/// A program that has begun to write a file gets a Ctrl-C.
#[cfg(unix)]
fn after_ctrl_c(folder: &Folder, command: &str, file: &str) -> Output {
    let child: Child =
        folder.command(command).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("the program is built");
    wait_for_part(folder, file);
    let sent = Command::new("kill").args(["-INT", &child.id().to_string()]).status().expect("kill is installed");
    assert!(sent.success(), "it was still running");
    child.wait_with_output().expect("it ends")
}

#[cfg(unix)]
#[test]
fn ctrl_c_ends_a_film_with_all_frames_and_the_card_so_far() {
    let folder = Folder::new("ctrl_c_film").with("fall.ron", fixed());
    let ended = after_ctrl_c(&folder, &format!("render {LONG} --size 256x144 --fps 10"), "fall.gif");
    let said = String::from_utf8_lossy(&ended.stderr).into_owned();
    assert_eq!(ended.status.code(), Some(130), "{said}");
    for text in ["frames before Ctrl-C", "Ctrl-C ended the run at t = ", "energy residual"] {
        assert!(said.contains(text), "{said}");
    }
    let bytes = folder.read("fall.gif");
    let mut film = gif::DecodeOptions::new().read_info(&bytes[..]).expect("a whole film");
    let mut frames = 0;
    while film.read_next_frame().expect("whole frames").is_some() {
        frames += 1;
    }
    assert!(frames > 0);
    folder.without_parts("fall.gif");
    assert_eq!(folder.names(), ["fall.gif", "fall.ron"]);
}

#[cfg(unix)]
#[test]
fn ctrl_c_ends_a_run_with_all_rows_and_its_result_so_far() {
    let folder = Folder::new("ctrl_c_run").with("fall.ron", FALL);
    // The table begins with the run. Its part file holds something once rows fill a buffer.
    let ended = after_ctrl_c(&folder, &format!("run {LONG} -o rows.csv --json"), "rows.csv");
    let said = String::from_utf8_lossy(&ended.stderr).into_owned();
    assert_eq!(ended.status.code(), Some(130), "{said}");
    assert!(said.contains("Ctrl-C ended the run at t = "), "{said}");
    let result: serde_json::Value = serde_json::from_slice(&ended.stdout).expect("a result");
    let reached = result["time"].as_f64().expect("a time");
    assert!(reached > 0.0 && reached < 5e4, "{reached}");
    let rows = String::from_utf8(folder.read("rows.csv")).expect("a table");
    let last: f64 = rows.lines().last().and_then(|row| row.split(',').next()).expect("a row").parse().expect("a time");
    assert!(rows.ends_with('\n') && last <= reached, "{last} of {reached}");
}

/// A look ahead for the camera keeps nothing, and says so. A Ctrl-C that comes before the program listens ends it without a word, so the
/// test waits longer then.
#[cfg(unix)]
#[test]
fn ctrl_c_before_the_first_frame_says_that_nothing_is_kept() {
    let folder = Folder::new("ctrl_c_early").with("fall.ron", FALL);
    let after = |wait: Duration| {
        let mut command = folder.command("render fall.ron --duration 5e4 --tick 1e-3 -o fall.gif");
        let child = command.stdout(Stdio::null()).stderr(Stdio::piped()).spawn().expect("the program is built");
        std::thread::sleep(wait);
        Command::new("kill").args(["-INT", &child.id().to_string()]).status().expect("kill is installed");
        child.wait_with_output().expect("it ends")
    };
    let waits = [0.3, 1.0, 5.0].map(Duration::from_secs_f64);
    let heard = waits.into_iter().map(after).find(|ended| ended.status.code().is_some());
    let ended = heard.expect("it listens after some seconds");
    let said = String::from_utf8_lossy(&ended.stderr).into_owned();
    assert_eq!(ended.status.code(), Some(130), "{said}");
    assert!(said.contains("there is nothing to keep"), "{said}");
    assert_eq!(folder.names(), ["fall.ron"]);
}
