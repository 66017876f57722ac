//! The schema and the scenes agree, and the manual is complete.

mod validate;

use std::path::{Path, PathBuf};

use bevy_app::App;
use jostle::plugins;
use jostle::scene::SceneRegistry;
use jostle::scene::schema::{Language, anchor, as_json};
use serde_json::{Value, json};
use validate::{complaints, misshapen};

fn standard() -> SceneRegistry {
    let mut app = App::empty();
    plugins::standard(&mut app);
    app.world().resource::<SceneRegistry>().clone()
}

fn language() -> Language {
    Language::of(&standard())
}

fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

/// The files of a folder and its folders that end in `.ron`.
fn scenes(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            found.extend(scenes(&path));
        } else if path.extension().is_some_and(|ending| ending == "ron") {
            found.push(path);
        }
    }
    found.sort();
    found
}

fn told_of(text: &str, schema: &Value) -> Vec<String> {
    let json = as_json(text).unwrap_or_else(|fault| panic!("{text}: {}", fault.message));
    complaints(&json, schema)
}

/// What is not tested here: that the schema refuses every scene that the reader refuses. It cannot: names that nothing
/// has, numbers out of their range and the like are beyond it.
#[test]
fn every_scene_of_the_program_fits_the_schema() {
    let schema = language().json();
    let mut files = scenes(&root().join("scenes"));
    files.push(root().join("assets/templates/scene.ron"));
    assert!(files.len() > 7);
    for file in files {
        let text = std::fs::read_to_string(&file).unwrap();
        let wrong = told_of(&text, &schema);
        assert!(wrong.is_empty(), "{}: {wrong:#?}", file.display());
    }
}

/// What draft 2020-12 asks of a schema itself: each keyword has the JSON type that belongs to it, and each `$ref` leads
/// somewhere. What is not tested here: that patterns are regular expressions.
#[test]
fn the_schema_is_a_schema() {
    assert_eq!(misshapen(&language().json()), Vec::<String>::new());
    for wrong in [
        json!({"properties": null}),
        json!({"properties": {"a": {"properties": null}}}),
        json!({"type": "text"}),
        json!({"items": [{}]}),
        json!({"required": "a"}),
        json!({"$ref": "#/$defs/nobody"}),
        json!({"description": null}),
        json!({"anyOf": []}),
    ] {
        assert_eq!(misshapen(&wrong).len(), 1, "{wrong}");
    }
}

/// The examples that error messages and the manual show are right by the schema, each as a scene's only content.
#[test]
fn every_example_fits_the_schema() {
    let (registry, language) = (standard(), language());
    let mut schema = language.json();
    schema["required"] = json!([]);
    let registered = registry.sections().into_iter().map(|section| (section.name, section.example));
    let mut count = 0;
    for (name, example) in language.unregistered(&registry).into_iter().chain(registered) {
        let around = |entry: &str| match example.starts_with(&format!("{name}: [")) {
            true => format!("{name}: [{entry}]"),
            false => format!("{name}: {entry}"),
        };
        let entries = registry.entries(name);
        let written = entries.iter().map(|entry| around(entry.example));
        for example in written.chain([example.to_owned()]) {
            let wrong = told_of(&format!("Scene({example})"), &schema);
            assert!(wrong.is_empty(), "{example}: {wrong:#?}");
            count += 1;
        }
    }
    for layer in registry.entries("look.layers") {
        let wrong = told_of(&format!("Scene(look: (layers: [{}]))", layer.example), &schema);
        assert!(wrong.is_empty(), "{}: {wrong:#?}", layer.example);
        count += 1;
    }
    assert!(count > 30, "{count}");
}

/// The mistakes that a schema can find.
#[test]
fn the_schema_refuses_what_does_not_belong() {
    let schema = language().json();
    let wrong = |sections: &str| {
        let told = told_of(&format!("Scene(format: 1, clock: (duration: 1), {sections})"), &schema);
        !told.is_empty()
    };
    assert!(!wrong("bodies: [(name: \"a\", at: (0, \"3 cm\"), atoms: Disc(radius: 0.1), inertia: Points)]"));
    for sections in [
        "physics: 3",
        "randomise: []",
        "gravity: 9.81",
        "gravity: (0, -9.81, 0)",
        "film: (fps: 30, sound: true)",
        "film: (size: (1280.5, 720))",
        "bodies: [(at: (0, 0), atoms: Disc(radius: 0.1))]",
        "bodies: [(name: \"a\", at: (0, 0), atoms: Square(radius: 0.1))]",
        "bodies: [(name: \"a\", at: (0, 0), atoms: Disc(radius: true))]",
        "bodies: [(name: \"a\", at: (0, 0), atoms: Disc(radius: 0.1), datum: Middle)]",
        "bodies: [(name: 3, at: (0, 0), atoms: Disc(radius: 0.1))]",
        "materials: { \"rock\": (hardness: 3) }",
        "materials: [(name: \"rock\")]",
        "forces: [Drag(cubic: 1)]",
        "forces: [Magnet()]",
        "forces: Drag(linear: 1)",
        "contacts: Penalty(normal: Hertz)",
        "camera: None",
    ] {
        assert!(wrong(sections), "{sections}");
    }
    assert!(!told_of("Scene(format: 2, clock: (duration: 1))", &schema).is_empty());
    assert!(!told_of("Scene(format: 1)", &schema).is_empty());
}

/// Whoever reads the manual wants to know of each field what happens without it.
#[test]
fn every_optional_field_says_its_default_and_says_it_right() {
    let language = language();
    assert_eq!(language.without_default(), Vec::<String>::new());
    assert_eq!(language.wrong_defaults(), Vec::<String>::new());
}

#[test]
fn the_manual_has_no_bare_sections_and_no_dead_links() {
    let manual = language().manual();
    assert!(!manual.contains("It has no described fields"), "{manual}");
    let headings: Vec<String> = manual
        .lines()
        .filter(|line| line.starts_with("## ") || line.starts_with("### "))
        .map(|line| anchor(line.trim_start_matches(['#', ' '])))
        .collect();
    for link in manual.split("](#").skip(1).filter_map(|rest| rest.split(')').next()) {
        let leads_to = headings.iter().filter(|heading| *heading == link).count();
        assert_eq!(leads_to, 1, "{link}");
    }
    for section in standard().sections() {
        assert!(manual.contains(&format!("\n## `{}`\n\n", section.name)));
        assert!(!manual.contains(&format!("## `{}`\n\n```", section.name)), "{} has no meaning", section.name);
    }
}

#[test]
fn one_entry_is_told_in_plain_words() {
    let language = language();
    let told = language.told("forces", Some("Drag")).unwrap();
    let field = "\n  linear: damping in N s/m; default: 0. Linear coefficient in N s/m.\n";
    assert!(told.starts_with("Resistance of air that rests: ") && told.contains(field), "{told}");
    let told = language.told("clock", None).unwrap();
    assert!(told.contains("\n  duration: time in s; needed. Length of the run, "), "{told}");
    let told = language.told("bodies", None).unwrap();
    assert!(told.contains("needed. "), "{told}");
    assert_eq!(language.told("forces", None).unwrap(), "Forces on bodies beside gravity and contacts.");
    assert_eq!(language.told("forces", Some("Magnet")), None);
    assert_eq!(language.told("clock", Some("Drag")), None);
}
