//! An atom: a disc of a body, that touches other atoms and walls.

use bevy_ecs::prelude::*;
use glam::DVec2;

use super::body::mark_changed;
use super::material::MaterialIndex;

/// A disc of a body. Changed by inserting it anew.
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

/// The atoms of a body, in the order in which they were given. They are despawned with it.
#[derive(Component, Debug, Default)]
#[relationship_target(relationship = AtomOf, linked_spawn)]
pub struct Atoms(Vec<Entity>);

impl Atoms {
    /// The atoms in the order in which they were given.
    pub fn entities(&self) -> &[Entity] {
        &self.0
    }
}
