//! An atom: a disc of a body that touches other atoms and walls.

use bevy_ecs::prelude::*;
use glam::DVec2;

use super::body::mark_changed;
use super::material::MaterialIndex;

/// A disc of a body. It is changed by inserting it again. The atom of a body with one atom is a component of the body's
/// entity. Several atoms are entities that point to the body. [`atoms_of`] finds all of them.
#[derive(Component, Clone, Copy, Debug, PartialEq)]
#[component(immutable, on_insert = mark_changed, on_remove = mark_changed)]
pub struct Atom {
    /// Centre in the body's own frame, from its centre of mass, in metres.
    pub offset: DVec2,
    /// Radius in metres.
    pub radius: f64,
    /// Mass in kg: its share of the body's mass, for systems that act on atoms.
    pub mass: f64,
    /// Contact stiffness in N/m. While a scene is read, it is NaN for a material that gives none.
    pub stiffness: f64,
    /// The index of its material.
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

/// The atoms of a body in the order in which they were given; empty if there is no such body.
pub fn atoms_of(world: &World, body: Entity) -> impl Iterator<Item = Atom> {
    let body = world.get_entity(body).ok();
    let own = body.and_then(|body| body.get::<Atom>().copied());
    let others = body.and_then(|body| body.get::<Atoms>()).map_or(&[][..], Atoms::entities);
    own.into_iter().chain(others.iter().filter_map(|&atom| world.get(atom).copied()))
}

/// The number of atoms.
pub(crate) fn count_atoms(world: &mut World) -> usize {
    world.query_filtered::<(), With<Atom>>().iter(world).count()
}

/// Makes all atoms so many times as stiff, and with them their contacts. To be done before the packed state is made.
pub(crate) fn stiffen(world: &mut World, factor: f64) {
    let mut atoms = world.query::<(Entity, &Atom)>();
    let stiffer = |(entity, atom): (Entity, &Atom)| (entity, Atom { stiffness: factor * atom.stiffness, ..*atom });
    let atoms: Vec<_> = atoms.iter(world).map(stiffer).collect();
    atoms.into_iter().for_each(|(entity, atom)| _ = world.entity_mut(entity).insert(atom));
}

/// Whether an atom waits for the stiffness of its material.
pub(crate) fn any_without_stiffness(world: &mut World) -> bool {
    world.query::<&Atom>().iter(world).any(|atom| atom.stiffness.is_nan())
}

/// Gives this stiffness in N/m to all atoms that wait for it.
pub(crate) fn give_stiffness(world: &mut World, stiffness: f64) {
    let mut atoms = world.query::<(Entity, &Atom)>();
    let waiting = atoms.iter(world).filter(|(_, atom)| atom.stiffness.is_nan());
    let given: Vec<_> = waiting.map(|(entity, atom)| (entity, Atom { stiffness, ..*atom })).collect();
    given.into_iter().for_each(|(entity, atom)| _ = world.entity_mut(entity).insert(atom));
}

impl Atoms {
    /// An empty list with room for `count` atoms.
    pub(super) fn with_room(count: usize) -> Self {
        Self(Vec::with_capacity(count))
    }

    /// The atoms in the order in which they were given.
    pub fn entities(&self) -> &[Entity] {
        &self.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::world::{Bodies, NewBody, packed};

    /// A body that is one disc, one whose disc is beside its centre, and one of two.
    fn three_bodies(world: &mut World) -> [Entity; 3] {
        let atom = |x: f64| Atom {
            offset: DVec2::new(x, 0.0),
            radius: 0.5,
            mass: 2.0,
            stiffness: 1e3,
            material: MaterialIndex::default(),
        };
        let body = |atoms: Vec<Atom>| NewBody { mass: 2.0, atoms, ..NewBody::default() };
        [vec![atom(0.0)], vec![atom(0.1)], vec![atom(-0.2), atom(0.2)]].map(|atoms| body(atoms).spawn(world))
    }

    #[test]
    fn atoms_are_found_on_bodies_and_beside_them() {
        let mut world = World::new();
        let bodies = three_bodies(&mut world);
        let on_body = bodies.map(|body| world.get::<Atom>(body).is_some());
        assert_eq!(on_body, [true, true, false]);
        let offsets = |body| atoms_of(&world, body).map(|atom| atom.offset.x).collect::<Vec<_>>();
        assert_eq!(bodies.map(offsets), [vec![0.0], vec![0.1], vec![-0.2, 0.2]]);
        assert_eq!(atoms_of(&world, bodies[0]).next().map(|atom| atom.mass), Some(2.0));
        assert_eq!(count_atoms(&mut world), 4);
        stiffen(&mut world, 3.0);
        let stiffness = |body| atoms_of(&world, body).map(|atom| atom.stiffness).collect::<Vec<_>>();
        assert_eq!(bodies.map(stiffness), [vec![3e3], vec![3e3], vec![3e3; 2]]);
    }

    #[test]
    fn an_atom_is_changed_by_inserting_it_anew() {
        let mut world = World::new();
        let [disc, ..] = three_bodies(&mut world);
        let larger = Atom { radius: 0.75, ..atoms_of(&world, disc).next().unwrap() };
        world.entity_mut(disc).insert(larger);
        assert_eq!(atoms_of(&world, disc).collect::<Vec<_>>(), [larger]);
        assert_eq!(count_atoms(&mut world), 4);
        assert_eq!(packed::rebuild(&mut world, Bodies::default()).atom_radius[0], 0.75);
    }

    /// Promise: if all bodies are lone discs, values without a list equal those of a list.
    #[test]
    fn lone_discs_are_packed_like_others() {
        let mut world = World::new();
        let bodies = three_bodies(&mut world);
        let told = |world: &mut World| {
            let bodies = packed::rebuild(world, Bodies::default());
            let whose = (bodies.atom_body(0), bodies.atoms_of(0), bodies.atom_count(), bodies.len());
            let shape = (bodies.atom_offset(0), bodies.atom_place(0), bodies.extent(0), bodies.atom_stiffness(0));
            (bodies.lone_discs, whose, shape)
        };
        let (lone, whose, shape) = told(&mut world);
        assert!(!lone && whose == (0, 0..1, 4, 3));
        world.despawn(bodies[1]);
        world.despawn(bodies[2]);
        assert_eq!(told(&mut world), (true, (0, 0..1, 1, 1), shape));
        assert_eq!(shape, (DVec2::ZERO, DVec2::ZERO, 0.5, 1e3));
        let packed = packed::rebuild(&mut world, Bodies::default());
        assert_eq!(bodies.map(|body| packed.index(body)), [Some(0), None, None]);
    }
}
