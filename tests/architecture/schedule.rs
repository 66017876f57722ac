//! The order of systems is never left to chance. With everything that a scene can name, any two systems on the same
//! data have an order.

use bevy_ecs::prelude::*;
use bevy_ecs::schedule::{LogLevel, ScheduleBuildSettings, Schedules};
use jostle::Simulation;
use jostle::scene::Source;
use jostle::tick::{Evaluate, EvaluateStage, Modes, SimTick, TickAppExt};
use jostle::world::{Force, Velocity};

const EVERYTHING: &str = r#"Scene(
    format: 1,
    clock: (duration: 1, tick: "1 ms"),
    gravity: (0, -9.81),
    materials: { "m": (friction: 0.5, inelasticity: 0.2) },
    walls: [(name: "floor", left: (5, 0), right: (0, 0), material: "m")],
    bodies: [
        (name: "a", at: (1, 1), material: "m", atoms: Disc(radius: 0.1)),
        (name: "b", at: (2, 1), material: "m", atoms: Disc(radius: 0.1)),
    ],
    forces: [
        Drag(linear: 0.1), Thrust(of: "a", force: (0, 1)), Torque(of: "a", value: 0.1), Attraction(constant: 0.1),
    ],
    sensors: [Energy(), ContactForce(on: "floor"), Pose(of: "*"), Velocity(of: "*"), Overlap()],
    expect: [Inside(of: "*", box: ((-9, -9), (9, 9))), Channel(name: "energy.residual", below: 1)],
)"#;

/// An ordinary force: the engine then keeps components up to date around it.
fn breeze(mut bodies: Query<(&Velocity, &mut Force)>) {
    for (velocity, mut force) in &mut bodies {
        force.0 -= velocity.0;
    }
}

fn strict(simulation: &mut Simulation) {
    let mut schedules = simulation.world_mut().resource_mut::<Schedules>();
    let strict = ScheduleBuildSettings { ambiguity_detection: LogLevel::Error, ..Default::default() };
    schedules.get_mut(SimTick).unwrap().set_build_settings(strict.clone());
    schedules.get_mut(Evaluate).unwrap().set_build_settings(strict.clone());
    schedules.get_mut(Modes).unwrap().set_build_settings(strict);
}

#[test]
fn packed_systems_are_in_order() {
    let mut simulation = Simulation::load(&Source::new("everything.ron", EVERYTHING)).unwrap();
    strict(&mut simulation);
    simulation.run_to_tick(10).unwrap();
}

#[test]
fn ordinary_forces_are_in_order() {
    let source = Source::new("everything.ron", EVERYTHING);
    let mut simulation = Simulation::load_with(&source, &Default::default(), |app| {
        app.add_force(breeze).add_force(breeze);
    })
    .unwrap();
    strict(&mut simulation);
    simulation.run_to_tick(10).unwrap();
}

/// The check above must be able to fail: two systems put into a stage without an order are found.
#[test]
#[should_panic(expected = "mbigu")]
fn systems_without_an_order_are_found() {
    let source = Source::new("everything.ron", EVERYTHING);
    let mut simulation = Simulation::load_with(&source, &Default::default(), |app| {
        app.add_systems(Evaluate, (breeze.in_set(EvaluateStage::Forces), breeze.in_set(EvaluateStage::Forces)));
    })
    .unwrap();
    strict(&mut simulation);
    simulation.run_to_tick(10).unwrap();
}
