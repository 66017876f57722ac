//! The kernel of contacts between atoms: candidate pairs are followed eight at a time, as many side by side as the
//! processor can, and their forces go to the bodies pair by pair in canonical order.
//!
//! What a pair needs to know of an atom stands in one [`Record`], a line of the cache: the sixteen lines of eight pairs are
//! loaded and transposed in registers.

use std::marker::PhantomData;

use glam::DVec2;

use super::apply::{End, Sink};
use super::contact::Losses;
use super::follow::{Followed, Touch};
use super::law::{LawTable, PairLaw};
use super::list::{ContactList, Phases, lanes};
use super::normal::{Approach, NormalForce};
use crate::contacts::{AtomPair, DeepestOverlap};
use crate::simd::{BLOCK, Kernel, Lanes, Record};
use crate::world::Bodies;

/// What contacts need to know of each atom: place, displacement since the last accepted state, turn since then, radius and
/// velocity.
#[derive(Debug, Default)]
pub(super) struct Records {
    pub list: Vec<Record>,
    /// The atoms that move and that some pair may need, in order; empty: all.
    needed: Vec<u32>,
}

impl Records {
    /// Takes up new lists of pairs.
    pub fn prepare(&mut self, bodies: &Bodies, pairs: &[AtomPair]) {
        self.list.clear();
        self.list.resize(bodies.atom_count(), Record::default());
        self.needed.clear();
        let mut needed = vec![false; bodies.atom_count()];
        for pair in pairs {
            needed[pair.a as usize] = true;
            needed[pair.b as usize] = true;
        }
        let moves = |atom: usize| bodies.moves[bodies.atom_body[atom] as usize];
        let count = (0..needed.len()).filter(|&atom| needed[atom] && moves(atom)).count();
        // Where most are needed, going by all in order is faster.
        if !bodies.lone_discs || 4 * count < 3 * needed.len() {
            self.needed.extend((0..needed.len()).filter(|&atom| needed[atom] && moves(atom)).map(|atom| atom as u32));
        }
        // Those of bodies that stand or are asleep are not filled in again.
        (0..bodies.atom_count()).for_each(|atom| self.fill(bodies, atom));
    }

    /// Fills in the present state, as far as some pair has to be looked at; see [`FollowPairs::path`].
    pub fn update(&mut self, bodies: &Bodies, pairs: &[AtomPair], list: &ContactList, path: f64) {
        let is_due = |block: &usize| !list.is_early(*block, path);
        let blocks = || (0..list.awake_blocks()).map(|number| list.awake_block(number)).filter(is_due);
        let all = bodies.lone_discs && self.needed.is_empty();
        let atoms = if all { self.list.len() } else { self.needed.len() };
        if 2 * BLOCK * blocks().count() < atoms {
            for first in blocks().map(|block| BLOCK * block) {
                for pair in &pairs[first..pairs.len().min(first + BLOCK)] {
                    self.fill(bodies, pair.a as usize);
                    self.fill(bodies, pair.b as usize);
                }
            }
            return;
        }
        if !all {
            for place in 0..self.needed.len() {
                self.fill(bodies, self.needed[place] as usize);
            }
            return;
        }
        for number in 0..bodies.awake_blocks() {
            let block = bodies.awake_block(number);
            let atoms = bodies.first_atom[block.start] as usize..bodies.first_atom[block.end] as usize;
            for atom in atoms {
                self.fill(bodies, atom);
            }
        }
    }

    #[inline(always)]
    fn fill(&mut self, bodies: &Bodies, atom: usize) {
        if bodies.lone_discs {
            let (place, moved, velocity) = (bodies.position[atom], bodies.drift[atom], bodies.velocity[atom]);
            let (turn, radius) = (bodies.turn[atom], bodies.atom_radius[atom]);
            self.list[atom].0 = [place.x, place.y, moved.x, moved.y, turn, radius, velocity.x, velocity.y];
            return;
        }
        let end = End::of(bodies, atom as u32);
        let (place, (moved, turn), velocity) =
            (bodies.atom_position[atom], end.displacement(bodies), end.velocity(bodies));
        self.list[atom].0 = [place.x, place.y, moved.x, moved.y, turn, end.radius, velocity.x, velocity.y];
    }
}

/// All candidate pairs of atoms follow the motion of their sides.
pub(super) struct FollowPairs<'a, 'b, N> {
    pub records: &'a [Record],
    pub pairs: &'a [AtomPair],
    pub list: &'a mut ContactList,
    pub laws: &'a LawTable,
    pub sink: &'a mut Sink<'b>,
    pub deepest: &'a mut DeepestOverlap,
    /// Bodies are discs that move by forces, and nobody asks for single forces.
    pub plain: bool,
    /// How far any point of a body can have gone since the beginning, in metres; not a number where that is not known.
    pub path: f64,
    /// Time of the state in seconds.
    pub time: f64,
    /// Seconds since the state that was last accepted.
    pub elapsed: f64,
    pub law: PhantomData<N>,
}

/// Forces of a block: on side B, and the torques about the centres of both atoms.
#[derive(Default)]
struct Pushes {
    force: [[f64; BLOCK]; 2],
    torque_a: [f64; BLOCK],
    torque_b: [f64; BLOCK],
}

/// Touching pairs of a block from which on all its pairs are pushed.
const FULL: u32 = 4;

/// Partial sums of what is lost, in J.
#[derive(Default)]
struct PartialLosses {
    friction: [f64; BLOCK],
    inelasticity: [f64; BLOCK],
}

/// The bits that belong to lanes.
#[inline(always)]
fn lanes_of<V: Lanes>() -> u8 {
    ((1_u16 << V::COUNT) - 1) as u8
}

/// Bits of a block with those of some lanes written anew.
#[inline(always)]
fn written<V: Lanes>(old: u8, mask: V::Mask, lane: usize) -> u8 {
    (old & !(lanes_of::<V>() << lane)) | ((V::bits(mask) & lanes_of::<V>()) << lane)
}

#[inline(always)]
fn add<V: Lanes>(sums: &mut [f64], terms: V) {
    (V::load(sums) + terms).store(sums);
}

/// Where the sides of the pairs of a block are, and how they moved.
#[derive(Clone, Copy, Default)]
struct Geometry {
    block: usize,
    a: [u32; BLOCK],
    b: [u32; BLOCK],
    /// Which pairs are there, are not asleep, and are near enough to touch or did.
    among: u8,
    normal: [[f64; BLOCK]; 2],
    overlap: [f64; BLOCK],
    displacement: [[f64; BLOCK]; 2],
    swing: [f64; BLOCK],
    radius: [[f64; BLOCK]; 2],
    turn: [[f64; BLOCK]; 2],
    parting: [f64; BLOCK],
}

/// Blocks whose geometry is worked out before their laws are applied: so the processor finds the roots and quotients of several
/// at the same time.
const AHEAD: usize = 4;

impl<N: NormalForce> Kernel for FollowPairs<'_, '_, N> {
    type Output = Losses;

    #[inline(always)]
    fn run<V: Lanes>(mut self) -> Losses {
        let mut lost = PartialLosses::default();
        let mut pushes = Pushes::default();
        let mut ahead = [Geometry::default(); AHEAD];
        let only = self.laws.is_uniform().then(|| self.laws.lanes::<V>(&[0; BLOCK]));
        let (blocks, mut number) = (self.list.awake_blocks(), 0);
        while number < blocks {
            let together = AHEAD.min(blocks - number);
            let mut near = 0;
            for _ in 0..together {
                let block = self.list.awake_block(number);
                number += 1;
                // Nobody can have come near since it was looked at last.
                if self.list.is_early(block, self.path) {
                    continue;
                }
                self.look::<V>(block, &mut ahead[near]);
                near += usize::from(ahead[near].among != 0);
            }
            for geometry in &ahead[..near] {
                let (mut lane, mut touching) = (0, 0);
                while lane < BLOCK {
                    touching |= self.follow(lane, geometry, only.as_ref(), &mut pushes, &mut lost) << lane;
                    lane += V::COUNT;
                }
                if touching != 0 {
                    self.push(geometry, touching, &pushes);
                }
            }
        }
        let sum = |partial: &[f64; BLOCK]| partial.iter().fold(0.0, |sum, part| sum + part);
        Losses { friction: sum(&lost.friction), inelasticity: sum(&lost.inelasticity) }
    }
}

impl<N: NormalForce> FollowPairs<'_, '_, N> {
    /// Finds out where the sides of the pairs of a block are.
    #[inline(always)]
    fn look<V: Lanes>(&mut self, block: usize, geometry: &mut Geometry) {
        let first = BLOCK * block;
        let chunk = &self.pairs[first..self.pairs.len().min(first + BLOCK)];
        if chunk.len() < BLOCK {
            (geometry.a, geometry.b) = ([0; BLOCK], [0; BLOCK]);
        }
        for (lane, pair) in chunk.iter().enumerate() {
            (geometry.a[lane], geometry.b[lane]) = (pair.a, pair.b);
        }
        let there = (u16::MAX >> (16 - chunk.len())) as u8 & !self.list.asleep_in(block);
        let touched = self.list.phases[block].touching();
        (geometry.block, geometry.among) = (block, 0);
        let mut lane = 0;
        while lane < BLOCK {
            let [x_a, y_a, dx_a, dy_a, turn_a, radius_a, u_a, v_a] = V::records(self.records, &geometry.a[lane..]);
            let [x_b, y_b, dx_b, dy_b, turn_b, radius_b, u_b, v_b] = V::records(self.records, &geometry.b[lane..]);
            let (x, y) = (x_b - x_a, y_b - y_a);
            let squared = x * x + y * y;
            let reach = radius_a + radius_b;
            // Written so that what is no number counts as near.
            let away = !squared.lt(reach * reach) & squared.lt(V::splat(f64::INFINITY));
            let near = V::mask((there & touched) >> lane) | (V::mask(there >> lane) & !away);
            geometry.among |= (V::bits(near) & lanes_of::<V>()) << lane;
            let distance = squared.sqrt();
            let inverse = V::splat(1.0) / distance;
            // Centres in one place have no direction: up is as good as any.
            let apart = V::splat(0.0).lt(distance);
            let normal = ((x * inverse).only(apart), V::select(apart, y * inverse, V::splat(1.0)));
            let displacement = (dx_b - dx_a, dy_b - dy_a);
            let swing = ((displacement.1 * normal.0 - displacement.0 * normal.1) * inverse).only(apart);
            normal.0.store(&mut geometry.normal[0][lane..]);
            normal.1.store(&mut geometry.normal[1][lane..]);
            (reach - distance).store(&mut geometry.overlap[lane..]);
            displacement.0.store(&mut geometry.displacement[0][lane..]);
            displacement.1.store(&mut geometry.displacement[1][lane..]);
            swing.store(&mut geometry.swing[lane..]);
            radius_a.store(&mut geometry.radius[0][lane..]);
            radius_b.store(&mut geometry.radius[1][lane..]);
            turn_a.store(&mut geometry.turn[0][lane..]);
            turn_b.store(&mut geometry.turn[1][lane..]);
            if N::DEPENDS_ON_VELOCITY {
                ((u_b - u_a) * normal.0 + (v_b - v_a) * normal.1).store(&mut geometry.parting[lane..]);
            }
            lane += V::COUNT;
        }
        self.list.due[block] = f64::NEG_INFINITY;
        if geometry.among == 0 {
            // Both sides may come nearer.
            let mut gap = f64::INFINITY;
            for lane in 0..chunk.len() {
                gap = gap.min(-geometry.overlap[lane]);
            }
            self.list.due[block] = self.path + 0.5 * gap;
        }
    }

    /// Follows the pairs from `lane` of a block on. Returns which of them touch.
    #[inline(always)]
    fn follow<V: Lanes>(
        &mut self,
        lane: usize,
        geometry: &Geometry,
        only: Option<&PairLaw<V>>,
        pushes: &mut Pushes,
        lost: &mut PartialLosses,
    ) -> u8 {
        let block = geometry.block;
        let place = BLOCK * block + lane;
        let phases = self.list.phases[block];
        let among = V::mask(geometry.among >> lane);
        let (loading, unloading) = (V::mask(phases.loading >> lane), V::mask(phases.unloading >> lane));
        let law = match only {
            Some(law) => *law,
            None => self.laws.lanes(&self.list.law[place..]),
        };
        let normal = (V::load(&geometry.normal[0][lane..]), V::load(&geometry.normal[1][lane..]));
        let mut approach = Approach { parting: V::splat(0.0), mobility: V::splat(0.0) };
        if N::DEPENDS_ON_VELOCITY {
            approach.parting = V::load(&geometry.parting[lane..]);
            if law.damping.depends_on_mobility() {
                approach.mobility = self.mobility((&geometry.a[lane..], &geometry.b[lane..]), normal);
            }
        }
        let radius = (V::load(&geometry.radius[0][lane..]), V::load(&geometry.radius[1][lane..]));
        let touch = Touch {
            normal,
            overlap: V::load(&geometry.overlap[lane..]),
            approach,
            displacement: (V::load(&geometry.displacement[0][lane..]), V::load(&geometry.displacement[1][lane..])),
            swing: V::load(&geometry.swing[lane..]),
            rolled_a: (radius.0, V::load(&geometry.turn[0][lane..])),
            rolled_b: (radius.1, V::load(&geometry.turn[1][lane..])),
        };
        let mut contacts = Followed::<V> {
            overlap: V::load(&self.list.overlap[place..]),
            normal_force: V::load(&self.list.normal_force[place..]),
            elongation: V::load(&self.list.elongation[place..]),
            held: V::load(&self.list.held[place..]),
            loading,
            unloading,
            slips: V::mask(phases.slips >> lane),
            slides: V::mask(phases.slides >> lane),
        };
        let losses = contacts.follow::<N>(&law, &touch, self.elapsed, among);
        add(&mut lost.friction[lane..], losses.friction);
        add(&mut lost.inelasticity[lane..], losses.inelasticity);
        contacts.overlap.store(&mut self.list.overlap[place..]);
        contacts.normal_force.store(&mut self.list.normal_force[place..]);
        contacts.elongation.store(&mut self.list.elongation[place..]);
        contacts.held.store(&mut self.list.held[place..]);
        self.list.phases[block] = Phases {
            loading: written::<V>(phases.loading, contacts.loading, lane),
            unloading: written::<V>(phases.unloading, contacts.unloading, lane),
            slips: written::<V>(phases.slips, contacts.slips, lane),
            slides: written::<V>(phases.slides, contacts.slides, lane),
        };
        let pushing = (contacts.loading | contacts.unloading) & among;
        let touching = V::bits(pushing) & lanes_of::<V>();
        let smaller = V::select(radius.0.lt(radius.1), radius.0, radius.1);
        let deeper = V::bits(contacts.overlap.gt(V::splat(self.deepest.share) * smaller)) & touching;
        let (normal_force, tangential) = (contacts.normal_force, contacts.tangential_force(&law));
        let arm_a = radius.0 - law.share_a * contacts.overlap;
        let arm_b = radius.1 - law.share_b * contacts.overlap;
        let (x, y) = (normal.0 * normal_force + normal.1 * tangential, normal.1 * normal_force - normal.0 * tangential);
        x.only(pushing).store(&mut pushes.force[0][lane..]);
        y.only(pushing).store(&mut pushes.force[1][lane..]);
        (arm_a * tangential).only(pushing).store(&mut pushes.torque_a[lane..]);
        (arm_b * tangential).only(pushing).store(&mut pushes.torque_b[lane..]);
        if deeper != 0 {
            self.note_deepest(place, deeper, (&geometry.a[lane..], &geometry.b[lane..]));
        }
        touching
    }

    /// Relative velocity along the normal that an impulse of one newton second makes, in 1/kg.
    #[inline(always)]
    fn mobility<V: Lanes>(&self, (a, b): (&[u32], &[u32]), normal: (V, V)) -> V {
        let bodies = &*self.sink.bodies;
        if bodies.lone_discs {
            return V::gather(&bodies.inverse_mass, a) + V::gather(&bodies.inverse_mass, b);
        }
        let (mut x, mut y, mut mobility) = ([0.0; BLOCK], [0.0; BLOCK], [0.0; BLOCK]);
        normal.0.store(&mut x);
        normal.1.store(&mut y);
        for lane in 0..V::COUNT {
            let along = DVec2::new(x[lane], y[lane]);
            let of = |atom: u32| End::of(bodies, atom).mobility(bodies, along);
            mobility[lane] = of(a[lane]) + of(b[lane]);
        }
        V::load(&mobility)
    }

    #[cold]
    fn note_deepest(&mut self, place: usize, deeper: u8, (a, b): (&[u32], &[u32])) {
        for lane in lanes(deeper) {
            let (a, b) = (End::of(self.sink.bodies, a[lane]), End::of(self.sink.bodies, b[lane]));
            let entity = &self.sink.bodies.entity;
            self.deepest.note(self.list.overlap[place + lane], a.radius.min(b.radius), self.time, || {
                (entity[a.body], entity[b.body])
            });
        }
    }

    /// Forces of a block go to the bodies, one pair after the other.
    #[inline(always)]
    fn push(&mut self, geometry: &Geometry, touching: u8, pushes: &Pushes) {
        if !self.plain {
            return self.push_and_account(geometry, touching, pushes);
        }
        let (a, b) = (&geometry.a, &geometry.b);
        let bodies = &mut *self.sink.bodies;
        let count = bodies.force.len();
        let (forces, torques) = (&mut bodies.force[..count], &mut bodies.torque[..count]);
        // Where most pairs touch the others push with nothing: cheaper than to guess which they are.
        let mut left = if touching.count_ones() >= FULL { u8::MAX } else { touching };
        while left != 0 {
            let lane = left.trailing_zeros() as usize;
            left &= left - 1;
            let (x, y) = (pushes.force[0][lane], pushes.force[1][lane]);
            let (a, b) = (a[lane] as usize, b[lane] as usize);
            forces[a].x -= x;
            forces[a].y -= y;
            torques[a] += pushes.torque_a[lane];
            forces[b].x += x;
            forces[b].y += y;
            torques[b] += pushes.torque_b[lane];
        }
    }

    /// The same where bodies have several atoms, where some do not move by forces, or where somebody asks for forces.
    fn push_and_account(&mut self, geometry: &Geometry, touching: u8, pushes: &Pushes) {
        let (first, a, b) = (BLOCK * geometry.block, &geometry.a, &geometry.b);
        for lane in lanes(touching) {
            let force = DVec2::new(pushes.force[0][lane], pushes.force[1][lane]);
            let (a, b) = (a[lane] as usize, b[lane] as usize);
            let bodies = &mut *self.sink.bodies;
            let (body_a, body_b) = (bodies.atom_body[a] as usize, bodies.atom_body[b] as usize);
            let (arm_a, arm_b) =
                (bodies.atom_position[a] - bodies.position[body_a], bodies.atom_position[b] - bodies.position[body_b]);
            bodies.force[body_a] -= force;
            bodies.torque[body_a] += pushes.torque_a[lane] - arm_a.perp_dot(force);
            bodies.force[body_b] += force;
            bodies.torque[body_b] += pushes.torque_b[lane] + arm_b.perp_dot(force);
            if self.sink.forces.is_some() || !(bodies.dynamic[body_a] && bodies.dynamic[body_b]) {
                let normal = DVec2::new(geometry.normal[0][lane], geometry.normal[1][lane]);
                let ends = (&End::of(bodies, a as u32), &End::of(bodies, b as u32));
                let law = self.laws.get(self.list.law[first + lane]);
                self.sink.account(ends, normal, self.list.overlap[first + lane], law, force);
            }
        }
    }
}
