//! A scene inside a Bevy app, in its fixed timestep: the same bits as without the app, next to the app's own systems.
//! Failures are reported.
//!
//! Not tested: windows, and apps with threads of their own (physics stays on the thread that runs its system).

use std::time::Duration;

use bevy_app::{App, FixedUpdate, Update};
use bevy_ecs::prelude::*;
use bevy_time::{Fixed, Time, TimePlugin, TimeUpdateStrategy};
use bevy_transform::components::Transform;
use glam::DVec2;
use jostle::bevy::{Pace, Physics, PhysicsPlugin, RunStatus, SyncTransforms, timestep};
use jostle::report::Card;
use jostle::scene::Source;
use jostle::simulation::Overrides;
use jostle::tick::{State, TickAppExt};
use jostle::world::{Atom, Force, MaterialIndex, Name, NewBody, Position, Rotation, hash::state_hash};
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
        assert!(
            matches!(app.world().resource::<RunStatus>(), RunStatus::Ended),
            "{:?}",
            app.world().resource::<RunStatus>()
        );
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
    let told = app.world().resource::<RunStatus>().trouble().unwrap();
    assert!(told.contains("0.015625 s") && told.contains("0.0005 s"), "{told}");
    assert_eq!(app.world().resource::<State>().clock().ticks, 0, "nothing may run meanwhile");
    let right = timestep(app.world());
    app.insert_resource(Time::<Fixed>::from_duration(right));
    app.update();
    app.update();
    assert!(app.world().resource::<RunStatus>().trouble().is_none());
    assert!(app.world().resource::<State>().clock().ticks > 0);
}

const SAME_CLOCK: Pace = Pace::SameClock(|world| world.resource::<Time<Fixed>>().timestep());

/// An app whose fixed timestep is its own.
fn game(physics: PhysicsPlugin, timestep: Duration) -> App {
    let mut app = app(physics, 1);
    app.insert_resource(Time::<Fixed>::from_duration(timestep));
    app
}

/// How long game and physics have run. The first update of an app takes no time.
fn clocks(app: &App) -> (f64, f64) {
    (app.world().resource::<Time<Fixed>>().elapsed_secs_f64(), app.world().resource::<State>().clock().time())
}

/// Law: n timesteps of the game are n times as many ticks. Rounding: that of the two times, a few parts in 2^52 each.
#[test]
fn game_and_physics_keep_one_clock_over_many_timesteps() {
    let mut physics = PhysicsPlugin::new(scene(), SAME_CLOCK);
    (physics.overrides.tick, physics.overrides.duration) = (Some(1.0 / 640.0), Some(1e4));
    let mut app = game(physics, Duration::from_micros(15_625));
    for _ in 0..=20_000 {
        app.update();
    }
    let (game, physics) = clocks(&app);
    assert_eq!(game, 20_000.0 / 64.0);
    assert!((game - physics).abs() <= 4.0 * f64::EPSILON * game, "{game} {physics}");
}

/// Law: where ticks do not divide the timestep the physics is behind by less than a tick; the bits are those of a headless run.
#[test]
fn ticks_that_do_not_divide_the_timestep_stay_near_the_game() {
    let mut headless = Simulation::load(&scene()).unwrap();
    headless.run_to_end().unwrap();
    let mut app = game(PhysicsPlugin::new(scene(), SAME_CLOCK), Duration::from_micros(15_625));
    for _ in 0..32 {
        app.update();
        let (game, physics) = clocks(&app);
        assert!(physics <= game + 1e-12 && game - physics < 0.0005, "{game} {physics}");
    }
    app.update();
    assert!(
        matches!(app.world().resource::<RunStatus>(), RunStatus::Ended),
        "{:?}",
        app.world().resource::<RunStatus>()
    );
    assert_eq!(hash(&app), state_hash(headless.bodies()));
}

/// A timestep shorter than a tick runs none until one is due.
#[test]
fn a_timestep_shorter_than_a_tick_waits_for_it() {
    let mut physics = PhysicsPlugin::new(scene(), SAME_CLOCK);
    physics.overrides.tick = Some(0.01);
    let mut app = game(physics, Duration::from_millis(4));
    let ticks: Vec<u64> = (0..=5)
        .map(|_| {
            app.update();
            app.world().resource::<State>().clock().ticks
        })
        .collect();
    assert_eq!(ticks, [0, 0, 0, 1, 1, 2]);
}

/// Each body has a `Transform` from the beginning, one that is spawned later too; its z and scale stay the app's.
#[test]
fn transforms_follow_bodies() {
    let mut app = game(PhysicsPlugin::new(scene(), SAME_CLOCK), Duration::from_micros(15_625));
    app.add_plugins(SyncTransforms { units_per_meter: 100.0 });
    app.update();
    for mut transform in app.world_mut().query::<&mut Transform>().iter_mut(app.world_mut()) {
        transform.translation.z = 7.0;
    }
    let atom =
        Atom { offset: DVec2::ZERO, radius: 0.1, mass: 1.0, stiffness: 5000.0, material: MaterialIndex::default() };
    let late = NewBody { name: "late".into(), mass: 1.0, inertia: 0.005, atoms: vec![atom], ..NewBody::default() };
    late.spawn(app.world_mut());
    for _ in 0..10 {
        app.update();
    }
    let mut bodies = app.world_mut().query::<(&Name, &Position, &Rotation, &Transform)>();
    let mut seen = 0;
    for (name, position, rotation, transform) in bodies.iter(app.world()) {
        seen += 1;
        let place = (position.0 * 100.0).as_vec2();
        assert_eq!([transform.translation.x, transform.translation.y], [place.x, place.y]);
        assert_eq!(transform.translation.z, if *name == *"late" { 0.0 } else { 7.0 }, "{name}");
        // A turn by an angle about z, in the digits of an `f32`.
        let half = (0.5 * rotation.0) as f32;
        assert!((transform.rotation.z - half.sin()).abs() < 1e-6 && transform.rotation.w > 0.0, "{name}");
    }
    assert_eq!(seen, 3);
}

/// The example ends well: it runs as it is shipped.
#[path = "../../examples/bevy_headless.rs"]
mod example;

#[test]
fn the_example_throws_a_ball_in_mid_run() {
    example::main().unwrap();
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
    let told = app.world().resource::<RunStatus>().trouble().unwrap();
    assert!(told.contains("gravty") && told.contains("gravity"), "{told}");
    let mut app = App::new();
    assert!(PhysicsPlugin::new(wrong, Pace::Free).install(&mut app).is_err());

    let mut app = App::new();
    PhysicsPlugin::new(scene(), Pace::Free).install(&mut app).unwrap();
    let told = PhysicsPlugin::new(scene(), Pace::Free).install(&mut app).unwrap_err();
    assert!(told.to_string().contains("already"), "{told}");
    // As a plugin, the second one stops the first: neither is what was asked for.
    app.add_plugins((PhysicsPlugin::new(scene(), Pace::Free), PhysicsPlugin::new(scene(), Pace::Free)));
    assert!(app.world().resource::<RunStatus>().trouble().unwrap().contains("already"));
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
    let RunStatus::Failed(failure) = app.world().resource::<RunStatus>().clone() else {
        panic!("it should have failed")
    };
    assert_eq!(failure.body, "a");
    let ticks = app.world().resource::<State>().clock().ticks;
    app.update();
    assert_eq!(app.world().resource::<State>().clock().ticks, ticks, "nothing runs after a failure");
}
