//! The packed state: bodies, atoms and walls in canonical order, one array per quantity.
//!
//! The canonical order is the order of keys. It does not depend on the order of spawning, on archetypes or on threads.
//! Every sum over bodies or contacts follows it. That makes runs repeatable to the last bit. Atoms are listed body by
//! body: those of body `b` are `first_atom[b] .. first_atom[b + 1]`.

use bevy_ecs::prelude::*;
use glam::DVec2;

use super::apart::IgnoredPairs;
use super::atom::{atoms_of, count_atoms};
use super::body::{Body, Mass, Motion, Position, Rotation, Spin, Velocity};
use super::fitting::Counts;
use super::flight::Flights;
use super::hull::{Hulls, Intangible, NO_HULL, PackedHull};
use super::keys::Keys;
use super::kinematic::{Kinematic, Prescribed};
use super::line::{self, Line, PackedLine};
use super::lone::{Surface, Surfaces};
use super::motion::Travel;
use super::wall::{PackedWall, Wall};
use crate::threads::Threads;
use jostle_simd::{BLOCK, Lanes, Level, Record};
use serde::{Deserialize, Serialize};

/// How it is known how far bodies moved since the last accepted state.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(crate) enum Moved {
    /// As is listed for each of them.
    #[default]
    Listed,
    /// Velocity times this many seconds: for lone discs without prescribed motion.
    For(f64),
}

/// All bodies, atoms and walls, packed.
///
/// Lists of bodies have [`Bodies::len`] items, lists of atoms [`Bodies::atom_count`]. A system that writes to the lists
/// keeps their lengths, because bodies come and go as entities. A run in which a system has changed a length ends with
/// [`FailureKind::Torn`](crate::tick::FailureKind::Torn). A model that does so while it acts may panic.
#[derive(Debug, Default, Serialize, Deserialize)]
pub struct Bodies {
    /// A plugin sets this if it changes an input of forces that is no component, such as a setting. Forces are then evaluated
    /// again before the next tick.
    pub touched: bool,
    /// Instructions for work on many bodies at once. Default: the best there are.
    #[serde(skip)]
    pub level: Level,
    /// Threads for work on many bodies or contacts. Default: one.
    #[serde(skip)]
    pub threads: Threads,
    /// Counts the rebuilds, for code that keeps indices.
    pub generation: u64,

    /// Entity of each body.
    pub entity: Vec<Entity>,
    /// Index of the body of each entity, by the number of the entity. The values of other entities are meaningless.
    pub(crate) indices: Vec<u32>,
    /// Key of each body, ascending.
    pub key: Keys,
    /// Whether the body moves by forces.
    pub dynamic: Vec<bool>,
    /// Whether it ever moves: by forces, or as prescribed.
    pub moves: Vec<bool>,
    /// The bodies that move as prescribed.
    pub prescribed: Prescribed,
    /// Whether its atoms touch anything.
    pub collides: Vec<bool>,
    /// Mass in kg.
    pub mass: Vec<f64>,
    /// Moment of inertia about the centre of mass in kg m2.
    pub inertia: Vec<f64>,
    /// See [`Bodies::inverse_mass`]; empty if all bodies move by forces.
    pub(crate) inverse_mass: Vec<f64>,
    /// See [`Bodies::inverse_inertia`]; likewise.
    pub(crate) inverse_inertia: Vec<f64>,
    /// See [`Bodies::extent`]; empty where bodies are lone discs.
    pub(crate) extent: Vec<f64>,
    /// First atom of each body, and the number of atoms at the end; empty where bodies are lone discs. See [`Bodies::atoms_of`].
    pub(crate) first_atom: Vec<u32>,

    /// Centre of mass in metres.
    pub position: Vec<DVec2>,
    /// Rounding remainder of the position (compensated summation, Kahan 1965).
    pub position_residual: Vec<DVec2>,
    /// Angle in radians, continuous.
    pub angle: Vec<f64>,
    /// Rounding remainder of the angle.
    pub angle_residual: Vec<f64>,
    /// Velocity in m/s.
    pub velocity: Vec<DVec2>,
    /// Angular velocity in rad/s.
    pub spin: Vec<f64>,
    /// Velocities in m/s that forces are evaluated with, where an integrator estimates them; empty: they see the
    /// velocities themselves. An evaluation that is repeated for the same state sees the same estimate.
    pub estimated_velocity: Vec<DVec2>,
    /// Likewise angular velocities in rad/s.
    pub estimated_spin: Vec<f64>,
    /// Displacement since the last accepted state, in metres, if it is listed: see [`Bodies::displacement`].
    pub(crate) drift: Vec<DVec2>,
    /// Likewise turn since the last accepted state, in radians.
    pub(crate) turn: Vec<f64>,
    pub(crate) moved: Moved,
    /// The estimate of velocities has taken the place of them.
    pub(crate) estimating: bool,
    /// Bodies that joints hold in the current state; empty if there are none.
    pub(crate) jointed: Vec<bool>,
    /// Keys of bodies that do not touch each other, the lower one first, in order.
    pub(crate) apart: Vec<(u64, u64)>,
    /// Force of the present evaluation in newtons.
    pub force: Vec<DVec2>,
    /// Torque of the present evaluation in N m.
    pub torque: Vec<f64>,

    /// See [`Bodies::atom_offset`]; empty where bodies are lone discs.
    pub(crate) atom_offset: Vec<DVec2>,
    /// Centre of each atom in the world, in metres; empty where bodies are lone discs. See [`Bodies::atom_place`].
    pub(crate) atom_position: Vec<DVec2>,
    /// Radius of each atom in metres.
    pub atom_radius: Vec<f64>,
    /// Index of the surface of each atom in [`Bodies::surfaces`]; empty if all have the same. See
    /// [`Bodies::atom_stiffness`] and [`Bodies::atom_material`].
    pub(crate) atom_surface: Vec<u32>,
    /// The surfaces that atoms have, each once.
    pub(crate) surfaces: Vec<Surface>,
    /// See [`Bodies::atom_body`]; empty where bodies are lone discs.
    pub(crate) atom_body: Vec<u32>,

    /// Whether each body is one disc about its centre of mass: atoms have the numbers of their bodies then.
    pub lone_discs: bool,
    /// Whether all bodies move by forces.
    pub all_dynamic: bool,

    /// Radius of the smallest atom in metres; infinite without atoms.
    pub smallest_radius: f64,

    /// Bodies that need no work because they are at rest, until a disturbance. Each has a bit, and eight bodies a byte.
    /// Empty if there are none.
    pub asleep: Vec<u8>,
    /// Blocks of eight bodies that need work, in order. They are listed only if some need none.
    pub awake: Vec<u32>,
    /// The number of times that sleeping bodies have woken. While it is constant, every sleeping body has kept its
    /// position.
    pub(crate) rousings: u64,

    /// Seconds for which velocities have yet to change by the present forces: see [`Bodies::kick_later`].
    pub(crate) owed: Option<f64>,

    /// Lent by contacts that need all of them: the data of each disc. Code that moves all bodies also fills them in.
    pub(crate) records: Vec<Record>,
    /// They were filled in, with the present state.
    pub(crate) recorded: bool,

    /// Whether the move of the bodies has already cleared the forces and moved the atoms.
    pub(crate) posed: bool,
    /// Acceleration in m/s2 of a uniform field: forces are not cleared to nothing but to the weight in it.
    pub(crate) field: Option<DVec2>,
    /// Mass of all bodies with a weight, in kg, and mass times position, in kg m, at the current positions.
    pub(crate) weighed: (f64, DVec2),

    /// Bodies that need no work because their motion is known.
    pub(crate) flights: Flights,

    /// Whether a sleeping body was pushed. Then forces are evaluated again, with all bodies awake.
    pub disturbed: bool,
    /// The greatest possible way of any point of a body since the beginning, in metres. It is the sum of the greatest
    /// ways of all ticks. It is unreliable if code other than [`Bodies::advance`] and [`Bodies::prescribe`] moved
    /// bodies.
    pub path: f64,
    /// By how much of that bodies moved by forces since others moved as prescribed.
    pub(crate) advanced: f64,

    /// The hulls of bodies, in the order of the bodies.
    pub hulls: Vec<PackedHull>,
    /// Cosine and sine of the angle of each body, for its atoms; empty without hulls.
    pub(crate) turned: Vec<DVec2>,
    /// Place of the hull of which each atom is a corner; empty without hulls.
    pub(crate) atom_hull: Vec<u32>,
    /// The walls in canonical order. Pieces of a line are walls, one behind the other.
    pub walls: Vec<PackedWall>,
    /// The lines among them.
    pub lines: Vec<PackedLine>,
    /// Velocity of the surface of each wall in m/s; empty if all are at rest.
    pub belts: Vec<DVec2>,

    /// The lengths of the lists when they were filled.
    #[serde(skip)]
    pub(crate) counts: Option<Counts>,
}

impl Bodies {
    /// Number of bodies.
    pub fn len(&self) -> usize {
        self.entity.len()
    }

    /// Whether there are no bodies.
    pub fn is_empty(&self) -> bool {
        self.entity.is_empty()
    }

    /// Index of the body of an entity. `None` for entities without a body, and for bodies that came after the arrays
    /// were filled.
    #[inline]
    pub fn index(&self, entity: Entity) -> Option<usize> {
        let index = *self.indices.get(entity.index_u32() as usize)? as usize;
        (self.entity.get(index) == Some(&entity)).then_some(index)
    }

    /// The number of bodies that move by forces.
    pub(crate) fn dynamic_count(&self) -> usize {
        if self.all_dynamic { self.len() } else { self.dynamic.iter().filter(|dynamic| **dynamic).count() }
    }

    /// Whether a body needs no work because it is at rest.
    #[inline]
    pub fn is_asleep(&self, body: usize) -> bool {
        self.asleep.get(body / BLOCK).is_some_and(|bits| bits >> (body % BLOCK) & 1 != 0)
    }

    /// Whether no body needs any work.
    pub fn all_asleep(&self) -> bool {
        self.awake.is_empty() && !self.asleep.is_empty()
    }

    /// Wakes all bodies.
    pub fn wake_all(&mut self) {
        self.lay_asleep(&[]);
        self.awake.clear();
    }

    /// Puts the bodies of these bits to sleep, and no others. The caller fills `awake`.
    pub(crate) fn lay_asleep(&mut self, asleep: &[u8]) {
        let sleeps_on = |block: usize, bits: u8| bits & !asleep.get(block).copied().unwrap_or(0) == 0;
        let all_sleep_on = self.asleep.iter().enumerate().all(|(block, &bits)| sleeps_on(block, bits));
        self.rousings += u64::from(!all_sleep_on);
        self.posed = false;
        self.asleep.clear();
        self.asleep.extend_from_slice(asleep);
    }

    /// Blocks of eight bodies that need work: how many there are, to be asked for with [`Bodies::awake_block`].
    #[inline(always)]
    pub fn awake_blocks(&self) -> usize {
        if self.asleep.is_empty() { self.len().div_ceil(BLOCK) } else { self.awake.len() }
    }

    /// The bodies of one of the blocks that need work.
    #[inline(always)]
    pub fn awake_block(&self, number: usize) -> std::ops::Range<usize> {
        let block = if self.asleep.is_empty() { number } else { self.awake[number] as usize };
        BLOCK * block..self.len().min(BLOCK * block + BLOCK)
    }

    /// The awake blocks whose bodies lie in a range that begins and ends with blocks.
    pub fn awake_blocks_within(&self, bodies: std::ops::Range<usize>) -> std::ops::Range<usize> {
        let (first, last) = (bodies.start / BLOCK, bodies.end.div_ceil(BLOCK));
        if self.asleep.is_empty() {
            return first..last;
        }
        let index = |block: usize| self.awake.partition_point(|&awake| (awake as usize) < block);
        index(first)..index(last)
    }

    /// Velocity of a point that moves with body `body`, `arm` metres from its centre of mass.
    #[inline]
    pub fn velocity_at(&self, body: usize, arm: DVec2) -> DVec2 {
        self.velocity[body] + arm.perp() * self.spin[body]
    }

    /// 1/mass of a body in 1/kg, zero if it does not move by forces.
    #[inline(always)]
    pub fn inverse_mass(&self, body: usize) -> f64 {
        self.inverse_mass.get(body).copied().unwrap_or_else(|| 1.0 / self.mass[body])
    }

    /// 1/inertia of a body in 1/(kg m2), zero if it does not move by forces.
    #[inline(always)]
    pub fn inverse_inertia(&self, body: usize) -> f64 {
        self.inverse_inertia.get(body).copied().unwrap_or_else(|| 1.0 / self.inertia[body])
    }

    /// Displacement of a body since the last accepted state in metres, and its turn in radians. Tangential springs follow them.
    #[inline(always)]
    pub fn displacement(&self, body: usize) -> (DVec2, f64) {
        let Some((velocity, spin, time)) = self.drift_of(body..body + 1) else {
            return (self.drift[body], self.turn[body]);
        };
        let time = if self.dynamic[body] { time } else { 0.0 };
        (velocity[0] * time, spin[0] * time)
    }

    /// The velocities and spins of consecutive bodies since the last accepted state, and the seconds that they lasted.
    /// `None` if displacements are listed. Bodies that do not move by forces did not move.
    #[inline]
    pub(crate) fn drift_of(&self, bodies: std::ops::Range<usize>) -> Option<(&[DVec2], &[f64], f64)> {
        let Moved::For(time) = self.moved else { return None };
        let (velocity, spin) = if self.estimating {
            (&self.estimated_velocity, &self.estimated_spin)
        } else {
            (&self.velocity, &self.spin)
        };
        Some((&velocity[bodies.clone()], &spin[bodies], time))
    }

    /// The way in metres that some point of a body made at most since the last accepted state.
    pub(crate) fn travel(&self, body: usize) -> f64 {
        let (moved, turn) = self.displacement(body);
        moved.length() + turn.abs() * self.extent(body)
    }

    /// Adds a force that acts `arm` metres from the centre of mass of body `body`.
    #[inline]
    pub fn push(&mut self, body: usize, arm: DVec2, force: DVec2) {
        self.force[body] += force;
        self.torque[body] += arm.perp_dot(force);
    }

    /// Takes the present state as the one from which drift and turn are counted.
    pub fn accept(&mut self) {
        if matches!(self.moved, Moved::For(_)) {
            self.moved = Moved::For(0.0);
        } else {
            self.list_displacements();
        }
    }

    /// A body has not moved since the last accepted state: it was laid to rest, its velocity is zero.
    pub(crate) fn stays(&mut self, body: usize) {
        if self.moved == Moved::Listed {
            (self.drift[body], self.turn[body]) = (DVec2::ZERO, 0.0);
        }
    }

    /// Displacements and turns are listed, from nothing on.
    pub(crate) fn list_displacements(&mut self) {
        self.moved = Moved::Listed;
        self.drift.clear();
        self.drift.resize(self.len(), DVec2::ZERO);
        self.turn.clear();
        self.turn.resize(self.len(), 0.0);
    }

    /// Exchanges the velocities with the estimate, if there is one. It is called before an evaluation and after it.
    pub fn swap_estimate(&mut self) {
        if !self.estimated_velocity.is_empty() {
            std::mem::swap(&mut self.velocity, &mut self.estimated_velocity);
            std::mem::swap(&mut self.spin, &mut self.estimated_spin);
            self.estimating = !self.estimating;
        }
    }

    /// Moves the bodies with prescribed motion to their state at `time` seconds, in a tick that began at `begin`.
    /// Returns their ways in the tick.
    pub fn prescribe(&mut self, begin: f64, time: f64) -> Travel {
        let prescribed = std::mem::take(&mut self.prescribed);
        (self.posed, self.recorded) = (false, false);
        let mut travelled = Travel::default();
        for (body, motion) in &prescribed.motions {
            let (body, from, now) = (*body, motion.state(begin), motion.state(time));
            (self.position[body], self.angle[body]) = (now.position, now.angle);
            (self.velocity[body], self.spin[body]) = (now.velocity, now.spin);
            if !self.estimated_velocity.is_empty() {
                (self.estimated_velocity[body], self.estimated_spin[body]) = (now.velocity, now.spin);
            }
            (self.drift[body], self.turn[body]) = (now.position - from.position, now.angle - from.angle);
            let travel = self.drift[body].length() + self.turn[body].abs() * self.extent(body);
            travelled.greatest = travelled.greatest.max(travel);
            travelled.sum += travel;
        }
        self.prescribed = Prescribed { time, ..prescribed };
        // A body moves by forces or as prescribed, never both.
        self.path += (travelled.greatest - std::mem::take(&mut self.advanced)).max(0.0);
        travelled
    }
}

/// Moves atoms with their body to a position and an angle. Returns cosine and sine of the angle, if it was needed.
#[inline(always)]
pub(super) fn place_atoms<V: Lanes>(
    (position, angle): (DVec2, f64),
    offsets: &[DVec2],
    places: &mut [DVec2],
) -> Option<DVec2> {
    // A lone disc in its centre of mass needs no angle.
    if let [offset] = offsets
        && *offset == DVec2::ZERO
    {
        places[0] = position;
        return None;
    }
    let (sin, cos) = libm::sincos(angle);
    let rotation = DVec2::new(cos, sin);
    let several = V::COUNT * (offsets.len() / V::COUNT);
    let (x, y, sin, cos) = (V::splat(position.x), V::splat(position.y), V::splat(sin), V::splat(cos));
    for first in (0..several).step_by(V::COUNT) {
        let (along, across) = V::load_pairs(&offsets[first..]);
        let (along, across) = (cos * along - sin * across, sin * along + cos * across);
        V::store_pairs(x + along, y + across, &mut places[first..]);
    }
    for (offset, place) in offsets.iter().zip(places).skip(several) {
        *place = position + rotation.rotate(*offset);
    }
    Some(rotation)
}

impl Bodies {
    /// Tells atoms of which hulls they are corners.
    fn list_corners(&mut self) {
        if self.hulls.is_empty() {
            return;
        }
        self.atom_hull = vec![NO_HULL; self.atom_count()];
        for (index, hull) in self.hulls.iter().enumerate() {
            self.atom_hull[hull.corners()].fill(index as u32);
        }
    }

    /// Makes room for so many bodies and atoms and no more: lists that grow end up to twice as long.
    fn make_room(&mut self, bodies: usize, atoms: usize) {
        self.entity.reserve_exact(bodies);
        for list in [&mut self.dynamic, &mut self.moves, &mut self.collides] {
            list.reserve_exact(bodies);
        }
        let Self { mass, inertia, angle, angle_residual, spin, torque, .. } = self;
        for list in [mass, inertia, angle, angle_residual, spin, torque] {
            list.reserve_exact(bodies);
        }
        for list in [&mut self.position, &mut self.position_residual, &mut self.velocity, &mut self.force] {
            list.reserve_exact(bodies);
        }
        self.atom_radius.reserve_exact(atoms);
        self.atom_surface.reserve_exact(atoms);
        if !self.lone_discs {
            self.extent.reserve_exact(bodies);
            self.first_atom.reserve_exact(bodies + 1);
            self.atom_offset.reserve_exact(atoms);
            self.atom_body.reserve_exact(atoms);
        }
    }
}

/// Whether a body is one disc about its centre of mass.
fn is_lone_disc(world: &World, body: Entity) -> bool {
    let mut atoms = atoms_of(world, body);
    atoms.next().is_some_and(|atom| atom.offset == DVec2::ZERO) && atoms.next().is_none()
}

/// The reach of a body without atoms, in metres. It is that of its parts that touch nothing, or its radius of gyration
/// without such parts. Turning counts by that length against moving.
fn extent_without_atoms(intangible: Option<&Intangible>, mass: f64, inertia: f64) -> f64 {
    let parts = intangible.map_or(&[][..], |intangible| &intangible.hulls);
    let reach = parts.iter().map(|hull| hull.reach_of_core(DVec2::ZERO) + hull.radius()).fold(0.0, f64::max);
    if reach > 0.0 { reach } else { (inertia / mass).sqrt() }
}

/// Fills the arrays again from the entities, in the order of keys. The rounding remainders in `previous` are kept.
pub fn rebuild(world: &mut World, previous: Bodies) -> Bodies {
    let mut found: Vec<(u64, Entity)> = world.query::<(Entity, &Body)>().iter(world).map(|(e, b)| (b.key, e)).collect();
    found.sort_unstable();
    let mut bodies = Bodies {
        generation: previous.generation + 1,
        level: previous.level,
        threads: previous.threads,
        field: previous.field,
        flights: previous.flights.ended(),
        apart: world.get_resource::<IgnoredPairs>().map(|apart| apart.pairs().to_vec()).unwrap_or_default(),
        lone_discs: found.iter().all(|&(_, entity)| is_lone_disc(world, entity)),
        ..Default::default()
    };
    let last = found.iter().map(|(_, entity)| entity.index_u32() as usize).max();
    bodies.indices = vec![0; last.map_or(0, |last| last + 1)];
    bodies.make_room(found.len(), count_atoms(world));
    let mut surfaces = Surfaces::default();
    for (index, &(key, entity)) in found.iter().enumerate() {
        let body = world.entity(entity);
        let &Body { motion, collides, .. } = body.get::<Body>().expect("queried with Body");
        let &Mass { mass, inertia } = body.get::<Mass>().expect("Body requires Mass");
        let dynamic = motion == Motion::Dynamic;
        bodies.entity.push(entity);
        bodies.indices[entity.index_u32() as usize] = index as u32;
        bodies.key.push(key);
        bodies.dynamic.push(dynamic);
        let prescribed = body.get::<Kinematic>().filter(|_| motion == Motion::Kinematic);
        bodies.moves.push(dynamic || prescribed.is_some());
        bodies.prescribed.motions.extend(prescribed.map(|motion| (index, motion.clone())));
        bodies.collides.push(collides);
        bodies.mass.push(mass);
        bodies.inertia.push(inertia);
        let position = body.get::<Position>().expect("Body requires Position").0;
        let angle = body.get::<Rotation>().expect("Body requires Rotation").0;
        let before = previous.key.find(key);
        let kept = |same: bool| before.filter(|_| same);
        let position_kept = kept(before.is_some_and(|b| previous.position[b] == position));
        let angle_kept = kept(before.is_some_and(|b| previous.angle[b] == angle));
        bodies.position.push(position);
        bodies.position_residual.push(position_kept.map_or(DVec2::ZERO, |b| previous.position_residual[b]));
        bodies.angle.push(angle);
        bodies.angle_residual.push(angle_kept.map_or(0.0, |b| previous.angle_residual[b]));
        let velocity = body.get::<Velocity>().expect("Body requires Velocity").0;
        let spin = body.get::<Spin>().expect("Body requires Spin").0;
        bodies.velocity.push(velocity);
        bodies.spin.push(spin);
        if !previous.estimated_velocity.is_empty() {
            let kept = kept(before.is_some_and(|b| previous.velocity[b] == velocity && previous.spin[b] == spin));
            bodies.estimated_velocity.push(kept.map_or(velocity, |b| previous.estimated_velocity[b]));
            bodies.estimated_spin.push(kept.map_or(spin, |b| previous.estimated_spin[b]));
        }
        bodies.force.push(DVec2::ZERO);
        bodies.torque.push(0.0);
        let (mut extent, first_atom) = (0.0_f64, bodies.atom_count() as u32);
        for atom in atoms_of(world, entity) {
            bodies.atom_radius.push(atom.radius);
            bodies.atom_surface.push(surfaces.index(atom));
            if !bodies.lone_discs {
                extent = extent.max(atom.offset.length() + atom.radius);
                bodies.atom_offset.push(atom.offset);
                bodies.atom_body.push(index as u32);
            }
        }
        if !bodies.lone_discs {
            if extent == 0.0 {
                extent = extent_without_atoms(body.get::<Intangible>(), mass, inertia);
            }
            bodies.extent.push(extent);
            bodies.first_atom.push(first_atom);
        }
        if let Some(hulls) = body.get::<Hulls>() {
            bodies.hulls.extend(PackedHull::of_body(index, hulls, bodies.atom_radius.len()));
        }
    }
    bodies.list_corners();
    (bodies.surfaces, bodies.atom_surface) = surfaces.listed(std::mem::take(&mut bodies.atom_surface));
    if !bodies.lone_discs {
        bodies.first_atom.push(bodies.atom_count() as u32);
        bodies.atom_position = vec![DVec2::ZERO; bodies.atom_count()];
        bodies.turned = if bodies.hulls.is_empty() { Vec::new() } else { vec![DVec2::X; bodies.len()] };
        for body in 0..bodies.len() {
            let (pose, atoms) = ((bodies.position[body], bodies.angle[body]), bodies.atoms_of(body));
            let turned = place_atoms::<f64>(pose, &bodies.atom_offset[atoms.clone()], &mut bodies.atom_position[atoms]);
            if let (Some(turned), Some(slot)) = (turned, bodies.turned.get_mut(body)) {
                *slot = turned;
            }
        }
    }
    bodies.moved =
        if bodies.lone_discs && bodies.prescribed.motions.is_empty() { Moved::For(0.0) } else { Moved::Listed };
    bodies.accept();
    bodies.all_dynamic = bodies.dynamic.iter().all(|dynamic| *dynamic);
    if !bodies.all_dynamic {
        let inverse = |list: &[f64]| {
            let of = |(value, dynamic): (&f64, &bool)| if *dynamic { 1.0 / value } else { 0.0 };
            list.iter().zip(&bodies.dynamic).map(of).collect()
        };
        (bodies.inverse_mass, bodies.inverse_inertia) = (inverse(&bodies.mass), inverse(&bodies.inertia));
    }
    let mut walls: Vec<(Entity, Wall, Option<Line>)> = world
        .query::<(Entity, &Wall, Option<&Line>)>()
        .iter(world)
        .map(|(entity, wall, line)| (entity, *wall, line.cloned()))
        .collect();
    bodies.smallest_radius = if bodies.hulls.is_empty() {
        bodies.atom_radius.iter().copied().fold(f64::INFINITY, f64::min)
    } else {
        (0..bodies.atom_count()).map(|atom| bodies.size_of_atom(atom)).fold(f64::INFINITY, f64::min)
    };
    walls.sort_unstable_by_key(|(_, wall, _)| wall.key);
    (bodies.walls, bodies.lines) = line::pack(&walls);
    if walls.iter().any(|(_, wall, _)| wall.surface_velocity != DVec2::ZERO) {
        let velocity = |(_, wall, line): &(Entity, Wall, Option<Line>)| {
            let pieces = line.as_ref().map_or(1, |Line(points)| points.len() - 1);
            std::iter::repeat_n(wall.surface_velocity, pieces)
        };
        bodies.belts = walls.iter().flat_map(velocity).collect();
    }
    bodies.count_all();
    bodies
}
