//! Components from outside: readers see the current state, and writers change it, in a batch of ticks or one at a time.
//!
//! Law: uniform motion, x = v t, exact in binary for these numbers but for the rounding of t = k dt, which is 2^-10 s here. No
//! tolerance. Not tested: systems in the tick (`replaced_system`), bodies that come and go (`contact_events`).

use bevy_app::App;
use bevy_ecs::prelude::*;
use jostle::Simulation;
use jostle::scene::Source;
use jostle::sensors::{Channel, Channels, SensorAppExt};
use jostle::simulation::Overrides;
use jostle::world::{Body, Position, Velocity};

const SCENE: &str = "Scene(format: 1, clock: (duration: 1, tick: 0.0009765625), bodies: [
    (name: \"ball\", at: (0, 0), velocity: (2, 0), atoms: Disc(radius: 0.25))])";

const DT: f64 = 1.0 / 1024.0;

fn simulation(plugins: fn(&mut App)) -> Simulation {
    Simulation::load_with(&Source::new("x.ron", SCENE), &Overrides::default(), plugins).expect("a correct scene")
}

fn place(world: &World) -> f64 {
    let mut bodies = world.try_query_filtered::<&Position, With<Body>>().expect("there is a body");
    bodies.single(world).expect("there is one").0.x
}

#[test]
fn the_world_shows_the_present_state_whenever_it_is_asked_for() {
    let mut simulation = simulation(|_| {});
    for tick in [1_u32, 2, 3, 500] {
        simulation.run_to_tick(tick.into()).expect("numbers stay finite");
        assert_eq!(place(simulation.world()), 2.0 * f64::from(tick) * DT);
    }
}

#[test]
fn a_component_that_is_written_between_ticks_changes_the_state() {
    let mut simulation = simulation(|_| {});
    simulation.run_to_tick(3).expect("numbers stay finite");
    let ball = simulation.bodies().entity[0];
    simulation.world_mut().get_mut::<Velocity>(ball).expect("bodies have one").0.x = -4.0;
    simulation.run_to_tick(4).expect("numbers stay finite");
    assert_eq!(simulation.bodies().position[0].x, (6.0 - 4.0) * DT);
    simulation.run_to_tick(6).expect("numbers stay finite");
    assert_eq!(place(simulation.world()), (6.0 - 12.0) * DT);
}

fn find(_: &mut World, owner: &str, quantity: &str) -> Option<Channel> {
    (owner == "ball" && quantity == "seen").then(|| Channel::new("ball.seen", "m", place))
}

#[test]
fn a_channel_that_reads_components_reads_those_of_the_present_tick() {
    let mut simulation = simulation(|app| {
        app.add_channels(&["ball.seen"], find);
    });
    let channel = jostle::sensors::find(simulation.world_mut(), "ball.seen").expect("it was added");
    for tick in [1_u32, 2, 700] {
        simulation.run_to_tick(tick.into()).expect("numbers stay finite");
        assert_eq!(simulation.value(&channel), 2.0 * f64::from(tick) * DT);
    }
}

#[test]
fn a_channel_that_a_plugin_adds_by_itself_reads_those_too() {
    let mut simulation = simulation(|app| Channels::add(app.world_mut(), Channel::new("seen", "m", place)));
    simulation.run_to_tick(64).expect("numbers stay finite");
    let channels: Vec<_> = simulation.resource::<Channels>().iter().collect();
    assert_eq!(simulation.value(channels[0]), 128.0 * DT);
}
