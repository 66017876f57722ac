//! Scenes in which commas, colons or brackets are missing, wrong or too many.

use super::wrong;

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
fn a_comma_missing_after_a_word() {
    wrong(
        r#"
Scene(
    format: 1,
    clock: (duration: 1, method: Auto tick: 1),
)"#,
        r#"
error: clock.method: a comma is missing after this value
 --> a.ron:3:37
  |
3 |     clock: (duration: 1, method: Auto tick: 1),
  |                                     ^ `,` expected after this
  |
  = help: separate fields and list items with `,`
"#,
    );
}

#[test]
fn a_bracket_missing_after_a_name() {
    wrong(
        r#"
Scene(
    format: 1,
    clock: (duration: 1),
    bodies: [(name: "b", at: (0, 0), atoms: List[(at: (0, 0), radius: 1)])],
)"#,
        r#"
error: bodies[0].atoms: `(` is missing after `List`
 --> a.ron:4:45
  |
4 |     bodies: [(name: "b", at: (0, 0), atoms: List[(at: (0, 0), radius: 1)])],
  |                                             ^^^^ `(` expected after this
  |
  = help: write `List([..])`
"#,
    );
}
