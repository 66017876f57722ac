//! Readers that go away, and streams that are closed or full.

use std::process::Stdio;

use super::harness::{FALL, Folder};

/// As in `jostle .. | head -0`: the pipe is closed before anything is written.
#[test]
fn a_reader_that_goes_away_does_no_harm() {
    let folder = Folder::new("closed").with("fall.ron", FALL);
    for (arguments, code) in [
        ("run fall.ron --json", 0),
        ("run fall.ron", 0),
        ("check fall.ron", 0),
        ("render fall.ron", 0),
        ("check none.ron", 2),
        ("check none.ron --json", 2),
        ("run fall.ron --tick 0", 2),
        ("--help", 0),
    ] {
        let mut command = folder.command(arguments);
        let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        drop((child.stdout.take(), child.stderr.take()));
        assert_eq!(child.wait().unwrap().code(), Some(code), "{arguments}");
    }
}

#[test]
fn quiet_is_quiet_when_all_is_well() {
    let folder = Folder::new("quiet").with("fall.ron", FALL);
    for arguments in ["run fall.ron --quiet", "render fall.ron --quiet", "render fall.ron --at 0.1 --quiet"] {
        let ended = folder.jostle(arguments).code(0);
        assert_eq!((ended.out.as_str(), ended.err.as_str()), ("", ""), "{arguments}");
    }
}

/// A result that is lost is an error; a full disk has a device of its own.
#[cfg(target_os = "linux")]
#[test]
fn a_result_that_cannot_be_written_is_told() {
    let folder = Folder::new("full").with("fall.ron", FALL);
    let Ok(full) = std::fs::OpenOptions::new().write(true).open("/dev/full") else { return };
    let output = folder.command("run fall.ron --json").stdout(full).output().unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&output.stderr).contains("cannot be written to standard output"));

    // Results of many lines say so once.
    let full = std::fs::OpenOptions::new().write(true).open("/dev/full").unwrap();
    let output = folder.command("list").stdout(full).output().unwrap();
    assert_eq!(output.status.code(), Some(2));
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(said.matches("cannot be written to standard output").count(), 1, "{said}");
}
