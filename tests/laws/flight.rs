//! Law: a free body moves along a parabola, `x + v t + g t²/2`, and turns uniformly (Galilei; Newton's first and second
//! laws). So its motion need not be computed tick by tick. Neither that choice, nor readers, nor the batches of a run
//! change anything.
//!
//! Tolerances: rounding, `u = 2^-53`. A place is rounded when it is given in the scene and once more at its end, each by `u` of
//! its size, the way between by a few `u` of itself. A collision makes what rounding left larger by some `1 + 2 l / r` (a disc of
//! radius `r` that is hit after a flight of `l`), here by less than 50. What is seen of a run changes nothing: no tolerance.
//!
//! Not tested: bodies of several discs, which do not fly.

use glam::DVec2;
use jostle::scene::Source;
use jostle::simulation::Overrides;
use jostle::tick::{SimTick, Stage, State, TickAppExt, largest_travel};
use jostle::world::hash::state_hash;
use jostle::world::{Atom, Bodies, MaterialIndex, NewBody};
use jostle::{Simulation, SimulationExt};

use bevy_app::App;
use bevy_ecs::prelude::*;

use super::support::{load, phases};

const GRAVITY: DVec2 = DVec2::new(0.3, -2.0);

/// Discs of two sizes in rows and columns 1 m apart, each with a velocity of its own up to `speed` along each axis.
fn cloud(columns: usize, rows: usize, speed: f64, rest: &str) -> String {
    let mut parts = phases((columns * rows) as u32 * 3);
    let mut part = || 2.0 * parts.next().unwrap() - 1.0;
    let disc = |number: usize| {
        let (u, v, spin) = (speed * part(), speed * part(), 3.0 * part());
        let (x, y, radius) = (number % columns, number / columns, if number.is_multiple_of(3) { 0.1 } else { 0.15 });
        format!(
            "(name: \"disc {number}\", at: ({x}, {y}), velocity: ({u}, {v}), spin: {spin}, material: \"stone\", \
             atoms: Disc(radius: {radius})),"
        )
    };
    let discs: String = (0..columns * rows).map(disc).collect();
    format!(
        "Scene(format: 1, gravity: ({}, {}), {rest}
        materials: {{ \"stone\": (stiffness: 20000, friction: 0.3, restitution: 0.8, density: 10) }},
        bodies: [{discs}])",
        GRAVITY.x, GRAVITY.y
    )
}

const CLOCK: &str = "clock: (duration: 1, tick: 0.001, method: VelocityVerlet),";

fn load_with(text: &str, plugins: impl Fn(&mut App) + Send + Sync + 'static) -> Simulation {
    let simulation = Simulation::load_with(&Source::new("cloud.ron", text), &Overrides::default(), plugins);
    simulation.unwrap_or_else(|errors| panic!("{errors}"))
}

/// With a force that others bring, and that does nothing, no body flies.
fn load_bound(text: &str) -> Simulation {
    fn nothing(_: Query<&jostle::world::Force>) {}
    load_with(text, |app| {
        app.add_force(nothing);
    })
}

/// The state before and the ways that discs should have made since, in place and angle.
fn parabola(before: &Bodies, body: usize, gravity: DVec2, time: f64) -> (DVec2, f64, DVec2) {
    let position = before.position[body] + before.velocity[body] * time + gravity * (0.5 * time * time);
    (position, before.angle[body] + before.spin[body] * time, before.velocity[body] + gravity * time)
}

fn demand_parabolas(begin: &Simulation, end: &Simulation, gravity: DVec2, time: f64) {
    let (begin, end) = (begin.bodies(), end.bodies());
    for body in 0..begin.len() {
        let (position, angle, velocity) = parabola(begin, body, gravity, time);
        // Places and ways are below 32 m, angles and velocities below 8: eight roundings each.
        let far = (end.position[body] - position).abs().max_element() > 8.0 * 32.0 * f64::EPSILON;
        assert!(!far, "disc {body}: {} and not {position}", end.position[body]);
        let turned = (end.angle[body] - angle).abs() > 8.0 * 8.0 * f64::EPSILON;
        assert!(!turned, "disc {body}: {} and not {angle}", end.angle[body]);
        // Two kicks in each tick round, each by half a unit of the last place; the flight itself does not.
        let fast = (end.velocity[body] - velocity).abs().max_element() > 8.0 * 8.0 * f64::EPSILON;
        assert!(!fast, "disc {body}: {} and not {velocity}", end.velocity[body]);
    }
}

#[test]
fn what_nothing_touches_moves_along_a_parabola() {
    let text = cloud(20, 10, 0.2, CLOCK);
    let begin = load(&text);
    let mut end = load(&text);
    end.run_to_tick(1000).unwrap();
    assert_eq!(end.bodies().flying(), 200);
    demand_parabolas(&begin, &end, GRAVITY, 1.0);
}

/// Half way gravity turns round.
#[test]
fn whoever_changes_gravity_changes_all_flights() {
    fn turn(mut state: ResMut<State>) {
        if state.clock().ticks == 500 {
            assert!(state.set_gravity(-GRAVITY));
        }
    }
    let text = cloud(20, 10, 0.2, CLOCK);
    let begin = load(&text);
    let mut end = load_with(&text, |app| {
        app.add_systems(SimTick, turn.in_set(Stage::Begin));
    });
    end.run_to_tick(1000).unwrap();
    // What the field gives the bodies as it turns is work: rounding of sums over 200 bodies.
    let card = end.card();
    assert!(card.energy_error() < 1e-10, "{card}");
    let (before, after) = (begin.bodies(), end.bodies());
    assert_eq!(after.flying(), 200);
    for body in 0..before.len() {
        let (place, _, velocity) = parabola(before, body, GRAVITY, 0.5);
        let place = place + velocity * 0.5 - GRAVITY * (0.5 * 0.5 * 0.5);
        let far = (after.position[body] - place).abs().max_element() > 16.0 * 32.0 * f64::EPSILON;
        assert!(!far, "disc {body}: {} and not {place}", after.position[body]);
    }
}

/// A packed system that pushes all bodies once: to them it is as if they had been thrown anew.
#[test]
fn what_others_write_into_the_packed_state_counts() {
    fn throw(mut state: ResMut<State>) {
        if state.clock().ticks == 500 {
            state.bodies_mut().velocity.iter_mut().for_each(|velocity| velocity.x += 1.0);
        }
    }
    let text = cloud(20, 10, 0.2, CLOCK);
    let begin = load(&text);
    let mut end = load_with(&text, |app| {
        app.add_packed_systems(SimTick, throw.in_set(Stage::Begin));
    });
    end.run_to_tick(1000).unwrap();
    for body in 0..200 {
        let (position, ..) = parabola(begin.bodies(), body, GRAVITY, 1.0);
        let position = position + DVec2::X * 0.5;
        let far = (end.bodies().position[body] - position).abs().max_element() > 500.0 * 32.0 * f64::EPSILON;
        assert!(!far, "disc {body}: {} and not {position}", end.bodies().position[body]);
    }
}

/// Likewise one that does so at the end of each tick: in how many pieces the run is made does not matter.
#[test]
fn what_others_write_at_the_end_of_a_tick_counts_in_every_tick() {
    fn blow(mut state: ResMut<State>) {
        state.bodies_mut().velocity.iter_mut().for_each(|velocity| velocity.x += 0.001);
    }
    let text = cloud(20, 10, 0.2, CLOCK);
    let run = |pieces: u64| {
        let mut simulation = load_with(&text, |app| {
            app.add_packed_systems(SimTick, blow.in_set(Stage::Observe));
        });
        let before: Vec<f64> = simulation.bodies().velocity.iter().map(|velocity| velocity.x).collect();
        for piece in 1..=pieces {
            simulation.run_to_tick(600 * piece / pieces).unwrap();
        }
        // Sums of 1200 numbers below 2 m/s.
        let expected = |body: usize| before[body] + 0.6 + GRAVITY.x * 0.6;
        for (body, velocity) in simulation.bodies().velocity.iter().enumerate() {
            assert!((velocity.x - expected(body)).abs() < 1200.0 * 2.0 * f64::EPSILON, "disc {body}: {velocity}");
        }
        state_hash(simulation.bodies())
    };
    assert_eq!(run(1), run(600));
}

/// Where a body of two discs comes in the middle of a batch of ticks, all bodies are moved tick by tick from then on.
#[test]
fn flights_end_where_a_clump_comes() {
    fn come(world: &mut World) {
        if world.resource::<State>().clock().ticks == 500 {
            let atom = |x: f64| Atom {
                offset: DVec2::new(x, 0.0),
                radius: 0.1,
                mass: 0.5,
                stiffness: 2e4,
                material: MaterialIndex::default(),
            };
            let (position, atoms) = (DVec2::new(0.0, 40.0), vec![atom(-0.1), atom(0.1)]);
            NewBody { position, mass: 1.0, inertia: 0.1, atoms, ..NewBody::default() }.spawn(world);
        }
    }
    let text = cloud(20, 10, 0.2, CLOCK);
    let begin = load(&text);
    let mut end = load_with(&text, |app| {
        app.add_systems(SimTick, come.in_set(Stage::Begin));
    });
    end.run_to_tick(499).unwrap();
    assert_eq!(end.bodies().flying(), 200);
    end.run_to_tick(1000).unwrap();
    assert_eq!((end.bodies().len(), end.bodies().flying()), (201, 0));
    for body in 0..200 {
        let (position, ..) = parabola(begin.bodies(), body, GRAVITY, 1.0);
        // Five hundred drifts round by half a unit of 32 m each, less than what compensation leaves of them.
        let far = (end.bodies().position[body] - position).abs().max_element() > 500.0 * 32.0 * f64::EPSILON;
        assert!(!far, "disc {body}: {} and not {position}", end.bodies().position[body]);
    }
}

/// Discs that hit each other a few times, and a floor: bound, and in flight between.
#[test]
fn collisions_are_those_of_bodies_that_are_moved_tick_by_tick() {
    let rest =
        format!("{CLOCK} walls: [(name: \"floor\", left: (30, -0.5), right: (-10, -0.5), material: \"stone\")],");
    let text = cloud(20, 10, 2.0, &rest);
    let (mut flying, mut bound) = (load(&text), load_bound(&text));
    let mut most = 0;
    for tick in (50..=1000).step_by(50) {
        flying.run_to_tick(tick).unwrap();
        bound.run_to_tick(tick).unwrap();
        most = most.max(flying.bodies().flying());
        assert_eq!(bound.bodies().flying(), 0);
    }
    let (a, b) = (flying.bodies(), bound.bodies());
    let hit = (0..a.len()).filter(|&body| (b.spin[body] - load(&text).bodies().spin[body]).abs() > 1e-6).count();
    assert!(most > 150 && hit > 60, "{most} flew at most, {hit} were hit");
    // Each disc is hit some three times at the most: rounding of a thousand ticks times 50³.
    let bound_of = 1000.0 * f64::EPSILON * 50.0_f64.powi(3);
    let apart = (0..a.len()).map(|body| (a.position[body] - b.position[body]).abs().max_element()).fold(0.0, f64::max);
    assert!(apart < bound_of, "{apart} m apart");
    let (a, b) = (flying.world(), bound.world());
    let (a, b) = (a.resource::<State>().ledger(), b.resource::<State>().ledger());
    let (lost, expected) = (a.inelasticity.value(), b.inelasticity.value());
    assert!((lost - expected).abs() < 1e3 * bound_of * expected, "{lost} J and not {expected} J");
    for (own, other) in [(a.impulse[1], b.impulse[1]), (a.angular_impulse, b.angular_impulse)] {
        assert!((own.value() - other.value()).abs() < 1e3 * bound_of * other.value().abs(), "{own:?} {other:?}");
    }
    let (a, b) = (largest_travel(flying.state()), largest_travel(bound.state()));
    assert!((a - b).abs() < bound_of, "{a} m and not {b} m in a tick");
}

#[test]
fn who_looks_changes_no_bit() {
    fn look(_: Query<&jostle::world::Position>) {}
    let text = cloud(20, 10, 2.0, CLOCK);
    let run = |pieces: u64, looks: bool| {
        let mut simulation = load_with(&text, move |app| {
            if looks {
                app.add_systems(SimTick, look.in_set(Stage::Observe));
            }
        });
        for piece in 1..=pieces {
            simulation.run_to_tick(800 * piece / pieces).unwrap();
        }
        assert!(simulation.bodies().flying() > 0);
        state_hash(simulation.bodies())
    };
    let expected = run(1, false);
    for (pieces, looks) in [(7, false), (800, false), (1, true), (13, true)] {
        assert_eq!(run(pieces, looks), expected, "{pieces} pieces, looks: {looks}");
    }
}

/// Expectations look at all bodies in each tick, and find those that fly where they are.
#[test]
fn whoever_looks_in_a_tick_sees_where_bodies_are() {
    #[derive(Resource)]
    struct Seen(Vec<DVec2>);
    fn look(bodies: Query<&jostle::world::Position>, mut seen: ResMut<Seen>) {
        seen.0.push(bodies.iter().map(|position| position.0).sum());
    }
    let text = cloud(20, 10, 0.2, CLOCK);
    let mut simulation = load_with(&text, |app| {
        app.insert_resource(Seen(Vec::new())).add_systems(SimTick, look.in_set(Stage::Observe));
    });
    let sum = |simulation: &Simulation| {
        let bodies = simulation.bodies();
        (bodies.position.iter().copied().sum::<DVec2>(), bodies.velocity.iter().copied().sum::<DVec2>())
    };
    let (place, velocity) = sum(&simulation);
    simulation.run_to_tick(400).unwrap();
    assert_eq!(simulation.bodies().flying(), 200);
    for (tick, seen) in (1..).zip(&simulation.resource::<Seen>().0) {
        let time = 0.001 * f64::from(tick);
        let expected = place + velocity * time + GRAVITY * (200.0 * 0.5 * time * time);
        // Two hundred sums of numbers below 4096.
        assert!((*seen - expected).abs().max_element() < 200.0 * 4096.0 * f64::EPSILON, "{seen} {expected}");
    }
}
