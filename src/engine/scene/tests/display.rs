//! The display of mistakes: as data, in colour, many of them, on long lines, in large and odd texts.

use super::super::{Diagnostics, SceneErrors, Source, load};
use super::{messages, plugins};

fn errors(text: &str) -> SceneErrors {
    match load(&mut plugins::app(), &Source::new("a.ron", text)) {
        Ok(_) => panic!("the scene was taken as good:\n{text}"),
        Err(errors) => errors,
    }
}

/// A scene with these bodies.
fn scene(bodies: &str) -> String {
    format!("Scene(format: 1, clock: (duration: 1), bodies: [\n{bodies}\n])")
}

#[test]
fn as_data() {
    let found = errors(&scene("(name: \"ä\", at: (0, 1), atoms: Disk(radius: 1)),"));
    assert_eq!(
        found.to_json(),
        serde_json::json!({
            "scene": "a.ron",
            "errors": [{
                "line": 2,
                "column": 32,
                "path": "bodies[0].atoms",
                "message": "`Disk` is not one of the choices",
                "help": "did you mean `Disc`? choices: `Picture`, `List`, `Disc`, `Png`",
            }],
        })
    );
}

#[test]
fn color_only_where_it_is_asked_for() {
    let found = errors("Scene(");
    assert!(found.render(true).contains('\u{1b}'));
    assert!(!found.render(false).contains('\u{1b}'));
    assert_eq!(found.render(false), found.to_string());
}

#[test]
fn twenty_are_shown_and_the_rest_counted() {
    let bodies: String = (0..30).map(|n| format!("(name: \"b{n}\", at: (0, 0), atoms: Disc(radius: 0)),\n")).collect();
    let found = errors(&scene(&bodies));
    assert_eq!(found.errors().len(), 30);
    let text = found.to_string();
    assert_eq!(text.matches("error: ").count(), 20);
    assert!(text.ends_with("\n\n... and 10 more mistakes of this scene\n"), "{text}");
}

#[test]
fn thousands_are_counted_by_the_report() {
    let bodies: String =
        (0..2000).map(|n| format!("(name: \"b{n}\", at: (0, 0), atoms: Disc(radius: 0)),\n")).collect();
    let found = errors(&scene(&bodies));
    assert_eq!(found.errors().len(), 1001);
    let rest = &found.errors()[1000];
    assert_eq!(rest.message, "the checks found 1000 more mistakes, the first of them here");
    assert_eq!((rest.path.as_str(), rest.line), ("bodies[1000].atoms.radius", Some(1002)));
}

#[test]
fn a_line_too_long_to_show_is_named() {
    let bodies: String = (0..200).map(|n| format!("(name: \"b{n}\", at: (0, 0), atoms: Disc(radius: 1)), ")).collect();
    assert_eq!(
        messages(&scene(&format!("{bodies} (name: 1)"))),
        "error: bodies[200].name: expected a text in quotes, found the number 1\n--> a.ron:2:10299\n = help: for \
         example: bodies: [(name: \"ball\", at: (2, 3), atoms: Disc(radius: 0.2))]\n"
    );
}

#[test]
fn two_places_far_apart_are_both_named() {
    let bodies: String = (0..300).map(|n| format!("(name: \"b{n}\", at: (0, 0), atoms: Disc(radius: 1)),\n")).collect();
    assert_eq!(
        messages(&scene(&format!("{bodies}(name: \"b0\", at: (0, 0), atoms: Disc(radius: 1))"))),
        r#"error: bodies[300].name: the name "b0" is taken by another body
   --> a.ron:302:8
    |
302 | (name: "b0", at: (0, 0), atoms: Disc(radius: 1))
    |        ^^^^ here again
    |
    = note: this body has the name too at 2:8
    = help: give every thing its own name
"#
    );
}

#[test]
fn windows_lines_and_tabs() {
    let found = errors("Scene(\r\n\tformat: 1,\r\n\tclock: (duration: -1),\r\n\tbodies: [],\r\n)");
    let error = &found.errors()[0];
    assert_eq!((error.line, error.column), (Some(3), Some(20)));
    assert_eq!(
        found.to_string(),
        "error: clock.duration: must be a finite number above zero, got -1\n --> a.ron:3:20\n  |\n\
         3 |     clock: (duration: -1),\n  |                       ^^ this value\n"
    );
}

#[test]
fn a_text_beyond_the_limit_is_refused() {
    let found = errors(&" ".repeat(super::super::LARGEST_SCENE + 1));
    assert_eq!(found.errors()[0].message, "the scene is too large: the limit is 64 MiB");
}

#[test]
fn no_garbage_makes_it_stumble() {
    use rand_chacha::ChaCha8Rng;
    use rand_chacha::rand_core::{Rng, SeedableRng};
    let pieces = [
        "Scene(",
        "format: 1,",
        "clock: (duration: 1),",
        "bodies: [",
        "(name: \"b\",",
        "at: (0, 1),",
        "atoms: Disc(",
        "radius: ",
        "\"2 cm\"",
        "1e400",
        "NaN",
        "-inf",
        ")",
        "]",
        "}",
        "{",
        "\"",
        "'",
        ",",
        ":",
        "//",
        "/*",
        "*/",
        "\n",
        "#",
        "é",
        "\u{a0}",
        "0..1",
        "r#\"",
        "\\",
        "Some(",
        "None",
        "materials: {",
        "\"rock\": (friction: (",
        "[[[[",
        "fill: [(name: \"g\", count: 3,",
        "within: ((0, 0), (1, 1))",
        "forces: [Drag(of: [\"*\"])]",
        "contacts: None,",
    ];
    let mut random = ChaCha8Rng::seed_from_u64(1);
    for _ in 0..3000 {
        let count = random.next_u32() % 40;
        let text: String = (0..count).map(|_| pieces[random.next_u32() as usize % pieces.len()]).collect();
        if let Err(errors) = load(&mut plugins::app(), &Source::new("a.ron", text)) {
            let _ = errors.render(true);
        }
    }
}

#[test]
fn notes_of_a_report_are_kept() {
    let mut report = Diagnostics::new();
    report.note("first");
    assert!(report.is_clean());
    assert_eq!(report.notes(), ["first"]);
}
