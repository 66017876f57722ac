//! Pay for what you use: schedules hold the systems that the scene's sections ask for, and no others.
//!
//! Counted are systems; instructions are counted by `tools/pay_for_what_you_use`.

use bevy_ecs::schedule::{ScheduleLabel, Schedules};
use jostle::Simulation;
use jostle::scene::Source;
use jostle::tick::{Evaluate, Modes, SimTick};

/// Systems of a scene with a body that touches nobody, in the tick, in the evaluation and for the modes.
fn systems(sections: &str) -> [usize; 3] {
    let scene = format!(
        "Scene(format: 1, clock: (duration: 1, tick: 0.001), {sections}
         bodies: [(name: \"ball\", at: (0, 5), collides: false, atoms: Disc(radius: 0.1))])"
    );
    let mut simulation = Simulation::load(&Source::new("pay.ron", scene)).unwrap_or_else(|errors| panic!("{errors}"));
    // Whatever is added while running counts as well.
    simulation.run_to_tick(2).unwrap();
    let schedules = simulation.world().resource::<Schedules>();
    [SimTick.intern(), Evaluate.intern(), Modes.intern()].map(|label| schedules.get(label).unwrap().systems_len())
}

#[test]
fn a_scene_schedules_what_it_names_and_nothing_else() {
    let bare = systems("");
    for (sections, more) in [
        // What is only drawn, measured after the run, or said in words is not in the tick.
        (
            "look: (theme: \"night\", layers: [Trails(seconds: 1), ContactForces, FreeBody, Velocities, ContactPoints, Names, Boxes]),",
            [0, 0, 0],
        ),
        (
            "title: \"Words\", notes: \"More words.\", film: (fps: 25), camera: Look(center: (0, 0), height: 3),",
            [0, 0, 0],
        ),
        ("plots: [(channels: [\"energy.total\", \"ball.contacts\"])],", [0, 0, 0]),
        ("materials: { \"m\": (friction: 0.5) }, walls: [(name: \"floor\", left: (1, 0), right: (0, 0))],", [0, 0, 0]),
        ("sensors: [Pose(of: \"*\"), Velocity(of: \"*\"), Energy(), Overlap()],", [0, 0, 0]),
        ("contacts: None,", [0, 0, 0]),
        // Who asks for contacts has them found, and counted.
        ("sensors: [Contacts(of: \"ball\"), Contacts(of: \"*\")],", [2, 0, 0]),
        // One stage for all forces.
        ("gravity: (0, -9.81),", [0, 1, 0]),
        ("forces: [Drag(linear: 0.1)],", [0, 1, 0]),
        ("forces: [Drag(linear: 0.1), Drag(quadratic: 0.1)],", [0, 1, 0]),
        ("forces: [Wind(velocity: (1, 0), linear: 0.1)],", [0, 1, 0]),
        ("forces: [Torque(of: \"ball\", value: 1)],", [0, 1, 0]),
        ("forces: [Attraction(constant: 1)],", [0, 1, 0]),
        // Thrust is switched on and off before a tick.
        ("forces: [Thrust(of: \"ball\", force: (1, 0))],", [0, 1, 1]),
        ("gravity: (0, -9.81), forces: [Drag(linear: 0.1), Attraction(constant: 1)],", [0, 1, 0]),
        // All expectations are watched by one system.
        ("expect: [Inside(of: \"*\", box: ((-9, -9), (9, 9)))],", [1, 0, 0]),
        ("expect: [Channel(name: \"ball.angle\", below: 1), Channel(name: \"ball.spin\", below: 1)],", [1, 0, 0]),
        // One more for those that look at more than the state.
        ("expect: [Channel(name: \"energy.residual\", below: 1), Channel(name: \"ball.spin\", below: 1)],", [2, 0, 0]),
    ] {
        let found = systems(sections);
        let expected = [bare[0] + more[0], bare[1] + more[1], bare[2] + more[2]];
        assert_eq!(found, expected, "{sections}; a bare scene has {bare:?}");
    }
    assert_eq!(bare, [1, 0, 0], "the integrator, and nothing else");
}
