//! Files that are no scenes: the message names the file and what to do, the exit code is 1.

use super::harness::Folder;

#[test]
fn a_missing_file_is_named_with_a_remedy() {
    let folder = Folder::new("missing");
    for command in ["run", "render", "check"] {
        let ended = folder.jostle(&format!("{command} no/such.ron")).code(2);
        let expected =
            "error: there is no file `no/such.ron`\n |\n = help: check the spelling and the folder you are in\n";
        assert_eq!(ended.err, expected);
        assert_eq!(ended.out, "");
    }
    assert_eq!(folder.names(), [""; 0]);
}

#[test]
fn a_folder_an_empty_file_and_bytes_are_no_scenes() {
    let folder =
        Folder::new("no_scenes").with("empty.ron", "").with("bytes.ron", b"GIF89a\0\xff").with("latin.ron", b"// \xe4");
    for (scene, message) in [
        (".", "error: `.` is a folder"),
        ("empty.ron", "error: the scene is empty\n --> empty.ron:1:1"),
        ("bytes.ron", "error: `bytes.ron` is not a text file: a zero byte at position 6"),
        ("latin.ron", "error: `latin.ron` is not UTF-8 text: the first bad byte is on line 1"),
    ] {
        folder.jostle(&format!("run {scene}")).code(1).says(message).says("= help: ");
    }
}

/// The file is sparse: nothing is written, and nothing may be read.
#[test]
fn a_file_of_a_hundred_megabytes_is_refused_unread() {
    let folder = Folder::new("large");
    std::fs::File::create(folder.path("large.ron")).unwrap().set_len(100 << 20).unwrap();
    let message = "error: `large.ron` is too large for a scene: 100 MiB, the limit is 64 MiB";
    folder.jostle("check large.ron").code(1).says(message).says("many bodies are shorter with `fill`");
    std::fs::remove_file(folder.path("large.ron")).unwrap();
}

#[test]
fn nested_and_truncated_scenes_are_refused_with_a_place() {
    let deep = format!("Scene(format: 1, clock: {}{})", "(".repeat(50_000), ")".repeat(50_000));
    let folder = Folder::new("broken").with("deep.ron", deep).with("open.ron", "[".repeat(100_000));
    for scene in ["deep.ron", "open.ron"] {
        folder.jostle(&format!("check {scene}")).code(1).says("brackets are nested more than 48 deep").says(scene);
    }
    let whole = super::harness::FALL;
    for length in (1..whole.len()).step_by(37) {
        let folder = Folder::new("truncated").with("cut.ron", &whole[..length]);
        folder.jostle("check cut.ron").code(1).says("error: ").says("--> cut.ron:");
    }
}

#[test]
fn an_unknown_example_is_answered_with_the_known_ones() {
    let ended = Folder::new("example").jostle("run example:chess").code(2);
    assert!(ended.err.starts_with("error: there is no example `chess`\n"), "{ended:?}");
    assert!(ended.err.contains("= help: examples: arch, billiards, "), "{ended:?}");
}

/// The scene is read once, though the camera looks ahead: a pipe has nothing left the second time.
#[cfg(unix)]
#[test]
fn a_scene_may_come_from_a_pipe() {
    use std::io::Write;
    use std::process::Stdio;
    let folder = Folder::new("pipe");
    let mut child = folder.command("render /dev/stdin --quiet").stdin(Stdio::piped()).spawn().unwrap();
    child.stdin.take().unwrap().write_all(super::harness::FALL.as_bytes()).unwrap();
    assert!(child.wait().unwrap().success());
    assert_eq!(folder.names(), ["stdin.gif"]);
}

/// Names with a path stand wherever names do: sensors and their columns, forces, expectations, cameras and results.
#[test]
fn names_with_a_path_stand_wherever_names_do() {
    let scene = r#"Scene(
        format: 1,
        clock: (duration: 0.2, tick: "1 ms"),
        film: (fps: 10, size: (64, 36), freeze: [(touch: ("robot_1/left_leg", "robot_1/sole"), for: 0.1)]),
        gravity: (0, -9.81),
        templates: { "robot": (args: ["x"],
            bodies: [(name: "left_leg", at: ("x", 0.1), atoms: Disc(radius: 0.1, mass: 1))],
            walls: [(name: "sole", left: (1, 0), right: (0, 0))],
        ) },
        instances: [Repeat(count: 2, make: (of: "robot", name: "robot_{i}", with: (x: "i")))],
        sensors: [Pose(of: "robot_1/left_leg"), Velocity(of: "robot_*/left_leg"), ContactForce(on: "robot_0/sole"), Contacts(of: "robot_1/left_leg")],
        forces: [Drag(linear: 0.1, of: "robot_1/*"), Torque(of: "robot_0/left_leg", value: 0.01), Thrust(of: ["robot_0/left_leg"], force: (0.1, 0))],
        camera: Follow(of: "robot_1/left_leg", height: 2),
        expect: [
            Position(of: "robot_1/left_leg", at: 0, is: (1, 0.1), within: 1e-3),
            Inside(of: "robot_*", box: ((-1, 0), (2, 1))),
            Channel(name: "robot_1/left_leg.position.y", below: 1),
        ],
    )"#;
    let folder = Folder::new("paths").with("robots.ron", scene);
    let ended = folder.jostle("run robots.ron -o channels.csv --json").code(0);
    let result: serde_json::Value = serde_json::from_str(&ended.out).unwrap();
    assert_eq!(result["bodies"][1]["name"], "robot_1/left_leg");
    assert!(result["expect"].as_array().unwrap().iter().all(|expectation| expectation["holds"] == true), "{result}");
    let table = String::from_utf8(folder.read("channels.csv")).unwrap();
    let header: Vec<&str> = table.lines().next().unwrap().split(',').collect();
    for column in ["robot_1/left_leg.position.x [m]", "robot_0/left_leg.velocity.y [m/s]", "robot_0/sole.force.y [N]"] {
        assert!(header.contains(&column), "{column} of {header:?}");
    }
    folder.jostle("render robots.ron --quiet").code(0);
}
