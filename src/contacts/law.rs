//! What a contact law owes the card: a law from outside hands it over when it is installed, so that nothing is left out in silence.

use bevy_app::App;
use bevy_ecs::prelude::*;
use glam::DVec2;

use super::{CandidatePairs, DeepestOverlap, search};

use crate::tick::balance::EnergyTerms;
use crate::tick::response::{Spring, Springs};
use crate::tick::{Clock, Fastest, Holder, Responses, SimTick, Stability, Stage, TickAppExt};
use crate::world::Bodies;

/// Ticks from one look at how fast the touching pairs respond together to the next.
const PATIENCE: u64 = 64;

/// The contact law of a run. Present when some law is installed.
#[derive(Resource, Clone, Copy, Debug, PartialEq, Eq)]
pub struct ContactLaw(&'static str);

impl ContactLaw {
    /// A law of the engine's own, which tells the card by itself.
    pub(super) fn of_engine(name: &'static str) -> Self {
        Self(name)
    }

    /// Its name, as scenes write it.
    pub fn name(self) -> &'static str {
        self.0
    }
}

/// A pair that touches.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Touching {
    /// Side A: an atom, or a wall where it is none.
    pub a: Option<usize>,
    /// The atom on side B.
    pub b: usize,
    /// The wall on side A, if it is one.
    pub wall: Option<usize>,
    /// Unit normal from A to B.
    pub normal: DVec2,
    /// Overlap in metres, positive.
    pub overlap: f64,
}

/// A contact law from outside, as [`add_law`] takes it.
#[derive(Resource, Clone, Copy, Debug)]
pub struct Law {
    /// Its name, as scenes write it.
    pub name: &'static str,
    /// The elastic energy in J that all contacts hold in the present state.
    pub elastic_energy: fn(&World) -> f64,
    /// Stiffness along the normal and across it, in N/m, of a pair that touches. The critical tick follows from them.
    pub stiffness: fn(&World, &Touching) -> (f64, f64),
}

/// How fast the contacts of a law from outside respond, as far as it was measured.
#[derive(Resource, Default)]
struct Watched {
    found: Responses,
    springs: Springs,
    next: u64,
}

/// Installs the search for pairs, and all that the card says of contacts: the deepest overlap, the elastic energy, the critical tick.
/// The forces are for a system of the caller's own, in [`EvaluateStage::Contacts`](crate::tick::EvaluateStage::Contacts) after
/// [`FindPairs`](super::FindPairs).
pub fn add_law(app: &mut App, law: Law) {
    search::plugin(app);
    app.insert_resource(ContactLaw(law.name))
        .insert_resource(law)
        .init_resource::<DeepestOverlap>()
        .init_resource::<Watched>()
        .add_packed_systems(SimTick, watch.in_set(Stage::Observe));
    app.world_mut().get_resource_or_init::<EnergyTerms>().elastic.push(law.elastic_energy);
    let sources = &mut app.world_mut().get_resource_or_init::<Stability>().into_inner().sources;
    sources.push(|world| world.resource::<Watched>().found);
}

/// The system of [`Stage::Observe`].
fn watch(world: &mut World) {
    let touching = touching(world.resource(), world.resource());
    let time = world.resource::<Clock>().time();
    world.resource_scope(|world, mut deepest: Mut<DeepestOverlap>| {
        let bodies = world.resource::<Bodies>();
        for pair in &touching {
            let entity = |atom: usize| bodies.entity[bodies.atom_body(atom)];
            let other = pair.wall.map(|wall| bodies.walls[wall].entity).or(pair.a.map(entity));
            let smaller = pair.a.map_or(f64::INFINITY, |a| bodies.atom_radius[a]).min(bodies.atom_radius[pair.b]);
            deepest.note(pair.overlap, smaller, time, || (other.unwrap_or(Entity::PLACEHOLDER), entity(pair.b)));
        }
    });
    let ticks = world.resource::<Clock>().ticks;
    if touching.is_empty() || ticks < world.resource::<Watched>().next {
        return;
    }
    world.resource_scope(|world, mut watched: Mut<Watched>| {
        watched.next = ticks + PATIENCE;
        let (bodies, law) = (world.resource::<Bodies>(), world.resource::<Law>());
        let side = |atom: usize| {
            let body = bodies.atom_body(atom);
            (body, bodies.atom_place(atom) - bodies.position[body])
        };
        let spring = |pair: &Touching| Spring {
            a: pair.a.map(side),
            b: side(pair.b),
            normal: pair.normal,
            stiffness: (law.stiffness)(world, pair),
            damped: 0.0,
            turning: 0.0,
        };
        watched.springs.gather(touching.iter().map(spring), [], bodies);
        let angular_frequency = watched.springs.largest().sqrt();
        if angular_frequency > watched.found.fastest.map_or(0.0, |fastest| fastest.angular_frequency) {
            let body = bodies.entity[watched.springs.bound().body];
            watched.found.fastest = Some(Fastest { angular_frequency, body, holder: Holder::Contacts, time });
        }
    });
}

/// The pairs that touch.
fn touching(bodies: &Bodies, pairs: &CandidatePairs) -> Vec<Touching> {
    let atoms = pairs.atoms.iter().map(|&pair| {
        let (a, b) = (pair.a as usize, pair.b as usize);
        let distance = (bodies.atom_place(b) - bodies.atom_place(a)).length();
        let overlap = bodies.atom_radius[a] + bodies.atom_radius[b] - distance;
        Touching { a: Some(a), b, wall: None, normal: pair.normal(bodies), overlap }
    });
    let walls = pairs.walls.iter().map(|&pair| {
        let (wall, b) = (pair.wall as usize, pair.atom as usize);
        let height = (bodies.atom_place(b) - bodies.walls[wall].point).dot(bodies.walls[wall].normal);
        let overlap = bodies.atom_radius[b] - height;
        Touching { a: None, b, wall: Some(wall), normal: bodies.walls[wall].normal, overlap }
    });
    atoms.chain(walls).filter(|pair| pair.overlap > 0.0).collect()
}
