//! Every file that the program writes comes from one writer. Two programs do not spoil each other's files, links and
//! permissions stay, and only the target changes.

use std::process::Stdio;

use super::harness::{FALL, Folder};

/// A command for each way to write a file, and the file.
const WAYS: [(&str, &str); 10] = [
    ("run fall.ron -o out.csv", "out.csv"),
    ("render fall.ron -o out.gif", "out.gif"),
    ("render fall.ron -o out.apng", "out.apng"),
    ("render fall.ron -o out.rgba", "out.rgba"),
    ("render fall.ron -o out.png --at 0.1", "out.png"),
    ("render fall.ron -o out.png --strip 0,0.1", "out.png"),
    ("plot fall.ron --channels ball.position.y -o out.png", "out.png"),
    ("test fall.ron --junit out.xml", "out.xml"),
    ("schema -o out.json", "out.json"),
    ("sweep fall.ron --vary clock.tick=1ms,2ms -o . --no-sheet", "table.csv"),
];

const MINE: &[u8] = b"a file of my own";

fn folder(name: &str, way: usize) -> Folder {
    Folder::new(&format!("{name}_{way}")).with("fall.ron", FALL)
}

/// Films of different lengths: the one that ends last wins, and is whole.
#[test]
fn two_programs_that_write_one_target_leave_the_whole_file_of_one() {
    let folder = Folder::new("two_writers").with("fall.ron", FALL);
    for (name, command) in [
        ("film.gif", "render fall.ron --size 128x72 --quiet -o film.gif --fps 50 --duration"),
        ("film.apng", "render fall.ron --size 128x72 --quiet -o film.apng --fps 50 --duration"),
        ("table.csv", "run fall.ron --quiet -o table.csv --tick 0.02ms --duration"),
    ] {
        let alone = ["1", "1.7"].map(|duration| {
            folder.jostle(&format!("{command} {duration}")).code(0);
            folder.read(name)
        });
        for trial in 0..6 {
            let begin = |duration: &str| {
                let mut command = folder.command(&format!("{command} {duration}"));
                command.stderr(Stdio::null()).stdout(Stdio::null()).spawn().unwrap()
            };
            for mut child in [begin("1"), begin("1.7")] {
                assert!(child.wait().unwrap().success(), "{name}, trial {trial}");
            }
            assert!(alone.contains(&folder.read(name)), "{name}, trial {trial}: {} bytes", folder.read(name).len());
        }
        assert!(folder.names().iter().all(|name| !name.ends_with(".part")), "{:?}", folder.names());
    }
}

/// Names of temporary files have random letters, so that a file of the user's never has one.
#[test]
fn files_that_end_with_part_stay() {
    for (way, (command, name)) in WAYS.into_iter().enumerate() {
        let part = format!("{name}.part");
        let folder = folder("part_stays", way).with(&part, MINE);
        folder.jostle(command).code(0);
        assert_eq!(folder.read(&part), MINE, "{command}");
        assert_eq!(folder.names(), ["fall.ron", name, &part], "{command}");
    }
}

#[cfg(unix)]
#[test]
fn links_stay_links_and_lead_to_the_new_file() {
    for (way, (command, name)) in WAYS.into_iter().enumerate() {
        let folder = folder("links", way).with("real/old", MINE).with("mine", MINE);
        for real in ["real/old", "real/new"] {
            let _ = std::fs::remove_file(folder.path(name));
            std::os::unix::fs::symlink(real, folder.path(name)).unwrap();
            // In older programs this was where the file was written until it was complete.
            let part = folder.path(&format!("{name}.part"));
            let _ = std::fs::remove_file(&part);
            std::os::unix::fs::symlink("mine", &part).unwrap();
            folder.jostle(command).code(0);
            assert!(folder.path(name).symlink_metadata().unwrap().is_symlink(), "{command}");
            assert!(folder.read(real) != MINE && folder.read(real).len() > 10, "{command} to {real}");
            assert_eq!(folder.read("mine"), MINE, "{command}");
        }
        let mut names: Vec<_> =
            std::fs::read_dir(folder.path("real")).unwrap().map(|it| it.unwrap().file_name()).collect();
        names.sort();
        assert_eq!(names, ["new", "old"], "{command}");
    }
}

#[cfg(unix)]
#[test]
fn permissions_stay_and_new_files_have_those_of_any_file() {
    use std::os::unix::fs::PermissionsExt;
    let mode = |folder: &Folder, name: &str| folder.path(name).metadata().unwrap().permissions().mode() & 0o777;
    for (way, (command, name)) in WAYS.into_iter().enumerate() {
        let folder = folder("modes", way);
        std::fs::write(folder.path("any"), "").unwrap();
        folder.jostle(command).code(0);
        assert_eq!(mode(&folder, name), mode(&folder, "any"), "{command}");
        std::fs::set_permissions(folder.path(name), PermissionsExt::from_mode(0o640)).unwrap();
        folder.jostle(command).code(0);
        assert_eq!(mode(&folder, name), 0o640, "{command}");
    }
}

#[cfg(unix)]
#[test]
fn read_only_files_are_refused_and_stay() {
    use std::os::unix::fs::PermissionsExt;
    for (way, (command, name)) in WAYS.into_iter().enumerate() {
        let folder = folder("read_only", way).with(name, MINE);
        std::fs::set_permissions(folder.path(name), PermissionsExt::from_mode(0o444)).unwrap();
        folder.jostle(command).code(2).says("could not be written: it is read-only");
        assert_eq!(folder.read(name), MINE, "{command}");
        assert_eq!(folder.names(), ["fall.ron", name], "{command}");
    }
}

/// A name that tells of a picture or a table, and leads to a scene.
#[cfg(unix)]
#[test]
fn links_to_scenes_are_refused() {
    let merge = "sweep --merge out";
    for (command, link) in [
        ("render fall.ron --quiet -o link.gif", "link.gif"),
        ("render fall.ron --quiet --at 0.1 -o link.png", "link.png"),
        ("run fall.ron --quiet -o link.csv", "link.csv"),
        ("run fall.ron --quiet --save at=0.1s:link.bin", "link.bin"),
        (merge, "out/table.csv"),
    ] {
        let folder = Folder::new("scene_link").with("fall.ron", FALL).with("other.ron", FALL).with("out/x", "");
        if command == merge {
            for shard in ["1/2", "2/2"] {
                let sweep =
                    format!("sweep fall.ron --vary clock.duration=1..2 --no-sheet --quiet -o out --shard {shard}");
                folder.jostle(&sweep).code(0);
            }
        }
        std::os::unix::fs::symlink(folder.path("other.ron"), folder.path(link)).unwrap();
        folder.jostle(command).code(2).says("scene");
        assert_eq!(folder.read("other.ron"), FALL.as_bytes(), "{command}");
        assert!(folder.path(link).is_symlink(), "{command}");
    }
}

/// The random letters of the temporary file do not make a name too long that is long but good.
#[test]
fn a_name_as_long_as_names_may_be_is_written() {
    let name = format!("{}.csv", "long".repeat(62));
    let folder = Folder::new("long_name").with("fall.ron", FALL);
    folder.jostle(&format!("run fall.ron --quiet -o {name}")).code(0);
    assert_eq!(folder.names(), ["fall.ron", &name]);
}

/// A scene is written only where no file has its name, not even a link to one that is not there.
#[cfg(unix)]
#[test]
fn a_new_scene_does_not_follow_links() {
    let folder = Folder::new("new_link");
    std::os::unix::fs::symlink("elsewhere.ron", folder.path("mine.ron")).unwrap();
    folder.jostle("new scene mine").code(2).says("`mine.ron` exists already");
    assert_eq!(folder.names(), ["mine.ron"]);
}

/// A disk that is full leaves no half of a new crate.
#[cfg(target_os = "linux")]
#[test]
fn a_new_plugin_is_whole_or_not_there() {
    let folder = Folder::new("new_full");
    let script = format!("trap '' XFSZ; ulimit -f 1; exec {} new plugin band", env!("CARGO_BIN_EXE_jostle"));
    let output =
        std::process::Command::new("bash").args(["-c", &script]).current_dir(folder.path("")).output().unwrap();
    assert_eq!(output.status.code(), Some(2), "{output:?}");
    assert!(folder.names().is_empty(), "{:?}", folder.names());
}
