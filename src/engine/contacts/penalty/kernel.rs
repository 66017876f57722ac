//! The vectorised kernel of contacts between atoms. Candidate pairs are followed eight at a time, in the lanes of the
//! processor. Their forces are added to the bodies pair by pair in canonical order.
//!
//! The data of an atom for a pair is one [`Record`], a cache line ([`super::records`]). The sixteen lines of eight
//! pairs are loaded and transposed in registers.

use std::marker::PhantomData;

use glam::DVec2;

use super::apply::{Sink, account};
use super::contact::Losses;
use super::contact_list::{ContactList, ListPart, Phases, lanes};
use super::dashpot::Damping;
use super::follow::{Followed, Touch};
use super::normal::{Approach, NormalForce};
use super::pair_law::{LawTable, PairLaw};
use crate::contacts::geometry::{ContactEnd, arms};
use crate::contacts::{AtomPair, ContactForces, DeepestOverlap};
use crate::tick::Rates;
use crate::world::Bodies;
use crate::world::chunk::{cut, parts_of};
use jostle_simd::{BLOCK, Kernel, Lanes, Level, PairBlock, PairedRecords, Pushes, Record};

/// The other data of an evaluation.
#[derive(Clone, Copy)]
pub(super) struct EvaluationTime {
    /// The greatest possible way of any point of a body since the beginning, in metres; NaN if it is unknown.
    pub path: f64,
    /// Time of the state in seconds.
    pub time: f64,
    /// Seconds since the state that was last accepted.
    pub elapsed: f64,
}

/// Pairs of the smallest part: with fewer it costs more to hand them out than they do.
pub(super) const FEWEST: usize = 16384;

/// All candidate pairs of atoms follow the motion of their sides, in parts if there are many. Each part adds forces to
/// the bodies that are first in its pairs. Forces on other bodies wait until all parts are done, and are added in the
/// order of pairs.
pub(super) fn follow_pairs<N: NormalForce>(
    records: &[Record],
    (pairs, group_ends): (&[AtomPair], [usize; 2]),
    list: &mut ContactList,
    laws: &LawTable,
    sink: &mut Sink,
    deepest: &mut DeepestOverlap,
    evaluation_time: EvaluationTime,
) -> Losses {
    // If each block has only a few pairs to be evaluated, they are evaluated one by one.
    let sparse = list.is_sparse();
    let level = if sparse { Level::Scalar } else { sink.bodies.level };
    let plain = sink.bodies.lone_discs && sink.bodies.all_dynamic && sink.forces.is_none();
    let count = parts_of(pairs.len(), FEWEST);
    let (mut force, mut torque) = (std::mem::take(&mut sink.bodies.force), std::mem::take(&mut sink.bodies.torque));
    let bodies = &*sink.bodies;
    let start = Found { rates: *sink.rates, deepest: *deepest, ..Found::default() };
    let follow = |(list, share, found): (ListPart, Share, Found), forces: Option<&mut ContactForces>| {
        let (sides, law) = (list.pairs.records(records), PhantomData::<N>);
        let pairs = Pairs { sides, list, laws, bodies, plain, sparse, evaluation_time, law };
        jostle_simd::run(level, FollowPairs { pairs, share, found, forces })
    };
    let mut losses = Losses::default();
    if count == 1 {
        let share = Share { first: 0, force: &mut force, torque: &mut torque };
        let found = follow((list.whole(), share, start), sink.forces.as_deref_mut());
        (*sink.rates, *deepest, losses) = (found.rates, found.deepest, found.losses);
        (sink.bodies.force, sink.bodies.torque) = (force, torque);
        return losses;
    }
    *sink.rates = Rates::default();
    let mut found = Vec::new();
    // Each group is sorted, so that parts of it have bodies of their own.
    let [touching, close] = group_ends.map(|end| end.div_ceil(BLOCK));
    for range in [0..touching, touching..close, close..pairs.len().div_ceil(BLOCK)] {
        let blocks = range.len().div_ceil(parts_of(BLOCK * range.len(), FEWEST)).max(1);
        let (mut forces, mut torques) = (&mut force[..], &mut torque[..]);
        let mut parts = Vec::new();
        for list in list.parts(range.clone(), blocks) {
            let end = list.first + blocks;
            let first = bodies.len() - forces.len();
            let next = pairs.get(BLOCK * end).filter(|_| end < range.end);
            let last = next.map_or(bodies.len(), |pair| bodies.atom_body(pair.a as usize));
            let share = Share { first, force: cut(&mut forces, last - first), torque: cut(&mut torques, last - first) };
            let found = if list.first == 0 { start.clone() } else { Found { deepest: *deepest, ..Found::default() } };
            parts.push((list, share, found));
        }
        let mut done: Vec<Option<Found>> = parts.iter().map(|_| None).collect();
        let parts = parts.into_iter().zip(&mut done);
        if sink.forces.is_some() {
            parts.for_each(|(part, done)| *done = Some(follow(part, sink.forces.as_deref_mut())));
        } else {
            bodies.threads.each(parts.collect(), |(part, done)| *done = Some(follow(part, None)));
        }
        for mut part in done.into_iter().flatten() {
            for (body, own, turning) in std::mem::take(&mut part.others) {
                force[body as usize] += own;
                torque[body as usize] += turning;
            }
            found.push(part);
        }
    }
    (sink.bodies.force, sink.bodies.torque) = (force, torque);
    for part in found {
        sink.rates.add(&part.rates);
        losses.friction += part.losses.friction;
        losses.inelasticity += part.losses.inelasticity;
        deepest.merge(&part.deepest);
    }
    losses
}

/// Forces of bodies in a row.
struct Share<'a> {
    /// The first of them.
    first: usize,
    force: &'a mut [DVec2],
    torque: &'a mut [f64],
}

/// The results of a part of the pairs, beside forces on its bodies.
#[derive(Clone, Default)]
struct Found {
    /// Forces and torques for bodies of other parts.
    others: Vec<(u32, DVec2, f64)>,
    rates: Rates,
    deepest: DeepestOverlap,
    losses: Losses,
}

/// Pairs of a part follow the motion of their sides.
struct FollowPairs<'a, N> {
    pairs: Pairs<'a, N>,
    share: Share<'a>,
    found: Found,
    forces: Option<&'a mut ContactForces>,
}

/// The inputs for following the pairs of a part. Only inlined functions may take it by reference. Then the addresses of
/// its lists stay in registers.
struct Pairs<'a, N> {
    sides: PairedRecords<'a>,
    list: ListPart<'a>,
    laws: &'a LawTable,
    /// Without forces: those are shared out.
    bodies: &'a Bodies,
    /// Whether bodies are discs that move by forces, and no sensor needs single forces.
    plain: bool,
    /// Few pairs of each block have to be looked at, and others are left out.
    sparse: bool,
    evaluation_time: EvaluationTime,
    law: PhantomData<N>,
}

/// Touching pairs of a block from which on all its pairs are pushed.
const FULL: u32 = 4;

/// Partial sums of losses, in J.
#[derive(Default)]
#[repr(C, align(64))]
struct PartialLosses {
    friction: [f64; BLOCK],
    inelasticity: [f64; BLOCK],
}

/// The bits that belong to lanes.
#[inline(always)]
fn lanes_of<V: Lanes>() -> u8 {
    ((1_u16 << V::COUNT) - 1) as u8
}

/// Whether no bit of the lanes from `lane` on is set, and they are not the whole block.
#[inline(always)]
fn none_of<V: Lanes>(bits: u8, lane: usize) -> bool {
    V::COUNT < BLOCK && (bits >> lane) & lanes_of::<V>() == 0
}

/// The bits of a block with those of some lanes replaced.
#[inline(always)]
fn written<V: Lanes>(old: u8, mask: V::Mask, lane: usize) -> u8 {
    (old & !(lanes_of::<V>() << lane)) | ((V::bits(mask) & lanes_of::<V>()) << lane)
}

#[inline(always)]
fn add<V: Lanes>(sums: &mut [f64], terms: V) {
    (V::load(sums) + terms).store(sums);
}

/// The positions and displacements of the sides of the pairs of a block. Lists begin at cache lines.
#[derive(Clone, Copy, Default)]
#[repr(C, align(64))]
struct Geometry {
    normal: [[f64; BLOCK]; 2],
    overlap: [f64; BLOCK],
    displacement: [[f64; BLOCK]; 2],
    swing: [f64; BLOCK],
    radius: [[f64; BLOCK]; 2],
    turn: [[f64; BLOCK]; 2],
    parting: [f64; BLOCK],
    block: usize,
    /// The pairs that exist, are not asleep, and are near enough to touch or did.
    among: u8,
}

/// Blocks whose geometry is computed before their laws are applied. So the processor computes the roots and quotients
/// of several blocks at the same time.
const AHEAD: usize = 4;

/// The number of blocks by which the fetch of records runs ahead: the time of some two hundred nanoseconds.
const FETCHED: usize = 10;

impl<N: NormalForce> Kernel for FollowPairs<'_, N> {
    type Output = Found;

    #[inline(always)]
    fn run<V: Lanes>(self) -> Found {
        let Pairs { list, laws, .. } = &self.pairs;
        match list.only_law {
            Some(law) => {
                let law = laws.lanes::<V>(&[law; BLOCK]);
                if self.pairs.plain && list.is_whole() {
                    self.all::<V, true, true>(&law)
                } else {
                    self.all::<V, true, false>(&law)
                }
            }
            None if list.phases.is_empty() => self.found,
            None => {
                let law = laws.lanes::<V>(&[0; BLOCK]);
                self.all::<V, false, false>(&law)
            }
        }
    }
}

impl<N: NormalForce> FollowPairs<'_, N> {
    /// Follows all pairs; `law` is that of all of them if there is only one. `PLAIN`: they are [plain](Pairs::plain),
    /// and all of them have to be evaluated.
    #[inline(always)]
    fn all<V: Lanes, const ONE_LAW: bool, const PLAIN: bool>(self, law: &PairLaw<V>) -> Found {
        let Self { mut pairs, share: Share { first, force, torque }, mut found, mut forces } = self;
        let (plain, sparse) = (PLAIN || pairs.plain, !PLAIN && pairs.sparse);
        let mut lost = PartialLosses::default();
        let mut pushes = Pushes::NONE;
        let mut ahead = [Geometry::default(); AHEAD];
        let (blocks, mut number) = (if PLAIN { pairs.list.phases.len() } else { pairs.list.awake_blocks() }, 0);
        while number < blocks {
            let together = AHEAD.min(blocks - number);
            let mut near = 0;
            for _ in 0..together {
                let block = if PLAIN { number } else { pairs.list.awake_block(number) };
                number += 1;
                // No pair can have come near since its last evaluation.
                if pairs.list.is_early(block, pairs.evaluation_time.path) {
                    continue;
                }
                pairs.sides.fetch(pairs.list.first + block + FETCHED);
                pairs.look::<V, PLAIN>(block, &mut ahead[near]);
                near += usize::from(ahead[near].among != 0);
            }
            for geometry in &ahead[..near] {
                let (mut lane, mut touching, mut deeper) = (0, 0, 0);
                let deepest = (found.deepest.in_share.share, found.deepest.in_meters.overlap);
                while lane < BLOCK {
                    if !(sparse && none_of::<V>(geometry.among, lane)) {
                        let (touch, deep) =
                            pairs.follow::<V, ONE_LAW>(lane, geometry, law, deepest, &mut pushes, &mut lost);
                        touching |= touch << lane;
                        deeper |= deep << lane;
                    }
                    lane += V::COUNT;
                }
                let block = geometry.block;
                let sides = pairs.sides.pairs(pairs.list.first + block);
                if deeper != 0 {
                    let overlaps = pairs.list.histories[block].overlap;
                    note_deepest(&mut found.deepest, pairs.bodies, sides, deeper, overlaps, pairs.evaluation_time.time);
                }
                if touching == 0 {
                    continue;
                }
                let share = Share { first, force: &mut *force, torque: &mut *torque };
                if !plain {
                    let laws = (pairs.laws, pairs.list.law[block], pairs.list.histories[block].overlap);
                    let sink = (share, &mut found, forces.as_deref_mut());
                    push_and_account(pairs.bodies, sides, geometry, touching, &pushes, laws, sink);
                    continue;
                }
                // If most pairs touch, the others push with zero force. That is cheaper than to select them.
                let lanes = if touching.count_ones() >= FULL && !sparse { u8::MAX } else { touching };
                let Share { first, force, torque } = share;
                if !pushes.give(&pairs.sides, pairs.list.first + block, lanes, (first, force, torque)) {
                    push_among_parts(Share { first, force, torque }, &mut found, sides, touching, &pushes);
                }
            }
        }
        let sum = |partial: &[f64; BLOCK]| partial.iter().fold(0.0, |sum, part| sum + part);
        found.losses = Losses { friction: sum(&lost.friction), inelasticity: sum(&lost.inelasticity) };
        found
    }
}

impl<N: NormalForce> Pairs<'_, N> {
    /// Computes the positions of the sides of the pairs of a block.
    #[inline(always)]
    fn look<V: Lanes, const PLAIN: bool>(&mut self, block: usize, geometry: &mut Geometry) {
        let sparse = !PLAIN && self.sparse;
        let there = if PLAIN { self.list.there_in(block) } else { self.list.awake_in(block) };
        let (touched, mut among) = (self.list.phases[block].touching(), 0);
        let mut lane = 0;
        while lane < BLOCK {
            if sparse && none_of::<V>(there, lane) {
                lane += V::COUNT;
                continue;
            }
            let ([x, y, dx, dy, u, v, turn_b, radius_b], [turn_a, radius_a]) =
                self.sides.load::<V>(self.list.first + block, lane);
            let squared = x * x + y * y;
            let reach = radius_a + radius_b;
            // In this form NaN counts as near.
            let away = !squared.lt(reach * reach) & squared.lt(V::splat(f64::INFINITY));
            let near = V::mask((there & touched) >> lane) | (V::mask(there >> lane) & !away);
            among |= (V::bits(near) & lanes_of::<V>()) << lane;
            let distance = squared.sqrt();
            let inverse = V::splat(1.0) / distance;
            // Centres in one place have no direction: up is as good as any.
            let apart = V::splat(0.0).lt(distance);
            let normal = ((x * inverse).only(apart), V::select(apart, y * inverse, V::splat(1.0)));
            let swing = ((dy * normal.0 - dx * normal.1) * inverse).only(apart);
            normal.0.store(&mut geometry.normal[0][lane..]);
            normal.1.store(&mut geometry.normal[1][lane..]);
            (reach - distance).store(&mut geometry.overlap[lane..]);
            dx.store(&mut geometry.displacement[0][lane..]);
            dy.store(&mut geometry.displacement[1][lane..]);
            swing.store(&mut geometry.swing[lane..]);
            radius_a.store(&mut geometry.radius[0][lane..]);
            radius_b.store(&mut geometry.radius[1][lane..]);
            turn_a.store(&mut geometry.turn[0][lane..]);
            turn_b.store(&mut geometry.turn[1][lane..]);
            if N::DEPENDS_ON_VELOCITY {
                (u * normal.0 + v * normal.1).store(&mut geometry.parting[lane..]);
            }
            lane += V::COUNT;
        }
        (geometry.block, geometry.among) = (block, among);
        self.list.due[block] = f64::NEG_INFINITY;
        if among == 0 {
            // Both sides may come nearer.
            let mut gap = f64::INFINITY;
            for lane in 0..self.list.count_in(block) {
                gap = gap.min(-geometry.overlap[lane]);
            }
            self.list.due[block] = self.evaluation_time.path + 0.5 * gap;
        }
    }

    /// Follows the pairs from `lane` of a block on. Returns which of them touch.
    #[inline(always)]
    fn follow<V: Lanes, const ONE_LAW: bool>(
        &mut self,
        lane: usize,
        geometry: &Geometry,
        only: &PairLaw<V>,
        (share, meters): (f64, f64),
        pushes: &mut Pushes,
        lost: &mut PartialLosses,
    ) -> (u8, u8) {
        let block = geometry.block;
        let phases = self.list.phases[block];
        let among = V::mask(geometry.among >> lane);
        let (loading, unloading) = (V::mask(phases.loading >> lane), V::mask(phases.unloading >> lane));
        let mut law = if ONE_LAW { *only } else { self.laws.lanes(&self.list.law[block][lane..]) };
        let normal = (V::load(&geometry.normal[0][lane..]), V::load(&geometry.normal[1][lane..]));
        let mut approach = Approach { parting: V::splat(0.0), mobility: V::splat(0.0) };
        if N::DEPENDS_ON_VELOCITY {
            approach.parting = V::load(&geometry.parting[lane..]);
            if !self.list.damping.is_empty() {
                law.damping = Damping::Coefficient(V::load(&self.list.damping[block][lane..]));
            } else if law.damping.depends_on_mobility() {
                approach.mobility = self.mobility(block, lane, normal);
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
        let history = &mut self.list.histories[block];
        let mut contacts = Followed::<V> {
            overlap: V::load(&history.overlap[lane..]),
            normal_force: V::load(&history.normal_force[lane..]),
            elongation: V::load(&history.elongation[lane..]),
            held: if phases.slides == 0 { V::splat(0.0) } else { V::load(&self.list.held[block][lane..]) },
            loading,
            unloading,
            slips: V::mask(phases.slips >> lane),
            slides: V::mask(phases.slides >> lane),
        };
        let losses = contacts.follow::<N>(&law, &touch, self.evaluation_time.elapsed, among);
        add(&mut lost.friction[lane..], losses.friction);
        add(&mut lost.inelasticity[lane..], losses.inelasticity);
        contacts.overlap.store(&mut history.overlap[lane..]);
        contacts.normal_force.store(&mut history.normal_force[lane..]);
        contacts.elongation.store(&mut history.elongation[lane..]);
        // Held forces count only if some contact slides.
        if phases.slides != 0 {
            contacts.held.store(&mut self.list.held[block][lane..]);
        }
        self.list.phases[block] = Phases {
            loading: written::<V>(phases.loading, contacts.loading, lane),
            unloading: written::<V>(phases.unloading, contacts.unloading, lane),
            slips: written::<V>(phases.slips, contacts.slips, lane),
            slides: written::<V>(phases.slides, contacts.slides, lane),
        };
        let pushing = (contacts.loading | contacts.unloading) & among;
        let touching = V::bits(pushing) & lanes_of::<V>();
        let smaller = V::select(radius.0.lt(radius.1), radius.0, radius.1);
        let deeper = contacts.overlap.gt(V::splat(share) * smaller) | contacts.overlap.gt(V::splat(meters));
        let deeper = V::bits(deeper) & touching;
        let (normal_force, tangential) = (contacts.normal_force, contacts.tangential_force(&law));
        let arm_a = radius.0 - law.share_a * contacts.overlap;
        let arm_b = radius.1 - law.share_b * contacts.overlap;
        let (x, y) = (normal.0 * normal_force + normal.1 * tangential, normal.1 * normal_force - normal.0 * tangential);
        V::store_pairs(x.only(pushing), y.only(pushing), &mut pushes.force[lane..]);
        (arm_a * tangential).only(pushing).store(&mut pushes.torque_first[lane..]);
        (arm_b * tangential).only(pushing).store(&mut pushes.torque_second[lane..]);
        (touching, deeper)
    }

    /// Relative velocity along the normal that an impulse of one newton second makes, in 1/kg.
    #[inline(always)]
    fn mobility<V: Lanes>(&self, block: usize, first: usize, normal: (V, V)) -> V {
        let (bodies, pairs) = (self.bodies, self.sides.pairs(self.list.first + block));
        let (mut x, mut y, mut mobility) = ([0.0; BLOCK], [0.0; BLOCK], [0.0; BLOCK]);
        normal.0.store(&mut x);
        normal.1.store(&mut y);
        for lane in 0..V::COUNT {
            let along = DVec2::new(x[lane], y[lane]);
            let of = |atom: u32| ContactEnd::of(bodies, atom).mobility(bodies, along);
            let (a, b) = pairs.get(first + lane);
            mobility[lane] = of(a) + of(b);
        }
        V::load(&mobility)
    }
}

#[cold]
fn note_deepest(
    deepest: &mut DeepestOverlap,
    bodies: &Bodies,
    sides: &PairBlock,
    deeper: u8,
    overlaps: [f64; BLOCK],
    time: f64,
) {
    for lane in lanes(deeper) {
        let (a, b) = sides.get(lane);
        let (a, b) = (ContactEnd::of(bodies, a), ContactEnd::of(bodies, b));
        let entity = &bodies.entity;
        deepest.note(overlaps[lane], a.radius.min(b.radius), time, || (entity[a.body], entity[b.body]));
    }
}

/// Adds the forces of a block to the bodies, pair by pair, if some side lies in another part. Otherwise [`Pushes::give`] adds
/// them.
#[cold]
fn push_among_parts(mut share: Share, found: &mut Found, sides: &PairBlock, touching: u8, pushes: &Pushes) {
    for lane in lanes(touching) {
        let ((a, b), force) = (sides.get(lane), pushes.force[lane]);
        share.give(found, a, -force, pushes.torque_first[lane]);
        share.give(found, b, force, pushes.torque_second[lane]);
    }
}

impl Share<'_> {
    /// A body of the part gets a force and a torque at once, one of another part later.
    fn give(&mut self, found: &mut Found, body: u32, force: DVec2, torque: f64) {
        let own = (body as usize).wrapping_sub(self.first);
        if let (Some(forces), Some(torques)) = (self.force.get_mut(own), self.torque.get_mut(own)) {
            *forces += force;
            *torques += torque;
        } else {
            found.others.push((body, force, torque));
        }
    }
}

/// Adds the forces of a block to the bodies, one pair after the other. It serves bodies of several atoms, bodies that
/// do not move by forces, and sensors of forces.
#[inline(never)]
fn push_and_account(
    bodies: &Bodies,
    sides: &PairBlock,
    geometry: &Geometry,
    touching: u8,
    pushes: &Pushes,
    (laws, law, overlaps): (&LawTable, [u32; BLOCK], [f64; BLOCK]),
    (mut share, found, mut forces): (Share, &mut Found, Option<&mut ContactForces>),
) {
    for lane in lanes(touching) {
        let (force, (a, b)) = (pushes.force[lane], sides.get(lane));
        let (a, b) = (a as usize, b as usize);
        let (body_a, body_b) = (bodies.atom_body(a), bodies.atom_body(b));
        let (arm_a, arm_b) =
            (bodies.atom_place(a) - bodies.position[body_a], bodies.atom_place(b) - bodies.position[body_b]);
        share.give(found, body_a as u32, -force, pushes.torque_first[lane] - arm_a.perp_dot(force));
        share.give(found, body_b as u32, force, pushes.torque_second[lane] + arm_b.perp_dot(force));
        if forces.is_some() || !(bodies.dynamic[body_a] && bodies.dynamic[body_b]) {
            let normal = DVec2::new(geometry.normal[0][lane], geometry.normal[1][lane]);
            let ends = (&ContactEnd::of(bodies, a as u32), &ContactEnd::of(bodies, b as u32));
            let arms = arms(ends, normal, overlaps[lane], laws.get(law[lane]).shares());
            account(bodies, (&mut found.rates, forces.as_deref_mut()), ends, arms, force);
        }
    }
}
