//! Overlaps at the start: springs that begin compressed, with energy that the scene does not supply. They are noted
//! once, before the first tick, so that `jostle check` reports them too.

use bevy_ecs::prelude::*;
use glam::DVec2;
use jostle_shapes::distance;

use super::{cells, hulls, lines, most_pairs};
use crate::scene::SceneError;
use crate::tick::pairs::Surface;
use crate::tick::{LoadErrors, Notes, State};
use crate::world::line::BEHIND;
use crate::world::{Bodies, Name};
use jostle_language::numbers::number;

/// Overlaps of at most this share of the smaller radius are not reported. Contacts at rest bear their loads like that.
const SHARE: f64 = 0.05;
/// Pairs that are counted for the note: what lies in one heap has billions.
const MOST_PAIRS: usize = 1 << 22;
/// Pairs of atoms that are looked at, at most: a second or two are enough.
const MOST_LOOKS: usize = 1 << 30;
/// Pairs of a side and a corner of hulls that are looked at, at most. One takes some nanoseconds.
const MOST_SIDES: usize = 1 << 28;

/// The deepest overlap before the first tick, if it deserves a report.
#[derive(Resource, Clone, Copy, Debug, PartialEq)]
pub struct OverlapAtStart {
    /// In metres.
    pub overlap: f64,
    /// As a share of the smaller radius.
    pub share: f64,
    /// The two bodies, or the body and the wall.
    pub between: (Entity, Entity),
}

/// A body, and a body behind it or a wall.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Pair {
    Bodies(u32, u32),
    Wall(u32, u32),
}

/// The overlapping pairs.
#[derive(Default)]
struct Overlaps {
    /// More pairs of atoms than this are too many.
    most: usize,
    pairs: Vec<Pair>,
    /// The number of pairs of atoms in them.
    atoms: usize,
    /// Whether there may be more.
    more: bool,
    /// Pairs of a side and a corner of hulls that were looked at.
    looks: usize,
    /// The deepest, as a share of the smaller radius: the share, the overlap in metres, and the pair.
    deepest: Option<(f64, f64, Pair)>,
}

impl Overlaps {
    fn of(bodies: &Bodies) -> Self {
        let mut found = Self { most: most_pairs(bodies), ..Self::default() };
        let some_round = (0..bodies.atom_count()).any(|atom| !bodies.is_corner(atom));
        let complete = !some_round
            || cells::overlapping(bodies, MOST_LOOKS, |pair| {
                let [a, b] = [pair.a, pair.b].map(|atom| atom as usize);
                if bodies.is_corner(a) || bodies.is_corner(b) {
                    return true;
                }
                let overlap = pair.reach(bodies) - bodies.atom_place(a).distance(bodies.atom_place(b));
                let whose = Pair::Bodies(bodies.atom_body(a) as u32, bodies.atom_body(b) as u32);
                found.add(overlap, bodies.atom_radius[a].min(bodies.atom_radius[b]), whose)
            });
        let touching: Vec<usize> = (0..bodies.len()).filter(|&b| bodies.dynamic[b] && bodies.collides[b]).collect();
        let looked_at = if touching.is_empty() { 0 } else { MOST_LOOKS / touching.len() };
        for index in bodies.single_walls().take(looked_at) {
            let wall = &bodies.walls[index];
            let height = |at: DVec2| wall.nearest(at).height;
            let near = touching.iter().filter(|&&body| height(bodies.position[body]) < bodies.extent(body));
            for atom in near.flat_map(|&body| bodies.atoms_of(body)).filter(|&atom| bodies.probes(atom)) {
                let (at, radius) = bodies.meeting_wall(wall, atom);
                let whose = Pair::Wall(bodies.atom_body(atom) as u32, index as u32);
                found.add(radius - height(at), bodies.size_of_atom(atom), whose);
            }
        }
        lines::each_place(bodies, (0.0, BEHIND), &[], |pair, height| {
            let atom = pair.probe as usize;
            let line = pair.wall(bodies).unwrap_or_default();
            let whose = Pair::Wall(bodies.atom_body(atom) as u32, line as u32);
            found.add(bodies.atom_radius[atom] - height, bodies.size_of_atom(atom), whose);
        });
        let apart = super::indices_apart(bodies);
        // Bars may cross without a corner of one inside the other.
        hulls::each_pair_of_hulls(bodies, &apart, found.most, |a, b| {
            let [first, second] = [a, b].map(|hull| &bodies.hulls[hull]);
            if found.is_full() || !found.may_look(first.hull.corners().len() * second.hull.corners().len()) {
                return;
            }
            let [pose, other] = [first, second].map(|packed| bodies.pose_with_hulls(packed.body as usize));
            let overlap = -distance(&first.hull, &pose, &second.hull, &other);
            found.add(overlap, first.half_width.min(second.half_width), Pair::Bodies(first.body, second.body));
        });
        if found.is_full() {
            return found;
        }
        // Corners beside hulls take as long as the hulls themselves.
        let complete_hulls = found.may_look(0)
            && hulls::each_pair(bodies, 0.0, (&apart, found.most), |pair| {
                let sides = match pair.surface(bodies) {
                    Surface::Hull(hull) => bodies.hulls[hull].hull.corners().len(),
                    Surface::Wall(_) => 1,
                };
                if !found.may_look(sides) {
                    return;
                }
                let whose = match (pair.bodies(bodies), pair.wall(bodies)) {
                    ((Some(a), b), _) => Pair::Bodies(a.min(b) as u32, a.max(b) as u32),
                    ((None, body), wall) => Pair::Wall(body as u32, wall.unwrap_or_default() as u32),
                };
                found.add(pair.overlap(bodies), pair.size(bodies), whose);
            });
        let single = bodies.single_walls().count();
        found.more |= !complete || !complete_hulls || single > looked_at && !touching.is_empty();
        found.pairs.sort_unstable();
        found.pairs.dedup();
        found
    }

    /// Adds an overlap; returns whether there is room for more.
    fn add(&mut self, overlap: f64, smaller_radius: f64, pair: Pair) -> bool {
        let share = overlap / smaller_radius;
        if share > SHARE {
            self.atoms += 1;
            // Atoms of one body are consecutive, so most duplicates are found here.
            self.more |= self.pairs.len() == MOST_PAIRS;
            if self.pairs.last() != Some(&pair) && !self.more {
                self.pairs.push(pair);
            }
            if self.deepest.is_none_or(|(most, ..)| share > most) {
                self.deepest = Some((share, overlap, pair));
            }
        }
        !self.is_full()
    }

    /// Whether so many more looks are worth their time.
    fn may_look(&mut self, looks: usize) -> bool {
        self.looks = self.looks.saturating_add(looks);
        self.more |= self.looks > MOST_SIDES;
        self.looks <= MOST_SIDES
    }

    /// Whether there are too many for a run. Others change nothing of that.
    fn is_full(&self) -> bool {
        self.atoms > self.most
    }
}

/// Notes the overlapping pairs on the card.
pub(super) fn note_overlaps(world: &mut World) {
    let bodies = &world.resource::<State>().bodies;
    let Overlaps { most, pairs, atoms, more, deepest, .. } = Overlaps::of(bodies);
    let Some((share, overlap, deepest)) = deepest else { return };
    if atoms > most {
        let message =
            format!("at the start more than {most} pairs of atoms overlap: so many contacts do not fit into memory");
        let help = "move them apart, or give `collides: false` to bodies that are not to touch";
        let error = SceneError::new("bodies", message).with_help(help);
        return world.get_resource_or_init::<LoadErrors>().0.push(error);
    }
    let [a, b] = match deepest {
        Pair::Bodies(a, b) => [bodies.entity[a as usize], bodies.entity[b as usize]],
        Pair::Wall(body, wall) => [bodies.entity[body as usize], bodies.walls[wall as usize].entity],
    };
    let begin = OverlapAtStart { overlap, share, between: (a, b) };
    let [a, b] = [a, b].map(|entity| world.get::<Name>(entity).map_or_else(|| "(unnamed)".to_owned(), Name::to_string));
    let (overlap, percent) = (number(overlap), number((share * 1000.0).round() / 10.0));
    let who = match pairs.len() {
        1 => format!("`{a}` and `{b}` overlap by {overlap} m, {percent} % of the smaller radius"),
        many => format!(
            "{}{many} pairs overlap by more than {} % of the smaller radius. The deepest are `{a}` and `{b}` by {overlap} m \
             ({percent} %)",
            if more { "at least " } else { "" },
            100.0 * SHARE
        ),
    };
    let note = format!(
        "at the start {who}. Their compressed contacts push bodies apart, unless a load presses them together. To prevent it, \
         move them apart, make them smaller, or give them `collides: false`"
    );
    world.resource_mut::<Notes>().0.push(note);
    world.insert_resource(begin);
}
