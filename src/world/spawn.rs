//! Spawning bodies and walls, at the beginning or in mid-run.

use bevy_ecs::prelude::*;
use glam::DVec2;

use super::Kinematic;
use super::atom::{Atom, AtomOf};
use super::body::{Body, Mass, Motion, Name, Position, Rotation, Spin, Velocity};

/// The key that the next spawned body gets: later spawns stand behind all earlier ones in the canonical order.
#[derive(Resource, Debug, Default)]
pub struct NextKey {
    /// Of bodies.
    pub body: u64,
    /// Of walls.
    pub wall: u64,
}

/// Everything a body needs to exist.
///
/// ```
/// use bevy_ecs::prelude::*;
/// use glam::DVec2;
/// use jostle::world::{Atom, MaterialIndex, NewBody};
///
/// let mut world = World::new();
/// let atom = Atom { offset: DVec2::ZERO, radius: 0.1, mass: 2.0, stiffness: 1e4, material: MaterialIndex::default() };
/// let ball = NewBody { name: "ball".into(), mass: 2.0, inertia: 0.01, atoms: vec![atom], ..Default::default() };
/// let entity = ball.spawn(&mut world);
/// assert!(world.get::<jostle::world::Atoms>(entity).is_some());
/// ```
#[derive(Clone, Debug)]
pub struct NewBody {
    /// Name in the scene.
    pub name: String,
    /// How it moves.
    pub motion: Motion,
    /// How it moves if that is prescribed: then it is [`Motion::Kinematic`] from the beginning, and starts where this
    /// says.
    pub kinematic: Option<Kinematic>,
    /// Whether its atoms touch anything.
    pub collides: bool,
    /// Centre of mass in metres.
    pub position: DVec2,
    /// Angle in radians.
    pub angle: f64,
    /// Velocity in m/s.
    pub velocity: DVec2,
    /// Angular velocity in rad/s.
    pub spin: f64,
    /// Mass in kg.
    pub mass: f64,
    /// Moment of inertia about the centre of mass in kg m2.
    pub inertia: f64,
    /// Its atoms, offsets from the centre of mass.
    pub atoms: Vec<Atom>,
}

impl Default for NewBody {
    /// A body of 1 kg and 1 kg m2 without atoms, at rest in the origin.
    fn default() -> Self {
        Self {
            name: String::new(),
            motion: Motion::Dynamic,
            kinematic: None,
            collides: true,
            position: DVec2::ZERO,
            angle: 0.0,
            velocity: DVec2::ZERO,
            spin: 0.0,
            mass: 1.0,
            inertia: 1.0,
            atoms: Vec::new(),
        }
    }
}

impl NewBody {
    /// Spawns the body behind all others in the canonical order and returns its entity.
    pub fn spawn(self, world: &mut World) -> Entity {
        let mut next = world.get_resource_or_init::<NextKey>();
        let key = next.body;
        next.body += 1;
        self.spawn_with_key(world, key)
    }

    /// Spawns the body with a key of the caller's choice. No two bodies may share a key.
    pub fn spawn_with_key(self, world: &mut World, key: u64) -> Entity {
        let mut next = world.get_resource_or_init::<NextKey>();
        next.body = next.body.max(key + 1);
        let motion = if self.kinematic.is_some() { Motion::Kinematic } else { self.motion };
        let body = world
            .spawn((
                Body { key, motion, collides: self.collides },
                Name(self.name),
                Position(self.position),
                Rotation(self.angle),
                Velocity(self.velocity),
                Spin(self.spin),
                Mass { mass: self.mass, inertia: self.inertia },
            ))
            .id();
        if let Some(kinematic) = self.kinematic {
            world.entity_mut(body).insert(kinematic);
        }
        for atom in self.atoms {
            world.spawn((atom, AtomOf(body)));
        }
        body
    }
}
