//! Same scene, same binary: same bits. Source: design of the engine. The order of every sum is a function of keys and
//! state, never of spawning, archetypes, batches or pictures.
//!
//! Tolerance: none, hashes and states are compared to the last bit. A scene that is insensitive to the order of sums
//! proves nothing. So each hash is of a pile with friction after thousands of ticks of shaking.
//!
//! Not tested: other machines.

mod batches;
mod changes;
mod levels;
mod pinned;
mod pinned_methods;
mod plots;
mod same_bits;
mod snapshots;
mod threads;

use bevy_app::App;
use bevy_ecs::prelude::*;
use glam::DVec2;
use jostle::Simulation;
use jostle::scene::Source;
use jostle::simulation::Overrides;
use jostle::world::{Atom, MaterialIndex, Materials, NewBody, hash::state_hash};

/// A box under gravity with drag, sticking and slipping friction, and losses; `sections` and `bodies` come in addition.
fn scene(method: &str, sections: &str, bodies: &str) -> String {
    format!(
        "Scene(format: 1, clock: (duration: 4, tick: 0.0005, method: {method}), {sections}
        gravity: (0.2, -9.81), contacts: Penalty(), forces: [Drag(linear: 0.01)],
        materials: {{
            \"stone\": (stiffness: 4000, friction: (static: 0.5, dynamic: 0.3), inelasticity: 0.2),
            \"wood\": (stiffness: 2000, friction: (static: 0.4, dynamic: 0.25), inelasticity: 0.4),
        }},
        walls: [
            (name: \"floor\", left: (2, 0), right: (0, 0), material: \"stone\"),
            (name: \"left\", left: (0, 0), right: (0, 2), material: \"wood\"),
            (name: \"right\", left: (2, 2), right: (2, 0), material: \"stone\"),
        ],
        bodies: [{bodies}])"
    )
}

/// Twelve clumps of four atoms as text.
fn clumps() -> String {
    let clump = |number: usize| {
        let (x, y) = place(number);
        let material = MATERIALS[number % 2];
        format!(
            "(name: \"clump_{number}\", at: ({x:?}, {y:?}), spin: {:?}, material: \"{material}\",
              atoms: Picture(spacing: 0.1, mass: 0.02, rows: [\"##\", \"##\"])),",
            spin(number)
        )
    };
    (0..12).map(clump).collect()
}

/// The same with a mill that moves as prescribed, on a belt.
fn stirred(method: &str) -> String {
    let mill = "(name: \"mill\", at: (0.5, 0.5), material: \"stone\", atoms: Disc(radius: 0.08),
        kinematic: (spin: 2, repeat: true, path: [(time: 0.3, by: (0.4, 0.1), spin: -1), (time: 0.7, turn: 1, spin: 2)])),";
    let standing = "right: (0, 0), material: \"stone\"";
    let text = scene(method, "", &(mill.to_owned() + &clumps()));
    assert!(text.contains(standing), "no floor to move");
    text.replace(standing, "right: (0, 0), material: \"stone\", surface_velocity: (0.3, 0)")
}

const MATERIALS: [&str; 2] = ["stone", "wood"];

fn place(number: usize) -> (f64, f64) {
    (0.3 + 0.4 * (number % 4) as f64 + 0.03 * (number / 4) as f64, 0.3 + 0.4 * (number / 4) as f64)
}

fn spin(number: usize) -> f64 {
    3.0 - number as f64
}

/// Clump `number` of the scene's materials, as a plugin would make it.
fn new_clump(world: &World, number: usize) -> NewBody {
    let material = MaterialIndex::new(world.resource::<Materials>().index(Some(MATERIALS[number % 2])));
    let stiffness = world.resource::<Materials>().by_index[material.index()].stiffness;
    let offsets = [(-0.05, 0.05), (0.05, 0.05), (-0.05, -0.05), (0.05, -0.05)];
    let atom = |(x, y)| Atom { offset: DVec2::new(x, y), radius: 0.05, mass: 0.02, stiffness, material };
    NewBody {
        name: format!("clump_{number}"),
        position: DVec2::from(place(number)),
        spin: spin(number),
        mass: 0.08,
        inertia: 4.0 * 0.02 * (0.05 * 0.05 / 2.0 + 0.005),
        atoms: offsets.into_iter().map(atom).collect(),
        ..NewBody::default()
    }
}

fn load(text: &str, plugins: impl Fn(&mut App) + Send + Sync + 'static) -> Simulation {
    let source = Source::new("same.ron", text);
    Simulation::load_with(&source, &Overrides::default(), plugins).unwrap_or_else(|errors| panic!("{errors}\n{text}"))
}

fn run(simulation: &mut Simulation, ticks: u64) {
    simulation.run_to_tick(ticks).expect("numbers stay finite");
}

fn hash(simulation: &Simulation) -> u64 {
    state_hash(simulation.bodies())
}

/// Position, velocity, angle and spin of a body, as bits.
type State = [u64; 6];

/// State of each body in canonical order, with its key.
fn states(simulation: &Simulation) -> Vec<(u64, State)> {
    let bodies = simulation.bodies();
    let state = |body: usize| {
        let (position, velocity) = (bodies.position[body], bodies.velocity[body]);
        let numbers = [position.x, position.y, velocity.x, velocity.y, bodies.angle[body], bodies.spin[body]];
        (bodies.key.at(body), numbers.map(f64::to_bits))
    };
    (0..bodies.len()).map(state).collect()
}
