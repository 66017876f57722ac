//! Scenes whose text is broken: brackets, commas, quotes, comments.

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
fn a_missing_comma() {
    wrong(
        r#"
Scene(
    format: 1,
    clock: (duration: 1),
    bodies: [
        (name: "ball", at: (0, 1), atoms: Disc(radius: 0.1))  // the ball
        (name: "box", at: (2, 1), atoms: Disc(radius: 0.1)),
    ],
)"#,
        r#"
error: bodies[0]: a comma is missing after this value
 --> a.ron:5:60
  |
5 |         (name: "ball", at: (0, 1), atoms: Disc(radius: 0.1))  // the ball
  |                                                            ^ `,` expected after this
  |
  = help: separate fields and list items with `,`
"#,
    );
}

#[test]
fn a_missing_comma_between_fields() {
    wrong(
        r#"
Scene(
    format: 1,
    clock: (
        duration: 1
        tick: 0.001,
    ),
)"#,
        r#"
error: clock.duration: a comma is missing after this value
 --> a.ron:4:19
  |
4 |         duration: 1
  |                   ^ `,` expected after this
  |
  = help: separate fields and list items with `,`
"#,
    );
}

#[test]
fn a_scene_cut_off() {
    wrong(
        r#"
Scene(
    format: 1,
    clock: (duration: 1),
    bodies: [
        (name: "ball", at: (0, 1), atoms: Disc(radius: 0.1"#,
        r#"
error: bodies[0].atoms: the scene ends before this bracket is closed
 --> a.ron:5:47
  |
5 |         (name: "ball", at: (0, 1), atoms: Disc(radius: 0.1
  |                                               ^ no `)` for it
  |
  = help: the text may be cut off; close it with `)`
"#,
    );
}

#[test]
fn the_wrong_bracket() {
    wrong(
        r#"
Scene(
    format: 1,
    clock: (duration: 1),
    bodies: [
        (name: "ball", at: (0, 1], atoms: Disc(radius: 0.1)),
    ],
)"#,
        r#"
error: bodies[0].at: `]` closes nothing here: `)` must come first
 --> a.ron:5:33
  |
5 |         (name: "ball", at: (0, 1], atoms: Disc(radius: 0.1)),
  |                            -    ^ expected `)`
  |                            |
  |                            this bracket is still open
  |
  = help: close it with `)`
"#,
    );
}

#[test]
fn a_list_left_open() {
    wrong(
        r#"
Scene(
    format: 1,
    clock: (duration: 1),
    bodies: [
        (name: "ball", at: (0, 1), atoms: Disc(radius: 0.1)),
    forces: [Drag()],
)"#,
        r#"
error: bodies: the list is not closed before the field `forces`
 --> a.ron:6:5
  |
4 |     bodies: [
  |             - this list is still open
5 |         (name: "ball", at: (0, 1), atoms: Disc(radius: 0.1)),
6 |     forces: [Drag()],
  |     ^^^^^^ a new field
  |
  = help: close the list with `]`
"#,
    );
}

#[test]
fn one_bracket_too_many() {
    wrong(
        r#"
Scene(
    format: 1,
    clock: (duration: 1),
    bodies: [(name: "ball", at: (0, 1), atoms: Disc(radius: 0.1))],
    ),
)"#,
        r#"
error: there is text after the end of the scene
 --> a.ron:5:6
  |
5 |     ),
  |      ^ not expected here
  |
  = help: check for a closing bracket too many before it
"#,
    );
}

#[test]
fn an_equals_sign() {
    wrong(
        r#"
Scene(
    format: 1,
    clock: (duration: 1),
    bodies: [(name = "ball", at: (0, 1), atoms: Disc(radius: 0.1))],
)"#,
        r#"
error: bodies[0]: fields take `:`, not `=`
 --> a.ron:4:20
  |
4 |     bodies: [(name = "ball", at: (0, 1), atoms: Disc(radius: 0.1))],
  |                    ^ expected `:`
  |
  = help: write `name: ..`
"#,
    );
}

#[test]
fn a_semicolon() {
    wrong(
        r#"
Scene(
    format: 1,
    clock: (duration: 1),
    bodies: [(name: "ball"; at: (0, 1), atoms: Disc(radius: 0.1))],
)"#,
        r#"
error: bodies[0]: fields and items are separated by `,`, not `;`
 --> a.ron:4:27
  |
4 |     bodies: [(name: "ball"; at: (0, 1), atoms: Disc(radius: 0.1))],
  |                           ^ expected `,`
  |
  = help: write `,`
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
error: bodies[0].atoms: `10cm` is not a number
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
fn a_decimal_comma() {
    wrong(
        r#"
Scene(
    format: 1,
    clock: (duration: 1),
    bodies: [(name: "ball", at: (0, 1), atoms: Disc(radius: 0,1))],
)"#,
        r#"
error: bodies[0].atoms.radius: decimals take a point, not a comma
 --> a.ron:4:61
  |
4 |     bodies: [(name: "ball", at: (0, 1), atoms: Disc(radius: 0,1))],
  |                                                             ^^^ two numbers
  |
  = help: write `0.1`
"#,
    );
}

#[test]
fn a_field_without_value() {
    wrong(
        r#"
Scene(
    format: 1,
    clock: (duration: 1),
    bodies: [(name: "ball", at: , atoms: Disc(radius: 0.1))],
)"#,
        r#"
error: bodies[0]: `at` has no value
 --> a.ron:4:29
  |
4 |     bodies: [(name: "ball", at: , atoms: Disc(radius: 0.1))],
  |                             ^^ a value is missing after this
  |
  = help: write `at: ..`, or remove it
"#,
    );
}

#[test]
fn two_commas() {
    wrong(
        r#"
Scene(
    format: 1,
    clock: (duration: 1),
    bodies: [(name: "ball", at: (0, 1),, atoms: Disc(radius: 0.1))],
)"#,
        r#"
error: bodies[0]: `,` is not expected here
 --> a.ron:4:40
  |
4 |     bodies: [(name: "ball", at: (0, 1),, atoms: Disc(radius: 0.1))],
  |                                        ^ not the beginning of a value
  |
  = help: one comma is enough
"#,
    );
}

#[test]
fn very_deep_nesting() {
    wrong(
        r#"
Scene(
    format: 1,
    clock: (duration: 1),
    bodies: [[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]],
)"#,
        r#"
error: brackets are nested more than 48 deep
 --> a.ron:4:60
  |
4 |     bodies: [[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]],
  |                                                            ^ this one is too deep
  |
  = help: a scene needs about eight levels
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
fn a_value_among_fields() {
    wrong(
        r#"
Scene(
    format: 1,
    clock: (duration: 1),
    bodies: [(name: "ball", (0, 1), atoms: Disc(radius: 0.1))],
)"#,
        r#"
error: bodies[0]: expected a field name and `:`
 --> a.ron:4:29
  |
4 |     bodies: [(name: "ball", (0, 1), atoms: Disc(radius: 0.1))],
  |                             ^ no field name
  |
  = help: every field here has a name, as in `name: value`
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
fn no_colon() {
    wrong(
        r#"
Scene(
    format: 1,
    clock: (duration: 1),
    bodies: [(name "ball", at: (0, 1), atoms: Disc(radius: 0.1))],
)"#,
        r#"
error: bodies[0]: `:` is missing after `name`
 --> a.ron:4:15
  |
4 |     bodies: [(name "ball", at: (0, 1), atoms: Disc(radius: 0.1))],
  |               ^^^^ `:` expected after this
  |
  = help: write `name: ..`
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
