//! An interrupted sweep continues. Tables of shards that were cut or changed are detected.

use std::process::Stdio;
use std::time::{Duration, Instant};

use super::harness::{FALL, Folder};

const SWEEP: &str = "sweep fall.ron --vary clock.duration=1..30 --no-sheet --threads 1 -o out";

/// Ticks so short that a run takes some hundredths of a second.
fn folder(name: &str) -> Folder {
    Folder::new(name).with("fall.ron", FALL.replace("1 ms", "0.05 ms"))
}

/// Kills a sweep when so many runs are done.
fn killed_after(folder: &Folder, command: &str, runs: usize) {
    let mut child = folder.command(command).stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
    let start = Instant::now();
    let done = || std::fs::read_to_string(folder.path("out/table.runs")).map_or(0, |text| text.lines().count());
    while done() < runs + 1 {
        assert!(start.elapsed() < Duration::from_secs(60) && child.try_wait().unwrap().is_none(), "too late");
        std::thread::sleep(Duration::from_millis(1));
    }
    child.kill().unwrap();
    child.wait().unwrap();
}

#[test]
fn a_killed_sweep_goes_on_where_it_was() {
    let folder = folder("sweep_killed");
    folder.jostle(SWEEP).code(0);
    let whole = folder.read("out/table.csv");
    std::fs::remove_file(folder.path("out/table.csv")).unwrap();
    killed_after(&folder, SWEEP, 5);
    assert!(!folder.has("out/table.csv"));
    // A kill may leave half of a line.
    let mut record = folder.read("out/table.runs");
    record.truncate(record.len() - 3);
    std::fs::write(folder.path("out/table.runs"), &record).unwrap();
    let ended = folder.jostle(&format!("{SWEEP} --json")).code(0);
    let again = ended.json().len();
    assert!((20..27).contains(&again), "{again} runs were made again");
    assert!(ended.err.contains("the sweep makes only the others"), "{ended:?}");
    assert!(folder.read("out/table.csv") == whole);
    assert!(!folder.has("out/table.runs"));
}

/// Another scene, other flags, or a record that was changed: nothing of it counts.
#[test]
fn what_another_sweep_has_done_does_not_count() {
    let folder = folder("sweep_other");
    let other = SWEEP.replace("1..30", "1..29");
    folder.jostle(&other).code(0);
    let whole = folder.read("out/table.csv");
    killed_after(&folder, SWEEP, 3);
    folder.jostle(&other).code(0);
    assert!(folder.read("out/table.csv") == whole);
    killed_after(&folder, &other, 3);
    let record = String::from_utf8(folder.read("out/table.runs")).unwrap();
    let changed = record.replace("good", "evil");
    assert_ne!(record, changed);
    std::fs::write(folder.path("out/table.runs"), changed).unwrap();
    let ended = folder.jostle(&other).code(0);
    assert!(!ended.err.contains("goes on"), "{ended:?}");
    assert!(folder.read("out/table.csv") == whole);
    // A full disk may leave less than the first line.
    for begin in ["", "jostle s"] {
        std::fs::write(folder.path("out/table.runs"), begin).unwrap();
        folder.jostle(&other).code(0);
    }
    // A file of the user's own stays.
    std::fs::write(folder.path("out/table.runs"), "mine").unwrap();
    folder.jostle(&other).code(2).says("`out/table.runs` is no record of finished runs of a sweep: move it away");
    assert_eq!(folder.read("out/table.runs"), b"mine");
}

#[test]
fn two_sweeps_do_not_share_a_folder() {
    let folder = folder("sweep_twice");
    let mut first = folder.command(SWEEP).stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
    while !folder.has("out/table.runs") {
        assert!(first.try_wait().unwrap().is_none(), "it keeps no record");
        std::thread::sleep(Duration::from_millis(1));
    }
    std::thread::sleep(Duration::from_millis(20));
    folder.jostle(SWEEP).code(2).says("another sweep writes into this folder");
    assert!(first.wait().unwrap().success());
}

#[test]
fn a_shard_that_was_cut_or_changed_is_found_out() {
    let folder = Folder::new("shard_sums").with("fall.ron", FALL);
    for shard in ["1/2", "2/2"] {
        folder.jostle(&format!("sweep fall.ron --vary clock.duration=1..6 --no-sheet -o out --shard {shard}")).code(0);
    }
    folder.jostle("sweep --merge out").code(0);
    let (whole, shard) = (folder.read("out/table.csv"), folder.read("out/table.2-of-2.csv"));
    let text = String::from_utf8(shard.clone()).unwrap();
    let last_line = text.trim_end().rfind('\n').unwrap() + 1;
    for changed in [
        text.replacen("good", "evil", 1),
        text[..last_line].to_owned(),
        text[..text.len() - 4].to_owned(),
        text.replacen(" sum ", " summa ", 1),
        text.replacen('7', "8", 1),
    ] {
        assert_ne!(changed, text);
        std::fs::write(folder.path("out/table.2-of-2.csv"), changed).unwrap();
        let ended = folder.jostle("sweep --merge out").code(2).says("run this shard again");
        assert!(ended.err.contains("`out/table.2-of-2.csv`: it "), "{ended:?}");
        assert!(folder.read("out/table.csv") == whole);
    }
    std::fs::write(folder.path("out/table.2-of-2.csv"), shard).unwrap();
    folder.jostle("sweep --merge out").code(0);
}

/// Names of tables may tell of any number of shards, and belong to anything.
#[cfg(target_os = "linux")]
#[test]
fn what_is_no_table_of_a_shard_is_told_at_once() {
    let folder = Folder::new("shards_odd").with("fall.ron", FALL).with("many/table.1-of-99999999999.csv", "");
    let ended = folder.jostle("sweep --merge many").code(2);
    assert!(ended.err.contains("these are absent: 2, 3, 4") && ended.err.contains(" and more"), "{ended:?}");
    std::fs::create_dir(folder.path("pipe")).unwrap();
    let pipe = folder.path("pipe/table.1-of-1.csv");
    assert!(std::process::Command::new("mkfifo").arg(&pipe).status().unwrap().success());
    folder.jostle("sweep --merge pipe").code(2).says("`pipe/table.1-of-1.csv` is no file");
}
