//! A Bevy app without a window, whose game and physics keep one clock: ten ticks of the physics in each fixed timestep of the
//! game. A system of the game throws a ball in mid-run, and `Transform`s follow the bodies, as sprites would.
//!
//! `cargo run --example bevy_headless`
//!
//! A game with a window has `DefaultPlugins` of the crate `bevy` in place of the two plugins below; the rest is the same.

use std::error::Error;
use std::time::Duration;

use bevy_app::{App, AppExit, FixedUpdate, ScheduleRunnerPlugin, Update};
use bevy_ecs::prelude::*;
use bevy_time::{Fixed, Time, TimePlugin, TimeUpdateStrategy};
use bevy_transform::components::Transform;
use glam::DVec2;
use jostle::bevy::{Pace, PhysicsPlugin, RunStatus, SyncTransforms};
use jostle::scene::Source;
use jostle::tick::State;
use jostle::world::{Atom, MaterialIndex, Name, NewBody};

const SCENE: &str = r#"Scene(
    format: 1,
    clock: (duration: 4, tick: "1.5625 ms", method: VelocityVerlet),
    gravity: (0, -9.81),
    walls: [(name: "floor", left: (1, 0), right: (0, 0))],
    bodies: [(name: "crate", at: (0, 0.2), mass: 5, shape: Rectangle(width: 0.4, height: 0.4))],
)"#;

/// Pixels of the game for each metre of the scene.
const PIXELS: f64 = 100.0;

/// Throws a ball at the crate after a second of the game.
fn throw(world: &mut World, mut thrown: Local<bool>) {
    if *thrown || world.resource::<Time<Fixed>>().elapsed_secs_f64() < 1.0 {
        return;
    }
    *thrown = true;
    let atom = Atom { offset: DVec2::ZERO, radius: 0.1, mass: 1.0, stiffness: 1e5, material: MaterialIndex::default() };
    let ball = NewBody {
        name: "ball".into(),
        position: DVec2::new(-3.0, 0.5),
        velocity: DVec2::new(4.0, 3.0),
        mass: 1.0,
        inertia: 0.005,
        atoms: vec![atom],
        ..NewBody::default()
    };
    ball.spawn(world);
}

/// Ends the app with the scene, or when the scene cannot go on.
fn leave(run: Res<RunStatus>, mut exit: MessageWriter<AppExit>) {
    match run.trouble() {
        Some(trouble) => {
            eprintln!("{trouble}");
            exit.write(AppExit::error());
        }
        None if matches!(*run, RunStatus::Ended) => _ = exit.write(AppExit::Success),
        None => (),
    }
}

fn tell(bodies: Query<(&Name, &Transform)>, game: Res<Time<Fixed>>, state: Res<State>, mut next: Local<f64>) {
    if game.elapsed_secs_f64() < *next {
        return;
    }
    *next += 0.5;
    println!("game {:.3} s, physics {:.3} s", game.elapsed_secs_f64(), state.clock().time());
    for (name, transform) in &bodies {
        let (x, y) = (transform.translation.x, transform.translation.y);
        println!("  {name}: {x:.0}, {y:.0} pixels");
    }
}

/// Runs the app.
pub fn main() -> Result<(), Box<dyn Error>> {
    let mut app = App::new();
    app.add_plugins((TimePlugin, ScheduleRunnerPlugin::run_loop(Duration::ZERO)));
    // A film of the game takes 60 pictures a second, however long each takes to make.
    app.insert_resource(TimeUpdateStrategy::ManualDuration(Duration::from_secs_f64(1.0 / 60.0)));
    app.insert_resource(Time::<Fixed>::from_hz(64.0));

    let pace = Pace::SameClock(|world| world.resource::<Time<Fixed>>().timestep());
    PhysicsPlugin::new(Source::new("game.ron", SCENE), pace).install(&mut app)?;
    app.add_plugins(SyncTransforms { units_per_meter: PIXELS });
    app.add_systems(FixedUpdate, throw).add_systems(Update, (tell, leave));
    match app.run() {
        AppExit::Success => Ok(()),
        AppExit::Error(_) => Err("the scene did not come to its end".into()),
    }
}
