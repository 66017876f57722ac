//! Law: a run states how far whole ticks lead from located events, by default and under a tolerance. A box whose corners rattle as it
//! slides has some ticks with too many events to locate. Whole ticks of velocity Verlet agree with each other to 1e-7 m, and slip by
//! another law than located events. Two such runs agree within three times what both state. A run that locates most of its events has
//! an error of its own, which is as large and unknown: it is nearer than ten times what they state. Statements of 1e-7 m would be ten
//! thousand times too small.

use super::ran::{end, run};

#[test]
fn whole_ticks_state_how_far_located_events_lead() {
    let boxes =
        [(1e4, 0.9, 7.0, 0.5), (4e4, 0.9, 6.5, 0.5), (1e4, 0.85, 7.0, 0.5), (1e4, 0.9, 7.0, 0.4), (2e4, 0.9, 7.5, 0.4)];
    for (stiffness, restitution, push, sticks) in boxes {
        let scene = |clock: &str| {
            format!(
                "Scene(format: 1, clock: (duration: 3{clock}), gravity: (0, -9.81),
                    materials: {{ \"m\": (stiffness: {stiffness:?}, friction: (static: {sticks:?}, dynamic: 0.4),
                                 restitution: {restitution:?}) }},
                    walls: [(name: \"floor\", left: (9, 0), right: (-9, 0), material: \"m\")],
                    bodies: [(name: \"b\", at: (0, 0.25), mass: 1, material: \"m\", shape: Rectangle(width: 1, height: 0.5))],
                    forces: [Drive(of: \"b\", force: ({push:?}, 0), course: Sine(frequency: 0.5))])"
            )
        };
        let runs = ["", ", tolerance: 1e-3", ", tolerance: 1e-5"].map(|clock| run(&scene(clock), 1).unwrap());
        // A run may also say that its error is not known.
        let stating: Vec<_> = runs.iter().filter(|ran| ran.stated().is_some()).collect();
        assert!(stating.len() >= 2, "{stiffness}, {restitution}: only {} runs state an error", stating.len());
        let located = end(&scene(", method: Dop853, tick: 0.001")).unwrap();
        let stated = |ran: &super::ran::Ran| ran.stated().expect("an error is stated").0;
        let check = |apart: f64, most: f64| {
            assert!(apart <= most, "{stiffness}, {restitution}: {apart:e} m apart, at most {most:e} allowed");
        };
        for (number, one) in stating.iter().enumerate() {
            stating[..number].iter().for_each(|other| check(one.apart(other), 3.0 * (stated(one) + stated(other))));
            check(one.apart(&located), 10.0 * stated(one));
        }
    }
}
