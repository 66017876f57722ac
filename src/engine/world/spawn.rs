//! Spawning of bodies and walls, at the beginning or in mid-run.

use std::sync::Arc;

use bevy_ecs::bundle::NoBundleEffect;
use bevy_ecs::prelude::*;
use glam::DVec2;

use super::atom::{Atom, AtomOf, Atoms};
use super::body::{Body, Force, Mass, Motion, Position, Rotation, Spin, Torque, Velocity};
use super::{Hulls, Intangible, Kinematic, Name, Roster};
use jostle_shapes::Hull;

/// The key of the next spawned body. Later spawns follow all earlier ones in the canonical order.
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
/// # extern crate jostle_engine as jostle;
/// use bevy_ecs::prelude::*;
/// use glam::DVec2;
/// use jostle::world::{Atom, MaterialIndex, NewBody};
///
/// let mut world = World::new();
/// let atom = Atom { offset: DVec2::ZERO, radius: 0.1, mass: 2.0, stiffness: 1e4, material: MaterialIndex::default() };
/// let ball = NewBody { name: "ball".into(), mass: 2.0, inertia: 0.01, atoms: vec![atom], ..Default::default() };
/// let entity = ball.spawn(&mut world);
/// assert_eq!(jostle::world::atoms_of(&world, entity).count(), 1);
/// ```
#[derive(Clone, Debug)]
pub struct NewBody {
    /// Name in the scene.
    pub name: String,
    /// Its motion.
    pub motion: Motion,
    /// Its prescribed motion, if it has one. Then it is [`Motion::Kinematic`] from the beginning, and this sets its
    /// initial state.
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
    /// Its atoms, offsets from the centre of mass; the last ones are the corners of its hulls.
    pub atoms: Vec<Atom>,
    /// Its hulls about the centre of mass.
    pub hulls: Vec<Hull>,
    /// Its parts that touch nothing, if there are any.
    pub intangible: Option<Intangible>,
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
            hulls: Vec::new(),
            intangible: None,
        }
    }
}

/// Numbers of entities that are kept from the bodies of a scene.
const KEPT: usize = 256;

/// Spawns `count` bodies, and reserves smaller entity numbers for later entities. For each resource the ECS allocates a
/// list as long as the number of the resource's entity. Most resources come after the bodies.
pub(super) fn after_others(world: &mut World, count: usize, spawn: impl FnOnce(&mut World)) {
    if count <= KEPT {
        return spawn(world);
    }
    let kept: Vec<Entity> = world.entity_allocator().alloc_many(KEPT as u32).collect();
    spawn(world);
    world.entity_allocator_mut().free_many(&kept);
}

/// Spawns an entity with these components, and with those that force systems add to if there are any.
fn spawn_one(world: &mut World, pushed: bool, components: impl Bundle) -> Entity {
    if pushed {
        world.spawn((components, Force::default(), Torque::default())).id()
    } else {
        world.spawn(components).id()
    }
}

/// Bodies that are named by their numbers.
pub(super) struct Series {
    /// The prefix of their names.
    pub prefix: String,
    /// The number of them.
    pub count: usize,
    /// The key of the first; the others follow it. `None`: the next key.
    pub key: Option<u64>,
    /// Whether each is one disc about its centre of mass.
    pub lone_discs: bool,
}

/// Spawns the bodies of a series, whose individual names are ignored. If each is a lone disc, the ECS makes room for
/// all of them at once.
pub(super) fn spawn_series(world: &mut World, series: Series, body: impl Fn(usize) -> NewBody) {
    let Series { prefix, count, key, lone_discs } = series;
    let prefix = Arc::new(prefix);
    let mut next = world.get_resource_or_init::<NextKey>();
    let first = key.unwrap_or(next.body);
    next.body = next.body.max(first + count as u64);
    let bodies = (0..count).map(|number| (first + number as u64, Name::of_series(&prefix, number), body(number)));
    if !lone_discs {
        return after_others(world, count, |world| {
            bodies.for_each(|(key, name, body)| _ = body.spawn_named(world, key, name));
        });
    }
    let discs = bodies.map(|(key, name, body)| {
        let &[disc] = &body.atoms[..] else { unreachable!("each is a lone disc") };
        (body.components(key, name), disc)
    });
    let pushed = Roster::pushes(world);
    after_others(world, count, |world| {
        if pushed {
            world.spawn_batch(discs.map(|disc| (disc, Force::default(), Torque::default())));
        } else {
            world.spawn_batch(discs);
        }
    });
}

impl NewBody {
    /// Its components without atoms.
    fn components(&self, key: u64, name: Name) -> impl Bundle<Effect: NoBundleEffect> + use<> {
        (
            Body { key, motion: self.motion, collides: self.collides },
            name,
            Position(self.position),
            Rotation(self.angle),
            Velocity(self.velocity),
            Spin(self.spin),
            Mass { mass: self.mass, inertia: self.inertia },
        )
    }

    /// Spawns the body with a key, or behind all others.
    pub(super) fn spawn_keyed(self, world: &mut World, key: Option<u64>) -> Entity {
        match key {
            Some(key) => self.spawn_with_key(world, key),
            None => self.spawn(world),
        }
    }

    /// Spawns the body behind all others in the canonical order and returns its entity.
    pub fn spawn(self, world: &mut World) -> Entity {
        let mut next = world.get_resource_or_init::<NextKey>();
        let key = next.body;
        next.body += 1;
        self.spawn_with_key(world, key)
    }

    /// Spawns the body with a key of the caller's choice. No two bodies may share a key.
    pub fn spawn_with_key(mut self, world: &mut World, key: u64) -> Entity {
        let mut next = world.get_resource_or_init::<NextKey>();
        next.body = next.body.max(key + 1);
        let name = std::mem::take(&mut self.name).into();
        self.spawn_named(world, key, name)
    }

    fn spawn_named(mut self, world: &mut World, key: u64, name: Name) -> Entity {
        let (kinematic, atoms) = (self.kinematic.take(), std::mem::take(&mut self.atoms));
        let (hulls, intangible) = (std::mem::take(&mut self.hulls), self.intangible.take());
        if kinematic.is_some() {
            self.motion = Motion::Kinematic;
        }
        let components = self.components(key, name);
        // All components from the beginning. A later component moves the body to another table, and the old table keeps
        // its memory.
        let pushed = Roster::pushes(world);
        let body = match atoms[..] {
            [atom] => spawn_one(world, pushed, (components, atom)),
            _ => spawn_one(world, pushed, (components, Atoms::with_room(atoms.len()))),
        };
        if let Some(kinematic) = kinematic {
            world.entity_mut(body).insert(kinematic);
        }
        if !hulls.is_empty() {
            world.entity_mut(body).insert(Hulls(hulls));
        }
        if let Some(intangible) = intangible {
            world.entity_mut(body).insert(intangible);
        }
        if atoms.len() > 1 {
            for atom in atoms {
                world.spawn((atom, AtomOf(body)));
            }
        }
        body
    }
}
