//! A plugin that replaces a system by another one gets the expected result.
//!
//! Law: a drag of 0.5 kg/s on 1 kg lets a body that falls from rest reach `v = -g/c (1 - e^(-c t))`; without it, and with a
//! push of 2 N upwards in its place, `v = (2 - g) t`. Tolerance: velocity Verlet is of second order under drag, exact without.

use bevy_app::App;
use bevy_ecs::prelude::*;
use bevy_ecs::schedule::ScheduleCleanupPolicy;
use glam::DVec2;
use jostle::Simulation;
use jostle::scene::Source;
use jostle::simulation::Overrides;
use jostle::tick::{Evaluate, EvaluateStage, SimTick, Stage, State, TickAppExt, stages};
use jostle::world::Velocity;

const SCENE: &str = "Scene(format: 1, clock: (duration: 1, tick: 0.001, method: VelocityVerlet), gravity: (0, -9.81),
    forces: [Drag(linear: 0.5)],
    bodies: [(name: \"b\", at: (0, 0), atoms: Disc(radius: 0.1, mass: 1))])";

#[derive(Resource, Default)]
struct Runs(u64);

/// A world without drag, once `change` has made it another one.
fn without_drag(change: impl Fn(&mut App) + Send + Sync + 'static) -> Simulation {
    let source = Source::new("replaced.ron", SCENE);
    let mut simulation = Simulation::load_with(&source, &Overrides::default(), move |app| {
        app.init_resource::<Runs>();
        change(app);
    })
    .unwrap();
    let gone = simulation.world_mut().resource_mut::<State>().retain_models(|model| !model.name().contains("Drag"));
    assert_eq!(gone, 1);
    simulation
}

fn push_up(mut state: ResMut<State>, mut runs: ResMut<Runs>) {
    runs.0 += 1;
    state.bodies_mut().push(0, DVec2::ZERO, DVec2::new(0.0, 2.0));
}

#[test]
fn a_force_in_the_place_of_another_acts_in_its_place() {
    let mut simulation = without_drag(|_| {});
    simulation.world_mut().schedule_scope(Evaluate, |_, schedule| {
        schedule.add_systems(push_up.in_set(EvaluateStage::Systems));
    });
    simulation.run_to_end().unwrap();
    let speed = simulation.bodies().velocity[0].y;
    assert!((speed - (2.0 - 9.81)).abs() < 1e-9, "{speed} m/s");
    assert!(simulation.world_mut().resource::<Runs>().0 >= 1000);
}

/// Likewise one that is registered as working on the state only.
#[test]
fn a_packed_system_in_evaluations_acts() {
    let mut simulation = without_drag(|app| {
        app.add_packed_systems(Evaluate, push_up.in_set(EvaluateStage::Systems));
    });
    simulation.run_to_end().unwrap();
    let speed = simulation.bodies().velocity[0].y;
    assert!((speed - (2.0 - 9.81)).abs() < 1e-9, "{speed} m/s");
}

#[test]
fn a_system_that_is_taken_out_acts_no_more_whatever_else_is_there() {
    fn count(mut runs: ResMut<Runs>) {
        runs.0 += 1;
    }
    let mut simulation = without_drag(|app| {
        app.add_packed_systems(SimTick, count.in_set(Stage::Observe));
    });
    simulation.run_to_end().unwrap();
    let speed = simulation.bodies().velocity[0].y;
    assert!((speed + 9.81).abs() < 1e-9, "{speed} m/s");
    assert_eq!(simulation.world_mut().resource::<Runs>().0, 1000);
}

/// A system that reads components counts as one, though as many of the engine's systems are gone.
#[test]
fn components_are_kept_current_for_a_system_that_came_for_another() {
    #[derive(Resource, Default)]
    struct Fastest(f64);
    fn look(bodies: Query<&Velocity>, mut fastest: ResMut<Fastest>) {
        fastest.0 = bodies.iter().map(|velocity| velocity.0.length()).fold(fastest.0, f64::max);
    }
    let mut simulation = without_drag(|app| {
        app.init_resource::<Fastest>().add_systems(SimTick, look.in_set(Stage::Observe));
    });
    simulation.run_to_end().unwrap();
    let fastest = simulation.world_mut().resource::<Fastest>().0;
    assert!((fastest - 9.81).abs() < 1e-9, "{fastest} m/s");
}

/// Without the stage that sums forces there is none, not even the drag; the weight is where sums begin.
#[test]
fn a_stage_that_is_taken_out_is_not_run() {
    let source = Source::new("replaced.ron", SCENE);
    let mut simulation = Simulation::load_with(&source, &Overrides::default(), |_| {}).unwrap();
    simulation.run_to_tick(1).unwrap();
    simulation.world_mut().schedule_scope(Evaluate, |world, schedule| {
        let policy = ScheduleCleanupPolicy::RemoveSystemsOnly;
        schedule.remove_systems_in_set(stages::apply_forces, world, policy).unwrap();
    });
    simulation.run_to_end().unwrap();
    let speed = simulation.bodies().velocity[0].y;
    assert!((speed + 9.81).abs() < 1e-4, "{speed} m/s");
}
