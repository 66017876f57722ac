//! The history of all candidate pairs, one list for each quantity. The kernel of contacts (`kernel.rs`) reads and
//! writes several pairs at a time.
//!
//! Modes are bits, a byte for eight contacts, which serve as masks directly.

mod saved;

use std::ops::{Deref, DerefMut, Range};

use super::contact::Contact;
use super::coulomb::{Grip, Slider};
use super::normal::Mode;
use super::remembered::Remembered;
use crate::tick::pairs::NEW;
use jostle_simd::{BLOCK, PairBlocks};
use serde::{Deserialize, Serialize};

/// The modes of eight contacts: a bit each in every byte.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct Phases {
    /// Set while loading, and while held.
    pub loading: u8,
    /// Set while unloading, and while held.
    pub unloading: u8,
    /// Set while slipping, and while held along the tangent.
    pub slips: u8,
    /// Set while sliding as a stage of a step, and while held along the tangent.
    pub slides: u8,
}

impl Phases {
    /// Those that touch.
    #[inline(always)]
    pub fn touching(self) -> u8 {
        self.loading | self.unloading
    }

    /// Those that are held along their normal or their tangent.
    #[inline(always)]
    fn held(self) -> u8 {
        self.loading & self.unloading | self.touching() & self.slides
    }

    pub fn mode(self, lane: usize) -> Mode {
        match ((self.loading >> lane) & 1, (self.unloading >> lane) & 1) {
            (0, 0) => Mode::Open,
            (_, 0) => Mode::Loading,
            (0, _) => Mode::Unloading,
            _ => Mode::Hold,
        }
    }

    pub fn grip(self, lane: usize) -> Grip {
        match ((self.slips >> lane) & 1, (self.slides >> lane) & 1) {
            (0, 0) => Grip::Stick,
            (_, 0) => Grip::Slip,
            (0, _) => Grip::Slide,
            _ => Grip::Hold,
        }
    }

    fn set(&mut self, lane: usize, mode: Mode, grip: Grip) {
        let write = |byte: &mut u8, bit: bool| *byte = *byte & !(1 << lane) | u8::from(bit) << lane;
        write(&mut self.loading, matches!(mode, Mode::Loading | Mode::Hold));
        write(&mut self.unloading, matches!(mode, Mode::Unloading | Mode::Hold));
        write(&mut self.slips, matches!(grip, Grip::Slip | Grip::Hold));
        write(&mut self.slides, matches!(grip, Grip::Slide | Grip::Hold));
    }
}

/// Numbers of eight contacts, each quantity side by side.
#[derive(Clone, Copy, Debug, Default, Serialize, Deserialize)]
#[repr(C, align(64))]
pub(super) struct Histories {
    pub overlap: [f64; BLOCK],
    pub normal_force: [f64; BLOCK],
    pub elongation: [f64; BLOCK],
}

/// Contacts of candidate pairs, in the order of the pairs. Lists are as long as whole blocks of eight.
#[derive(Debug, Default, Serialize, Deserialize)]
pub struct ContactList {
    len: usize,
    /// The pairs of atoms; empty in a list of walls.
    pub(super) pairs: PairBlocks,
    pub(super) law: Vec<[u32; BLOCK]>,
    /// The law of all of them, if there is one.
    pub(super) only_law: Option<u32>,
    pub(super) histories: Vec<Histories>,
    /// Forces that are held.
    pub(super) held: Vec<[f64; BLOCK]>,
    /// Damping in N s/m, if it is constant during the life of the pairs; else empty.
    pub(super) damping: Vec<[f64; BLOCK]>,
    pub(super) phases: Vec<Phases>,
    /// For each block the [`Bodies::path`](crate::world::Bodies::path) up to which none of its pairs can begin to touch.
    pub(super) due: Vec<f64>,
    /// The same for each pair; empty if it is unknown.
    pub(super) each_due: Vec<[f64; BLOCK]>,
    /// The memory of each pair with a hull.
    pub(super) remembered: Remembered,
    /// A bit for each pair that an evaluation has to include, touching ones among them, if these are few. Empty: all
    /// pairs.
    looked_at: Vec<u8>,
    /// Blocks in which some are, in order; only then.
    watched: Vec<u32>,
    /// A bit for each contact of sleeping bodies; empty if there is none.
    pub(super) asleep: Vec<u8>,
    /// Blocks in which some contact is not asleep; only where some are.
    awake: Vec<u32>,
    /// The number of sleeping contacts that touch.
    asleep_touching: usize,
}

/// Blocks that are looked at together where something is rarely found.
const TOGETHER: usize = 64;

impl ContactList {
    /// The number of them.
    pub fn len(&self) -> usize {
        self.len
    }

    /// Whether there are no contacts.
    pub fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// The contact at a place.
    #[inline]
    pub fn get(&self, index: usize) -> Contact {
        assert!(index < self.len, "no contact {index} among {}", self.len);
        let (block, lane) = (index / BLOCK, index % BLOCK);
        let (phases, history) = (self.phases[block], &self.histories[block]);
        let (elongation, held) = (history.elongation[lane], self.held[block][lane]);
        Contact {
            law: self.law[block][lane],
            mode: phases.mode(lane),
            overlap: history.overlap[lane],
            normal_force: history.normal_force[lane],
            tangential: Slider { elongation, held, grip: phases.grip(lane) },
        }
    }

    /// Replaces the contact at a place.
    #[inline]
    pub fn set(&mut self, index: usize, contact: &Contact) {
        assert!(index < self.len, "no contact {index} among {}", self.len);
        let Contact { law, mode, overlap, normal_force, tangential: Slider { elongation, held, grip } } = *contact;
        let (block, lane) = (index / BLOCK, index % BLOCK);
        let history = &mut self.histories[block];
        history.overlap[lane] = overlap;
        history.normal_force[lane] = normal_force;
        history.elongation[lane] = elongation;
        self.law[block][lane] = law;
        self.only_law = self.only_law.filter(|only| *only == law);
        self.held[block][lane] = held;
        self.phases[block].set(lane, mode, grip);
    }

    /// The contact at an index, for a change. It returns to the list when the loan ends.
    #[inline]
    pub fn edit(&mut self, index: usize) -> Edited<'_> {
        Edited { contact: self.get(index), index, list: self }
    }

    /// All in order.
    pub fn iter(&self) -> impl Iterator<Item = Contact> + '_ {
        (0..self.len).map(|index| self.get(index))
    }

    /// Places of those that touch, in order.
    pub fn touching(&self) -> impl Iterator<Item = usize> + Clone + '_ {
        let count = if self.is_sparse() { self.watched.len() } else { self.phases.len() };
        let blocks = (0..count).map(|number| if self.is_sparse() { self.watched[number] as usize } else { number });
        let blocks = blocks.map(|block| (block, self.phases[block].touching())).filter(|(_, touching)| *touching != 0);
        blocks.flat_map(|(block, touching)| lanes(touching).map(move |lane| BLOCK * block + lane))
    }

    /// Whether the contact at a place touches.
    #[inline]
    pub fn is_touching(&self, index: usize) -> bool {
        self.phases[index / BLOCK].touching() >> (index % BLOCK) & 1 != 0
    }

    /// The number of those that touch.
    pub fn touching_count(&self) -> usize {
        self.asleep_touching + self.awake_touching_count()
    }

    /// The number of contacts that touch and are not asleep.
    pub(super) fn awake_touching_count(&self) -> usize {
        if self.asleep.is_empty() && !self.is_sparse() {
            // Bits of several blocks are counted at once.
            let bits = |blocks: &[Phases]| {
                blocks.iter().fold(0_u64, |bits, phases| bits << BLOCK | u64::from(phases.touching()))
            };
            return self.phases.chunks(BLOCK).map(|blocks| bits(blocks).count_ones() as usize).sum();
        }
        let awake = |block: usize| self.phases[block].touching() & !self.asleep_in(block);
        (0..self.awake_blocks()).map(|number| awake(self.awake_block(number)).count_ones() as usize).sum()
    }

    /// Places of those that touch and are not asleep, in order.
    pub(super) fn awake_touching(&self) -> impl Iterator<Item = usize> + '_ {
        let blocks = (0..self.awake_blocks()).map(|number| self.awake_block(number));
        blocks.filter(|block| self.phases[*block].touching() != 0).flat_map(|block| {
            lanes(self.phases[block].touching() & !self.asleep_in(block)).map(move |lane| BLOCK * block + lane)
        })
    }

    /// The number of those that touch, are not asleep and are `counted`; no more once there are more than `enough`.
    pub(super) fn count_touching(&self, enough: usize, counted: impl Fn(usize) -> bool) -> usize {
        let mut count = 0;
        for number in 0..self.awake_blocks() {
            let block = self.awake_block(number);
            for lane in lanes(self.phases[block].touching() & !self.asleep_in(block)) {
                count += usize::from(counted(BLOCK * block + lane));
            }
            if count > enough {
                break;
            }
        }
        count
    }

    /// The blocks that need work, where that is not all.
    #[inline(always)]
    fn few(&self) -> Option<&[u32]> {
        if !self.asleep.is_empty() { Some(&self.awake) } else { self.is_sparse().then_some(&self.watched) }
    }

    /// Blocks in which some contact is not asleep, nor put off: how many there are.
    #[inline(always)]
    pub(super) fn awake_blocks(&self) -> usize {
        self.few().map_or(self.phases.len(), <[u32]>::len)
    }

    /// One of them.
    #[inline(always)]
    pub(super) fn awake_block(&self, number: usize) -> usize {
        self.few().map_or(number, |blocks| blocks[number] as usize)
    }

    /// Whether none of the pairs of a block can have begun to touch.
    #[inline(always)]
    pub(super) fn is_early(&self, block: usize, path: f64) -> bool {
        path < self.due[block]
    }

    /// The contacts of a block that are asleep.
    #[inline(always)]
    pub(super) fn asleep_in(&self, block: usize) -> u8 {
        self.asleep.get(block).copied().unwrap_or(0)
    }

    /// The contacts of a block that exist and are not asleep.
    #[inline(always)]
    pub(super) fn awake_in(&self, block: usize) -> u8 {
        there(self.len - BLOCK * block) & !self.asleep_in(block)
    }

    /// Places of those that are held along their normal or their tangent and are not asleep, in order.
    pub(super) fn awake_held(&self) -> impl Iterator<Item = usize> + '_ {
        let held = |block: usize| self.phases[block].held();
        let blocks = self.awake_blocks();
        let together = move |first: usize| first..blocks.min(first + TOGETHER);
        // Mostly there is none. Many consecutive blocks are checked at once.
        let some_are = move |first: &usize| {
            let held = |bits: u8, phases: &Phases| bits | phases.held();
            self.few().is_some() || self.phases[together(*first)].iter().fold(0, held) != 0
        };
        let numbers = (0..blocks).step_by(TOGETHER).filter(some_are).flat_map(together);
        let found = numbers.map(|number| self.awake_block(number)).filter(move |block| held(*block) != 0);
        found.flat_map(move |block| lanes(held(block) & !self.asleep_in(block)).map(move |lane| BLOCK * block + lane))
    }

    /// Whether the contact at a place is asleep.
    #[inline]
    pub(super) fn is_asleep(&self, index: usize) -> bool {
        self.asleep_in(index / BLOCK) >> (index % BLOCK) & 1 != 0
    }

    /// Evaluations look at all pairs again.
    pub(super) fn look_at_all(&mut self) {
        self.looked_at.clear();
        self.watched.clear();
        self.due.fill(f64::NEG_INFINITY);
        self.each_due.clear();
    }

    /// Excludes all pairs from the next evaluation, except those added by [`ContactList::look_at`].
    pub(super) fn look_at_none(&mut self) {
        self.looked_at.resize(self.phases.len(), 0);
        self.watched.clear();
    }

    /// Includes these pairs of a block in the next evaluation, behind all others that were included.
    pub(super) fn look_at(&mut self, block: usize, pairs: u8) {
        if pairs != 0 {
            (self.looked_at[block], self.due[block]) = (pairs, f64::NEG_INFINITY);
            self.watched.push(block as u32);
        }
    }

    /// Whether evaluations look at some pairs alone.
    pub(super) fn is_sparse(&self) -> bool {
        !self.looked_at.is_empty()
    }

    /// Wakes all.
    pub(super) fn wake_all(&mut self) {
        self.asleep.clear();
        self.awake.clear();
        self.asleep_touching = 0;
    }

    /// Puts the contacts at the indices of `sleeps` to sleep, and wakes all others.
    pub(super) fn lay_asleep(&mut self, sleeps: impl Fn(usize) -> bool) {
        self.wake_all();
        self.look_at_all();
        let bits = |block: usize| {
            let indices = BLOCK * block..self.len.min(BLOCK * block + BLOCK);
            indices.rev().fold(0, |bits, index| bits << 1 | u8::from(sleeps(index)))
        };
        self.asleep.extend((0..self.phases.len()).map(bits));
        for (block, (asleep, phases)) in self.asleep.iter().zip(&self.phases).enumerate() {
            self.asleep_touching += (phases.touching() & asleep).count_ones() as usize;
            let there = self.len - BLOCK * block;
            let all = if there < BLOCK { (1 << there) - 1 } else { u8::MAX };
            if asleep & all != all {
                self.awake.push(block as u32);
            }
        }
    }

    /// Becomes the list of other pairs. Each has the history of the given old index, or none ([`NEW`]). If the bodies
    /// are the `same` as before, it keeps its law and its memory.
    pub(super) fn carry(&mut self, before: &[u32], same: bool, mut law: impl FnMut(usize) -> u32) {
        let old = std::mem::take(self);
        self.resize(before.len());
        let remembers = same && !old.remembered.records.is_empty();
        if remembers {
            self.tell_each();
            self.remembered.resize(before.len());
        }
        for (index, &before) in before.iter().enumerate() {
            let history = if before == NEW { Contact::default() } else { old.get(before as usize) };
            let known = before != NEW;
            let law = if same && known { history.law } else { law(index) };
            self.set(index, &Contact { law, ..history });
            if remembers && known {
                let ((block, lane), (from, old_lane)) = (split(index), split(before as usize));
                self.remembered.carry(index, (&old.remembered, before as usize));
                if let Some(due) = old.each_due.get(from) {
                    self.each_due[block][lane] = due[old_lane];
                }
            }
        }
        let first = self.law.first().map(|laws| laws[0]);
        self.only_law =
            first.filter(|first| (0..self.len).all(|index| self.law[index / BLOCK][index % BLOCK] == *first));
    }

    /// Makes it as long as whole blocks, filled with open contacts.
    pub(super) fn resize(&mut self, len: usize) {
        let blocks = len.div_ceil(BLOCK);
        self.len = len;
        self.law.resize(blocks, [0; BLOCK]);
        self.histories.resize(blocks, Histories::default());
        self.held.resize(blocks, [0.0; BLOCK]);
        self.phases.resize(blocks, Phases::default());
        self.due.resize(blocks, f64::NEG_INFINITY);
    }
}

/// The block of a place, and the lane in it.
#[inline(always)]
pub(super) fn split(index: usize) -> (usize, usize) {
    (index / BLOCK, index % BLOCK)
}

/// The bits of a block from whose beginning on there are so many contacts.
#[inline(always)]
fn there(count: usize) -> u8 {
    (u16::MAX >> (2 * BLOCK - count.min(BLOCK))) as u8
}

/// The contacts of some blocks in a row. Blocks are counted from the first of them.
pub(super) struct ListPart<'a> {
    /// The first block, counted in the whole list.
    pub first: usize,
    /// Of the whole list.
    pub pairs: &'a PairBlocks,
    /// The number of them in the whole list.
    len: usize,
    pub law: &'a [[u32; BLOCK]],
    pub only_law: Option<u32>,
    pub damping: &'a [[f64; BLOCK]],
    pub histories: &'a mut [Histories],
    pub held: &'a mut [[f64; BLOCK]],
    pub phases: &'a mut [Phases],
    pub due: &'a mut [f64],
    looked_at: &'a [u8],
    asleep: &'a [u8],
    /// Counted in the whole list.
    awake: Option<&'a [u32]>,
}

impl ListPart<'_> {
    /// Blocks in which some contact is not asleep: how many there are.
    #[inline(always)]
    pub fn awake_blocks(&self) -> usize {
        self.awake.map_or(self.phases.len(), <[u32]>::len)
    }

    /// One of them.
    #[inline(always)]
    pub fn awake_block(&self, number: usize) -> usize {
        self.awake.map_or(number, |awake| awake[number] as usize - self.first)
    }

    /// Whether none of the pairs of a block can have begun to touch.
    #[inline(always)]
    pub fn is_early(&self, block: usize, path: f64) -> bool {
        path < self.due[block]
    }

    /// The number of contacts that a block has.
    #[inline(always)]
    pub fn count_in(&self, block: usize) -> usize {
        BLOCK.min(self.len - BLOCK * (self.first + block))
    }

    /// Whether all have to be looked at.
    pub fn is_whole(&self) -> bool {
        self.asleep.is_empty() && self.looked_at.is_empty() && self.awake.is_none()
    }

    /// The contacts of a block that exist.
    #[inline(always)]
    pub fn there_in(&self, block: usize) -> u8 {
        there(self.count_in(block))
    }

    /// The contacts of a block that exist, are not asleep, and need a look.
    #[inline(always)]
    pub fn awake_in(&self, block: usize) -> u8 {
        let looked_at = self.looked_at.get(block).copied().unwrap_or(u8::MAX);
        self.there_in(block) & looked_at & !self.asleep.get(block).copied().unwrap_or(0)
    }
}

impl ContactList {
    /// The list as one part.
    pub(super) fn whole(&mut self) -> ListPart<'_> {
        let sparse = self.is_sparse();
        ListPart {
            first: 0,
            pairs: &self.pairs,
            len: self.len,
            law: &self.law,
            only_law: self.only_law,
            damping: &self.damping,
            histories: &mut self.histories,
            held: &mut self.held,
            phases: &mut self.phases,
            due: &mut self.due,
            looked_at: &self.looked_at,
            asleep: &self.asleep,
            awake: if !self.asleep.is_empty() { Some(&self.awake) } else { sparse.then_some(&self.watched) },
        }
    }

    /// Some blocks in a row in parts of so many; the last may have fewer.
    pub(super) fn parts(&mut self, range: Range<usize>, blocks: usize) -> impl Iterator<Item = ListPart<'_>> {
        let (count, begin, end) = (range.len().div_ceil(blocks), range.start, range.end);
        let of = |len: usize| range.start.min(len)..range.end.min(len);
        let (law, damping) = (&self.law[of(self.law.len())], &self.damping[of(self.damping.len())]);
        let (looked_at, asleep) = (&self.looked_at[of(self.looked_at.len())], &self.asleep[of(self.asleep.len())]);
        let (mut law, mut damping) = (law.chunks(blocks), damping.chunks(blocks));
        let (mut looked_at, mut asleep) = (looked_at.chunks(blocks), asleep.chunks(blocks));
        let mut histories = self.histories[range.clone()].chunks_mut(blocks);
        let mut held = self.held[range.clone()].chunks_mut(blocks);
        let mut phases = self.phases[range.clone()].chunks_mut(blocks);
        let mut due = self.due[range.clone()].chunks_mut(blocks);
        let (some_asleep, sparse) = (!self.asleep.is_empty(), !self.looked_at.is_empty());
        let awake = if some_asleep { &self.awake } else { &self.watched };
        let (pairs, len, only_law) = (&self.pairs, self.len, self.only_law);
        (0..count).map(move |number| {
            let first = begin + number * blocks;
            let index = |block: usize| awake.partition_point(|&awake| (awake as usize) < block);
            ListPart {
                first,
                pairs,
                len,
                law: law.next().unwrap_or_default(),
                only_law,
                damping: damping.next().unwrap_or_default(),
                histories: histories.next().unwrap_or_default(),
                held: held.next().unwrap_or_default(),
                phases: phases.next().unwrap_or_default(),
                due: due.next().unwrap_or_default(),
                looked_at: looked_at.next().unwrap_or_default(),
                asleep: asleep.next().unwrap_or_default(),
                // The last part may have fewer blocks, and others follow behind the range.
                awake: (some_asleep || sparse).then(|| &awake[index(first)..index(end.min(first + blocks))]),
            }
        })
    }
}

/// The places of the bits that are set, the lowest first.
#[inline(always)]
pub(super) fn lanes(mut bits: u8) -> impl Iterator<Item = usize> + Clone {
    std::iter::from_fn(move || {
        let lane = bits.trailing_zeros() as usize;
        bits &= bits.wrapping_sub(1);
        (lane < BLOCK).then_some(lane)
    })
}

/// A contact on loan.
pub struct Edited<'a> {
    contact: Contact,
    index: usize,
    list: &'a mut ContactList,
}

impl Deref for Edited<'_> {
    type Target = Contact;

    #[inline]
    fn deref(&self) -> &Contact {
        &self.contact
    }
}

impl DerefMut for Edited<'_> {
    #[inline]
    fn deref_mut(&mut self) -> &mut Contact {
        &mut self.contact
    }
}

impl Drop for Edited<'_> {
    #[inline]
    fn drop(&mut self) {
        self.list.set(self.index, &self.contact);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_block_that_needs_work_is_in_one_part() {
        let mut list = ContactList::default();
        list.resize(12 * BLOCK);
        // All of block 4 sleeps. Seven blocks in parts of three: two blocks are missing of the last, and other blocks follow.
        list.lay_asleep(|index| index / BLOCK == 4);
        let parts = list.parts(1..8, 3);
        let found: Vec<usize> = parts
            .flat_map(|part| {
                let own: Vec<usize> = (0..part.awake_blocks()).map(|number| part.awake_block(number)).collect();
                assert!(own.iter().all(|block| *block < part.due.len()), "{own:?} of {}", part.due.len());
                own.into_iter().map(move |block| part.first + block)
            })
            .collect();
        assert_eq!(found, [1, 2, 3, 5, 6, 7]);
    }

    #[test]
    fn contacts_come_back_as_they_were_put() {
        let mut list = ContactList::default();
        list.resize(11);
        let modes = [Mode::Open, Mode::Loading, Mode::Unloading, Mode::Hold];
        let grips = [Grip::Stick, Grip::Slip, Grip::Slide, Grip::Hold];
        let contact = |index: usize| Contact {
            law: index as u32,
            mode: modes[index % 4],
            overlap: 0.5 * index as f64,
            normal_force: 1.5,
            tangential: Slider { elongation: -2.0, held: 3.0, grip: grips[(index / 4) % 4] },
        };
        for index in 0..11 {
            list.set(index, &contact(index));
        }
        assert!((0..11).all(|index| list.get(index) == contact(index)));
        assert_eq!(list.touching().collect::<Vec<_>>(), [1, 2, 3, 5, 6, 7, 9, 10]);
        list.edit(10).mode = Mode::Open;
        assert_eq!(list.get(10), Contact { mode: Mode::Open, ..contact(10) });
        assert_eq!(list.get(9), contact(9));
    }
}
