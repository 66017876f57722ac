//! An atom: a disc of a body, that touches other atoms and walls.

use bevy_ecs::prelude::*;
use glam::DVec2;

use super::body::mark_changed;
use super::material::MaterialIndex;

/// A disc of a body. Changed by inserting it anew. The atom of a body that has one stands on the body's own entity; where there are
/// more, each is an entity that points to the body. [`atoms_of`] finds both.
#[derive(Component, Clone, Copy, Debug, PartialEq)]
#[component(immutable, on_insert = mark_changed, on_remove = mark_changed)]
pub struct Atom {
    /// Centre in the body's own frame, from its centre of mass, in metres.
    pub offset: DVec2,
    /// Radius in metres.
    pub radius: f64,
    /// Mass in kg: its share of the body's, for whoever wants to act on atoms.
    pub mass: f64,
    /// Contact stiffness in N/m.
    pub stiffness: f64,
    /// What it is made of.
    pub material: MaterialIndex,
}

/// Points from an atom to its body.
#[derive(Component, Clone, Copy, Debug, PartialEq, Eq)]
#[relationship(relationship_target = Atoms)]
pub struct AtomOf(pub Entity);

/// The atoms of a body that are entities, in the order in which they were given. They are despawned with it.
#[derive(Component, Debug, Default)]
#[relationship_target(relationship = AtomOf, linked_spawn)]
pub struct Atoms(Vec<Entity>);

/// The atoms of a body in the order in which they were given; none if there is no such body.
pub fn atoms_of(world: &World, body: Entity) -> impl Iterator<Item = &Atom> {
    let body = world.get_entity(body).ok();
    let own = body.and_then(|body| body.get::<Atom>());
    let others = body.and_then(|body| body.get::<Atoms>()).map_or(&[][..], Atoms::entities);
    own.into_iter().chain(others.iter().filter_map(|&atom| world.get(atom)))
}

impl Atoms {
    /// None yet, with room for so many.
    pub(super) fn with_room(count: usize) -> Self {
        Self(Vec::with_capacity(count))
    }

    /// The atoms in the order in which they were given.
    pub fn entities(&self) -> &[Entity] {
        &self.0
    }
}
