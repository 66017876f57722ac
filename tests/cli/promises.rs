//! Small promises of the commands, each a law of an output and its target.

use super::harness::{FALL, Folder};

/// Law: `-o -` is standard output with the very bytes of the file, and no file is made.
#[test]
fn channels_go_to_standard_output() {
    let folder = Folder::new("run_standard_output").with("fall.ron", FALL);
    folder.jostle("run fall.ron -o fall.csv --quiet").code(0);
    let ended = folder.jostle("run fall.ron -o - --quiet").code(0);
    assert_eq!(ended.out.as_bytes(), folder.read("fall.csv"));
    assert_eq!(folder.names(), ["fall.csv", "fall.ron"]);
    folder.jostle("run fall.ron -o - --json").code(2).says("not both");
}

/// Law: a channel is one column, however many sensors name it.
#[test]
fn a_channel_is_one_column() {
    let twice = FALL.replace("Energy()]", "Energy(), Pose(of: \"*\"), Energy()]");
    assert_ne!(twice, FALL);
    let folder = Folder::new("one_column").with("once.ron", FALL).with("twice.ron", twice);
    let once = folder.jostle("run once.ron -o - --quiet").code(0).out;
    assert_eq!(folder.jostle("run twice.ron -o - --quiet").code(0).out, once);
}

/// Law: `camera: Fit` shows what moves in every picture. The body moves 19 m in a run of less than two frames; a picture
/// without it would be that of the standing one alone.
#[test]
fn stills_between_frames_show_what_moves() {
    let scene = |moving: &str| {
        format!(
            "Scene(format: 1, clock: (duration: 1.9, tick: \"1 ms\"), film: (fps: 1, size: (320, 240)), look: (layers: []),
            camera: Fit(margin: 0), materials: {{ \"red\": (color: \"vermilion\") }}, bodies: [
                (name: \"b\", at: (0, 0), velocity: (10, 0), material: \"red\", atoms: Disc(radius: {moving}, mass: 1)),
                (name: \"c\", at: (0, 3), fixed: true, atoms: Disc(radius: 0.5, mass: 1))])"
        )
    };
    let folder = Folder::new("fit_stills").with("fit.ron", scene("0.5"));
    let red = |place: &str| {
        let pictures = image::load_from_memory(&folder.read(place)).unwrap().to_rgb8();
        pictures.pixels().filter(|pixel| pixel.0[0] > 150 && pixel.0[1] < 120 && pixel.0[2] < 90).count()
    };
    folder.jostle("render fit.ron --at 1.9 -o late.png --quiet").code(0);
    folder.jostle("render fit.ron --at 0 -o early.png --quiet").code(0);
    assert!(red("early.png") > 20 && red("late.png") > 20, "{} {}", red("early.png"), red("late.png"));
}

/// Law: what is explained and listed is all that may stand in a scene.
#[test]
fn every_word_of_a_scene_is_explained() {
    let folder = Folder::new("explain_all");
    let sections = folder.jostle("list sections").code(0).out;
    for name in ["format", "title", "notes", "include", "params", "templates", "instances", "Repeat", "bodies"] {
        assert!(sections.lines().any(|line| line.starts_with(&format!("{name} "))), "{name}: {sections}");
    }
    for line in sections.lines() {
        let name = line.split(' ').next().unwrap();
        folder.jostle(&format!("explain {name}")).code(0);
    }
    for (name, text) in [
        ("film.freeze", "a field of the section `film`"),
        ("clock.tick", "a field of the section `clock`"),
        ("paper", "is a theme"),
        ("T.position.x", "is a channel"),
    ] {
        let ended = folder.jostle(&format!("explain {name}")).code(0);
        assert!(ended.out.contains(text), "{name}: {ended:?}");
    }
    folder.jostle("explain film.nothing").code(2);
}

/// Law: the paragraphs at the end of a help text are filled: no line could have taken the first word of the next.
#[test]
fn help_is_wrapped_once() {
    let folder = Folder::new("help_paragraphs");
    for command in ["test", "fmt", "sweep", "run", "bench"] {
        let help = folder.jostle(&format!("{command} --help")).code(0).out;
        let (_, end) = help.split_once("Examples:").unwrap();
        let lines: Vec<&str> = end.lines().collect();
        for pair in lines.windows(2).filter(|pair| pair.iter().all(|line| line.starts_with(char::is_alphabetic))) {
            let word = pair[1].split(' ').next().unwrap();
            assert!(pair[0].len() + 1 + word.len() > 100, "{command}: {pair:?}");
        }
    }
}

/// What varies and is nothing in the scene is told before anything is written.
#[test]
fn a_slip_in_what_varies_is_told_at_once() {
    let scene = FALL.replace("    format: 1,", "    format: 1, params: { \"gap\": 1 },");
    let folder = Folder::new("vary_slip").with("fall.ron", scene);
    let ended = folder.jostle("sweep fall.ron --vary gapp=1..2 -o out").code(2).says("did you mean `gap`?");
    assert_eq!(ended.err.lines().count(), 1, "{ended:?}");
    assert_eq!(folder.names(), ["fall.ron"]);
}

/// A file that its owner made read-only stays as it is, also behind a link.
#[cfg(unix)]
#[test]
fn read_only_files_are_left_alone() {
    use std::os::unix::fs::PermissionsExt;
    let folder = Folder::new("read_only").with("kept.ron", FALL.replace("    format: 1,", "format:1,"));
    let before = folder.read("kept.ron");
    std::fs::set_permissions(folder.path("kept.ron"), std::fs::Permissions::from_mode(0o444)).unwrap();
    std::os::unix::fs::symlink("kept.ron", folder.path("link.ron")).unwrap();
    for name in ["kept.ron", "link.ron"] {
        folder.jostle(&format!("fmt {name}")).code(2).says("read-only");
    }
    assert_eq!(folder.read("kept.ron"), before);
}

/// An encoder that ends well and has written nothing has not made a film.
#[cfg(unix)]
#[test]
fn an_empty_video_is_no_video() {
    use std::os::unix::fs::PermissionsExt;
    let folder = Folder::new("empty_video").with("fall.ron", FALL).with("bin/ffmpeg", "#!/bin/sh\ncat > /dev/null\n");
    std::fs::set_permissions(folder.path("bin/ffmpeg"), std::fs::Permissions::from_mode(0o755)).unwrap();
    let path = format!("{}:/usr/bin:/bin", folder.path("bin").display());
    let ended = folder.command("render fall.ron -o fall.mp4").env("PATH", path).output().unwrap();
    assert_eq!(ended.status.code(), Some(2), "{ended:?}");
    assert!(String::from_utf8_lossy(&ended.stderr).contains("wrote no film"), "{ended:?}");
    assert_eq!(folder.names(), ["bin", "fall.ron"]);
}

/// Output that cannot be written is told once, not for each scene.
#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_is_told_once() {
    let folder = Folder::new("test_full").with("a.ron", FALL).with("b.ron", FALL).with("c.ron", FALL);
    let full = std::fs::File::options().write(true).open("/dev/full").unwrap();
    let ended = folder.command("test --json").stdout(full).output().unwrap();
    assert_eq!(ended.status.code(), Some(2), "{ended:?}");
    assert_eq!(String::from_utf8_lossy(&ended.stderr).matches("error: ").count(), 1, "{ended:?}");
}
