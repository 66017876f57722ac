//! Files are complete or old: however the program ends, no name belongs to half of a film.

use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use super::harness::Folder;

const OLD: &[u8] = b"the film of yesterday";

/// Twenty kills of each format, spread over the whole time that the film takes, at random within each twentieth. Not
/// tested: a machine that loses power, where the system may not have written what it took.
#[test]
fn a_film_killed_at_any_moment_is_the_old_one_or_the_whole_new_one() {
    for name in ["film.gif", "film.apng"] {
        let folder = Folder::new(&format!("killed_{name}"));
        let arguments = format!("render example:tetris --duration 6 --size 320x180 --quiet -o {name}");
        let start = Instant::now();
        folder.jostle(&arguments).code(0);
        let (lasts, new) = (start.elapsed(), folder.read(name));
        let mut random = 2026_u64;
        let (mut old, mut whole) = (0, 0);
        for kill in 0..20 {
            random = random.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            let part = (f64::from(kill) + (random >> 40) as f64 / f64::from(1 << 24)) / 20.0;
            std::fs::write(folder.path(name), OLD).unwrap();
            let mut child = folder.command(&arguments).stderr(Stdio::null()).spawn().unwrap();
            std::thread::sleep(lasts.mul_f64(1.2 * part));
            let _ = child.kill();
            let ended = child.wait().unwrap();
            let found = folder.read(name);
            assert!(found == OLD || found == new, "{name}, kill {kill}: {} bytes", found.len());
            assert!(!ended.success() || found == new, "{name}, kill {kill}: it said that all went well");
            if found == OLD { old += 1 } else { whole += 1 }
        }
        assert!(old > 0, "{name}: {old} old, {whole} new: none was killed in time");
        // What is left over is in the way of no later film.
        folder.jostle(&arguments).code(0);
        assert!(folder.read(name) == new);
        // A film that is of no use before its end has no name until then: nothing is left of those that were killed.
        let left = folder.without_parts(name);
        assert!(!cfg!(target_os = "linux") || name.ends_with(".gif") || left.is_empty(), "{left:?}");
        assert_eq!(folder.names(), [name]);
    }
}

/// A film that has to fit is made several times. A program that looks at its name all the while finds the old film and then
/// the one that stays, so a kill at any moment leaves one of the two.
#[test]
fn a_film_within_a_size_is_the_old_one_until_the_last_is_made() {
    for most in ["20kB", "60kB", "1kB"] {
        let folder = Folder::new(&format!("squeezed_{most}")).with("film.gif", OLD);
        let arguments =
            format!("render example:tetris --duration 4 --size 320x180 --quiet --max-size {most} -o film.gif");
        let mut child = folder.command(&arguments).stderr(Stdio::null()).spawn().unwrap();
        let mut seen = vec![OLD.to_vec()];
        loop {
            let ended = child.try_wait().unwrap();
            let now = folder.read("film.gif");
            if *seen.last().unwrap() != now {
                seen.push(now);
            }
            if let Some(ended) = ended {
                assert_eq!(seen.len(), if ended.success() { 2 } else { 1 }, "{most}");
                assert_eq!(ended.success(), most != "1kB");
                break;
            }
            std::thread::sleep(Duration::from_millis(1));
        }
        assert_eq!(folder.names(), ["film.gif"]);
    }
}

/// A disk that takes no more than 16 kB, as the limit of the shell for files.
#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_leaves_the_old_file_and_is_told() {
    let render = "render example:tetris --duration 6 --size 640x360 --quiet";
    for (name, command) in [
        ("film.gif", render.to_owned()),
        ("film.apng", render.to_owned()),
        ("film.rgba", render.to_owned()),
        ("sheet.png", format!("{render} --sheet 4x3")),
        ("table.csv", "run example:tetris --duration 6".to_owned()),
    ] {
        let folder = Folder::new(&format!("disk_{name}")).with(name, OLD);
        let jostle = env!("CARGO_BIN_EXE_jostle");
        let script = format!("trap '' XFSZ; ulimit -f 16; exec {jostle} {command} -o {name}");
        let output = Command::new("bash").args(["-c", &script]).current_dir(folder.path("")).output().unwrap();
        let said = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{name}: {said}");
        let told = format!("error: `{name}` could not be written: File too large");
        assert!(said.starts_with(&told) && said.contains("free some space"), "{said}");
        assert_eq!(folder.read(name), OLD);
        // The beginning of a GIF can be watched, that of a table read, and the message says where it is.
        let is_of_use = name.ends_with(".gif") || name.ends_with(".csv");
        let parts = folder.without_parts(name);
        assert_eq!(parts.len(), usize::from(is_of_use), "{said}");
        assert_eq!(folder.names(), [name], "{said}");
        let place = parts.iter().all(|part| said.contains(&format!("The part written so far is in `{part}`")));
        assert!(place && said.contains("so far") == is_of_use, "{said}");
    }
}

/// Nothing stays of a film that has to fit, and nothing is said to stay.
#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_keeps_no_beginning_of_a_film_within_a_size() {
    let folder = Folder::new("disk_within").with("film.gif", OLD);
    let command = "render example:tetris --duration 6 --size 640x360 --quiet --max-size 90MB -o film.gif";
    let script = format!("trap '' XFSZ; ulimit -f 16; exec {} {command}", env!("CARGO_BIN_EXE_jostle"));
    let output = Command::new("bash").args(["-c", &script]).current_dir(folder.path("")).output().unwrap();
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{said}");
    assert!(said.contains("File too large") && !said.contains("so far"), "{said}");
    assert_eq!((folder.read("film.gif"), folder.names()), (OLD.to_vec(), vec!["film.gif".to_owned()]));
}

/// The same for what goes to standard output, whose device is full or whose reader goes away.
#[cfg(target_os = "linux")]
#[test]
fn a_full_or_closed_standard_output_is_told() {
    let folder = Folder::new("closed_pipe");
    let render = "render example:tetris --duration 6 --size 320x180 --quiet -o -";
    let full = std::fs::OpenOptions::new().write(true).open("/dev/full").unwrap();
    let output = folder.command(render).stdout(full).output().unwrap();
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert!(said.starts_with("error: `standard output` could not be written: No space left on device"), "{said}");

    let mut child = folder.command(render).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    let mut reader = child.stdout.take().unwrap();
    std::io::Read::read_exact(&mut reader, &mut [0; 100]).unwrap();
    drop(reader);
    let output = child.wait_with_output().unwrap();
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{said}");
    assert!(said.contains("`standard output` could not be written: Broken pipe"), "{said}");
    assert!(said.contains("the program that read it ended before the film"), "{said}");
}

/// Law: memory does not grow with the length of the film, forwards, backwards or within a size. Four times as many
/// frames as in the short film, 900 more, would be 132 MB as pictures of 256 x 144; 8 MB of difference are allowed for
/// what the system's allocator keeps. Peaks are read from the system while the program runs, so what it takes in the
/// last millisecond is left out.
#[cfg(target_os = "linux")]
#[test]
fn memory_does_not_grow_with_the_length_of_the_film() {
    let scene = r#"Scene(
        format: 1,
        clock: (duration: 10, tick: "1 ms"),
        film: (fps: 30, size: (256, 144), speed: SPEED),
        camera: Look(center: (0, 0), height: 4),
        bodies: [(name: "ball", at: (-2, 0), velocity: (0.1, 0), spin: 3, atoms: Disc(radius: 0.3))],
    )"#;
    for (name, speed, flags) in [
        ("film.gif", "1", ""),
        ("film.apng", "1", ""),
        ("film.rgba", "1", ""),
        ("frames/", "1", ""),
        ("film.gif", "-1", ""),
        ("film.gif", "1", "--max-size 100kB"),
    ] {
        let folder = Folder::new("memory").with("spin.ron", scene.replace("SPEED", speed));
        let peak = |duration: u32| {
            let arguments = format!("render spin.ron --quiet --threads 2 --duration {duration} {flags} -o {name}");
            let mut child = folder.command(&arguments).spawn().unwrap();
            let status = format!("/proc/{}/status", child.id());
            let mut peak = 0;
            while child.try_wait().unwrap().is_none() {
                let text = std::fs::read_to_string(&status).unwrap_or_default();
                // Until the program has taken its place a new process has the name and the memory of this one.
                let begun = text.starts_with("Name:\tjostle\n");
                let line = text.lines().find_map(|line| line.strip_prefix("VmHWM:")).filter(|_| begun);
                let now = line.and_then(|line| line.trim().trim_end_matches(" kB").parse::<u64>().ok());
                peak = peak.max(now.unwrap_or(0));
                std::thread::sleep(Duration::from_millis(1));
            }
            assert!(child.wait().unwrap().success(), "{arguments}");
            peak
        };
        let (short, long) = (peak(10), peak(40));
        assert!(short > 1000 && long < short + 8000, "{name} {flags} at speed {speed}: {short} kB, {long} kB");
    }
}
