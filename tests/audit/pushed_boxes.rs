//! Law: no row pulls. A plate pushes two boxes along the floor, which lean on each other with eight corners. No choice of modes may let all of
//! them push. Then the springs of the contacts decide, the run goes on, and its card says so.

use super::ran::{demand_agreement, end};

const CLOCKS: [&str; 5] =
    ["", ", tolerance: 1e-2", ", tolerance: 1e-3", ", method: Reference", ", method: Dop853, tick: 1e-4"];

/// Two boxes of one material: friction, restitution, and masses in kg of boxes of 3 mm.
struct Boxes {
    friction: f64,
    restitution: f64,
    masses: (f64, f64),
}

const BOXES: Boxes = Boxes { friction: 0.206446, restitution: 0.1, masses: (0.0171349, 0.0135462) };

/// Boxes in front of a plate that goes there and back. `size` in m: all lengths, with the masses and stiffness of the same material.
fn pushed(boxes: &Boxes, size: f64, clock: &str) -> String {
    let lengths = size / 0.003;
    let (mass, time) = (lengths * lengths, lengths.sqrt());
    let at = |length: f64| length * lengths;
    format!(
        "Scene(format: 1, clock: (duration: {duration:?}{clock}), gravity: (0, -9.81),
            materials: {{ \"m\": (stiffness: {stiffness:?}, friction: {friction:?}, restitution: {restitution:?}) }},
            walls: [(name: \"floor\", left: ({far:?}, 0), right: (0, 0), material: \"m\")],
            bodies: [
                (name: \"plate\", at: (0, {p:?}), material: \"m\", shape: Rectangle(width: {width:?}, height: {low:?}),
                 kinematic: (path: [(time: {middle:?}, by: ({by:?}, 0)), (time: {end:?}, by: (0, 0))])),
                (name: \"a\", at: ({a:?}, {up:?}), mass: {first:?}, material: \"m\", shape: Rectangle(width: {width:?}, height: {height:?})),
                (name: \"b\", at: ({b:?}, {up:?}), mass: {second:?}, material: \"m\", shape: Rectangle(width: {width:?}, height: {height:?})),
            ])",
        duration = 0.16 * time,
        stiffness = 1.65421e6 * mass / lengths,
        far = 300.0 * size,
        p = at(0.0009),
        width = at(0.003),
        low = at(0.0012),
        middle = 0.0790283 * time,
        by = at(0.00604689),
        end = 0.158057 * time,
        a = at(0.0039),
        b = at(0.00705),
        up = at(0.00075),
        height = at(0.0015),
        first = boxes.masses.0 * mass,
        second = boxes.masses.1 * mass,
        friction = boxes.friction,
        restitution = boxes.restitution,
    )
}

/// Runs that go on behind such a moment agree with the others.
#[test]
fn boxes_that_lean_on_each_other_run_to_the_end_and_agree() {
    demand_agreement("boxes", &CLOCKS, 1, |clock| pushed(&BOXES, 0.003, clock));
}

/// Rounding decides at which moment such modes meet, so some of these runs may miss them.
#[test]
fn the_card_tells_of_contacts_that_exclude_each_other() {
    let of = |friction: f64, restitution: f64, masses: (f64, f64)| Boxes { friction, restitution, masses };
    let runs = [
        (of(0.229, 0.2, (0.0108, 0.0235)), 9e-5),
        (of(0.342, 0.5, (0.0212, 0.0213)), 9e-5),
        (of(0.176, 0.2, (0.0294, 0.0171)), 5e-5),
    ];
    let tells = |(boxes, tick): &(Boxes, f64)| {
        let clock = format!(", method: Dop853, tick: {tick:?}");
        let ran = end(&pushed(boxes, 0.003, &clock)).unwrap_or_else(|why| panic!("{why}"));
        ran.card.notes.iter().any(|note| note.contains("contacts excluded each other (once)"))
    };
    assert!(runs.iter().any(tells));
}
