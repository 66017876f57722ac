//! Law: the stated error of a loose tolerance holds as that of a tight one does. Under loose tolerances the errors of two runs with
//! events may be alike by chance, so that both agree to far less than they are wrong.

use super::ran::demand_agreement;

const CLOCKS: [&str; 6] = [
    ", tolerance: 0.1",
    ", tolerance: 0.03",
    ", tolerance: 0.01",
    ", tolerance: 0.003",
    ", tolerance: 0.001",
    ", tolerance: 1e-6",
];

/// A disc on the floor. A force that swings lifts it, drops it and presses it down again.
struct Lifted {
    radius: f64,
    mass: f64,
    stiffness: f64,
    restitution: f64,
    force: f64,
    frequency: f64,
    duration: f64,
}

const LIFTED: [Lifted; 4] = [
    Lifted {
        radius: 0.495263,
        mass: 521.647,
        stiffness: 6.0623e7,
        restitution: 0.488731,
        force: 9339.02,
        frequency: 1.61547,
        duration: 2.25138,
    },
    Lifted {
        radius: 2.0,
        mass: 51135.8,
        stiffness: 1.48685e9,
        restitution: 0.6,
        force: 959040.184,
        frequency: 0.368003674,
        duration: 7.0,
    },
    Lifted { radius: 0.1, mass: 5.0, stiffness: 3e6, restitution: 0.5, force: 90.0, frequency: 2.7, duration: 1.3 },
    Lifted { radius: 0.03, mass: 0.4, stiffness: 5e5, restitution: 0.7, force: 6.2, frequency: 4.1, duration: 0.9 },
];

#[test]
fn a_disc_that_a_force_lifts_and_drops_lands_where_loose_tolerances_say() {
    for (number, disc) in LIFTED.iter().enumerate() {
        let scene = |clock: &str| {
            let Lifted { radius, mass, stiffness, restitution, force, frequency, duration } = disc;
            format!(
                "Scene(format: 1, clock: (duration: {duration:?}{clock}), gravity: (0, -9.81),
                    materials: {{ \"m\": (stiffness: {stiffness:?}, friction: 0.3, restitution: {restitution:?}) }},
                    walls: [(name: \"floor\", left: (1, 0), right: (0, 0), material: \"m\")],
                    bodies: [(name: \"b\", at: (0, {radius:?}), mass: {mass:?}, material: \"m\", shape: Disc(radius: {radius:?}))],
                    forces: [Drive(of: \"b\", force: (0, {force:?}), course: Sine(frequency: {frequency:?}))])"
            )
        };
        demand_agreement(&format!("disc {number}"), &CLOCKS, 5, scene);
    }
}
