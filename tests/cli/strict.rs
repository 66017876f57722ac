//! `--strict`: the verdict `Do not trust it` is an exit code. Also the predictions of `check`.

use std::process::Stdio;

use super::harness::{FALL, Folder};

/// A ball on a spring so stiff that each period takes three ticks: it comes to its end, and nothing of it is right.
const WILD: &str = r#"Scene(
    format: 1,
    clock: (duration: 0.5, tick: "10 ms", method: VelocityVerlet),
    film: (fps: 10, size: (64, 36)),
    gravity: (0, -9.81),
    materials: { "hard": (stiffness: 1e5) },
    walls: [(name: "floor", left: (1, 0), right: (0, 0), material: "hard")],
    bodies: [(name: "ball", at: (0.5, 0.6), material: "hard", atoms: Disc(radius: 0.1, mass: 1))],
    sensors: [Pose(of: "ball")],
)"#;

#[test]
fn strict_makes_distrust_an_exit_code() {
    let folder = Folder::new("strict").with("wild.ron", WILD).with("fall.ron", FALL);
    folder.jostle("run wild.ron").code(0).says("Do not trust it: ");
    for command in [
        "run",
        "run --quiet",
        "run --json",
        "render",
        "check --run",
        "test",
        "sweep --vary clock.duration=0.5,0.45 -o out",
    ] {
        folder.jostle(&format!("{command} wild.ron")).code(0);
        let ended = folder.jostle(&format!("{command} wild.ron --strict")).code(3);
        assert!(format!("{}{}", ended.out, ended.err).contains("Do not trust it: "), "{ended:?}");
        folder.jostle(&format!("{} fall.ron --strict", command.replace("0.45", "0.4"))).code(0);
    }
    folder.jostle("check wild.ron --strict").code(2).says("--strict is about runs: add --run");
}

#[test]
fn check_finds_what_render_refuses() {
    let folder = Folder::new("check_films").with("bad.ron", "Theme(ink: 1)");
    for (name, film, told) in [
        ("lost", "look: (theme: \"lost.ron\"), ", "look.theme: there is no file `lost.ron`"),
        ("bad", "look: (theme: \"bad.ron\"), ", "look.theme: `bad.ron` is no theme: "),
        ("slow", "film: (speed: 1e-9), ", "film: 0.2 s of physics would be 6e9 frames, more than 1000000"),
        ("late", "film: (from: 0.3), ", "film.from: the film begins at 0.3 s, but the run ends at 0.2 s"),
        ("still", "film: (freeze: [(at: 0.3, for: 1)]), ", "film.freeze[0].at: the film is to stop at 0.3 s"),
    ] {
        let scene = FALL.replace("film: (fps: 10, size: (64, 36)),", "").replace("gravity", &format!("{film}gravity"));
        std::fs::write(folder.path(&format!("{name}_.ron")), scene).unwrap();
        for command in ["render", "check", "check --run"] {
            folder.jostle(&format!("{command} {name}_.ron")).code(1).says(told);
        }
        let ended = folder.jostle(&format!("check --json {name}_.ron")).code(1);
        let message = ended.json()[0]["errors"][0]["message"].as_str().unwrap().to_owned();
        assert!(message.starts_with(told.split_once(": ").unwrap().1.trim_end()), "{message}");
    }
}

/// `jostle run .. -o - | head`: a reader that has seen enough is no mistake.
#[cfg(unix)]
#[test]
fn a_table_whose_reader_goes_away_ends_quietly() {
    let folder = Folder::new("head").with("fall.ron", FALL);
    let mut command = folder.command("run fall.ron -o - --quiet --duration 20 --tick 0.1ms");
    let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    let mut reader = child.stdout.take().unwrap();
    std::io::Read::read_exact(&mut reader, &mut [0; 20]).unwrap();
    drop(reader);
    let output = child.wait_with_output().unwrap();
    assert_eq!((output.status.code(), String::from_utf8(output.stderr).unwrap()), (Some(0), String::new()));
}
