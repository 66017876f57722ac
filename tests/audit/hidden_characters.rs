//! No character that a terminal obeys or hides reaches standard output or standard error, whatever a scene or a command
//! line holds.
//!
//! The law is a property of the bytes that the program writes, so there is no tolerance. The characters are the controls
//! C0 and C1, DEL, the marks of direction (Unicode Standard Annex #9) and marks without a width. Line breaks and tabs
//! are allowed. Each text of a scene takes part: as it stands, and as escapes of the scene language. JSON and formatted
//! scenes must also keep their meaning. Not tested: pixels of films on standard output, and messages of the system's loader.

use std::io::{ErrorKind, Write};
use std::path::PathBuf;
use std::process::{Command, Output, Stdio};

use jostle::scene::Source;
use jostle::simulation::Simulation;

/// Of each kind a few: a change of the terminal's title and colour, bells, deletions, directions, no width.
const HOSTILE: &str =
    "x\u{1b}]0;y\u{7}\u{8}\u{1b}[31m\u{7f}\u{85}\u{9b}2J\u{202e}\u{2066}\u{200f}\u{200b}\u{feff}\u{e0041}";

/// The same for places that hold a name of a file.
const HOSTILE_FILE: &str = "f\u{1b}[2J\u{7}\u{9b}\u{202e}\u{200b}";

/// A scene that runs. `@` stands for any text.
const RUNS: &str = r#"Scene( // @
    format: 1,
    title: "@",
    notes: "@",
    clock: (duration: 0.01, tick: 0.001, method: VelocityVerlet), /* @ */
    film: (fps: 100, size: (64, 36)),
    gravity: (0, -9.81),
    params: { "mass": 1 },
    bodies: [(name: "a", at: (0, 0), atoms: Disc(radius: 0.1, mass: "mass"))],
    sensors: [Pose(of: "a"), Expression(name: "h", of: "a.position.y")],
    plots: [(title: "@", channels: ["a.position.y"])],
    expect: [Inside(of: // @
        "a", /* @ */ box: ((5, 5), (6, 6)))],
)"#;

/// Wrong entries of a scene, each with text at another place.
const WRONG: [&str; 30] = [
    "title: r\"@\", @",
    "@: 1",
    "title: 1 /* @ */ 2",
    "walls: [(name: \"@\", left: (0, 0), right: (1, 0))]",
    "walls: [(name: \"f\", left: (0, 0), right: (1, 0), material: \"@\")]",
    "walls: [(name: \"f\", left: (0, 0), right: \"@\")]",
    "walls: [(name: \"f\", left: (0, \"1 @\"), right: (1, 0))]",
    "walls: [(name: \"f\", left: (0, \"@ + 1\"), right: (1, 0))]",
    "materials: { \"@\": (color: \"@\") }",
    "materials: { \"m\": (color: \"@\") }",
    "materials: { \"m\": (stiffness: \"2 @/m\") }",
    "pairs: [(between: (\"@\", \"m\"), friction: 1)]",
    "params: { \"@\": 1 }",
    "params: { \"p\": \"@\" }, sensors: [Pose(of: \"{p}\")]",
    "params: { \"p\": \"2 @\" }, gravity: (\"p\", 0)",
    "templates: { \"@\": (args: [\"@\"], bodies: []) }, instances: [(of: \"q@\", name: \"@\")]",
    "templates: { \"t\": (bodies: [(name: \"@\", at: (0, 0))]) }, instances: [(of: \"t\", name: \"i\")]",
    "include: [\"@.ron\"]",
    "sensors: [Pose(of: \"@\")]",
    "sensors: [Expression(name: \"@\", of: \"a.position.x\")]",
    "sensors: [Expression(name: \"e\", of: \"'@' + 1\")]",
    "sensors: [@(of: \"a\")]",
    "look: (theme: \"@\")",
    "look: (theme: \"@.ron\")",
    "look: (layers: [Trails(of: \"@\")])",
    "film: (freeze: [(touch: (\"@\", \"a\"), for: 1)])",
    "plots: [(title: \"@\", channels: [\"@\"])]",
    "joints: [Revolute(name: \"@\", a: \"@\", b: \"a\")]",
    "expect: [Channel(name: \"@\", below: 1)]",
    "expect: [Position(of: \"a\", // @\n at: 99, is: (1, 1), within: \"@\")]",
];

fn is_hidden(letter: char) -> bool {
    let invisible = matches!(letter, '\u{ad}' | '\u{61c}' | '\u{200b}'..='\u{200f}' | '\u{2028}'..='\u{202e}'
        | '\u{2060}'..='\u{206f}' | '\u{feff}' | '\u{e0000}'..='\u{e007f}');
    invisible || letter.is_control() && !matches!(letter, '\n' | '\t')
}

fn escaped(text: &str) -> String {
    text.chars()
        .map(|letter| if is_hidden(letter) { format!("\\u{{{:x}}}", letter as u32) } else { letter.into() })
        .collect()
}

/// A folder of its own, in which the program runs.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let path = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("hidden").join(name);
        let _ = std::fs::remove_dir_all(&path);
        std::fs::create_dir_all(&path).unwrap();
        Self(path)
    }

    fn write(&self, name: &str, text: &str) {
        std::fs::write(self.0.join(name), text).unwrap();
    }

    /// Runs the program, and looks at all that it prints.
    fn run(&self, arguments: &[&str], input: &str) -> Output {
        let mut command = Command::new(env!("CARGO_BIN_EXE_jostle"));
        command
            .current_dir(&self.0)
            .args(arguments)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped());
        let mut child = command.spawn().unwrap();
        match child.stdin.take().unwrap().write_all(input.as_bytes()) {
            // A command that reads no input may have ended before.
            Err(gone) if gone.kind() == ErrorKind::BrokenPipe => {}
            written => written.unwrap(),
        }
        let output = child.wait_with_output().unwrap();
        for (stream, bytes) in [("output", &output.stdout), ("error", &output.stderr)] {
            let text =
                std::str::from_utf8(bytes).unwrap_or_else(|_| panic!("{arguments:?}: no text on standard {stream}"));
            let found: Vec<char> = text.chars().filter(|letter| is_hidden(*letter)).collect();
            assert!(
                found.is_empty(),
                "{arguments:?} prints {found:?} to standard {stream}:\n{text:?}\ninput: {input:?}"
            );
        }
        let said = output.stdout.len() + output.stderr.len();
        assert!(said > 0 || arguments.contains(&"fmt"), "{arguments:?} says nothing");
        output
    }
}

fn lines_of_json(output: &Output) -> Vec<serde_json::Value> {
    let text = std::str::from_utf8(&output.stdout).unwrap();
    text.lines().map(|line| serde_json::from_str(line).unwrap_or_else(|error| panic!("{error}: {line}"))).collect()
}

#[test]
fn a_scene_that_runs_prints_no_hidden_character_by_any_command() {
    let folder = Folder::new("runs");
    for (way, text) in [("raw", HOSTILE.to_owned()), ("escaped", escaped(HOSTILE))] {
        let name = format!("{HOSTILE_FILE}{way}.ron");
        folder.write(&name, &RUNS.replace('@', &text));
        let name = name.as_str();
        let commands: [&[&str]; 16] = [
            &["run", name],
            &["run", name, "--reverse", "--no-estimate"],
            &["run", name, "--no-estimate", "-o", "-"],
            &["run", name, "--no-estimate", "-o", &format!("{HOSTILE_FILE}.csv")],
            &["render", name, "--no-estimate"],
            &["render", name, "--no-estimate", "--at", "0.005", "-o", &format!("{HOSTILE_FILE}.png")],
            &["plot", name, "--channels", "h"],
            &["check", name],
            &["check", name, "--run"],
            &["test", "."],
            &["test", name, "--junit", "junit.xml"],
            &["sweep", name, "--vary", "mass=1..2", "-o", HOSTILE_FILE],
            &["bench", name, "--rounds", "1", "--ticks", "2"],
            &["measure", name, "--budget", "0.2", "--rungs", "2", "--methods", "VelocityVerlet"],
            &["explain", name],
            &["fmt", "--check", name],
        ];
        for command in commands {
            folder.run(command, "");
        }
        let junit = std::fs::read_to_string(folder.0.join("junit.xml")).unwrap();
        assert!(!junit.contains(is_hidden), "{junit:?}");
        let json: [&[&str]; 6] = [
            &["run", name, "--no-estimate", "--json"],
            &["check", name, "--json"],
            &["test", name, "--json"],
            &["render", name, "--no-estimate", "--json", "-o", "film.gif"],
            &["bench", name, "--rounds", "1", "--ticks", "2", "--json"],
            &["explain", name, "--json"],
        ];
        for command in json {
            for value in lines_of_json(&folder.run(command, "")) {
                // Masked only as JSON masks, so that programs read the name and the title as they are.
                if let Some(scene) = value.get("scene") {
                    assert_eq!(scene, name, "{command:?}");
                }
                if let Some(title) = value.get("title") {
                    assert_eq!(title, HOSTILE, "{command:?}");
                }
            }
        }
    }
}

#[test]
fn the_standard_layout_has_no_hidden_character_and_keeps_the_meaning() {
    let folder = Folder::new("fmt");
    for quotes in [("\"", "\""), ("r\"", "\""), ("r#\"\"", "\\\"#")] {
        let (open, close) = quotes;
        let text = RUNS
            .replace("title: \"@\",\n    notes", &format!("title: {open}@{close},\n    notes"))
            .replace('@', HOSTILE);
        let title = |text: &str| Simulation::load(&Source::new("a.ron", text)).unwrap().header().title.clone();
        let output = folder.run(&["fmt", "-"], &text);
        let formatted = String::from_utf8(output.stdout).unwrap();
        assert_eq!(title(&formatted), title(&text), "{formatted}");
        assert_eq!(folder.run(&["fmt", "-"], &formatted).stdout, formatted.as_bytes(), "the layout is a fixed point");
    }
}

#[test]
fn mistakes_print_no_hidden_character() {
    let folder = Folder::new("wrong");
    let plain = |entry: &str| {
        let rest =
            "bodies: [(name: \"a\", at: (0, 0), atoms: Disc(radius: 0.1))], clock: (duration: 0.01, tick: 0.001)";
        format!("Scene(format: 1, {rest},\n /* @ */ {entry} // @\n)")
    };
    for entry in WRONG {
        for text in [HOSTILE.to_owned(), escaped(HOSTILE), format!("{HOSTILE}\n{HOSTILE}")] {
            let scene = plain(entry).replace('@', &text);
            folder.write("wrong.ron", &scene);
            for command in [&["check", "wrong.ron", "--run"][..], &["test", "wrong.ron"], &["fmt", "-"]] {
                folder.run(command, &scene);
            }
            lines_of_json(&folder.run(&["check", "wrong.ron", "--json"], ""));
        }
    }
}

#[test]
fn command_lines_print_no_hidden_character() {
    let folder = Folder::new("arguments");
    folder.write("a.ron", &RUNS.replace('@', "plain"));
    let flag = format!("--{HOSTILE_FILE}");
    let setting = format!("{HOSTILE_FILE}=1");
    let missing = format!("{HOSTILE_FILE}.ron");
    let commands: [&[&str]; 22] = [
        &[HOSTILE_FILE],
        &["run", &flag],
        &["run", &missing],
        &["run", &format!("example:{HOSTILE_FILE}")],
        &["run", "a.ron", "--method", HOSTILE_FILE],
        &["run", "a.ron", "--tick", HOSTILE_FILE],
        &["run", "a.ron", "--set", &setting],
        &["run", "a.ron", "--set", HOSTILE_FILE],
        &["run", "a.ron", "-o", &format!("{HOSTILE_FILE}/a.csv")],
        &["run", "a.ron", "--save", &format!("at={HOSTILE_FILE}:x")],
        &["run", "a.ron", "--resume", HOSTILE_FILE],
        &["render", "a.ron", "--theme", HOSTILE_FILE],
        &["render", "a.ron", "--layers", HOSTILE_FILE],
        &["render", "a.ron", "-o", &format!("film.{HOSTILE_FILE}")],
        &["plot", "a.ron", "--channels", HOSTILE_FILE],
        &["check", &missing, "--json"],
        &["test", HOSTILE_FILE],
        &["sweep", "a.ron", "--vary", &format!("{HOSTILE_FILE}=1..2"), "-o", "out"],
        &["report", HOSTILE_FILE, "-o", "out"],
        &["explain", HOSTILE_FILE],
        &["list", HOSTILE_FILE],
        &["new", "plugin", HOSTILE_FILE],
    ];
    for command in commands {
        folder.run(command, "");
    }
}
