//! Snapshots of runs with plugins: declared memory is kept, and for undeclared memory the snapshot refuses by name.
//!
//! Law: a run that is set down and taken up ends in the bits of one that was not. Tolerance: none.

use bevy_app::App;
use bevy_ecs::prelude::*;
use glam::DVec2;
use jostle::Simulation;
use jostle::scene::Source;
use jostle::simulation::Overrides;
use jostle::tick::kept::SnapshotAppExt;
use jostle::tick::snapshot::{Memory, UnfitSnapshot, recall};
use jostle::tick::{Energies, Model, SimTick, Stage, State, SteadySpring, TickAppExt};
use jostle::world::{Velocity, hash::state_hash};
use serde::{Deserialize, Serialize};

const SCENE: &str = r#"Scene(
    format: 1,
    clock: (duration: 1, tick: "1 ms", method: VelocityVerlet),
    gravity: (0, -10),
    walls: [(name: "floor", left: (1, 0), right: (0, 0))],
    bodies: [(name: "a", at: (0, 0.4), velocity: (1, 0), atoms: Disc(radius: 0.1)),
             (name: "b", at: (0.5, 0.3), spin: 3, atoms: Disc(radius: 0.1))],
)"#;

/// A force that grows with each tick: it remembers how often it acted.
#[derive(Default)]
struct Tiring {
    evaluations: u32,
    tells: bool,
}

impl Model for Tiring {
    fn energies(&self, _: &State) -> Energies {
        Energies::default()
    }

    fn stiffness(&self, _: &State, _: &mut Vec<SteadySpring>) {}

    fn apply_forces(&mut self, state: &mut State) {
        self.evaluations += 1;
        let force = DVec2::new(1e-3 * f64::from(self.evaluations), 0.0);
        let (bodies, rates) = state.bodies_and_rates();
        rates.work += force.dot(bodies.velocity[0]);
        rates.outside(bodies.position[0], force, 0.0);
        bodies.push(0, DVec2::ZERO, force);
    }

    fn save(&self) -> Memory {
        if self.tells { Memory::of(&self.evaluations) } else { Memory::Untold }
    }

    fn load(&mut self, bytes: &[u8]) -> Result<(), UnfitSnapshot> {
        self.evaluations = recall(bytes)?;
        Ok(())
    }
}

/// Counts ticks and kicks a body by the count.
#[derive(Resource, Default, Serialize, Deserialize)]
struct Kicks(u32);

/// How often a body was kicked.
#[derive(Component, Default, Serialize, Deserialize)]
struct Kicked(u32);

fn kick(mut kicks: ResMut<Kicks>, mut bodies: Query<(&mut Velocity, &mut Kicked)>) {
    kicks.0 += 1;
    if kicks.0.is_multiple_of(10) {
        for (mut velocity, mut kicked) in &mut bodies {
            kicked.0 += 1;
            velocity.0.y += 1e-3 * f64::from(kicked.0);
        }
    }
}

fn mark(mut commands: Commands, bodies: Query<Entity, (With<Velocity>, Without<Kicked>)>) {
    bodies.iter().for_each(|body| _ = commands.entity(body).insert(Kicked::default()));
}

fn load(plugins: impl Fn(&mut App) + Send + Sync + 'static) -> Simulation {
    Simulation::load_with(&Source::new("kicks.ron", SCENE), &Overrides::default(), plugins).expect("a correct scene")
}

/// Runs whole, and in two simulations one after the other; returns both hashes.
fn whole_and_resumed(plugins: impl Fn(&mut App) + Send + Sync + 'static + Copy) -> (u64, u64) {
    let mut whole = load(plugins);
    whole.run_to_end().unwrap();
    let mut first = load(plugins);
    first.run_to_tick(437).unwrap();
    let snapshot = first.snapshot().unwrap();
    let mut fork = first.fork().unwrap();
    let mut second = load(plugins);
    // It has been elsewhere meanwhile.
    second.run_to_tick(700).unwrap();
    second.restore(&snapshot).unwrap();
    second.run_to_end().unwrap();
    fork.run_to_end().unwrap();
    assert_eq!(state_hash(fork.bodies()), state_hash(second.bodies()));
    (state_hash(whole.bodies()), state_hash(second.bodies()))
}

#[test]
fn a_model_that_says_what_it_remembers_goes_on() {
    let (whole, resumed) = whole_and_resumed(|app| {
        app.add_model(Tiring { evaluations: 0, tells: true });
    });
    assert_eq!(whole, resumed);
}

#[test]
fn one_that_does_not_is_named() {
    let mut simulation = load(|app| {
        app.add_model(Tiring::default());
    });
    simulation.run_to_tick(10).unwrap();
    let error = simulation.snapshot().unwrap_err();
    assert!(error.name.contains("Tiring"), "{error}");
}

#[test]
fn registered_resources_and_components_go_on() {
    let (whole, resumed) = whole_and_resumed(|app| {
        app.init_resource::<Kicks>().keep_resource::<Kicks>().keep_component::<Kicked>();
        app.add_systems(SimTick, (mark, kick).chain().in_set(Stage::Begin));
    });
    assert_eq!(whole, resumed);
}

#[test]
fn what_is_not_registered_is_named() {
    let mut simulation = load(|app| {
        app.init_resource::<Kicks>();
    });
    assert!(simulation.snapshot().unwrap_err().name.contains("Kicks"));
    let mut simulation = load(|app| {
        app.init_resource::<Kicks>().keep_resource::<Kicks>();
        app.add_systems(SimTick, (mark, kick).chain().in_set(Stage::Begin));
    });
    simulation.run_to_tick(1).unwrap();
    assert!(simulation.snapshot().unwrap_err().name.contains("Kicked"));
    let mut simulation = load(|app| {
        app.init_resource::<Kicks>().follows_from_scene::<Kicks>();
    });
    assert!(simulation.snapshot().is_ok());
}

/// A snapshot of a run with other plugins does not fit, and the run it was tried on goes on as if nothing had been.
#[test]
fn a_snapshot_with_other_plugins_is_refused() {
    let with = |app: &mut App| {
        app.add_model(Tiring { evaluations: 0, tells: true });
    };
    let mut other = load(with);
    other.run_to_tick(100).unwrap();
    let snapshot = other.snapshot().unwrap();
    let (mut tried, mut plain) = (load(|_| {}), load(|_| {}));
    tried.run_to_tick(300).unwrap();
    let error = tried.restore(&snapshot).unwrap_err().to_string();
    assert!(error.contains("models"), "{error}");
    tried.run_to_end().unwrap();
    plain.run_to_end().unwrap();
    assert_eq!(state_hash(tried.bodies()), state_hash(plain.bodies()));
}

#[test]
fn simulations_can_be_sent_to_threads() {
    fn is_send<T: Send>(_: &T) {}
    let simulation = load(|_| {});
    is_send(&simulation);
    let hash = std::thread::spawn(move || {
        let mut simulation = simulation;
        simulation.run_to_end().unwrap();
        state_hash(simulation.bodies())
    });
    let mut here = load(|_| {});
    here.run_to_end().unwrap();
    assert_eq!(hash.join().unwrap(), state_hash(here.bodies()));
}

#[test]
fn a_run_with_a_system_of_later_goes_on_with_the_same_one_only() {
    fn lift(mut bodies: Query<&mut Velocity>) {
        bodies.iter_mut().for_each(|mut velocity| velocity.0.y += 1e-3);
    }
    let add = |simulation: &mut Simulation| {
        simulation.world_mut().schedule_scope(SimTick, |_, schedule| {
            schedule.add_systems(lift.in_set(Stage::Begin));
        });
    };
    let mut simulation = load(|_| {});
    simulation.run_to_tick(10).unwrap();
    add(&mut simulation);
    simulation.run_to_tick(20).unwrap();
    let why = simulation.fork().err().expect("a refusal").to_string();
    assert!(why.contains("other systems in the tick") && why.contains("lift"), "{why}");
    let snapshot = simulation.snapshot().unwrap();
    let mut second = load(|_| {});
    add(&mut second);
    second.restore(&snapshot).unwrap();
    assert_eq!(simulation.future_hash(), second.future_hash());
}
