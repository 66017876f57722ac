//! Runs the program in a folder of its own.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// A ball falls for a fifth of a second: two frames of a small picture.
pub const FALL: &str = r#"Scene(
    format: 1,
    clock: (duration: 0.2, tick: "1 ms", method: VelocityVerlet),
    film: (fps: 10, size: (64, 36)),
    gravity: (0, -9.81),
    materials: { "soft": (stiffness: 1000) },
    bodies: [(name: "ball", at: (0, 1), material: "soft", atoms: Disc(radius: 0.1, mass: 1))],
    sensors: [Pose(of: "ball"), Energy()],
)"#;

/// Two hard balls in a room, and a tick a thousand times too long: each bounce makes them faster.
pub const EXPLOSION: &str = r#"Scene(
    format: 1,
    clock: (duration: 4, tick: "10 ms", method: VelocityVerlet),
    film: (fps: 10, size: (64, 36)),
    gravity: (0, -9.81),
    materials: { "hard": (stiffness: 1e9) },
    walls: [
        (name: "floor", left: (1, 0), right: (0, 0), material: "hard"),
        (name: "ceiling", left: (0, 2), right: (1, 2), material: "hard"),
    ],
    bodies: [
        (name: "first", at: (1, 0.5), material: "hard", atoms: Disc(radius: 0.1, mass: 0.01)),
        (name: "second", at: (1.05, 0.75), material: "hard", atoms: Disc(radius: 0.1, mass: 0.01)),
    ],
    sensors: [Pose(of: "first")],
)"#;

/// Forces so large that velocities are infinite after one tick.
pub const OVERFLOW: &str = r#"Scene(
    format: 1,
    clock: (duration: 4, tick: "10 ms", method: VelocityVerlet),
    film: (fps: 10, size: (64, 36)),
    forces: [Thrust(of: "ball", force: (1e308, 0), from: 1)],
    bodies: [(name: "ball", at: (0, 1), atoms: Disc(radius: 0.1, mass: 0.001))],
)"#;

/// A folder of its own, empty at the beginning.
pub struct Folder(PathBuf);

impl Folder {
    pub fn new(name: &str) -> Self {
        let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join("cli").join(name);
        let _ = std::fs::remove_dir_all(&path);
        std::fs::create_dir_all(&path).unwrap();
        Self(path)
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.0.join(name)
    }

    pub fn has(&self, name: &str) -> bool {
        self.path(name).exists()
    }

    pub fn read(&self, name: &str) -> Vec<u8> {
        std::fs::read(self.path(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
    }

    pub fn with(self, name: &str, content: impl AsRef<[u8]>) -> Self {
        let path = self.path(name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, content).unwrap();
        self
    }

    /// The names in it, in order.
    pub fn names(&self) -> Vec<String> {
        let entries = std::fs::read_dir(&self.0).unwrap();
        let mut names: Vec<String> = entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }

    /// The temporary files for a name: with random letters and the ending `.part`.
    pub fn parts(&self, name: &str) -> Vec<String> {
        let begin = format!("{name}.");
        let mut names = self.names();
        names.retain(|other| other.starts_with(&begin) && other.ends_with(".part"));
        names
    }

    /// Removes the temporary files for a name, and returns what they were called.
    pub fn without_parts(&self, name: &str) -> Vec<String> {
        let parts = self.parts(name);
        parts.iter().for_each(|part| std::fs::remove_file(self.path(part)).unwrap());
        parts
    }

    /// The program, about to run in this folder.
    pub fn command(&self, arguments: &str) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_jostle"));
        command.current_dir(&self.0).args(arguments.split_whitespace()).stdin(Stdio::null());
        command
    }

    /// Runs the program with arguments separated by blanks.
    pub fn jostle(&self, arguments: &str) -> Ended {
        let output = self.command(arguments).output().unwrap();
        let ended = Ended {
            code: output.status.code(),
            out: String::from_utf8(output.stdout).unwrap(),
            err: String::from_utf8(output.stderr).unwrap(),
            arguments: arguments.to_owned(),
        };
        // 101 is the exit code of a panic.
        assert!(matches!(ended.code, Some(0..=3)) && !ended.err.contains("panicked"), "{ended:?}");
        ended
    }
}

/// How the program ended.
#[derive(Debug)]
pub struct Ended {
    pub code: Option<i32>,
    pub out: String,
    pub err: String,
    /// For messages of failing tests.
    #[expect(dead_code, reason = "shown by Debug")]
    arguments: String,
}

impl Ended {
    /// Checks the exit code.
    #[track_caller]
    pub fn code(self, code: i32) -> Self {
        assert_eq!(self.code, Some(code), "{self:#?}");
        self
    }

    /// Checks that standard error has a text.
    #[track_caller]
    pub fn says(self, text: &str) -> Self {
        assert!(self.err.contains(text), "expected {text:?} in {self:#?}");
        self
    }

    /// The lines of standard output, each read as JSON.
    #[track_caller]
    pub fn json(&self) -> Vec<serde_json::Value> {
        self.out
            .lines()
            .map(|line| serde_json::from_str(line).unwrap_or_else(|error| panic!("{error}: {line}")))
            .collect()
    }
}
