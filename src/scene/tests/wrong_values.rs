//! Scenes with values of the wrong size or unit.

use super::wrong;

#[test]
fn a_wrong_unit() {
    wrong(
        r#"
Scene(
    format: 1,
    clock: (duration: 1),
    bodies: [(name: "ball", at: (0, 1), atoms: Disc(radius: "2.5 g"))],
)"#,
        r#"
error: bodies[0].atoms.radius: expected a length such as `0.3` or "30 cm", got a mass `2.5 g`
 --> a.ron:4:61
  |
4 |     bodies: [(name: "ball", at: (0, 1), atoms: Disc(radius: "2.5 g"))],
  |                                                             ^^^^^^^ this value
"#,
    );
}

#[test]
fn an_unknown_unit() {
    wrong(
        r#"
Scene(
    format: 1,
    clock: (duration: 1),
    bodies: [(name: "ball", at: (0, "3 metres"), atoms: Disc(radius: 0.1))],
)"#,
        r#"
error: bodies[0].at[1]: unknown unit `metres` (did you mean `m`?) in "3 metres"; expected a length such as `0.3` or "30 cm"
 --> a.ron:4:37
  |
4 |     bodies: [(name: "ball", at: (0, "3 metres"), atoms: Disc(radius: 0.1))],
  |                                     ^^^^^^^^^^ this value
"#,
    );
}

#[test]
fn many_mistakes_at_once() {
    wrong(
        r#"
Scene(
    format: 1,
    clock: (duration: 1),
    bodies: [
        (name: "ball", at: (0, NaN), atoms: Disc(radius: 0.1, mass: -2), material: "stone"),
        (name: "box", at: (2, 1e400), spin: -inf, atoms: Disc(radius: 0), fixed: true, velocity: (1, 0)),
    ],
    walls: [(name: "floor", left: (1, 0), right: (1, 0), material: "rok")],
    materials: { "rock": (friction: -1, restitution: 2, inelasticity: 0.1) },
)"#,
        r#"
error: bodies[0].at[1]: must be a finite number, got NaN
 --> a.ron:5:32
  |
5 |         (name: "ball", at: (0, NaN), atoms: Disc(radius: 0.1, mass: -2), material: "stone"),
  |                                ^^^ not finite

error: bodies[0].atoms.mass: must be a finite number above zero, got -2
 --> a.ron:5:69
  |
5 |         (name: "ball", at: (0, NaN), atoms: Disc(radius: 0.1, mass: -2), material: "stone"),
  |                                                                     ^^ this value

error: bodies[0].material: there is no material named "stone"
 --> a.ron:5:84
  |
5 |         (name: "ball", at: (0, NaN), atoms: Disc(radius: 0.1, mass: -2), material: "stone"),
  |                                                                                    ^^^^^^^ this value
  |
  = help: materials: "rock"

error: bodies[1].at[1]: must be a finite number, got 1e400
 --> a.ron:6:31
  |
6 |         (name: "box", at: (2, 1e400), spin: -inf, atoms: Disc(radius: 0), fixed: true, velocity: (1, 0)),
  |                               ^^^^^ not finite

error: bodies[1].spin: must be a finite number, got -inf
 --> a.ron:6:45
  |
6 |         (name: "box", at: (2, 1e400), spin: -inf, atoms: Disc(radius: 0), fixed: true, velocity: (1, 0)),
  |                                             ^^^^ not finite

error: bodies[1].atoms.radius: must be a finite number above zero, got 0
 --> a.ron:6:71
  |
6 |         (name: "box", at: (2, 1e400), spin: -inf, atoms: Disc(radius: 0), fixed: true, velocity: (1, 0)),
  |                                                                       ^ this value

error: bodies[1].velocity: a fixed body does not move
 --> a.ron:6:98
  |
6 |         (name: "box", at: (2, 1e400), spin: -inf, atoms: Disc(radius: 0), fixed: true, velocity: (1, 0)),
  |                                                                                                  ^^^^^^ this value
  |
  = help: remove this, or remove `fixed: true`

error: walls[0].right: must differ from `left`, got (1, 0) for both
 --> a.ron:8:50
  |
8 |     walls: [(name: "floor", left: (1, 0), right: (1, 0), material: "rok")],
  |                                                  ^^^^^^ this value
  |
  = help: a wall is the line through two points, seen from the open side

error: walls[0].material: there is no material named "rok"
 --> a.ron:8:68
  |
8 |     walls: [(name: "floor", left: (1, 0), right: (1, 0), material: "rok")],
  |                                                                    ^^^^^ this value
  |
  = help: did you mean "rock"? materials: "rock"

error: materials["rock"].friction: must be a finite number, zero or above, got -1
 --> a.ron:9:37
  |
9 |     materials: { "rock": (friction: -1, restitution: 2, inelasticity: 0.1) },
  |                                     ^^ this value

error: materials["rock"].restitution: must be from 0 to 1, got 2
 --> a.ron:9:54
  |
9 |     materials: { "rock": (friction: -1, restitution: 2, inelasticity: 0.1) },
  |                                                      ^ this value

error: materials["rock"].inelasticity: `restitution` and `inelasticity` say the same thing; only one of them may stand
 --> a.ron:9:71
  |
9 |     materials: { "rock": (friction: -1, restitution: 2, inelasticity: 0.1) },
  |                                                                       ^^^ this value
  |
  = help: remove one of the two
"#,
    );
}

#[test]
fn mistakes_in_several_sections() {
    wrong(
        r#"
Scene(
    format: 1,
    clock: (duration: 1),
    bodies: [(name: 7)],
    film: (fps: "fast"),
    forces: [Drga()],
    wind: (speed: -1),
)"#,
        r#"
error: bodies[0].name: expected a text in quotes, found the number 7
 --> a.ron:4:21
  |
4 |     bodies: [(name: 7)],
  |                     ^ not a text in quotes
  |
  = help: for example: bodies: [(name: "ball", at: (2, 3), atoms: Disc(radius: 0.2))]

error: film.fps: expected a rate such as `250` or "250 Hz", found the text "fast"
 --> a.ron:5:17
  |
5 |     film: (fps: "fast"),
  |                 ^^^^^^ this value

error: forces[0]: `forces` has no entry `Drga`
 --> a.ron:6:14
  |
6 |     forces: [Drga()],
  |              ^^^^ unknown entry
  |
  = help: did you mean `Drag`? entries: `Drag`

error: wind.speed: must be from 0 to 100, got -1
 --> a.ron:7:19
  |
7 |     wind: (speed: -1),
  |                   ^^ this value
"#,
    );
}

#[test]
fn wrong_times() {
    wrong(
        r#"
Scene(
    format: 1,
    clock: (duration: "2 ms", tick: 1),
    bodies: [(name: "ball", at: (0, 1), atoms: Disc(radius: 0.1))],
    film: (from: 3, to: 1),
)"#,
        r#"
error: clock.tick: the tick of 1 s is longer than the whole run of 0.002 s
 --> a.ron:3:37
  |
3 |     clock: (duration: "2 ms", tick: 1),
  |                                     ^ this value
  |
  = help: a tick is some milliseconds: write `tick: "1 ms"`, or leave it out

error: film.to: must be after `from`, which is 3 s, got 1 s
 --> a.ron:5:25
  |
5 |     film: (from: 3, to: 1),
  |                         ^ this value
"#,
    );
}

#[test]
fn a_tick_of_nothing() {
    wrong(
        r#"
Scene(
    format: 1,
    clock: (duration: 0, tick: "0 s"),
    bodies: [(name: "ball", at: (0, 1), atoms: Disc(radius: 0.1))],
)"#,
        r#"
error: clock.duration: must be a finite number above zero, got 0
 --> a.ron:3:23
  |
3 |     clock: (duration: 0, tick: "0 s"),
  |                       ^ this value

error: clock.tick: must be a finite number above zero, got 0
 --> a.ron:3:32
  |
3 |     clock: (duration: 0, tick: "0 s"),
  |                                ^^^^^ this value
"#,
    );
}

#[test]
fn format_2() {
    wrong(
        r#"
Scene(format: 2, clock: (duration: 1), bodies: [(name: "ball", at: (0, 1), atoms: Disc(radius: 0.1))],)"#,
        r#"
error: format: must be 1, got 2
 --> a.ron:1:15
  |
1 | Scene(format: 2, clock: (duration: 1), bodies: [(name: "ball", at: (0, 1), atoms: Disc(radius: 0.1))],)
  |               ^ not 1
  |
  = help: this program reads scenes of format 1 only; a newer format needs a newer program
"#,
    );
}

#[test]
fn friction_the_wrong_way_round() {
    wrong(
        r#"
Scene(
    format: 1,
    clock: (duration: 1),
    bodies: [(name: "ball", at: (0, 1), atoms: Disc(radius: 0.1))],
    materials: { "rock": (friction: (static: 0.2, dynamic: 0.4)) },
)"#,
        r#"
error: materials["rock"].friction.dynamic: must not be above the static friction of 0.2, got 0.4
 --> a.ron:5:60
  |
5 |     materials: { "rock": (friction: (static: 0.2, dynamic: 0.4)) },
  |                                                            ^^^ this value
"#,
    );
}

#[test]
fn a_pair_twice() {
    wrong(
        r#"
Scene(
    format: 1,
    clock: (duration: 1),
    bodies: [(name: "ball", at: (0, 1), atoms: Disc(radius: 0.1))],
    materials: { "rock": (), "ice": () },
    pairs: [
        (between: ("rock", "ice"), friction: 0.1),
        (between: ("ice", "rock"), friction: 0.2),
        (between: ("ice", "iec")),
    ],
)"#,
        r#"
error: pairs[1].between: the pair of "ice" and "rock" stands here twice
 --> a.ron:8:19
  |
7 |         (between: ("rock", "ice"), friction: 0.1),
  |                   --------------- the first time
8 |         (between: ("ice", "rock"), friction: 0.2),
  |                   ^^^^^^^^^^^^^^^ here again

error: pairs[2]: this pair changes nothing
 --> a.ron:9:9
  |
9 |         (between: ("ice", "iec")),
  |         ^^^^^^^^^^^^^^^^^^^^^^^^^ this value
  |
  = help: give `friction` or `restitution`, or remove it

error: pairs[2].between[1]: there is no material named "iec"
 --> a.ron:9:27
  |
9 |         (between: ("ice", "iec")),
  |                           ^^^^^ this value
  |
  = help: did you mean "ice"? materials: "rock", "ice"
"#,
    );
}

#[test]
fn a_negative_count() {
    wrong(
        r#"
Scene(
    format: 1,
    clock: (duration: 1),
    fill: [(name: "gas", atoms: Disc(radius: 0.5), count: -5, within: ((0, 0), (1, 1)))],
)"#,
        r#"
error: fill[0].count: expected a whole number such as `12`, found the number -5
 --> a.ron:4:59
  |
4 |     fill: [(name: "gas", atoms: Disc(radius: 0.5), count: -5, within: ((0, 0), (1, 1)))],
  |                                                           ^^ not a whole number
  |
  = help: for example: fill: [(name: "gas", atoms: Disc(radius: 0.02), count: 500, within: ((0, 0), (6, 6)), speed: 1, seed: 7)]
"#,
    );
}

#[test]
fn a_colour_that_is_none() {
    wrong(
        r##"
Scene(
    format: 1,
    clock: (duration: 1),
    bodies: [(name: "ball", at: (0, 1), atoms: Disc(radius: 0.1))],
    materials: { "rock": (color: "#12345") },
)"##,
        r##"
error: materials["rock"].color: `#12345` is not a colour
 --> a.ron:5:34
  |
5 |     materials: { "rock": (color: "#12345") },
  |                                  ^^^^^^^^ this value
  |
  = help: write `"#rrggbb"`, such as `"#20a0c0"`
"##,
    );
}

#[test]
fn a_camera_of_no_height() {
    wrong(
        r#"
Scene(
    format: 1,
    clock: (duration: 1),
    bodies: [(name: "ball", at: (0, 1), atoms: Disc(radius: 0.1))],
    camera: Look(center: (0, 0), height: 0),
)"#,
        r#"
error: camera.height: must be a finite number above zero, got 0
 --> a.ron:5:42
  |
5 |     camera: Look(center: (0, 0), height: 0),
  |                                          ^ this value
"#,
    );
}

#[test]
fn a_unit_that_reads_two_ways() {
    wrong(
        r#"
Scene(
    format: 1,
    clock: (duration: 1),
    bodies: [(name: "T", at: (0, 1), velocity: (0, "3 m/s s"), atoms: Disc(radius: 1))],
)"#,
        r#"
error: bodies[0].velocity[1]: `m/s s` reads two ways (put products before `/`) in "3 m/s s"; expected a speed such as `0.2` or "20 cm/s"
 --> a.ron:4:52
  |
4 |     bodies: [(name: "T", at: (0, 1), velocity: (0, "3 m/s s"), atoms: Disc(radius: 1))],
  |                                                    ^^^^^^^^^ this value
"#,
    );
}

#[test]
fn an_infinite_quantity() {
    wrong(
        r#"
Scene(
    format: 1,
    clock: (duration: 1),
    bodies: [(name: "T", at: (0, 1), atoms: Disc(radius: "1e400 m"))],
)"#,
        r#"
error: bodies[0].atoms.radius: `1e400 m` is too large for a number; expected a length such as `0.3` or "30 cm"
 --> a.ron:4:58
  |
4 |     bodies: [(name: "T", at: (0, 1), atoms: Disc(radius: "1e400 m"))],
  |                                                          ^^^^^^^^^ this value
"#,
    );
}
