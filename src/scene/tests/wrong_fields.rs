//! Scenes with fields and sections that are unknown, missing or there twice.

use super::wrong;

#[test]
fn an_unknown_section() {
    wrong(
        r#"
Scene(
    format: 1,
    clock: (duration: 1),
    bodies: [(name: "ball", at: (0, 1), atoms: Disc(radius: 0.1))],
    gravty: (0, -9.81),
)"#,
        r#"
error: there is no section `gravty`
 --> a.ron:5:5
  |
5 |     gravty: (0, -9.81),
  |     ^^^^^^ unknown section
  |
  = help: did you mean `gravity`? sections: `format`, `title`, `notes`, `bodies`, `camera`, `clock`, `contacts`, `fill`, `film`, `forces`, `gravity`, `materials`, `pairs`, `walls`, `wind`
"#,
    );
}

#[test]
fn an_unknown_field() {
    wrong(
        r#"
Scene(
    format: 1,
    clock: (duration: 1),
    bodies: [(name: "ball", at: (0, 1), mas: 2, atoms: Disc(radius: 0.1))],
)"#,
        r#"
error: bodies[0].mas: `bodies[0]` has no field `mas`
 --> a.ron:4:41
  |
4 |     bodies: [(name: "ball", at: (0, 1), mas: 2, atoms: Disc(radius: 0.1))],
  |                                         ^^^ unknown field
  |
  = help: did you mean `mass`? fields: `name`, `atoms`, `at`, `angle`, `velocity`, `spin`, `material`, `fixed`, `kinematic`, `collides`, `datum`, `mass`, `inertia`
"#,
    );
}

#[test]
fn an_unknown_field_far_from_all() {
    wrong(
        r#"
Scene(
    format: 1,
    clock: (duration: 1),
    bodies: [(name: "ball", at: (0, 1), zebra: 2, atoms: Disc(radius: 0.1))],
)"#,
        r#"
error: bodies[0].zebra: `bodies[0]` has no field `zebra`
 --> a.ron:4:41
  |
4 |     bodies: [(name: "ball", at: (0, 1), zebra: 2, atoms: Disc(radius: 0.1))],
  |                                         ^^^^^ unknown field
  |
  = help: fields: `name`, `atoms`, `at`, `angle`, `velocity`, `spin`, `material`, `fixed`, `kinematic`, `collides`, `datum`, `mass`, `inertia`
"#,
    );
}

#[test]
fn an_unknown_field_deep_inside() {
    wrong(
        r#"
Scene(
    format: 1,
    clock: (duration: 1),
    bodies: [(name: "ball", at: (0, 1), atoms: Disc(radus: 0.1))],
)"#,
        r#"
error: bodies[0].atoms.radus: `Disc` has no field `radus`
 --> a.ron:4:53
  |
4 |     bodies: [(name: "ball", at: (0, 1), atoms: Disc(radus: 0.1))],
  |                                                     ^^^^^ unknown field
  |
  = help: did you mean `radius`? fields: `radius`, `mass`, `stiffness`
"#,
    );
}

#[test]
fn an_unknown_field_of_a_map() {
    wrong(
        r#"
Scene(
    format: 1,
    clock: (duration: 1),
    bodies: [(name: "ball", at: (0, 1), atoms: Disc(radius: 0.1))],
    materials: { "rock": (fricton: 0.5) },
)"#,
        r#"
error: materials["rock"].fricton: `materials["rock"]` has no field `fricton`
 --> a.ron:5:27
  |
5 |     materials: { "rock": (fricton: 0.5) },
  |                           ^^^^^^^ unknown field
  |
  = help: did you mean `friction`? fields: `stiffness`, `friction`, `restitution`, `inelasticity`, `density`, `color`
"#,
    );
}

#[test]
fn a_section_twice() {
    wrong(
        r#"
Scene(
    format: 1,
    clock: (duration: 1),
    bodies: [(name: "ball", at: (0, 1), atoms: Disc(radius: 0.1))],
    clock: (duration: 2),
)"#,
        r#"
error: clock: `clock` stands here twice
 --> a.ron:5:5
  |
3 |     clock: (duration: 1),
  |     ----- the first time
4 |     bodies: [(name: "ball", at: (0, 1), atoms: Disc(radius: 0.1))],
5 |     clock: (duration: 2),
  |     ^^^^^ the second time
  |
  = help: keep one of the two
"#,
    );
}

#[test]
fn a_field_twice() {
    wrong(
        r#"
Scene(
    format: 1,
    clock: (duration: 1),
    bodies: [
        (
            name: "ball",
            at: (0, 1),
            name: "box",
            atoms: Disc(radius: 0.1),
        ),
    ],
)"#,
        r#"
error: bodies[0].name: `name` stands here twice
 --> a.ron:8:13
  |
6 |             name: "ball",
  |             ---- the first time
7 |             at: (0, 1),
8 |             name: "box",
  |             ^^^^ the second time
  |
  = help: keep one of the two
"#,
    );
}

#[test]
fn a_material_twice() {
    wrong(
        r#"
Scene(
    format: 1,
    clock: (duration: 1),
    bodies: [(name: "ball", at: (0, 1), atoms: Disc(radius: 0.1))],
    materials: {
        "rock": (friction: 0.5),
        "rock": (friction: 0.6),
    },
)"#,
        r#"
error: materials["rock"]: `rock` stands here twice
 --> a.ron:7:9
  |
6 |         "rock": (friction: 0.5),
  |         ------ the first time
7 |         "rock": (friction: 0.6),
  |         ^^^^^^ the second time
  |
  = help: keep one of the two
"#,
    );
}

#[test]
fn a_missing_field() {
    wrong(
        r#"
Scene(
    format: 1,
    clock: (duration: 1),
    bodies: [(name: "ball", at: (0, 1))],
)"#,
        r#"
error: bodies[0]: the field `atoms` is missing
 --> a.ron:4:14
  |
4 |     bodies: [(name: "ball", at: (0, 1))],
  |              ^ `atoms: ..` is missing in here
  |
  = help: for example: bodies: [(name: "ball", at: (2, 3), atoms: Disc(radius: 0.2))]
"#,
    );
}

#[test]
fn a_missing_field_of_a_shape() {
    wrong(
        r#"
Scene(
    format: 1,
    clock: (duration: 1),
    bodies: [(name: "ball", at: (0, 1), atoms: Disc(mass: 2))],
)"#,
        r#"
error: bodies[0].atoms: the field `radius` is missing
 --> a.ron:4:41
  |
4 |     bodies: [(name: "ball", at: (0, 1), atoms: Disc(mass: 2))],
  |                                         ^^^^^ `radius: ..` is missing in here
  |
  = help: for example: bodies: [(name: "ball", at: (2, 3), atoms: Disc(radius: 0.2))]
"#,
    );
}

#[test]
fn missing_sections() {
    wrong(
        r#"
Scene(title: "nothing else", bodies: [(name: "ball", at: (0, 1), atoms: Disc(radius: 0.1))],)"#,
        r#"
error: the section `format` is missing
 --> a.ron:1:1
  |
1 | Scene(title: "nothing else", bodies: [(name: "ball", at: (0, 1), atoms: Disc(radius: 0.1))],)
  | ^^^^^ no `format` in here
  |
  = help: every scene says which version of the language it is in: write `format: 1`

error: the section `clock` is missing
 --> a.ron:1:1
  |
1 | Scene(title: "nothing else", bodies: [(name: "ball", at: (0, 1), atoms: Disc(radius: 0.1))],)
  | ^^^^^ no `clock` in here
  |
  = help: say how long to simulate: write `clock: (duration: 20)`
"#,
    );
}

#[test]
fn brackets_twice() {
    wrong(
        r#"
Scene(
    format: 1,
    clock: (duration: 1),
    bodies: [(name: "ball", at: (0, 1), atoms: Disc((radius: 1)))],
)"#,
        r#"
error: bodies[0].atoms: expected a field name
 --> a.ron:4:53
  |
4 |     bodies: [(name: "ball", at: (0, 1), atoms: Disc((radius: 1)))],
  |                                                     ^ in here
  |
  = help: for example: bodies: [(name: "ball", at: (2, 3), atoms: Disc(radius: 0.2))]
"#,
    );
}
