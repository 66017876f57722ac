//! A scene inside a Bevy app, in its fixed timestep: the same bits as without the app, next to the app's own systems.
//! Failures are reported.
//!
//! Not tested: windows, and apps with threads of their own (physics stays on the thread that runs its system).

use std::time::Duration;

use bevy_app::{App, FixedUpdate, Update};
use bevy_ecs::prelude::*;
use bevy_time::{Fixed, Time, TimePlugin, TimeUpdateStrategy};
use jostle::bevy::{Pace, Physics, PhysicsPlugin, Run, timestep};
use jostle::report::Card;
use jostle::scene::Source;
use jostle::simulation::Overrides;
use jostle::tick::{State, TickAppExt};
use jostle::world::{Force, Position, hash::state_hash};
use jostle::{Simulation, SimulationExt};

const CHECKED: Pace = Pace::Checked(|world| world.resource::<Time<Fixed>>().timestep());

/// Two balls fall onto a floor and roll: contacts with history.
fn scene() -> Source {
    Source::new(
        "balls.ron",
        r#"Scene(
            format: 1,
            clock: (duration: 0.5, tick: "0.5 ms"),
            gravity: (0.3, -9.81),
            materials: { "m": (stiffness: 5000, friction: 0.4, inelasticity: 0.2) },
            walls: [(name: "floor", left: (5, 0), right: (0, 0), material: "m")],
            bodies: [
                (name: "a", at: (1, 0.3), spin: 4, material: "m", atoms: Disc(radius: 0.1)),
                (name: "b", at: (1.05, 0.55), material: "m", atoms: Disc(radius: 0.1)),
            ],
            expect: [Inside(of: "*", box: ((0, -1), (5, 2)))],
        )"#,
    )
}

/// Lowest centre that a system of the app has seen so far, and how often it looked.
#[derive(Resource)]
struct Seen {
    lowest: f64,
    looks: u64,
}

fn look(bodies: Query<&Position>, mut seen: ResMut<Seen>) {
    seen.looks += 1;
    seen.lowest = bodies.iter().map(|position| position.0.y).fold(seen.lowest, f64::min);
}

#[derive(Component)]
struct Score(u32);

fn count(mut scores: Query<&mut Score>) {
    for mut score in &mut scores {
        score.0 += 1;
    }
}

/// An app with time that advances by `steps` fixed timesteps per update.
fn app(physics: PhysicsPlugin, steps: u32) -> App {
    let mut app = App::new();
    app.add_plugins((TimePlugin, physics)).insert_resource(TimeUpdateStrategy::FixedTimesteps(steps));
    let fixed = timestep(app.world());
    if fixed > Duration::ZERO {
        app.insert_resource(Time::<Fixed>::from_duration(fixed));
    }
    app.insert_resource(Seen { lowest: f64::INFINITY, looks: 0 })
        .add_systems(Update, count)
        .add_systems(FixedUpdate, look.before(Physics));
    app.world_mut().spawn(Score(0));
    app
}

fn hash(app: &App) -> u64 {
    state_hash(app.world().resource::<State>().bodies())
}

#[test]
fn a_bevy_app_computes_the_same_bits_as_a_headless_run() {
    let mut headless = Simulation::load(&scene()).unwrap();
    headless.run_to_end().unwrap();
    for steps in [1, 7] {
        let mut app = app(PhysicsPlugin::new(scene(), CHECKED), steps);
        for _ in 0..=1000 / steps + 1 {
            app.update();
        }
        assert!(matches!(app.world().resource::<Run>(), Run::Ended), "{:?}", app.world().resource::<Run>());
        assert_eq!(app.world().resource::<State>().clock().ticks, 1000);
        assert_eq!(hash(&app), state_hash(headless.bodies()), "{steps} ticks per update");
        // The card and the expectations of the scene are there too.
        assert_eq!(Card::of(app.world(), 1.0, None).energy.residual, headless.card().energy.residual);
        // Systems of the app ran as often as the physics or more, and saw a ball press itself into the floor.
        let seen = app.world().resource::<Seen>();
        assert!(seen.looks >= 1000 && seen.lowest < 0.1, "{} {}", seen.looks, seen.lowest);
        let scores: Vec<u32> = app.world_mut().query::<&Score>().iter(app.world()).map(|score| score.0).collect();
        assert_eq!(scores, [1000 / steps + 2]);
    }
}

/// A force that is an ordinary system belongs to the physics, wherever it runs.
#[test]
fn plugins_of_the_physics_work_in_an_app() {
    fn lift(mut bodies: Query<&mut Force>) {
        for mut force in &mut bodies {
            force.0.y += 1.0;
        }
    }
    let add = |app: &mut App| {
        app.add_force(lift);
    };
    let mut headless = Simulation::load_with(&scene(), &Overrides::default(), add).unwrap();
    headless.run_to_tick(200).unwrap();
    let mut physics = PhysicsPlugin::new(scene(), CHECKED);
    physics.plugins = |app| {
        app.add_force(lift);
    };
    physics.overrides.duration = Some(0.1);
    let mut app = app(physics, 10);
    for _ in 0..=21 {
        app.update();
    }
    assert_eq!(app.world().resource::<State>().clock().ticks, 200);
    assert_eq!(hash(&app), state_hash(headless.bodies()));
}

#[test]
fn another_timestep_than_the_clocks_stops_the_run_until_it_is_mended() {
    let mut app = app(PhysicsPlugin::new(scene(), CHECKED), 1);
    app.insert_resource(Time::<Fixed>::from_hz(64.0));
    app.update();
    app.update();
    let told = app.world().resource::<Run>().trouble().unwrap();
    assert!(told.contains("0.015625 s") && told.contains("0.0005 s"), "{told}");
    assert_eq!(app.world().resource::<State>().clock().ticks, 0, "nothing may run meanwhile");
    let right = timestep(app.world());
    app.insert_resource(Time::<Fixed>::from_duration(right));
    app.update();
    app.update();
    assert!(app.world().resource::<Run>().trouble().is_none());
    assert!(app.world().resource::<State>().clock().ticks > 0);
}

#[test]
fn a_free_pace_takes_any_timestep() {
    let mut app = app(PhysicsPlugin::new(scene(), Pace::Free), 1);
    app.insert_resource(Time::<Fixed>::from_hz(64.0));
    app.update();
    app.update();
    assert!(app.world().resource::<State>().clock().ticks > 0);
}

#[test]
fn a_wrong_scene_and_a_second_one_are_refused_without_a_panic() {
    let wrong = Source::new("wrong.ron", "Scene(format: 1, clock: (duration: 1), gravty: (0, 1), bodies: [])");
    let mut app = app(PhysicsPlugin::new(wrong.clone(), Pace::Free), 1);
    app.update();
    let told = app.world().resource::<Run>().trouble().unwrap();
    assert!(told.contains("gravty") && told.contains("gravity"), "{told}");
    let mut app = App::new();
    assert!(PhysicsPlugin::new(wrong, Pace::Free).install(&mut app).is_err());

    let mut app = App::new();
    PhysicsPlugin::new(scene(), Pace::Free).install(&mut app).unwrap();
    let told = PhysicsPlugin::new(scene(), Pace::Free).install(&mut app).unwrap_err();
    assert!(told.to_string().contains("already"), "{told}");
    // As a plugin, the second one stops the first: neither is what was asked for.
    app.add_plugins((PhysicsPlugin::new(scene(), Pace::Free), PhysicsPlugin::new(scene(), Pace::Free)));
    assert!(app.world().resource::<Run>().trouble().unwrap().contains("already"));
}

#[test]
fn numbers_that_stop_being_finite_end_the_run_and_are_told() {
    let mut app = app(PhysicsPlugin::new(scene(), CHECKED), 1);
    app.update();
    app.update();
    app.add_systems(FixedUpdate, |mut bodies: Query<&mut jostle::world::Velocity>| {
        bodies.iter_mut().for_each(|mut velocity| velocity.0.x = f64::NAN);
    });
    app.update();
    app.update();
    let Run::Failed(failure) = app.world().resource::<Run>().clone() else { panic!("it should have failed") };
    assert_eq!(failure.body, "a");
    let ticks = app.world().resource::<State>().clock().ticks;
    app.update();
    assert_eq!(app.world().resource::<State>().clock().ticks, ticks, "nothing runs after a failure");
}
