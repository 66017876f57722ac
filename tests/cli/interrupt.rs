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

/// Between two pictures lie hours of ticks, without a moment at which anything is drawn. A Ctrl-C that comes before the first picture
/// keeps nothing, so the next one waits longer.
#[cfg(unix)]
#[test]
fn ctrl_c_ends_a_strip_with_the_pictures_so_far() {
    let folder = Folder::new("ctrl_c_strip").with("fall.ron", fixed());
    let command = "render fall.ron --duration 5e6 --tick 0.0005 --size 256x144 --strip 0,0.01,4e6 -o strip.png";
    let mut said = String::new();
    for wait in [1, 4, 16, 60] {
        let child = folder.command(command).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("it is built");
        std::thread::sleep(Duration::from_secs(wait));
        let sent = Command::new("kill").args(["-INT", &child.id().to_string()]).status().expect("kill is installed");
        assert!(sent.success(), "it was still running");
        let ended = child.wait_with_output().expect("it ends");
        said = String::from_utf8_lossy(&ended.stderr).into_owned();
        if said.contains("strip.png: ") {
            assert_eq!(ended.status.code(), Some(130), "{said}");
            break;
        }
    }
    assert!(said.contains("Ctrl-C ended the run at t = "), "{said}");
    assert!(folder.names().contains(&"strip.png".to_owned()), "{said}");
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

/// A program gets a Ctrl-C as soon as `begun`.
#[cfg(unix)]
fn interrupted_once(folder: &Folder, command: &str, begun: impl Fn() -> bool) -> Output {
    let mut child: Child =
        folder.command(command).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("the program is built");
    let start = Instant::now();
    while !begun() && start.elapsed() < Duration::from_secs(60) {
        assert!(child.try_wait().expect("a child").is_none(), "it ended before");
        std::thread::sleep(Duration::from_millis(5));
    }
    let sent = Command::new("kill").args(["-INT", &child.id().to_string()]).status().expect("kill is installed");
    assert!(sent.success(), "it was still running");
    child.wait_with_output().expect("it ends")
}

/// The runs that are done stay in the record, and no half film stays beside them.
#[cfg(unix)]
#[test]
fn ctrl_c_ends_a_sweep_with_all_runs_so_far() {
    let folder = Folder::new("ctrl_c_sweep").with("fall.ron", fixed());
    let command = "sweep fall.ron --vary clock.duration=0.1,5e4 --tick 0.05 --films --size 256x144 --threads 1 -o out";
    let made = || -> Vec<String> {
        let entries = std::fs::read_dir(folder.path("out")).into_iter().flatten();
        let mut names: Vec<String> =
            entries.map(|entry| entry.expect("an entry").file_name().into_string().expect("a name")).collect();
        names.sort();
        names
    };
    // The second run has begun once the record holds the first.
    let done = || std::fs::read_to_string(folder.path("out/table.runs")).map_or(0, |text| text.lines().count());
    let ended = interrupted_once(&folder, command, || done() == 2);
    let said = String::from_utf8_lossy(&ended.stderr).into_owned();
    assert_eq!(ended.status.code(), Some(130), "{said}");
    assert!(said.contains("Ctrl-C ended the sweep after 1 of 2 runs. `out/table.runs` keeps them"), "{said}");
    assert_eq!(made(), ["run_1.gif", "table.runs"]);
}

#[cfg(unix)]
#[test]
fn ctrl_c_ends_a_test_with_a_whole_report_of_the_scenes_so_far() {
    let folder = Folder::new("ctrl_c_test").with("a.ron", FALL).with("b.ron", FALL.replace("1 ms", "1e-3 ns"));
    let command = "test a.ron b.ron --threads 1 --junit report.xml";
    let start = Instant::now();
    let ended = interrupted_once(&folder, command, || start.elapsed() > Duration::from_secs(3));
    let (told, said) = (String::from_utf8_lossy(&ended.stdout), String::from_utf8_lossy(&ended.stderr));
    assert_eq!(ended.status.code(), Some(130), "{said}");
    assert!(told.contains("1 scene in ") && said.contains("Ctrl-C ended the test after 1 of 2 scenes"), "{told}{said}");
    let report = String::from_utf8(folder.read("report.xml")).expect("text");
    assert!(report.contains("skipped=\"1\"") && report.contains("interrupted"), "{report}");
}

#[cfg(unix)]
#[test]
fn ctrl_c_ends_a_check_with_the_result_so_far() {
    let folder = Folder::new("ctrl_c_check").with("a.ron", FALL.replace("1 ms", "1e-3 ns")).with("b.ron", FALL);
    let start = Instant::now();
    let ended = interrupted_once(&folder, "check --run a.ron b.ron", || start.elapsed() > Duration::from_secs(3));
    let said = String::from_utf8_lossy(&ended.stderr).into_owned();
    assert_eq!(ended.status.code(), Some(130), "{said}");
    assert!(said.contains("a.ron: Ctrl-C ended the run at t = ") && !said.contains("b.ron"), "{said}");
}
