//! Scenes with values of the wrong kind.

use super::wrong;

#[test]
fn a_text_for_a_number() {
    wrong(
        r#"
Scene(
    format: 1,
    clock: (duration: 1),
    bodies: [(name: "ball", at: (0, 1), atoms: Disc(radius: "wide"))],
)"#,
        r#"
error: bodies[0].atoms.radius: expected a length such as `0.3` or "30 cm", found the text "wide"
 --> a.ron:4:61
  |
4 |     bodies: [(name: "ball", at: (0, 1), atoms: Disc(radius: "wide"))],
  |                                                             ^^^^^^ this value
"#,
    );
}

#[test]
fn a_number_for_a_text() {
    wrong(
        r#"
Scene(
    format: 1,
    clock: (duration: 1),
    bodies: [(name: 7, at: (0, 1), atoms: Disc(radius: 0.1))],
)"#,
        r#"
error: bodies[0].name: expected a text in quotes, found the number 7
 --> a.ron:4:21
  |
4 |     bodies: [(name: 7, at: (0, 1), atoms: Disc(radius: 0.1))],
  |                     ^ not a text in quotes
  |
  = help: for example: bodies: [(name: "ball", at: (2, 3), atoms: Disc(radius: 0.2))]
"#,
    );
}

#[test]
fn a_number_for_a_place() {
    wrong(
        r#"
Scene(
    format: 1,
    clock: (duration: 1),
    bodies: [(name: "ball", at: 7, atoms: Disc(radius: 0.1))],
)"#,
        r#"
error: bodies[0].at: expected round brackets `(..)`, found the number 7
 --> a.ron:4:33
  |
4 |     bodies: [(name: "ball", at: 7, atoms: Disc(radius: 0.1))],
  |                                 ^ not round brackets `(..)`
  |
  = help: for example: bodies: [(name: "ball", at: (2, 3), atoms: Disc(radius: 0.2))]
"#,
    );
}

#[test]
fn a_list_for_a_place() {
    wrong(
        r#"
Scene(
    format: 1,
    clock: (duration: 1),
    bodies: [(name: "ball", at: [0, 1], atoms: Disc(radius: 0.1))],
)"#,
        r#"
error: bodies[0].at: expected round brackets `(..)`, found a list `[..]`
 --> a.ron:4:33
  |
4 |     bodies: [(name: "ball", at: [0, 1], atoms: Disc(radius: 0.1))],
  |                                 ^^^^^^ not round brackets `(..)`
  |
  = help: for example: bodies: [(name: "ball", at: (2, 3), atoms: Disc(radius: 0.2))]
"#,
    );
}

#[test]
fn a_place_with_one_value() {
    wrong(
        r#"
Scene(
    format: 1,
    clock: (duration: 1),
    bodies: [(name: "ball", at: (0), atoms: Disc(radius: 0.1))],
)"#,
        r#"
error: bodies[0].at: expected two values `(x, y)`, each a length such as `0.3` or "30 cm", found a round bracket with 1 value
 --> a.ron:4:33
  |
4 |     bodies: [(name: "ball", at: (0), atoms: Disc(radius: 0.1))],
  |                                 ^^^ not two values `(x, y)`
  |
  = help: for example: bodies: [(name: "ball", at: (2, 3), atoms: Disc(radius: 0.2))]
"#,
    );
}

#[test]
fn a_place_with_three_values() {
    wrong(
        r#"
Scene(
    format: 1,
    clock: (duration: 1),
    bodies: [(name: "ball", at: (0, 1, 2), atoms: Disc(radius: 0.1))],
)"#,
        r#"
error: bodies[0].at: expected two values `(x, y)`, each a length such as `0.3` or "30 cm", found a round bracket with 3 values
 --> a.ron:4:33
  |
4 |     bodies: [(name: "ball", at: (0, 1, 2), atoms: Disc(radius: 0.1))],
  |                                 ^^^^^^^^^ not two values `(x, y)`
  |
  = help: for example: bodies: [(name: "ball", at: (2, 3), atoms: Disc(radius: 0.2))]
"#,
    );
}

#[test]
fn a_place_with_names() {
    wrong(
        r#"
Scene(
    format: 1,
    clock: (duration: 1),
    bodies: [(name: "ball", at: (x: 0, y: 1), atoms: Disc(radius: 0.1))],
)"#,
        r#"
error: bodies[0].at: the values in here have no names, found `x: ..`
 --> a.ron:4:34
  |
4 |     bodies: [(name: "ball", at: (x: 0, y: 1), atoms: Disc(radius: 0.1))],
  |                                  ^ no name here
  |
  = help: for example: bodies: [(name: "ball", at: (2, 3), atoms: Disc(radius: 0.2))]
"#,
    );
}

#[test]
fn a_word_for_a_number() {
    wrong(
        r#"
Scene(
    format: 1,
    clock: (duration: 1),
    bodies: [(name: "ball", at: (0, up), atoms: Disc(radius: 0.1))],
)"#,
        r#"
error: bodies[0].at[1]: expected a length such as `0.3` or "30 cm", found the word `up`
 --> a.ron:4:37
  |
4 |     bodies: [(name: "ball", at: (0, up), atoms: Disc(radius: 0.1))],
  |                                     ^^ not a length
  |
  = help: for example: bodies: [(name: "ball", at: (2, 3), atoms: Disc(radius: 0.2))]
"#,
    );
}

#[test]
fn a_number_for_yes_or_no() {
    wrong(
        r#"
Scene(
    format: 1,
    clock: (duration: 1),
    bodies: [(name: "ball", at: (0, 1), atoms: Disc(radius: 0.1), fixed: 1)],
)"#,
        r#"
error: bodies[0].fixed: expected `true` or `false`, found the number 1
 --> a.ron:4:74
  |
4 |     bodies: [(name: "ball", at: (0, 1), atoms: Disc(radius: 0.1), fixed: 1)],
  |                                                                          ^ not `true` or `false`
  |
  = help: for example: bodies: [(name: "ball", at: (2, 3), atoms: Disc(radius: 0.2))]
"#,
    );
}

#[test]
fn a_map_for_a_list() {
    wrong(
        r#"
Scene(
    format: 1,
    clock: (duration: 1),
    bodies: {"ball": (at: (0, 1), atoms: Disc(radius: 0.1))},
)"#,
        r#"
error: bodies: expected a list `[..]`, found a map `{..}`
 --> a.ron:4:13
  |
4 |     bodies: {"ball": (at: (0, 1), atoms: Disc(radius: 0.1))},
  |             ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^ not a list `[..]`
  |
  = help: for example: bodies: [(name: "ball", at: (2, 3), atoms: Disc(radius: 0.2))]
"#,
    );
}

#[test]
fn one_body_without_a_list() {
    wrong(
        r#"
Scene(
    format: 1,
    clock: (duration: 1),
    bodies: (name: "ball", at: (0, 1), atoms: Disc(radius: 0.1)),
)"#,
        r#"
error: bodies: expected a list `[..]`, found a round bracket with named fields `(..: ..)`
 --> a.ron:4:13
  |
4 |     bodies: (name: "ball", at: (0, 1), atoms: Disc(radius: 0.1)),
  |             ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^ not a list `[..]`
  |
  = help: for example: bodies: [(name: "ball", at: (2, 3), atoms: Disc(radius: 0.2))]
"#,
    );
}

#[test]
fn a_list_for_a_map() {
    wrong(
        r#"
Scene(
    format: 1,
    clock: (duration: 1),
    bodies: [(name: "ball", at: (0, 1), atoms: Disc(radius: 0.1))],
    materials: [(name: "rock")],
)"#,
        r#"
error: materials: expected a map `{ "name": (..) }`, found a list `[..]`
 --> a.ron:5:16
  |
5 |     materials: [(name: "rock")],
  |                ^^^^^^^^^^^^^^^^ not a map `{ "name": (..) }`
  |
  = help: for example: materials: { "rock": (friction: 0.5, restitution: 0.8, density: 2.5) }
"#,
    );
}

#[test]
fn a_text_for_a_method() {
    wrong(
        r#"
Scene(
    format: 1,
    clock: (duration: 1, method: "Auto"),
    bodies: [(name: "ball", at: (0, 1), atoms: Disc(radius: 0.1))],
)"#,
        r#"
error: clock.method: expected a word without quotes, found the text "Auto"
 --> a.ron:3:34
  |
3 |     clock: (duration: 1, method: "Auto"),
  |                                  ^^^^^^ not a word without quotes
  |
  = help: for example: clock: (duration: 20, tick: "1 ms", method: VelocityVerlet)
"#,
    );
}

#[test]
fn one_force_without_a_list() {
    wrong(
        r#"
Scene(
    format: 1,
    clock: (duration: 1),
    bodies: [(name: "ball", at: (0, 1), atoms: Disc(radius: 0.1))],
    forces: Drag(quadratic: 0.02),
)"#,
        r#"
error: forces: expected a list `[..]`, found `Drag(..)`
 --> a.ron:5:13
  |
5 |     forces: Drag(quadratic: 0.02),
  |             ^^^^^^^^^^^^^^^^^^^^^ not a list
  |
  = help: for example: forces: [Drag(quadratic: 0.02)]
"#,
    );
}

#[test]
fn half_a_pixel() {
    wrong(
        r#"
Scene(
    format: 1,
    clock: (duration: 1),
    bodies: [(name: "ball", at: (0, 1), atoms: Disc(radius: 0.1))],
    film: (size: (1280.5, 720)),
)"#,
        r#"
error: film.size[0]: expected a whole number such as `12`, found the number 1280.5
 --> a.ron:5:19
  |
5 |     film: (size: (1280.5, 720)),
  |                   ^^^^^^ not a whole number
  |
  = help: for example: film: (fps: 30, size: (1280, 720), speed: 0.5)
"#,
    );
}

#[test]
fn a_wrong_inertia() {
    wrong(
        r#"
Scene(
    format: 1,
    clock: (duration: 1),
    bodies: [(name: "ball", at: (0, 1), atoms: Disc(radius: 0.1), inertia: Disks)],
)"#,
        r#"
error: bodies[0].inertia: expected `Discs`, `Points`, `Union` or a moment of inertia such as `0.2`, found `Disks`
 --> a.ron:4:76
  |
4 |     bodies: [(name: "ball", at: (0, 1), atoms: Disc(radius: 0.1), inertia: Disks)],
  |                                                                            ^^^^^ this value
"#,
    );
}
