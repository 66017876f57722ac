//! Mistakes that no scene of the standard plugins can make, or that will soon disappear. They are in sections of
//! plugins, and in names reserved for later versions. All others are in `tests/wrong_scenes`, a file each.

use super::wrong;

#[test]
fn mistakes_in_a_section_of_a_plugin() {
    wrong(
        r#"
Scene(
    format: 1,
    clock: (duration: 1),
    bodies: [(name: "ball", at: (0, 1), atoms: Disc(radius: 0.1))],
    wind: (speed: 3, gust: []),
)"#,
        r#"
error: wind.gust: `wind` has no field `gust`
 --> a.ron:5:22
  |
5 |     wind: (speed: 3, gust: []),
  |                      ^^^^ unknown field
  |
  = help: did you mean `gusts`? fields: `speed`, `gusts`
"#,
    );
}

#[test]
fn checks_in_a_section_of_a_plugin() {
    wrong(
        r#"
Scene(
    format: 1,
    clock: (duration: 1),
    bodies: [(name: "ball", at: (0, 1), atoms: Disc(radius: 0.1))],
    wind: (speed: "200 m/s", gusts: [(at: -1, strength: Weak), (at: 1, strength: Strong(factor: 12))]),
)"#,
        r#"
error: wind.speed: must be from 0 to 100, got 200
 --> a.ron:5:19
  |
5 |     wind: (speed: "200 m/s", gusts: [(at: -1, strength: Weak), (at: 1, strength: Strong(factor: 12))]),
  |                   ^^^^^^^^^ this value

error: wind.gusts[0].at: must be a finite number, zero or above, got -1
 --> a.ron:5:43
  |
5 |     wind: (speed: "200 m/s", gusts: [(at: -1, strength: Weak), (at: 1, strength: Strong(factor: 12))]),
  |                                           ^^ this value

error: wind.gusts[1].strength.factor: must be from 1 to 10, got 12
 --> a.ron:5:97
  |
5 |     wind: (speed: "200 m/s", gusts: [(at: -1, strength: Weak), (at: 1, strength: Strong(factor: 12))]),
  |                                                                                                 ^^ this value
"#,
    );
}

#[test]
fn a_wrong_choice_in_a_section_of_a_plugin() {
    wrong(
        r#"
Scene(
    format: 1,
    clock: (duration: 1),
    bodies: [(name: "ball", at: (0, 1), atoms: Disc(radius: 0.1))],
    wind: (speed: 3, gusts: [(at: 1, strength: Storm)]),
)"#,
        r#"
error: wind.gusts[0].strength: `Storm` is not one of the choices
 --> a.ron:5:48
  |
5 |     wind: (speed: 3, gusts: [(at: 1, strength: Storm)]),
  |                                                ^^^^^ unknown
  |
  = help: choices: `Weak`, `Strong`
"#,
    );
}

#[test]
fn fields_and_choices_of_later_versions() {
    wrong(
        r#"
Scene(
    format: 1,
    clock: (duration: 1),
    bodies: [(name: "ball", at: (0, 0), soft: (stiffness: 500))],
)"#,
        r#"
error: bodies[0].soft: `soft` is not available yet
 --> a.ron:4:41
  |
4 |     bodies: [(name: "ball", at: (0, 0), soft: (stiffness: 500))],
  |                                         ^^^^ not available yet
  |
  = help: the name is reserved for a later version; remove it
"#,
    );
}
