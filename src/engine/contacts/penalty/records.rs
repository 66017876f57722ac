//! Records of atoms for the kernel of contacts, a cache line each.
//!
//! If an evaluation needed those of all discs, they are lent to the bodies. The code that moves all bodies has all data
//! of a record at hand, and fills it in. To read the data again from eight lists takes half as long as the move.

use std::ops::Range;

use super::contact_list::ContactList;
use super::kernel::FEWEST;
use crate::contacts::AtomPair;
use crate::contacts::geometry::ContactEnd;
use crate::world::Bodies;
use crate::world::chunk::parts_of;
use crate::world::packed::Moved;
use jostle_simd::{BLOCK, Record};
use serde::{Deserialize, Serialize};

/// Evaluations in which all records are lent again before a check whether all are still needed. The check visits each
/// block of pairs, which takes a fiftieth of a tick. A few useless fillings in 64 cost less.
const TRUSTED: u32 = 64;

/// The data of each atom for contacts: position, displacement and turn since the last accepted state, radius and
/// velocity.
#[derive(Debug, Default, Serialize, Deserialize)]
pub(super) struct Records {
    pub list: Vec<Record>,
    /// The atoms that move and that some pair may need, in order; empty: all.
    needed: Vec<u32>,
    /// There are records of those alone, in their order.
    sparse: bool,
    /// The last evaluation needed all of them.
    all: bool,
    /// Whether no body flew in it, so that the next move includes all bodies.
    pub lendable: bool,
    /// Those that were lent have come back with the present state.
    current: bool,
    /// Evaluations since it was seen that all are needed.
    trusted: u32,
}

/// The atoms that move and that these pairs need, in order, or none in place of most. And whether records of those alone suffice.
fn needs(bodies: &Bodies, pairs: &[AtomPair]) -> (Vec<u32>, bool) {
    let mut needed = vec![false; bodies.atom_count()];
    for pair in pairs {
        needed[pair.a as usize] = true;
        needed[pair.b as usize] = true;
    }
    let moves = |atom: usize| bodies.moves[bodies.atom_body(atom)];
    let count = (0..needed.len()).filter(|&atom| needed[atom] && moves(atom)).count();
    // If most are needed, visiting all in order is faster.
    let few = 4 * count < 3 * needed.len();
    let sparse = few && bodies.lone_discs && bodies.all_dynamic;
    let mut list = Vec::new();
    if few || !bodies.lone_discs {
        list.reserve_exact(count);
        list.extend((0..needed.len()).filter(|&atom| needed[atom] && moves(atom)).map(|atom| atom as u32));
    }
    (list, sparse)
}

impl Records {
    /// Whether the records are those that these pairs need, and each pair finds its own among them.
    pub fn fits(&self, bodies: &Bodies, pairs: &[AtomPair], contacts: &ContactList) -> bool {
        let Self { list, needed, sparse, .. } = self;
        let lent = &bodies.records;
        let listed = if lent.is_empty() { list.len() } else { lent.len() };
        let count = if *sparse { needed.len() } else { bodies.atom_count() };
        if pairs.is_empty() {
            return needed.is_empty() && (listed == 0 || listed == count);
        }
        let own =
            |record: u32, atom: u32| if *sparse { needed.get(record as usize) == Some(&atom) } else { record == atom };
        let found = |(index, pair): (usize, &AtomPair)| {
            let (a, b) = contacts.pairs.side(index / BLOCK).get(index % BLOCK);
            own(a, pair.a) && own(b, pair.b)
        };
        needs(bodies, pairs) == (needed.clone(), *sparse)
            && listed == count
            && contacts.pairs.records_fit(listed)
            && pairs.iter().enumerate().all(found)
    }

    /// After an evaluation: lends them to the bodies until the next one, if all were needed. It requires that no other
    /// code changes bodies between the step and that evaluation, because such changes would be missed.
    pub fn lend(&mut self, bodies: &mut Bodies) {
        let lendable = std::mem::take(&mut self.lendable);
        if lendable && self.all && bodies.asleep.is_empty() && matches!(bodies.moved, Moved::For(_)) {
            bodies.records = std::mem::take(&mut self.list);
        }
    }

    /// Takes back the lent records.
    pub fn take_back(&mut self, bodies: &mut Bodies) {
        if !bodies.records.is_empty() {
            self.list = std::mem::take(&mut bodies.records);
        }
        self.current = std::mem::take(&mut bodies.recorded);
    }

    /// Takes up new lists of pairs.
    pub fn prepare(&mut self, bodies: &Bodies, pairs: &[AtomPair], contacts: &mut ContactList) {
        self.list.clear();
        (self.all, self.current) = (false, false);
        (self.needed, self.sparse) = needs(bodies, pairs);
        if self.sparse {
            let mut index = vec![0; bodies.atom_count()];
            self.needed.iter().zip(0..).for_each(|(&atom, number)| index[atom as usize] = number);
            contacts.pairs.find_records(&index, self.needed.len());
            self.list.reserve_exact(self.needed.len());
            self.list.extend(self.needed.iter().map(|&atom| record(bodies, atom as usize)));
            return;
        }
        // Those of bodies at rest or asleep are not filled in again.
        self.list.reserve_exact(bodies.atom_count());
        self.list.extend((0..bodies.atom_count()).map(|atom| record(bodies, atom)));
    }

    /// Fills in the current state for all pairs that have to be evaluated; see [`super::kernel::EvaluationTime::path`].
    pub fn update(&mut self, bodies: &Bodies, pairs: &[AtomPair], list: &ContactList, path: f64) {
        let is_due = |block: &usize| !list.is_early(*block, path);
        let blocks = || (0..list.awake_blocks()).map(|number| list.awake_block(number)).filter(is_due);
        let all = bodies.lone_discs && self.needed.is_empty();
        let atoms = if all { self.list.len() } else { self.needed.len() };
        let current = std::mem::take(&mut self.current);
        self.trusted += 1;
        if current && self.trusted < TRUSTED {
            return;
        }
        let few = 2 * BLOCK * blocks().count() < atoms;
        (self.all, self.trusted) = (all && !few, 0);
        if current {
            return;
        }
        if few {
            for first in blocks().map(|block| BLOCK * block) {
                for (lane, pair) in pairs[first..pairs.len().min(first + BLOCK)].iter().enumerate() {
                    let (a, b) = list.pairs.side(first / BLOCK).get(lane);
                    self.list[a as usize] = record(bodies, pair.a as usize);
                    self.list[b as usize] = record(bodies, pair.b as usize);
                }
            }
            return;
        }
        let each = self.list.len().div_ceil(parts_of(atoms, FEWEST)).next_multiple_of(BLOCK);
        let parts = self.list.chunks_mut(each).enumerate().map(|(number, part)| (number * each, part)).collect();
        let (needed, sparse) = (&self.needed, self.sparse);
        bodies.threads.each(parts, |(first, part): (usize, &mut [Record])| {
            let atoms = first..first + part.len();
            if all && bodies.asleep.is_empty() {
                fill(bodies, atoms, part);
            } else if all {
                for number in bodies.awake_blocks_within(atoms) {
                    let atoms = bodies.awake_block(number);
                    fill(bodies, atoms.clone(), &mut part[atoms.start - first..atoms.end - first]);
                }
            } else if sparse {
                for (own, &atom) in part.iter_mut().zip(&needed[atoms]) {
                    *own = record(bodies, atom as usize);
                }
            } else {
                let index = |atom: usize| needed.partition_point(|&needed| (needed as usize) < atom);
                for &atom in &needed[index(atoms.start)..index(atoms.end)] {
                    part[atom as usize - first] = record(bodies, atom as usize);
                }
            }
        });
    }
}

/// The records of consecutive lone discs, as [`record`] makes them. Lists are cut to the discs, so that indices are
/// checked once.
#[inline]
fn fill(bodies: &Bodies, discs: Range<usize>, records: &mut [Record]) {
    let Some((velocity, spin, time)) = bodies.drift_of(discs.clone()) else {
        return discs.zip(records).for_each(|(disc, own)| *own = record(bodies, disc));
    };
    let count = records.len();
    let (place, now) = (&bodies.position[discs.clone()][..count], &bodies.velocity[discs.clone()][..count]);
    let (moves, radius) = (&bodies.moves[discs.clone()][..count], &bodies.atom_radius[discs][..count]);
    let (velocity, spin) = (&velocity[..count], &spin[..count]);
    for disc in 0..count {
        let time = if moves[disc] { time } else { 0.0 };
        let (place, now, moved, turn) = (place[disc], now[disc], velocity[disc] * time, spin[disc] * time);
        records[disc] = Record([place.x, place.y, moved.x, moved.y, now.x, now.y, turn, radius[disc]]);
    }
}

/// The current data of an atom for contacts.
#[inline(always)]
pub(super) fn record(bodies: &Bodies, atom: usize) -> Record {
    if bodies.lone_discs {
        let (place, velocity, radius) = (bodies.position[atom], bodies.velocity[atom], bodies.atom_radius[atom]);
        let (moved, turn) = bodies.displacement(atom);
        return Record([place.x, place.y, moved.x, moved.y, velocity.x, velocity.y, turn, radius]);
    }
    let end = ContactEnd::of(bodies, atom as u32);
    let (place, (moved, turn), velocity) = (bodies.atom_place(atom), end.displacement(bodies), end.velocity(bodies));
    Record([place.x, place.y, moved.x, moved.y, velocity.x, velocity.y, turn, end.radius])
}
