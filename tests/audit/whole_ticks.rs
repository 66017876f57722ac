//! Law: a run under a tolerance states how far whole ticks lead from located events. A box whose corners rattle as it slides has too many
//! events to locate. Whole ticks of velocity Verlet agree with each other to 1e-7 m, and slip by another law than located events. Two
//! such runs agree within three times what both state. A run that locates most of its events has an error of its own, which is as
//! large and unknown: it is nearer than ten times what they state. Statements of 1e-7 m would be ten thousand times too small.
//!
//! Not tested: runs without a tolerance, whose twins are too short of located events too.

use super::ran::{end, run};

#[test]
fn whole_ticks_state_how_far_located_events_lead() {
    for (stiffness, restitution, push) in [(1e4, 0.9, 7.0), (4e4, 0.9, 6.5), (1e4, 0.85, 7.0)] {
        let scene = |clock: &str| {
            format!(
                "Scene(format: 1, clock: (duration: 2{clock}), gravity: (0, -9.81),
                    materials: {{ \"m\": (stiffness: {stiffness:?}, friction: (static: 0.5, dynamic: 0.4),
                                 restitution: {restitution:?}) }},
                    walls: [(name: \"floor\", left: (9, 0), right: (-9, 0), material: \"m\")],
                    bodies: [(name: \"b\", at: (0, 0.25), mass: 1, material: \"m\", shape: Rectangle(width: 1, height: 0.5))],
                    forces: [Drive(of: \"b\", force: ({push:?}, 0), course: Sine(frequency: 0.5))])"
            )
        };
        let stating = [", tolerance: 1e-3", ", tolerance: 1e-5"].map(|clock| run(&scene(clock), 1).unwrap());
        let located = end(&scene(", method: Dop853, tick: 0.001")).unwrap();
        let stated = |ran: &super::ran::Ran| ran.stated().expect("an error is stated").0;
        let [one, other] = &stating;
        let pairs = [
            (one.apart(other), 3.0 * (stated(one) + stated(other))),
            (one.apart(&located), 10.0 * stated(one)),
            (other.apart(&located), 10.0 * stated(other)),
        ];
        for (apart, most) in pairs {
            assert!(apart <= most, "{stiffness}, {restitution}: {apart:e} m apart, at most {most:e} allowed");
        }
    }
}
