//! Spawning and despawning in mid-run by an ordinary system of a plugin: it works, and unrelated bodies keep their
//! bits. Contacts keep their history (elongation of tangential springs, sticking or slipping) when indices in the
//! packed state change.

use bevy_ecs::prelude::*;
use jostle::SimulationExt;
use jostle::tick::{SimTick, Stage, State};
use jostle::world::{Body, Position};

use super::{clumps, load, new_clump, run, scene, states};

const TICKS: u64 = 4000;

/// A body that touches nobody, far beyond the right wall, before all others in canonical order or behind them.
fn with_hermit(first: bool) -> String {
    let hermit = "(name: \"hermit\", at: (0, 300), material: \"wood\", atoms: Disc(radius: 0.05, mass: 0.1)),";
    let bodies = if first { format!("{hermit}{}", clumps()) } else { format!("{}{hermit}", clumps()) };
    scene("VelocityVerlet", "", &bodies)
}

fn nothing(_: Query<&Body>) {}

/// When whatever is higher than 100 m goes.
#[derive(Resource)]
struct Farewell(u64);

fn despawn_high(
    state: Res<State>,
    farewell: Res<Farewell>,
    bodies: Query<(Entity, &Position)>,
    mut commands: Commands,
) {
    if state.clock().ticks == farewell.0 {
        for (body, position) in &bodies {
            if position.0.y > 100.0 {
                commands.entity(body).despawn();
            }
        }
    }
}

fn without(simulation: &jostle::Simulation, name: &str) -> Vec<super::State> {
    let bodies = simulation.bodies();
    let kept = (0..bodies.len()).filter(|&body| simulation.name(body) != name);
    let states = states(simulation);
    kept.map(|body| states[body].1).collect()
}

#[test]
fn nobody_notices_that_a_far_away_body_goes() {
    for first in [true, false] {
        let text = with_hermit(first);
        let mut stays = load(&text, |app| {
            app.add_systems(SimTick, nothing.in_set(Stage::Begin));
        });
        run(&mut stays, TICKS);
        assert_eq!(stays.bodies().len(), 13);
        for tick in [0, 1000, 2000, TICKS - 1] {
            let mut goes = load(&text, move |app| {
                app.insert_resource(Farewell(tick)).add_systems(SimTick, despawn_high.in_set(Stage::Begin));
            });
            run(&mut goes, TICKS);
            assert_eq!(goes.bodies().len(), 12, "it should be gone");
            let same = without(&stays, "hermit") == without(&goes, "hermit");
            assert!(same, "hermit first: {first}, gone at tick {tick}: the others noticed");
        }
    }
}

/// When a clump comes, and with which number.
#[derive(Resource)]
struct Arrival(u64);

fn spawn_far_away(world: &mut World) {
    if world.resource::<State>().clock().ticks == world.resource::<Arrival>().0 {
        let mut body = new_clump(world, 1);
        body.name = "hermit".into();
        body.position.y = 300.0;
        body.spawn(world);
    }
}

#[test]
fn nobody_notices_that_a_far_away_body_comes() {
    let text = scene("VelocityVerlet", "", &clumps());
    let mut alone = load(&text, |app| {
        app.add_systems(SimTick, nothing.in_set(Stage::Begin));
    });
    run(&mut alone, TICKS);
    for tick in [0, 1000, TICKS - 1] {
        let mut joined = load(&text, move |app| {
            app.insert_resource(Arrival(tick)).add_systems(SimTick, spawn_far_away.in_set(Stage::Begin));
        });
        run(&mut joined, TICKS);
        assert_eq!(joined.bodies().len(), 13, "it should be there");
        assert!(without(&alone, "hermit") == without(&joined, "hermit"), "came at tick {tick}: the others noticed");
    }
}

/// One that comes between the others and goes again is felt while it is there, and moves like any other.
#[test]
fn who_comes_in_mid_run_falls_and_collides() {
    let text = scene("VelocityVerlet", "", &clumps());
    let spawn_above = |world: &mut World| {
        if world.resource::<State>().clock().ticks == 1000 {
            let mut body = new_clump(world, 0);
            body.name = "guest".into();
            body.position = glam::DVec2::new(1.0, 1.8);
            body.spawn(world);
        }
    };
    let mut simulation = load(&text, move |app| {
        app.add_systems(SimTick, spawn_above.in_set(Stage::Begin));
    });
    let mut alone = load(&text, |_| {});
    run(&mut simulation, 8000);
    run(&mut alone, 8000);
    let guest = simulation.bodies().len() - 1;
    assert_eq!(simulation.name(guest), "guest");
    let height = simulation.bodies().position[guest].y;
    assert!((0.0..1.0).contains(&height), "it should have fallen onto the pile or the floor: {height}");
    assert!(without(&simulation, "guest") != without(&alone, ""), "the others should have felt it");
    // What it brought is booked: momentum is accounted for to rounding, 1e-12 of weight times time per 1000 ticks.
    let card = simulation.card();
    let allowed = 8.0 * 1e-12 * 13.0 * 0.08 * 9.81 * 4.0;
    let [x, y] = card.momentum_residual;
    assert!(x.hypot(y) <= allowed, "{x:e} {y:e} {allowed:e}");
}
