//! Conservative advancement (Mirtich 1996) of contacts with walls and hulls: a pair waits as long as its gap cannot close.
//!
//! The engine evaluates a separate pair again when both sides can have closed the gap. Then its separating line
//! ([`super::remembered`]) mostly dismisses it, and gives the current distance.

use super::apply::{Sink, approach};
use super::contact::Losses;
use super::contact_list::{ContactList, lanes};
use super::follow::Touch;
use super::hull_kernel::Waiting;
use super::kernel::EvaluationTime;
use super::normal::{Approach, Mode, NormalForce};
use super::pair_law::LawTable;
use crate::contacts::geometry::{ContactEnd, PairGeometry};
use crate::contacts::{DeepestOverlap, Probe, Surface, SurfacePair};
use crate::world::{Bodies, NearestPoint};
use jostle_simd::BLOCK;

/// Share of a gap that any point may go before the pair is evaluated again. Both sides may move, so half of the gap
/// would close it. The rest is for rounding and for corrections by joints.
const WAY: f64 = 0.4;

/// Probes near surfaces follow their motion.
#[inline]
pub(super) fn follow_surfaces<N: NormalForce>(
    (list, pairs): (&mut ContactList, &[SurfacePair]),
    laws: &LawTable,
    (sink, losses): (&mut Sink, &mut Losses),
    deepest: &mut DeepestOverlap,
    evaluation_time: EvaluationTime,
) {
    if sink.bodies.hulls.is_empty() {
        follow_near::<N>((list, pairs), None, laws, (sink, losses), deepest, evaluation_time);
    } else {
        follow_with_hulls::<N>((list, pairs), laws, (sink, losses), deepest, evaluation_time);
    }
}

/// The same where bodies have hulls. Apart, so that scenes without them need no room for what waits.
#[inline(never)]
fn follow_with_hulls<N: NormalForce>(
    (list, pairs): (&mut ContactList, &[SurfacePair]),
    laws: &LawTable,
    (sink, losses): (&mut Sink, &mut Losses),
    deepest: &mut DeepestOverlap,
    evaluation_time: EvaluationTime,
) {
    let mut waiting = Waiting::default();
    list.tell_each();
    follow_near::<N>((list, pairs), Some(&mut waiting), laws, (sink, losses), deepest, evaluation_time);
    waiting.follow::<N>((list, pairs), laws, (sink, losses), deepest, evaluation_time);
}

/// Pairs that may touch follow their motion. Pairs that touch hulls join those `waiting`, which are empty without
/// hulls.
#[inline(always)]
fn follow_near<N: NormalForce>(
    (list, pairs): (&mut ContactList, &[SurfacePair]),
    mut waiting: Option<&mut Waiting>,
    laws: &LawTable,
    (sink, losses): (&mut Sink, &mut Losses),
    deepest: &mut DeepestOverlap,
    evaluation_time: EvaluationTime,
) {
    let path = evaluation_time.path;
    for number in 0..list.awake_blocks() {
        let block = list.awake_block(number);
        // No pair can have come near since its last evaluation.
        if list.is_early(block, path) {
            continue;
        }
        let own = &pairs[BLOCK * block..];
        // Those that are asleep may touch.
        let mut near = list.asleep_in(block) != 0;
        let mut gap = f64::INFINITY;
        let early = if waiting.is_some() { list.early_in(block, path) } else { 0 };
        for lane in lanes(list.awake_in(block) & !early) {
            let (pair, index) = (own[lane], BLOCK * block + lane);
            let Surface::Wall(wall) = pair.surface(sink.bodies) else {
                let Some(waiting) = &mut waiting else { continue };
                let found = look(list, index, pair, sink.bodies);
                match found {
                    Found::Apart(_) => {}
                    Found::Touch => {
                        let (law, sides) = (list.law[block][lane], list.remembered.sides[index]);
                        if waiting.add(sink.bodies, (index, pair), law, sides) {
                            waiting.follow::<N>((list, pairs), laws, (sink, losses), deepest, evaluation_time);
                        }
                    }
                    Found::End => {
                        waiting.follow::<N>((list, pairs), laws, (sink, losses), deepest, evaluation_time);
                        follow_end::<N>((list, index), pair, laws, (sink, losses), deepest, evaluation_time);
                    }
                }
                let way = if let Found::Apart(apart) = found { WAY * apart.max(0.0) } else { f64::NEG_INFINITY };
                near |= way == f64::NEG_INFINITY;
                gap = gap.min(way);
                list.each_due[block][lane] = path + way;
                continue;
            };
            let atom = pair.probe as usize;
            let (at, radius) = sink.bodies.meeting_wall(&sink.bodies.walls[wall], atom);
            let at = sink.bodies.passing(atom).map_or(at, |passing| passing.position);
            let apart = sink.bodies.nearest_on_wall(wall, atom, at).height - radius;
            if apart >= 0.0 && !list.is_touching(index) {
                // Half of it: more than rounding can take.
                gap = gap.min(0.5 * apart);
            } else {
                near = true;
                // A touching body does not fly.
                sink.bodies.bind(atom);
                follow_wall::<N>((list, index), (wall, pair.probe), laws, (sink, losses), deepest, evaluation_time);
            }
        }
        list.due[block] = if near { f64::NEG_INFINITY } else { path + gap.min(list.way_left(block, early, path)) };
    }
}

/// The result of the check of a pair.
#[derive(Clone, Copy)]
enum Found {
    /// They do not touch, and are at least so many metres apart.
    Apart(f64),
    /// An atom touches a hull, or did.
    Touch,
    /// An end of a wall does.
    End,
}

/// Looks whether a probe near a hull touches it, or did.
#[inline(always)]
fn look(list: &mut ContactList, index: usize, pair: SurfacePair, bodies: &Bodies) -> Found {
    let is_touching = list.is_touching(index);
    if let Probe::Atom(atom) = pair.probe(bodies) {
        if is_touching {
            return Found::Touch;
        }
        let gap = list.remembered.gap(index, bodies, atom);
        if gap > 0.0 {
            return Found::Apart(gap);
        }
    }
    look_closely((list, is_touching), index, pair, bodies)
}

#[inline(never)]
fn look_closely(
    (list, is_touching): (&mut ContactList, bool),
    index: usize,
    pair: SurfacePair,
    bodies: &Bodies,
) -> Found {
    let (geometry, apart) = PairGeometry::near(bodies, index, pair);
    if geometry.overlap <= 0.0 && !is_touching {
        list.remembered.part(index, bodies, pair, (&geometry, apart));
        return Found::Apart(apart);
    }
    if let Probe::End(..) = pair.probe(bodies) { Found::End } else { Found::Touch }
}

/// A hull near an end of a wall follows its motion.
fn follow_end<N: NormalForce>(
    (list, index): (&mut ContactList, usize),
    pair: SurfacePair,
    laws: &LawTable,
    (sink, losses): (&mut Sink, &mut Losses),
    deepest: &mut DeepestOverlap,
    EvaluationTime { time, elapsed, .. }: EvaluationTime,
) {
    let geometry = PairGeometry::surface(sink.bodies, index, pair);
    let mut contact = list.get(index);
    let law = laws.get(contact.law);
    let approach = if N::DEPENDS_ON_VELOCITY { geometry.approach(sink.bodies) } else { Approach::default() };
    let b = &geometry.pair.b;
    let (displacement, turn) = b.displacement(sink.bodies);
    let normal = geometry.pair.normal;
    let touch = Touch {
        normal: (normal.x, normal.y),
        overlap: geometry.overlap,
        approach,
        displacement: (displacement.x, displacement.y),
        swing: geometry.turned(sink.bodies, displacement),
        rolled_a: (0.0, 0.0),
        rolled_b: (b.radius, turn),
    };
    let lost = contact.follow::<N>(law, &touch, elapsed);
    losses.friction += lost.friction;
    losses.inelasticity += lost.inelasticity;
    list.set(index, &contact);
    if contact.mode != Mode::Open {
        deepest.note(contact.overlap, pair.size(sink.bodies), time, || geometry.pair.entities(sink.bodies));
        geometry.pair.push(sink, law, geometry.overlap, contact.force(law, normal));
    }
}

/// An atom near a wall follows its motion.
#[inline]
fn follow_wall<N: NormalForce>(
    (list, index): (&mut ContactList, usize),
    (wall, atom): (usize, u32),
    laws: &LawTable,
    (sink, losses): (&mut Sink, &mut Losses),
    deepest: &mut DeepestOverlap,
    EvaluationTime { time, elapsed, .. }: EvaluationTime,
) {
    let (end, place_of_atom) = ContactEnd::at_wall(sink.bodies, wall, atom);
    let NearestPoint { height, normal, distance } = sink.bodies.nearest_on_wall(wall, atom as usize, place_of_atom);
    let wall = sink.bodies.whole_wall(wall);
    let mut contact = list.get(index);
    let law = laws.get(contact.law);
    let (mut displacement, turn) = end.displacement(sink.bodies);
    if let Some(&belt) = sink.bodies.belts.get(wall) {
        displacement -= belt * elapsed;
    }
    let approach = if N::DEPENDS_ON_VELOCITY { approach(sink.bodies, None, &end, normal) } else { Approach::default() };
    let touch = Touch {
        normal: (normal.x, normal.y),
        overlap: end.radius - height,
        approach,
        displacement: (displacement.x, displacement.y),
        swing: if (0.0..f64::INFINITY).contains(&distance) { normal.perp_dot(displacement) / distance } else { 0.0 },
        rolled_a: (0.0, 0.0),
        rolled_b: (end.radius, turn),
    };
    let lost = contact.follow::<N>(law, &touch, elapsed);
    losses.friction += lost.friction;
    losses.inelasticity += lost.inelasticity;
    list.set(index, &contact);
    if contact.mode != Mode::Open {
        let size = sink.bodies.size_of_atom(atom as usize);
        deepest.note(contact.overlap, size, time, || (sink.bodies.entity[end.body], sink.bodies.walls[wall].entity));
        sink.wall_pushes(&end, wall as u32, normal, height, contact.force(law, normal));
    }
}
