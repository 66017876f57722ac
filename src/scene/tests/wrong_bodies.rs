//! Scenes with bodies, fills and shapes that cannot be.

use super::wrong;

#[test]
fn a_wrong_letter_in_a_picture() {
    wrong(
        r####"
Scene(
    format: 1,
    clock: (duration: 1),
    bodies: [(name: "T", at: (0, 1), atoms: Picture(spacing: 0.1, rows: ["###", ".x."]))],
)"####,
        r####"
error: bodies[0].atoms.rows[1]: 'x' in column 2 of the picture means nothing
 --> a.ron:4:81
  |
4 |     bodies: [(name: "T", at: (0, 1), atoms: Picture(spacing: 0.1, rows: ["###", ".x."]))],
  |                                                                                 ^^^^^ this value
  |
  = help: `#` is an atom, `.` and blank are none
"####,
    );
}

#[test]
fn a_full_box() {
    wrong(
        r#"
Scene(
    format: 1,
    clock: (duration: 1),
    fill: [(name: "gas", atoms: Disc(radius: 0.5), count: 500, within: ((0, 0), (1, 1)))],
)"#,
        r#"
error: fill[0].count: only 1 of 500 bodies find room in the box without touching anything
 --> a.ron:4:59
  |
4 |     fill: [(name: "gas", atoms: Disc(radius: 0.5), count: 500, within: ((0, 0), (1, 1)))],
  |                                                           ^^^ this value
  |
  = help: a larger `within`, a smaller `count` or smaller atoms would fit; chance fills about half the area
"#,
    );
}

#[test]
fn a_flat_box() {
    wrong(
        r#"
Scene(
    format: 1,
    clock: (duration: 1),
    fill: [(name: "gas", atoms: Disc(radius: 0.5), count: 5, within: ((0, 0), (1, 0)))],
)"#,
        r#"
error: fill[0].within: the box must have width and height, got 1 m by 0 m
 --> a.ron:4:70
  |
4 |     fill: [(name: "gas", atoms: Disc(radius: 0.5), count: 5, within: ((0, 0), (1, 0)))],
  |                                                                      ^^^^^^^^^^^^^^^^ this value
  |
  = help: give two opposite corners: `within: ((0, 0), (6, 6))`
"#,
    );
}

#[test]
fn an_empty_picture() {
    wrong(
        r#"
Scene(
    format: 1,
    clock: (duration: 1),
    bodies: [(name: "T", at: (0, 1), atoms: Picture(spacing: "10 cm", rows: []))],
)"#,
        r#"
error: bodies[0].atoms.rows: the picture has no atom
 --> a.ron:4:77
  |
4 |     bodies: [(name: "T", at: (0, 1), atoms: Picture(spacing: "10 cm", rows: []))],
  |                                                                             ^^ this value
  |
  = help: `#` is an atom, `.` and blank are none
"#,
    );
}

#[test]
fn an_empty_list_of_atoms() {
    wrong(
        r#"
Scene(
    format: 1,
    clock: (duration: 1),
    bodies: [(name: "T", at: (0, 1), atoms: List([]))],
)"#,
        r#"
error: bodies[0].atoms: a body needs at least one atom
 --> a.ron:4:45
  |
4 |     bodies: [(name: "T", at: (0, 1), atoms: List([]))],
  |                                             ^^^^^^^^ this value
  |
  = help: for example: List([(at: (0, 0), radius: 0.1)])
"#,
    );
}

#[test]
fn a_wrong_atom_of_a_list() {
    wrong(
        r#"
Scene(
    format: 1,
    clock: (duration: 1),
    bodies: [(name: "T", at: (0, 1), atoms: List([(at: (0, 0), radius: -1), (at: (0, 0), radius: 1, mas: 2)]))],
)"#,
        r#"
error: bodies[0].atoms[1].mas: `bodies[0].atoms[1]` has no field `mas`
 --> a.ron:4:101
  |
4 |     bodies: [(name: "T", at: (0, 1), atoms: List([(at: (0, 0), radius: -1), (at: (0, 0), radius: 1, mas: 2)]))],
  |                                                                                                     ^^^ unknown field
  |
  = help: did you mean `mass`? fields: `at`, `radius`, `mass`, `stiffness`
"#,
    );
}

#[test]
fn a_body_without_place() {
    wrong(
        r#"
Scene(
    format: 1,
    clock: (duration: 1),
    bodies: [(name: "T", atoms: Disc(radius: 1))],
)"#,
        r#"
error: bodies[0]: the field `at` is missing
 --> a.ron:4:14
  |
4 |     bodies: [(name: "T", atoms: Disc(radius: 1))],
  |              ^ `at: ..` is missing in here
  |
  = help: say where the centre of mass is: write `at: (0, 1)`
"#,
    );
}

#[test]
fn a_point_that_cannot_turn() {
    wrong(
        r#"
Scene(
    format: 1,
    clock: (duration: 1),
    bodies: [(name: "T", at: (0, 1), atoms: Disc(radius: 1), inertia: Points)],
)"#,
        r#"
error: bodies[0].inertia: one atom counted as a point has no moment of inertia
 --> a.ron:4:71
  |
4 |     bodies: [(name: "T", at: (0, 1), atoms: Disc(radius: 1), inertia: Points)],
  |                                                                       ^^^^^^ this value
  |
  = help: leave `inertia` out, or give a number in kg m2
"#,
    );
}

#[test]
fn mistakes_of_one_atom() {
    wrong(
        r#"
Scene(
    format: 1,
    clock: (duration: 1),
    bodies: [(name: "T", at: (0, 1), atoms: List([(at: (0, 0), radius: -1, mass: "0 g"), (at: (0, 0), radius: 0)]))],
)"#,
        r#"
error: bodies[0].atoms[0].radius: must be a finite number above zero, got -1
 --> a.ron:4:72
  |
4 |     bodies: [(name: "T", at: (0, 1), atoms: List([(at: (0, 0), radius: -1, mass: "0 g"), (at: (0, 0), radius: 0)]))],
  |                                                                        ^^ this value

error: bodies[0].atoms[0].mass: must be a finite number above zero, got 0
 --> a.ron:4:82
  |
4 |     bodies: [(name: "T", at: (0, 1), atoms: List([(at: (0, 0), radius: -1, mass: "0 g"), (at: (0, 0), radius: 0)]))],
  |                                                                                  ^^^^^ this value

error: bodies[0].atoms[1].radius: must be a finite number above zero, got 0
 --> a.ron:4:111
  |
4 |     bodies: [(name: "T", at: (0, 1), atoms: List([(at: (0, 0), radius: -1, mass: "0 g"), (at: (0, 0), radius: 0)]))],
  |                                                                                                               ^ this value
"#,
    );
}

#[test]
fn a_fill_named_like_a_body() {
    wrong(
        r#"
Scene(
    format: 1,
    clock: (duration: 1),
    bodies: [(name: "gas_3", at: (9, 9), atoms: Disc(radius: 0.1))],
    fill: [(name: "gas", atoms: Disc(radius: 0.01), count: 5, within: ((0, 0), (1, 1)))],
)"#,
        r#"
error: fill[0].name: the name "gas_3" is taken by another body
 --> a.ron:5:19
  |
4 |     bodies: [(name: "gas_3", at: (9, 9), atoms: Disc(radius: 0.1))],
  |                     ------- this body has the name too
5 |     fill: [(name: "gas", atoms: Disc(radius: 0.01), count: 5, within: ((0, 0), (1, 1)))],
  |                   ^^^^^ here again
  |
  = help: give every thing its own name
"#,
    );
}
