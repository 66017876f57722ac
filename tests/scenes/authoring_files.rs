//! Scenes made of several files, and sections of plugins in templates.
//!
//! Tolerance: none. What is left out: folders that cannot be read, which depends on who runs the tests.

use std::path::{Path, PathBuf};

use bevy_app::App;
use bevy_ecs::resource::Resource;
use jostle::Simulation;
use jostle::scene::{Diagnostics, NameKind, Outline, SceneAppExt, SceneErrors, Section, Source};
use jostle::simulation::Overrides;

use super::authoring::end;

/// Writes files into a folder of their own and reads the first as a scene.
fn scene(folder: &str, files: &[(&str, &str)]) -> Source {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("authoring").join(folder);
    let _ = std::fs::remove_dir_all(&folder);
    for (name, text) in files {
        let path = folder.join(name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, text).unwrap();
    }
    Source::read(&folder.join(files[0].0)).unwrap()
}

fn refused(source: &Source) -> SceneErrors {
    Simulation::load(source).err().unwrap_or_else(|| panic!("taken as good:\n{}", source.text))
}

/// The messages without the folder, which is another one on every machine.
fn told(source: &Source) -> String {
    let folder: PathBuf = source.folder.clone().unwrap();
    refused(source).to_string().replace(&format!("{}/", folder.display()), "")
}

const ARM: &str = r#"Scene(
    format: 1,
    params: { "size": "10 cm" },
    clock: (duration: 3),
    include: [(file: "deeper/finger.ron", prefix: "finger")],
    bodies: [(name: "hand", at: (2, 1), atoms: Disc(radius: "size"))],
    templates: { "dot": (args: ["x"], bodies: [(name: "dot", at: ("x", 5), atoms: Disc(radius: "size / 2"))]) },
    forces: [Drag(linear: 0.1, of: "hand"), Drag(linear: 0.2, of: "finger/tip")],
)"#;
const FINGER: &str = r#"Scene(format: 1, bodies: [(name: "tip", at: (3, 1), atoms: Disc(radius: 0.05))])"#;

#[test]
fn files_bring_their_lists_and_maps_under_a_prefix() {
    let main = r#"Scene(
        format: 1,
        clock: (duration: 0.5, tick: "1 ms"),
        gravity: (0, -9.81),
        include: [(file: "parts/arm.ron", prefix: "a"), (file: "parts/arm.ron", prefix: "b", with: (size: "2 * 10 cm"))],
        instances: [(of: "a/dot", name: "d", with: (x: 7))],
    )"#;
    let made = scene("good", &[("main.ron", main), ("parts/arm.ron", ARM), ("parts/deeper/finger.ron", FINGER)]);
    let by_hand = r#"Scene(
        format: 1,
        clock: (duration: 0.5, tick: "1 ms"),
        gravity: (0, -9.81),
        bodies: [
            (name: "a/finger/tip", at: (3, 1), atoms: Disc(radius: 0.05)),
            (name: "a/hand", at: (2, 1), atoms: Disc(radius: 0.1)),
            (name: "b/finger/tip", at: (3, 1), atoms: Disc(radius: 0.05)),
            (name: "b/hand", at: (2, 1), atoms: Disc(radius: 0.2)),
            (name: "d/dot", at: (7, 5), atoms: Disc(radius: 0.05)),
        ],
        forces: [
            Drag(linear: 0.1, of: "a/hand"), Drag(linear: 0.2, of: "a/finger/tip"),
            Drag(linear: 0.1, of: "b/hand"), Drag(linear: 0.2, of: "b/finger/tip"),
        ],
    )"#;
    assert_eq!(end(&made), end(&Source::new("a.ron", by_hand)));
    let notes = Simulation::load(&made).unwrap().header().remarks.clone();
    assert!(notes.iter().any(|note| note.contains("arm.ron: its `clock` is left out")), "{notes:?}");
}

const BALL: &str = "bodies: [(name: \"ball\", at: (0, 0), atoms: Disc(radius: 0.1))]";

#[test]
fn mistakes_point_into_the_file_they_are_in() {
    let main = format!(
        "Scene(\n    format: 1, clock: (duration: 1), {BALL},\n    include: [(file: \"part.ron\", prefix: \"p\")],\n)"
    );
    let part = "Scene(\n    format: 1,\n    bodies: [(name: \"x\", at: (0, 1), atoms: Disc(radius: -1))],\n)";
    let source = scene("wrong", &[("main.ron", &main), ("part.ron", part)]);
    let expected = r#"error: bodies[0].atoms.radius: must be a finite number above zero, got -1
 --> part.ron:3:58
  |
3 |     bodies: [(name: "x", at: (0, 1), atoms: Disc(radius: -1))],
  |                                                          ^^ this value
  |
 ::: main.ron:3:22
  |
3 |     include: [(file: "part.ron", prefix: "p")],
  |                      ---------- included here
"#;
    assert_eq!(told(&source), expected);
    let json = refused(&source).to_json();
    let error = &json["errors"][0];
    assert!(error["file"].as_str().unwrap().ends_with("part.ron") && error["line"] == 3, "{json}");
    assert_eq!(error["through"], serde_json::json!(["included here"]));
    let broken =
        scene("broken", &[("main.ron", &main), ("part.ron", "Scene(\n    format: 1,\n    bodies: [(name: ]\n)")]);
    assert!(told(&broken).contains("--> part.ron:3:"), "{}", told(&broken));
}

#[test]
fn files_in_a_circle_and_missing_files_are_told() {
    let with = |file: &str| {
        format!("Scene(format: 1, clock: (duration: 1), {BALL}, include: [(file: \"{file}\", prefix: \"p\")])")
    };
    let circle = scene("circle", &[("a.ron", &with("b.ron")), ("b.ron", &with("./a.ron"))]);
    let error = refused(&circle).errors()[0].clone();
    assert_eq!(error.message, "files include each other in a circle: `a.ron` includes `b.ron` includes `a.ron`");
    assert!(error.file.is_some_and(|file| file.ends_with("b.ron")));
    let own = scene("own", &[("a.ron", &with("a.ron"))]);
    assert!(refused(&own).errors()[0].message.ends_with("`a.ron` includes `a.ron`"));
    let missing = scene("missing", &[("a.ron", &with("nobody.ron"))]);
    assert!(told(&missing).starts_with("error: include[0].file: there is no file `nobody.ron`\n --> a.ron:1:"));
    let twice =
        format!("Scene(format: 1, clock: (duration: 1), {BALL}, include: [(file: \"b.ron\"), (file: \"b.ron\")])");
    let twice = scene("twice", &[("a.ron", &twice), ("b.ron", FINGER)]);
    assert!(told(&twice).contains("the name \"tip\" is taken by another body"), "{}", told(&twice));
}

/// A plugin's section: it knows nothing of templates, and reads plain numbers of serde.
#[derive(serde::Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
struct Paint {
    of: String,
    coats: u32,
    thickness: f64,
}

#[derive(serde::Deserialize, schemars::JsonSchema)]
struct PaintSection(Vec<Paint>);

#[derive(Resource, Default)]
struct Painted(Vec<(String, u32, f64)>);

impl Section for PaintSection {
    const NAME: &'static str = "paint";
    const EXAMPLE: &'static str = "paint: [(of: \"ball\", coats: 2, thickness: 0.1)]";

    fn check(&self, outline: &Outline, report: &mut Diagnostics) {
        for (index, paint) in self.0.iter().enumerate() {
            outline.require(NameKind::BODY, &paint.of, &format!("[{index}].of"), report);
            report.positive(&format!("[{index}].thickness"), paint.thickness);
        }
    }

    fn install(self, _outline: &Outline, app: &mut App) {
        app.insert_resource(Painted(
            self.0.into_iter().map(|paint| (paint.of, paint.coats, paint.thickness)).collect(),
        ));
    }
}

fn with_paint(scene: &str) -> Result<Simulation, SceneErrors> {
    Simulation::load_with(&Source::new("a.ron", scene), &Overrides::default(), |app| {
        app.register_section::<PaintSection>();
    })
}

#[test]
fn sections_of_plugins_work_in_templates() {
    let scene = |thick: &str| {
        format!(
            r#"Scene(
    format: 1, clock: (duration: 1), params: {{ "n": 3 }},
    templates: {{ "bob": (args: ["x", "thick"], bodies: [(name: "ball", at: ("x", 0), atoms: Disc(radius: 0.1))],
        paint: [(of: "ball", coats: "n - 1", thickness: "thick / 2")]) }},
    instances: [(of: "bob", name: "left", with: (x: 0, thick: 1)), (of: "bob", name: "right", with: (x: 1, thick: {thick}))],
)"#
        )
    };
    let simulation = with_paint(&scene("3")).unwrap_or_else(|errors| panic!("{errors}"));
    let expected = vec![("left/ball".to_owned(), 2, 0.5), ("right/ball".to_owned(), 2, 1.5)];
    assert_eq!(simulation.resource::<Painted>().0, expected);
    let error = with_paint(&scene("-3")).err().expect("it is wrong").errors()[0].clone();
    assert_eq!(error.path, "templates[\"bob\"].paint[0].thickness");
    assert_eq!((error.line, error.message.as_str()), (Some(4), "must be a finite number above zero, got -1.5"));
    let error = with_paint(&scene("\"2 cm\"")).err().expect("it is wrong").errors()[0].clone();
    assert_eq!(error.message, "expected a number, found the text \"0.01 m\"");
}

/// Names in a template mean things of the template, then those of its file, then of the file that includes it; a text
/// that an instance gives means what the name means where the instance stands.
#[test]
fn names_in_a_template_are_those_of_its_file() {
    let part = r#"Scene(format: 1,
        materials: { "steel": (density: 2), "glass": (density: 3) },
        templates: {
            "bob": (args: ["x", "stuff"], bodies: [
                (name: "ball", at: ("x", 5), material: "steel", atoms: Disc(radius: 0.125)),
                (name: "weight", at: ("x", 7), material: "{stuff}", atoms: Disc(radius: 0.125)),
            ]),
            "push": (args: ["f"], forces: [
                Thrust(of: "hand", force: ("f", 0)), Drag(linear: 0.5, of: "far"), Drag(linear: 0.25, of: "h*"),
            ]),
        },
        instances: [
            (of: "bob", name: "own", with: (x: 1, stuff: "glass")),
            (of: "push", name: "p", with: (f: 1)),
        ],
        bodies: [(name: "hand", at: (3, 5), material: "steel", atoms: Disc(radius: 0.125))],
    )"#;
    let things = r#"materials: { "steel": (density: 5) },
        bodies: [
            (name: "hand", at: (5, 5), material: "steel", atoms: Disc(radius: 0.125)),
            (name: "far", at: (7, 5), velocity: (1, 0), material: "steel", atoms: Disc(radius: 0.125)),
        ],"#;
    let main = format!(
        r#"Scene(format: 1, clock: (duration: 0.5, tick: "1 ms"), {things}
        include: [(file: "part.ron", prefix: "a")],
        instances: [(of: "a/bob", name: "mine", with: (x: 9, stuff: "steel"))],
    )"#
    );
    let by_hand = r#"Scene(format: 1, clock: (duration: 0.5, tick: "1 ms"),
        materials: { "steel": (density: 5), "a/steel": (density: 2), "a/glass": (density: 3) },
        bodies: [
            (name: "hand", at: (5, 5), material: "steel", atoms: Disc(radius: 0.125)),
            (name: "far", at: (7, 5), velocity: (1, 0), material: "steel", atoms: Disc(radius: 0.125)),
            (name: "a/own/ball", at: (1, 5), material: "a/steel", atoms: Disc(radius: 0.125)),
            (name: "a/own/weight", at: (1, 7), material: "a/glass", atoms: Disc(radius: 0.125)),
            (name: "a/hand", at: (3, 5), material: "a/steel", atoms: Disc(radius: 0.125)),
            (name: "mine/ball", at: (9, 5), material: "a/steel", atoms: Disc(radius: 0.125)),
            (name: "mine/weight", at: (9, 7), material: "steel", atoms: Disc(radius: 0.125)),
        ],
        forces: [
            Thrust(of: "a/hand", force: (1, 0)), Drag(linear: 0.5, of: "far"), Drag(linear: 0.25, of: "a/h*"),
        ],
    )"#;
    let made = scene("templates", &[("main.ron", &main), ("part.ron", part)]);
    assert_eq!(end(&made), end(&Source::new("a.ron", by_hand)));
    // The instance is used ahead of its file; the bodies stand in the order of the sections.
    let mass = |source: &Source, name: &str| {
        let simulation = Simulation::load(source).unwrap();
        let index = (0..simulation.bodies().len()).find(|&index| simulation.name(index) == name).unwrap();
        simulation.bodies().mass[index]
    };
    for name in ["a/own/ball", "a/own/weight", "mine/ball", "mine/weight"] {
        assert_eq!(mass(&made, name), mass(&Source::new("a.ron", by_hand), name), "{name}");
    }
    let notes = Simulation::load(&made).unwrap().header().remarks.clone();
    assert!(notes.iter().any(|note| note.contains("the template `push` makes no \"h*\"")), "{notes:?}");
}

/// A file that is good alone is good under a prefix too, also with patterns over what several entries of `fill` make and
/// with channels of no body; and never takes for its own what only the main file has.
#[test]
fn patterns_and_channels_keep_to_their_file() {
    let part = r#"Scene(format: 1, clock: (duration: 0.1, tick: "1 ms"),
        fill: [Repeat(count: 2, make: (name: "ball_{i}", count: 1, seed: 1, atoms: Disc(radius: 0.125),
            within: (("3 * i", 0), ("3 * i + 1", 1))))],
        plots: [(channels: ["ball_*.position.x"])],
        sensors: [Pose(of: "ball_*"), Energy()],
        expect: [Inside(of: "ball_*", box: ((0, 0), (9, 9))), Channel(name: "energy.residual", below: 1),
            Channel(name: "overlap.share", below: 1), Channel(name: "ball_1_0.position.x", below: 9)],
    )"#;
    // Far outside of the box: taking it for a ball of the part breaks the expectation.
    let main = r#"Scene(format: 1, clock: (duration: 0.1, tick: "1 ms"), include: [(file: "part.ron", prefix: "a")],
        bodies: [(name: "ball_9", at: (99, 0), atoms: Disc(radius: 0.125))])"#;
    let mut made = Simulation::load(&scene("patterns", &[("main.ron", main), ("part.ron", part)]))
        .unwrap_or_else(|errors| panic!("{errors}"));
    made.run_to_end().unwrap();
    let results = made.resource::<jostle::expect::Expectations>().outcomes();
    assert_eq!(results.len(), 4);
    assert!(results.iter().all(|result| result.holds), "{results:?}");
}

#[test]
fn files_are_included_by_repetition() {
    let part = r#"Scene(format: 1, params: { "x": 0 },
        bodies: [(name: "ball", at: ("x", 1), atoms: Disc(radius: 0.125))])"#;
    let main = r#"Scene(format: 1, clock: (duration: 0.1, tick: "1 ms"),
        include: [Repeat(count: 3, make: (file: "part.ron", prefix: "p_{i}", with: (x: "2 * i")))])"#;
    let by_hand = r#"Scene(format: 1, clock: (duration: 0.1, tick: "1 ms"), bodies: [
        (name: "p_0/ball", at: (0, 1), atoms: Disc(radius: 0.125)),
        (name: "p_1/ball", at: (2, 1), atoms: Disc(radius: 0.125)),
        (name: "p_2/ball", at: (4, 1), atoms: Disc(radius: 0.125)),
    ])"#;
    let made = scene("repeated", &[("main.ron", main), ("part.ron", part)]);
    assert_eq!(end(&made), end(&Source::new("a.ron", by_hand)));
}

/// Every scene that comes with the program can be a part of another: under a prefix it is read without a mistake and
/// makes the same number of bodies. What is not tested: that it moves the same, as gravity and contacts are the main
/// scene's.
#[test]
fn every_shipped_scene_can_be_included() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes");
    let mut count = 0;
    for entry in std::fs::read_dir(&folder).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_none_or(|ending| ending != "ron") {
            continue;
        }
        count += 1;
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        let main = format!(
            "Scene(format: 1, clock: (duration: 1, tick: \"1 ms\"), include: [(file: {name:?}, prefix: \"p\")])"
        );
        let main = Source { folder: Some(folder.clone()), ..Source::new("main.ron", main) };
        let alone = Simulation::load(&Source::read(&path).unwrap()).unwrap_or_else(|errors| panic!("{errors}"));
        let included = Simulation::load(&main).unwrap_or_else(|errors| panic!("{name}: {errors}"));
        assert_eq!(included.bodies().len(), alone.bodies().len(), "{name}");
        assert!((0..included.bodies().len()).all(|index| included.name(index).starts_with("p/")), "{name}");
    }
    assert_eq!(count, 42);
}
