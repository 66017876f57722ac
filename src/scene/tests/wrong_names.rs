//! Scenes with names that are unknown, missing, reserved or taken.

use super::wrong;

#[test]
fn no_bodies() {
    wrong(
        r#"
Scene(
    format: 1,
    clock: (duration: 1),
)"#,
        r#"
error: the scene has no bodies
 --> a.ron:1:1
  |
1 | Scene(
  | ^^^^^ in here
  |
  = help: the smallest scene is `Scene(format: 1, clock: (duration: 1), bodies: [(name: "ball", at: (0, 0), atoms: Disc(radius: 0.1))])`
"#,
    );
}

#[test]
fn a_reserved_section() {
    wrong(
        r#"
Scene(
    format: 1,
    clock: (duration: 1),
    bodies: [(name: "ball", at: (0, 1), atoms: Disc(radius: 0.1))],
    joints: [],
)"#,
        r#"
error: the section `joints` is not available yet
 --> a.ron:5:5
  |
5 |     joints: [],
  |     ^^^^^^ not available yet
  |
  = help: the name is reserved for a later version; remove the section
"#,
    );
}

#[test]
fn a_reserved_entry() {
    wrong(
        r#"
Scene(
    format: 1,
    clock: (duration: 1),
    bodies: [(name: "ball", at: (0, 1), atoms: Disc(radius: 0.1))],
    camera: Follow(of: "ball", height: 4),
)"#,
        r#"
error: camera: `Follow` is not available yet
 --> a.ron:5:13
  |
5 |     camera: Follow(of: "ball", height: 4),
  |             ^^^^^^ not available yet
  |
  = help: the name is reserved for a later version; remove the entry
"#,
    );
}

#[test]
fn a_reserved_method() {
    wrong(
        r#"
Scene(
    format: 1,
    clock: (duration: 1, method: RungeKutta4, tolerance: 1e-8, events: Located),
    bodies: [(name: "ball", at: (0, 1), atoms: Disc(radius: 0.1))],
)"#,
        r#"
error: clock.method: `RungeKutta4` is not available yet
 --> a.ron:3:34
  |
3 |     clock: (duration: 1, method: RungeKutta4, tolerance: 1e-8, events: Located),
  |                                  ^^^^^^^^^^^ this value
  |
  = help: the methods so far are `Auto`, `SemiImplicitEuler`, `VelocityVerlet`

error: clock.tolerance: `tolerance` is not available yet
 --> a.ron:3:58
  |
3 |     clock: (duration: 1, method: RungeKutta4, tolerance: 1e-8, events: Located),
  |                                                          ^^^^ this value
  |
  = help: write `tick: "1 ms"` instead, or leave it out

error: clock.events: `Located` is not available yet
 --> a.ron:3:72
  |
3 |     clock: (duration: 1, method: RungeKutta4, tolerance: 1e-8, events: Located),
  |                                                                        ^^^^^^^ this value
  |
  = help: write `events: Auto`, or leave it out
"#,
    );
}

#[test]
fn an_unknown_method() {
    wrong(
        r#"
Scene(
    format: 1,
    clock: (duration: 1, method: velocityverlet),
    bodies: [(name: "ball", at: (0, 1), atoms: Disc(radius: 0.1))],
)"#,
        r#"
error: clock.method: there is no method `velocityverlet`
 --> a.ron:3:34
  |
3 |     clock: (duration: 1, method: velocityverlet),
  |                                  ^^^^^^^^^^^^^^ this value
  |
  = help: did you mean `VelocityVerlet`? methods: `Auto`, `SemiImplicitEuler`, `VelocityVerlet`
"#,
    );
}

#[test]
fn an_unknown_entry() {
    wrong(
        r#"
Scene(
    format: 1,
    clock: (duration: 1),
    bodies: [(name: "ball", at: (0, 1), atoms: Disc(radius: 0.1))],
    forces: [Drga(quadratic: 0.02)],
)"#,
        r#"
error: forces[0]: `forces` has no entry `Drga`
 --> a.ron:5:14
  |
5 |     forces: [Drga(quadratic: 0.02)],
  |              ^^^^ unknown entry
  |
  = help: did you mean `Drag`? entries: `Drag`
"#,
    );
}

#[test]
fn an_entry_without_name() {
    wrong(
        r#"
Scene(
    format: 1,
    clock: (duration: 1),
    bodies: [(name: "ball", at: (0, 1), atoms: Disc(radius: 0.1))],
    forces: [(quadratic: 0.02)],
)"#,
        r#"
error: forces[0]: expected an entry with a leading name, found a round bracket with named fields `(..: ..)`
 --> a.ron:5:14
  |
5 |     forces: [(quadratic: 0.02)],
  |              ^^^^^^^^^^^^^^^^^ no name
  |
  = help: for example: forces: [Drag(quadratic: 0.02)]; entries: `Drag`
"#,
    );
}

#[test]
fn an_entry_without_brackets() {
    wrong(
        r#"
Scene(
    format: 1,
    clock: (duration: 1),
    bodies: [(name: "ball", at: (0, 1), atoms: Disc(radius: 0.1))],
    forces: [Drag],
)"#,
        r#"
error: forces[0]: brackets are missing after `Drag`
 --> a.ron:5:14
  |
5 |     forces: [Drag],
  |              ^^^^ `(..)` expected after this
  |
  = help: for example: Drag(quadratic: 0.02, of: ["ball"])
"#,
    );
}

#[test]
fn an_unknown_shape() {
    wrong(
        r#"
Scene(
    format: 1,
    clock: (duration: 1),
    bodies: [(name: "ball", at: (0, 1), atoms: Disk(radius: 0.1))],
)"#,
        r#"
error: bodies[0].atoms: `Disk` is not one of the choices
 --> a.ron:4:48
  |
4 |     bodies: [(name: "ball", at: (0, 1), atoms: Disk(radius: 0.1))],
  |                                                ^^^^ unknown
  |
  = help: did you mean `Disc`? choices: `Picture`, `List`, `Disc`
"#,
    );
}

#[test]
fn an_unknown_body() {
    wrong(
        r#"
Scene(
    format: 1,
    clock: (duration: 1),
    bodies: [(name: "anvil", at: (0, 1), atoms: Disc(radius: 0.1))],
    forces: [Drag(of: ["anvli", "gas_*"])],
)"#,
        r#"
error: forces[0].of[0]: there is no body named "anvli"
 --> a.ron:5:24
  |
5 |     forces: [Drag(of: ["anvli", "gas_*"])],
  |                        ^^^^^^^ this value
  |
  = help: did you mean "anvil"? bodies: "anvil"

error: forces[0].of[1]: no body has a name that fits "gas_*"
 --> a.ron:5:33
  |
5 |     forces: [Drag(of: ["anvli", "gas_*"])],
  |                                 ^^^^^^^ this value
  |
  = help: bodies: "anvil"
"#,
    );
}

#[test]
fn an_unknown_material() {
    wrong(
        r#"
Scene(
    format: 1,
    clock: (duration: 1),
    bodies: [(name: "ball", at: (0, 1), atoms: Disc(radius: 0.1), material: "rok")],
    materials: { "rock": () },
)"#,
        r#"
error: bodies[0].material: there is no material named "rok"
 --> a.ron:4:77
  |
4 |     bodies: [(name: "ball", at: (0, 1), atoms: Disc(radius: 0.1), material: "rok")],
  |                                                                             ^^^^^ this value
  |
  = help: did you mean "rock"? materials: "rock"
"#,
    );
}

#[test]
fn a_body_name_twice() {
    wrong(
        r#"
Scene(
    format: 1,
    clock: (duration: 1),
    bodies: [
        (name: "ball", at: (0, 1), atoms: Disc(radius: 0.1)),
        (name: "ball", at: (2, 1), atoms: Disc(radius: 0.1)),
    ],
)"#,
        r#"
error: bodies[1].name: the name "ball" is taken by another body
 --> a.ron:6:16
  |
5 |         (name: "ball", at: (0, 1), atoms: Disc(radius: 0.1)),
  |                ------ this body has the name too
6 |         (name: "ball", at: (2, 1), atoms: Disc(radius: 0.1)),
  |                ^^^^^^ here again
  |
  = help: give every thing its own name
"#,
    );
}

#[test]
fn a_wall_with_the_name_of_a_body() {
    wrong(
        r#"
Scene(
    format: 1,
    clock: (duration: 1),
    bodies: [(name: "ball", at: (0, 1), atoms: Disc(radius: 0.1))],
    walls: [(name: "ball", left: (6, 0), right: (0, 0))],
)"#,
        r#"
error: walls[0].name: the name "ball" is taken by a body
 --> a.ron:5:20
  |
4 |     bodies: [(name: "ball", at: (0, 1), atoms: Disc(radius: 0.1))],
  |                     ------ this body has the name too
5 |     walls: [(name: "ball", left: (6, 0), right: (0, 0))],
  |                    ^^^^^^ here again
  |
  = help: give every thing its own name
"#,
    );
}

#[test]
fn a_name_with_a_star() {
    wrong(
        r#"
Scene(
    format: 1,
    clock: (duration: 1),
    bodies: [(name: "gas_*", at: (0, 1), atoms: Disc(radius: 0.1))],
)"#,
        r#"
error: bodies[0].name: the name "gas_*" must not contain '*'
 --> a.ron:4:21
  |
4 |     bodies: [(name: "gas_*", at: (0, 1), atoms: Disc(radius: 0.1))],
  |                     ^^^^^^^ this value
  |
  = help: `*` stands for any letters where bodies are chosen; use letters, digits and `_`
"#,
    );
}

#[test]
fn a_struct_name_of_the_program() {
    wrong(
        r#"
Scene(
    format: 1,
    clock: (duration: 1),
    bodies: [BodyEntry(name: "ball", at: (0, 1), atoms: Disc(radius: 0.1))],
)"#,
        r#"
error: bodies[0]: no name `BodyEntry` belongs here
 --> a.ron:4:14
  |
4 |     bodies: [BodyEntry(name: "ball", at: (0, 1), atoms: Disc(radius: 0.1))],
  |              ^^^^^^^^^ remove this name
  |
  = help: for example: bodies: [(name: "ball", at: (2, 3), atoms: Disc(radius: 0.2))]
"#,
    );
}

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
fn a_material_without_quotes() {
    wrong(
        r#"
Scene(
    format: 1,
    clock: (duration: 1),
    bodies: [(name: "ball", at: (0, 1), atoms: Disc(radius: 0.1))],
    materials: { rock: () },
)"#,
        r#"
error: materials[rock]: the name `rock` must stand in quotes
 --> a.ron:5:18
  |
5 |     materials: { rock: () },
  |                  ^^^^ needs quotes
  |
  = help: write `"rock": ..`
"#,
    );
}

#[test]
fn a_shape_without_brackets() {
    wrong(
        r#"
Scene(
    format: 1,
    clock: (duration: 1),
    bodies: [(name: "ball", at: (0, 1), atoms: Disc)],
)"#,
        r#"
error: bodies[0].atoms: brackets are missing after `Disc`
 --> a.ron:4:48
  |
4 |     bodies: [(name: "ball", at: (0, 1), atoms: Disc)],
  |                                                ^^^^ `(..)` expected after this
  |
  = help: for example: bodies: [(name: "ball", at: (2, 3), atoms: Disc(radius: 0.2))]
"#,
    );
}

#[test]
fn an_entry_with_a_value_without_name() {
    wrong(
        r#"
Scene(
    format: 1,
    clock: (duration: 1),
    bodies: [(name: "ball", at: (0, 1), atoms: Disc(radius: 0.1))],
    forces: [Drag(1)],
)"#,
        r#"
error: forces[0]: expected a field name and `:`, found the number 1
 --> a.ron:5:19
  |
5 |     forces: [Drag(1)],
  |                   ^ no field name
  |
  = help: for example: Drag(quadratic: 0.02, of: ["ball"])
"#,
    );
}

#[test]
fn a_method_with_brackets() {
    wrong(
        r#"
Scene(
    format: 1,
    clock: (duration: 1, method: VelocityVerlet(3)),
    bodies: [(name: "ball", at: (0, 1), atoms: Disc(radius: 0.1))],
)"#,
        r#"
error: clock.method: `VelocityVerlet` takes nothing in brackets
 --> a.ron:3:34
  |
3 |     clock: (duration: 1, method: VelocityVerlet(3)),
  |                                  ^^^^^^^^^^^^^^ remove the brackets after it
  |
  = help: for example: clock: (duration: 20, tick: "1 ms", method: VelocityVerlet)
"#,
    );
}

#[test]
fn a_wrong_datum() {
    wrong(
        r#"
Scene(
    format: 1,
    clock: (duration: 1),
    bodies: [(name: "ball", at: (0, 1), atoms: Disc(radius: 1), datum: Center)],
)"#,
        r#"
error: bodies[0].datum: `Center` is not one of the choices
 --> a.ron:4:72
  |
4 |     bodies: [(name: "ball", at: (0, 1), atoms: Disc(radius: 1), datum: Center)],
  |                                                                        ^^^^^^ unknown
  |
  = help: did you mean `CenterOfMass`? choices: `CenterOfMass`, `Origin`
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
    bodies: [(name: "ball", at: (0, 0), shape: Capsule(length: 1, radius: 0.1))],
)"#,
        r#"
error: bodies[0].shape: `shape` is not available yet
 --> a.ron:4:41
  |
4 |     bodies: [(name: "ball", at: (0, 0), shape: Capsule(length: 1, radius: 0.1))],
  |                                         ^^^^^ not available yet
  |
  = help: the name is reserved for a later version; remove it
"#,
    );
}
