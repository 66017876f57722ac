//! Ten mistakes of a first day, each in `scenes/marble_mills.ron`, and their messages.
//!
//! `wrong_mills/NAME.txt` is what `jostle check` prints. Tolerance: none. To write the messages again:
//! `JOSTLE_REWRITE_MESSAGES=1 cargo test --test main wrong_mills`; then read them as a newcomer would.

use std::path::Path;

use jostle::Simulation;
use jostle::scene::Source;

const SCENE: &str = include_str!("../../scenes/marble_mills.ron");

/// Name, what stands in the scene once, and what is written in its place.
const MISTAKES: [(&str, &str, &str); 10] = [
    ("a_parameter_misspelt", r#""pitch": "2.5 * r""#, r#""pitch": "2.5 * radius""#),
    (
        "an_argument_missing",
        r#"with: (x: "(i + 0.5) * width / mills", spin: "if(mod(i, 2) == 0, turn, -turn)")"#,
        r#"with: (x: "(i + 0.5) * width / mills")"#,
    ),
    ("a_unit_of_another_kind", r#"atoms: Disc(radius: "3 * r")"#, r#"atoms: Disc(radius: "3 * r + 2 kg")"#),
    ("a_bracket_left_open", r#""0.6 * width / (2 * mills)""#, r#""0.6 * width / (2 * mills""#),
    ("a_function_nobody_knows", r#"sin(arm * pi / 3)"#, r#"sinus(arm * pi / 3)"#),
    ("a_template_misspelt", r#"make: (of: "mill", name: "mill_{i}""#, r#"make: (of: "mil", name: "mill_{i}""#),
    (
        "an_override_of_no_field",
        r#"make: (of: "mill", name: "mill_{i}","#,
        r#"make: (of: "mill", name: "mill_{i}", set: { "wheel.kinematic.speed": 3 },"#,
    ),
    (
        "a_repeat_without_count",
        r#"Repeat(count: (13, 4), grid: (from: ("1.25 * pitch", 2)"#,
        r#"Repeat(grid: (from: ("1.25 * pitch", 2)"#,
    ),
    ("a_division_by_zero", r#""pitch": "2.5 * r""#, r#""pitch": "2.5 * r / (mills - 6)""#),
    ("an_index_forgotten_in_a_name", r#"name: "marble_{i}_{j}""#, r#"name: "marble_{i}""#),
];

#[test]
fn ten_mistakes_are_told_so_that_a_newcomer_can_mend_them() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/scenes/wrong_mills");
    let mut differing = String::new();
    for (name, right, wrong) in MISTAKES {
        assert_eq!(SCENE.matches(right).count(), 1, "{name}: {right}");
        let source = Source::new("marble_mills.ron", SCENE.replace(right, wrong));
        let errors = Simulation::load(&source).err().unwrap_or_else(|| panic!("{name} is taken as good"));
        for error in errors.errors() {
            let placed = error.line.is_some() && error.column.is_some();
            assert!(placed && error.help.is_some(), "{name}: no place or no remedy: {errors}");
        }
        let (told, beside) = (errors.to_string(), folder.join(name).with_extension("txt"));
        if std::env::var_os("JOSTLE_REWRITE_MESSAGES").is_some() {
            std::fs::write(beside, told).unwrap();
            continue;
        }
        let written = std::fs::read_to_string(beside).unwrap_or_default();
        if told != written {
            differing += &format!("\n== {name}\n--- written down\n{written}\n--- now\n{told}\n");
        }
    }
    assert!(differing.is_empty(), "{differing}");
}
