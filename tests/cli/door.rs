//! Files that scenes may read: of bounded size, in the scene's folder or below it, or in one above it.

use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use super::harness::{FALL, Folder};

const PART: &str = r#"Scene(format: 1, bodies: [(name: "other", at: (2, 1), atoms: Disc(radius: 0.1, mass: 1))])"#;

/// An entry of a scene for each way to name a file.
fn ways(file: &str) -> [(&'static str, String); 5] {
    let before = |section: String| FALL.replace("bodies: [", &format!("{section}, bodies: ["));
    let forces = format!("forces: [Drive(of: \"ball\", force: (1, 0), course: Csv(\"{file}\"))]");
    let picture = format!("bodies: [(name: \"cow\", at: (9, 1), atoms: Png(file: \"{file}\", height: 1, count: 9)), ");
    [
        ("include", before(format!("include: [(file: \"{file}\", prefix: \"p\")]"))),
        ("course", before(forces)),
        ("packing", before(format!("packings: [(name: \"g\", file: \"{file}\")]"))),
        ("theme", before(format!("look: (theme: \"{file}\")"))),
        ("picture", FALL.replace("bodies: [", &picture)),
    ]
}

/// Runs the program and fails where it takes longer than anyone waits.
fn ends(command: &mut Command) -> (Option<i32>, String) {
    let start = Instant::now();
    let mut child = command.stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap();
    while child.try_wait().unwrap().is_none() {
        if start.elapsed() > Duration::from_secs(20) {
            child.kill().unwrap();
            panic!("{command:?} does not end");
        }
        std::thread::sleep(Duration::from_millis(5));
    }
    let output = child.wait_with_output().unwrap();
    (output.status.code(), String::from_utf8(output.stderr).unwrap())
}

#[cfg(unix)]
#[test]
fn devices_and_pipes_are_no_files_of_a_scene() {
    let folder = Folder::new("devices_in_scenes");
    std::os::unix::fs::symlink("/dev/zero", folder.path("zero.ron")).unwrap();
    assert!(Command::new("mkfifo").arg(folder.path("pipe.ron")).status().unwrap().success());
    for file in ["zero.ron", "pipe.ron"] {
        for (way, scene) in ways(file) {
            std::fs::write(folder.path("scene.ron"), scene).unwrap();
            for flag in ["", " --allow-outside"] {
                let (code, said) = ends(&mut folder.command(&format!("render scene.ron --quiet{flag}")));
                assert_eq!(code, Some(1), "{way}: {said}");
                let reason = if flag.is_empty() && file == "zero.ron" { "lies neither in" } else { "device or a pipe" };
                assert!(said.contains(reason), "{way}: {said}");
            }
            // What is refused is known before anything runs.
            let (code, said) = ends(&mut folder.command("check scene.ron"));
            assert_eq!(code, Some(1), "{way}: {said}");
        }
    }
}

/// What the command line names may be any file, but of bounded size.
#[cfg(unix)]
#[test]
fn endless_files_on_the_command_line_are_told() {
    let folder = Folder::new("endless").with("fall.ron", FALL).with("out/.keep", "");
    for name in ["zero.ron", "zero.csv", "out/table.1-of-1.csv"] {
        std::os::unix::fs::symlink("/dev/zero", folder.path(name)).unwrap();
    }
    for command in [
        "render fall.ron --theme zero.ron -o a.gif",
        "plot zero.csv -o a.png",
        "sweep --merge out/",
        "report kepler -o there --peers zero.csv",
        "run zero.ron",
        "fmt zero.ron",
    ] {
        let (code, said) = ends(&mut folder.command(command));
        assert!(matches!(code, Some(1 | 2)) && said.starts_with("error: ") && said.len() < 2000, "{command}: {said}");
    }
}

#[test]
fn files_outside_the_folders_of_the_scene_want_a_flag() {
    let folder = Folder::new("outside").with("deep/scenes/below/part.ron", PART).with("deep/scenes/part.ron", PART);
    let folder = folder.with("deep/part.ron", PART).with("part.ron", PART).with("deep/beside/part.ron", PART);
    let here = folder.path("deep/scenes");
    let absolute = folder.path("deep/beside/part.ron");
    for (file, near) in [
        ("part.ron", true),
        ("below/part.ron", true),
        ("../part.ron", true),
        ("../../part.ron", true),
        ("../scenes/part.ron", true),
        ("../beside/part.ron", false),
        (absolute.to_str().unwrap(), false),
    ] {
        let (_, scene) = &ways(file)[0];
        std::fs::write(here.join("scene.ron"), scene).unwrap();
        for arguments in
            ["check deep/scenes/scene.ron", "run deep/scenes/scene.ron --quiet", "fmt --check deep/scenes/scene.ron"]
        {
            let ended = folder.jostle(arguments);
            let refused =
                ended.err.contains("lies neither in the folder of the scene or below it, nor in one above it");
            // The layout of a scene is the same whatever it includes.
            assert_eq!(refused, !near && !arguments.starts_with("fmt"), "{file}: {ended:?}");
            assert!(!refused || ended.err.contains("--allow-outside"), "{ended:?}");
            let ended = folder.jostle(&format!("{arguments} --allow-outside"));
            assert!(!ended.err.contains("error"), "{file}: {ended:?}");
        }
    }
}

/// A link leads where it leads.
#[cfg(unix)]
#[test]
fn a_link_to_a_file_outside_is_outside() {
    let folder =
        Folder::new("outside_by_link").with("scenes/own.ron", &ways("part.ron")[0].1).with("beside/part.ron", PART);
    std::os::unix::fs::symlink("../beside/part.ron", folder.path("scenes/part.ron")).unwrap();
    folder.jostle("check scenes/own.ron").code(1).says("`part.ron` lies neither in");
    folder.jostle("check scenes/own.ron --allow-outside").code(0);
    // Links to folders of scenes are no obstacle.
    std::os::unix::fs::symlink("scenes", folder.path("same")).unwrap();
    folder.jostle("check same/own.ron --allow-outside").code(0);
}
