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

#[test]
fn a_kinematic_body_that_moves_in_two_ways() {
    wrong(
        r#"
Scene(
    format: 1,
    clock: (duration: 1),
    bodies: [
        (name: "a", at: (0, 0), velocity: (1, 0), kinematic: (spin: 2), atoms: Disc(radius: 0.1)),
        (name: "b", at: (1, 0), fixed: true, kinematic: (spin: 2), atoms: Disc(radius: 0.1)),
    ],
)"#,
        r#"
error: bodies[0].velocity: a kinematic body moves as `kinematic` says
 --> a.ron:5:43
  |
5 |         (name: "a", at: (0, 0), velocity: (1, 0), kinematic: (spin: 2), atoms: Disc(radius: 0.1)),
  |                                           ^^^^^^ this value
  |
  = help: write it into `kinematic: (..)`, and remove this

error: bodies[1].kinematic: a fixed body does not move
 --> a.ron:6:57
  |
6 |         (name: "b", at: (1, 0), fixed: true, kinematic: (spin: 2), atoms: Disc(radius: 0.1)),
  |                                                         ^^^^^^^^^ this value
  |
  = help: remove this, or remove `fixed: true`
"#,
    );
}

#[test]
fn paths_that_cannot_be() {
    wrong(
        r#"
Scene(
    format: 1,
    clock: (duration: 1),
    bodies: [
        (name: "a", at: (0, 0), kinematic: (path: [(time: 1), (time: 1)]), atoms: Disc(radius: 0.1)),
        (name: "b", at: (1, 0), kinematic: (spin: 2, path: [(time: 1)], repeat: true), atoms: Disc(radius: 0.1)),
        (name: "c", at: (2, 0), kinematic: (repeat: true), atoms: Disc(radius: 0.1)),
    ],
)"#,
        r#"
error: bodies[0].kinematic.path[1].time: must be above the time before it, 1 s, got 1 s
 --> a.ron:5:70
  |
5 |         (name: "a", at: (0, 0), kinematic: (path: [(time: 1), (time: 1)]), atoms: Disc(radius: 0.1)),
  |                                                                      ^ this value
  |
  = help: the points of a path stand in the order of their times

error: bodies[1].kinematic.repeat: a path that is repeated must end with the velocity and spin it begins with
 --> a.ron:6:81
  |
6 |         (name: "b", at: (1, 0), kinematic: (spin: 2, path: [(time: 1)], repeat: true), atoms: Disc(radius: 0.1)),
  |                                                                                 ^^^^ this value
  |
  = help: give its last point the same `velocity` and `spin` as the start; both are zero by default

error: bodies[2].kinematic.repeat: there is no path to repeat
 --> a.ron:7:53
  |
7 |         (name: "c", at: (2, 0), kinematic: (repeat: true), atoms: Disc(radius: 0.1)),
  |                                                     ^^^^ this value
  |
  = help: add `path: [(time: 1, by: (2, 0))]`
"#,
    );
}

#[test]
fn a_belt_that_moves_out_of_its_wall() {
    wrong(
        r#"
Scene(
    format: 1,
    clock: (duration: 1),
    walls: [(name: "belt", left: (1, 1), right: (0, 0), surface_velocity: (2, 0))],
    bodies: [(name: "a", at: (0, 0), atoms: Disc(radius: 0.1))],
)"#,
        r#"
error: walls[0].surface_velocity: a surface moves along its wall, not into or out of it
 --> a.ron:4:75
  |
4 |     walls: [(name: "belt", left: (1, 1), right: (0, 0), surface_velocity: (2, 0))],
  |                                                                           ^^^^^^ this value
  |
  = help: along this wall it would be (1.0, 1.0)
"#,
    );
}
