//! Texts that are no scene: empty, of another format, with open quotes and comments, stray letters.

use super::wrong;

#[test]
fn an_empty_scene() {
    wrong(
        r#"
"#,
        r#"
error: the scene is empty
 --> a.ron:1:1
  |
1 |
  | ^
  |
  = help: the smallest scene is `Scene(format: 1, clock: (duration: 1), bodies: [..])`
"#,
    );
}

#[test]
fn only_a_comment() {
    wrong(
        r#"
// nothing yet
"#,
        r#"
error: the scene is empty
 --> a.ron:1:1
  |
1 | // nothing yet
  | ^
  |
  = help: the smallest scene is `Scene(format: 1, clock: (duration: 1), bodies: [..])`
"#,
    );
}

#[test]
fn another_format() {
    wrong(
        r#"
{"format": 1}"#,
        r#"
error: expected `Scene(..)`, found a map `{..}`
 --> a.ron:1:1
  |
1 | {"format": 1}
  | ^^^^^^^^^^^^^ not a scene
  |
  = help: the smallest scene is `Scene(format: 1, clock: (duration: 1), bodies: [(name: "ball", at: (0, 0), atoms: Disc(radius: 0.1))])`
"#,
    );
}

#[test]
fn not_a_scene_at_all() {
    wrong(
        r#"
GIF89a"#,
        r#"
error: expected `Scene(..)`, found the word `GIF89a`
 --> a.ron:1:1
  |
1 | GIF89a
  | ^^^^^^ not a scene
  |
  = help: the smallest scene is `Scene(format: 1, clock: (duration: 1), bodies: [(name: "ball", at: (0, 0), atoms: Disc(radius: 0.1))])`
"#,
    );
}

#[test]
fn quoted_field_names() {
    wrong(
        r#"
Scene(
    format: 1,
    clock: (duration: 1),
    bodies: [("name": "ball", "at": (0, 1))],
)"#,
        r#"
error: bodies[0]: field names stand without quotes
 --> a.ron:4:15
  |
4 |     bodies: [("name": "ball", "at": (0, 1))],
  |               ^^^^^^ a field name in quotes
  |
  = help: write `name: ..`
"#,
    );
}

#[test]
fn single_quotes() {
    wrong(
        r#"
Scene(
    format: 1,
    clock: (duration: 1),
    bodies: [(name: 'ball', at: (0, 1), atoms: Disc(radius: 0.1))],
)"#,
        r#"
error: bodies[0]: texts stand in double quotes
 --> a.ron:4:21
  |
4 |     bodies: [(name: 'ball', at: (0, 1), atoms: Disc(radius: 0.1))],
  |                     ^^^^^^ single quotes
  |
  = help: write `"ball"`
"#,
    );
}

#[test]
fn a_text_that_never_ends() {
    wrong(
        r#"
Scene(
    format: 1,
    clock: (duration: 1),
    bodies: [(name: "ball, at: (0, 1), atoms: Disc(radius: 0.1))],
)"#,
        r#"
error: bodies[0]: the text that begins here never ends
 --> a.ron:4:21
  |
4 |     bodies: [(name: "ball, at: (0, 1), atoms: Disc(radius: 0.1))],
  |                     ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^ no closing `"`
  |
  = help: close it with `"`
"#,
    );
}

#[test]
fn a_comment_that_never_ends() {
    wrong(
        r#"
Scene(
    format: 1,
    clock: (duration: 1),
    /* to be done
    bodies: [(name: "ball", at: (0, 1), atoms: Disc(radius: 0.1))],
)"#,
        r#"
error: the comment that begins here never ends
 --> a.ron:4:5
  |
4 |     /* to be done
  |     ^^ no `*/`
  |
  = help: close it with `*/`
"#,
    );
}

#[test]
fn a_bare_unit() {
    wrong(
        r#"
Scene(
    format: 1,
    clock: (duration: 1),
    bodies: [(name: "ball", at: (0, 1), atoms: Disc(radius: 10 cm))],
)"#,
        r#"
error: bodies[0].atoms.radius: a number with a unit stands in quotes
 --> a.ron:4:61
  |
4 |     bodies: [(name: "ball", at: (0, 1), atoms: Disc(radius: 10 cm))],
  |                                                             ^^^^^ needs quotes
  |
  = help: write `"10 cm"`
"#,
    );
}

#[test]
fn a_bare_unit_without_blank() {
    wrong(
        r#"
Scene(
    format: 1,
    clock: (duration: 1),
    bodies: [(name: "ball", at: (0, 1), atoms: Disc(radius: 10cm))],
)"#,
        r#"
error: bodies[0].atoms.radius: `10cm` is not a number
 --> a.ron:4:61
  |
4 |     bodies: [(name: "ball", at: (0, 1), atoms: Disc(radius: 10cm))],
  |                                                             ^^^^ not a number
  |
  = help: a number with a unit stands in quotes: write `"10 cm"`
"#,
    );
}

#[test]
fn extensions() {
    wrong(
        r#"
#![enable(unwrap_newtypes)]
Scene(
    format: 1,
    clock: (duration: 1),
    bodies: [(name: "ball", at: (0, 1), atoms: Disc(radius: 0.1))],
)"#,
        r#"
error: the scene language has no extensions to enable
 --> a.ron:1:1
  |
1 | #![enable(unwrap_newtypes)]
  | ^^^^^^^^^^^^^^^^^^^^^^^^^^^
  |
  = help: remove it
"#,
    );
}

#[test]
fn a_list_of_json() {
    wrong(
        r#"
Scene(
    format: 1,
    clock: (duration: 1),
    bodies: [{"name": "ball", "at": [0, 1]}],
)"#,
        r#"
error: bodies[0]: expected round brackets `(..)`, found a map `{..}`
 --> a.ron:4:14
  |
4 |     bodies: [{"name": "ball", "at": [0, 1]}],
  |              ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^ not round brackets `(..)`
  |
  = help: for example: bodies: [(name: "ball", at: (2, 3), atoms: Disc(radius: 0.2))]
"#,
    );
}

#[test]
fn only_values_in_the_scene() {
    wrong(
        r#"
Scene(1, 2)"#,
        r#"
error: the section `format` is missing
 --> a.ron:1:1
  |
1 | Scene(1, 2)
  | ^^^^^ no `format` in here
  |
  = help: every scene says which version of the language it is in: write `format: 1`

error: the section `clock` is missing
 --> a.ron:1:1
  |
1 | Scene(1, 2)
  | ^^^^^ no `clock` in here
  |
  = help: say how long to simulate: write `clock: (duration: 20)`

error: expected a section, found the number 1
 --> a.ron:1:7
  |
1 | Scene(1, 2)
  |       ^ no section name
  |
  = help: a scene is made of sections such as `clock: (duration: 1)`

error: expected a section, found the number 2
 --> a.ron:1:10
  |
1 | Scene(1, 2)
  |          ^ no section name
  |
  = help: a scene is made of sections such as `clock: (duration: 1)`
"#,
    );
}

#[test]
fn a_text_closed_lines_below() {
    wrong(
        r#"
Scene(
    format: 1,
    clock: (duration: 1),
    bodies: [
        (name: "ball, at: (0, 1), atoms: Disc(radius: 0.1)),
        (name: "box", at: (2, 1), atoms: Disc(radius: 0.1)),
    ],
)"#,
        r#"
error: bodies[0].name: a text begins here and ends only lines below
 --> a.ron:5:16
  |
5 |         (name: "ball, at: (0, 1), atoms: Disc(radius: 0.1)),
  |                ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^ no closing `"` on this line
  |
  = help: close the text with `"`
"#,
    );
}

#[test]
fn a_text_closed_too_late() {
    wrong(
        r#"
Scene(
    format: 1,
    clock: (duration: 1),
    bodies: [(name: "ball, at: (0, 1), material: "rock", atoms: Disc(radius: 0.1))],
)"#,
        r#"
error: bodies[0].name: a comma is missing after this value
 --> a.ron:4:50
  |
4 |     bodies: [(name: "ball, at: (0, 1), material: "rock", atoms: Disc(radius: 0.1))],
  |                                                  ^ `,` expected after this
  |
  = help: separate fields and list items with `,`; or is a closing `"` missing before?
"#,
    );
}

#[test]
fn an_invisible_character() {
    wrong(
        "\nScene(\n    format: 1,\n    clock: (duration: 1),\n    bodies:\u{a0}[(name: \"ball\", at: (0, 1), atoms: Disc(radius: 0.1))],\n)",
        "\nerror: an invisible character (U+00A0) stands here\n --> a.ron:4:12\n  |\n4 |     bodies:\u{a0}[(name: \"ball\", at: (0, 1), atoms: Disc(radius: 0.1))],\n  |            ^ invisible\n  |\n  = help: replace it with an ordinary blank\n",
    );
}

#[test]
fn a_bare_unit_in_a_list_of_atoms() {
    wrong(
        r#"
Scene(
    format: 1,
    clock: (duration: 1),
    bodies: [(name: "ball", at: (0, 1), atoms: List([(at: (0, 0), radius: 1 cm)]))],
)"#,
        r#"
error: bodies[0].atoms[0].radius: a number with a unit stands in quotes
 --> a.ron:4:75
  |
4 |     bodies: [(name: "ball", at: (0, 1), atoms: List([(at: (0, 0), radius: 1 cm)]))],
  |                                                                           ^^^^ needs quotes
  |
  = help: write `"1 cm"`
"#,
    );
}

#[test]
fn braces_after_scene() {
    wrong(
        r#"
Scene {
    format: 1,
}"#,
        r#"
error: `(` is missing after `Scene`
 --> a.ron:1:1
  |
1 | Scene {
  | ^^^^^ `(` expected after this
  |
  = help: write `Scene(..)`
"#,
    );
}
