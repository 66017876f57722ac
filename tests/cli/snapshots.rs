//! `run --save` and `--resume`: a saved run continues in another process with the same bits.
//!
//! Tolerance: none. Compared are the state's hash, the rows of channels behind the moment, and the accounts of the card.

use serde_json::Value;

use super::harness::Folder;

fn result(text: &str) -> Value {
    serde_json::from_str(text).unwrap_or_else(|error| panic!("{error}: {text}"))
}

fn text(folder: &Folder, name: &str) -> String {
    String::from_utf8(folder.read(name)).unwrap()
}

/// Scenes with contacts at rest, flights, rolling and many bodies, one that locates events, and one under a tolerance.
#[test]
fn a_saved_run_goes_on_in_another_process_to_the_same_bits() {
    let scenes = [
        ("example:tetris", ""),
        ("example:conveyor", "--duration 2"),
        ("example:plinko", ""),
        ("example:billiards", "--duration 0.5 --method Dop853"),
        ("example:bounce", "--duration 2 --tolerance 1e-6"),
    ];
    for (scene, flags) in scenes {
        let folder = Folder::new(&format!("saved_{}", &scene[8..]));
        let run = format!("run {scene} {flags} --quiet --json --no-estimate");
        let whole = result(&folder.jostle(&format!("{run} -o whole.csv")).code(0).out);
        let end = whole["time"].as_f64().unwrap_or_else(|| panic!("{whole:#}"));
        for share in [0.21, 0.66] {
            let at = share * end;
            let saving = format!("{run} --save at={at}:run.snapshot -o saving.csv --threads 2");
            let saving = result(&folder.jostle(&saving).code(0).out);
            let resumed = format!("{run} --resume run.snapshot -o resumed.csv --threads 1 --simd scalar");
            let resumed = result(&folder.jostle(&resumed).code(0).out);
            for field in ["/card/hash", "/card/energy", "/card/largest_overlap", "/ticks", "/bodies"] {
                let expected = whole.pointer(field).unwrap();
                assert_eq!(saving.pointer(field).unwrap(), expected, "{scene}: {field}");
                assert_eq!(resumed.pointer(field).unwrap(), expected, "{scene}, saved at {at} s: {field}");
            }
            assert_eq!(text(&folder, "whole.csv"), text(&folder, "saving.csv"));
            let (rows, later) = (text(&folder, "whole.csv"), text(&folder, "resumed.csv"));
            let tail: Vec<&str> = later.lines().skip(2).collect();
            assert!(rows.lines().count() < 4 || !tail.is_empty());
            assert!(rows.ends_with(&tail.join("\n")) || rows.trim_end().ends_with(&tail.join("\n")), "{scene}, {at} s");
            let notes = resumed["card"]["notes"].to_string();
            assert!(notes.contains("went on from a snapshot of t = "), "{notes}");
        }
    }
}

/// Several moments in one run, the beginning and the end among them.
#[test]
fn several_moments_are_saved_in_one_run() {
    let folder = Folder::new("several_snapshots");
    let saves = "--save at=1s:b.snapshot --save at=0:a.snapshot --save at=1.5:c.snapshot";
    let run = "run example:tetris --duration 1.5 --quiet --json --no-estimate";
    let whole = result(&folder.jostle(&format!("{run} {saves}")).code(0).out);
    for name in ["a", "b", "c"] {
        let resumed = result(&folder.jostle(&format!("{run} --resume {name}.snapshot")).code(0).out);
        assert_eq!(resumed["card"]["hash"].as_str().unwrap(), whole["card"]["hash"].as_str().unwrap(), "{name}");
    }
    assert_eq!(folder.names(), ["a.snapshot", "b.snapshot", "c.snapshot"]);
}

#[test]
fn what_cannot_be_saved_or_resumed_is_said_before_anything_runs() {
    let folder = Folder::new("wrong_snapshots");
    folder.jostle("run example:tetris --duration 1 --quiet --save at=0.5:good.snapshot").code(0);
    let good = folder.read("good.snapshot");
    let mut damaged = good.clone();
    damaged[good.len() / 2] ^= 1;
    std::fs::write(folder.path("damaged.snapshot"), damaged).unwrap();
    std::fs::write(folder.path("short.snapshot"), &good[..good.len() / 2]).unwrap();
    std::fs::write(folder.path("text.snapshot"), "Scene(format: 1)").unwrap();
    std::fs::create_dir(folder.path("folder")).unwrap();
    let wrong = [
        ("run example:tetris --resume damaged.snapshot", "damaged"),
        ("run example:tetris --resume short.snapshot", "damaged"),
        ("run example:tetris --resume text.snapshot", "no snapshot"),
        ("run example:tetris --resume folder", "no file"),
        ("run example:tetris --resume missing.snapshot", "missing.snapshot"),
        ("run example:bounce --resume good.snapshot", "another scene"),
        ("run example:tetris --method Dop853 --resume good.snapshot", "goes by"),
        ("run example:tetris --duration 0.1 --resume good.snapshot", "behind the end"),
        ("run example:tetris --resume good.snapshot --reverse", "--reverse"),
        ("run example:tetris --resume good.snapshot --save at=0.1:late.snapshot", "not in the run"),
        ("run example:tetris --resume good.snapshot -o good.snapshot", "good.snapshot"),
        ("run example:tetris --resume good.snapshot --save at=0.7:good.snapshot", "good.snapshot"),
        ("run example:tetris --save at=99:late.snapshot", "not in the run"),
        ("run example:tetris --save at=1:folder", "directory"),
        ("run example:tetris --save at=1:x.csv -o x.csv", "already"),
        ("run example:tetris --save at=1:x --save at=2:x", "already"),
        ("run example:tetris --save 1s", "at=2s:half.snapshot"),
        ("run example:tetris --save at=-1:x", "time"),
    ];
    for (command, says) in wrong {
        let ran = folder.jostle(&format!("{command} --quiet")).code(2);
        assert!(ran.err.contains(says), "{command}: {}", ran.err);
    }
    assert!(folder.read("good.snapshot") == good, "a snapshot that was read is written over");
    let left = ["damaged.snapshot", "folder", "good.snapshot", "short.snapshot", "text.snapshot"];
    assert_eq!(folder.names(), left);
}

/// Two outputs of one command never share a file, however it is spelt, and even if it is not there yet.
#[test]
fn one_new_file_of_two_names_is_refused() {
    let folder = Folder::new("one_file_two_names");
    std::fs::create_dir(folder.path("sub")).unwrap();
    #[cfg(unix)]
    std::os::unix::fs::symlink("../a.snapshot", folder.path("sub/link.snapshot")).unwrap();
    let run = "run example:tetris --duration 0.2 --quiet --no-estimate";
    let whole = folder.path("a.snapshot");
    let mut pairs = vec![
        "--save at=0.1:a.snapshot --save at=0.2:./a.snapshot".to_owned(),
        "-o a.snapshot --save at=0.1:sub/../a.snapshot".to_owned(),
        format!("-o a.snapshot --save at=0.1:{}", whole.display()),
    ];
    if cfg!(unix) {
        pairs.push("--save at=0.1:a.snapshot --save at=0.2:sub/link.snapshot".to_owned());
    }
    for pair in pairs {
        let ended = folder.jostle(&format!("{run} {pair}")).code(2);
        assert!(ended.err.contains("this command writes `"), "{pair}: {}", ended.err);
        assert!(!whole.exists(), "{pair}");
    }
}

/// A snapshot that cannot be written costs neither the table nor the snapshots behind it. No file has a name of 300 letters.
#[test]
fn a_snapshot_that_cannot_be_written_does_not_end_the_run() {
    let folder = Folder::new("one_snapshot_fails");
    let run = "run example:tetris --duration 0.2 --quiet --no-estimate";
    folder.jostle(&format!("{run} -o whole.csv")).code(0);
    let name = "n".repeat(300);
    let saves = format!("--save at=0.1:{name} --save at=0.15:later.snapshot");
    let ended = folder.jostle(&format!("{run} -o saved.csv {saves}")).code(2);
    assert!(ended.err.contains("--save") && ended.err.contains("the run goes on"), "{}", ended.err);
    assert_eq!(text(&folder, "saved.csv"), text(&folder, "whole.csv"));
    assert!(folder.path("later.snapshot").exists());
}
