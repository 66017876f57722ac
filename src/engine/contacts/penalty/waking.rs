//! Bodies at rest that wake because they touch one that moves: breadth-first search over contacts (Moore 1959).
//!
//! The search finds forces for whole islands, and a contact that is held follows no law. So rest ends for all bodies that contacts
//! connect to one that moves through others at rest. It ends behind no body that moves by no force.

use super::contact_list::ContactList;
use super::rest::Rest;
use crate::contacts::CandidatePairs;
use crate::world::Bodies;

/// The pairs of each body, and the bodies whose neighbours have yet to wake. The memory is kept for the next time.
#[derive(Default)]
pub(super) struct Waking {
    /// The lists of pairs that are sorted here: their version, and how many bodies and pairs they have.
    lists: (u64, usize, usize),
    /// For each body the index in `pairs` of its first pair, and their number at the end.
    first: Vec<u32>,
    /// Places of pairs of two bodies, sorted by body: those of atoms, then those at surfaces.
    pairs: Vec<u32>,
    woken: Vec<usize>,
}

/// The lists of contacts with their pairs.
#[derive(Clone, Copy)]
pub(super) struct Lists<'a> {
    pub pairs: &'a CandidatePairs,
    pub atoms: &'a ContactList,
    pub surfaces: &'a ContactList,
    pub bodies: &'a Bodies,
}

impl Lists<'_> {
    fn count(&self) -> usize {
        self.pairs.atoms.len() + self.pairs.surfaces.len()
    }

    /// The bodies of the pair at a place, if there are two.
    #[inline]
    fn ends(&self, place: usize) -> Option<(usize, usize)> {
        let Some(pair) = self.pairs.atoms.get(place) else {
            let (a, b) = self.pairs.surfaces[place - self.pairs.atoms.len()].bodies(self.bodies);
            return Some((a?, b));
        };
        Some((self.bodies.atom_body(pair.a as usize), self.bodies.atom_body(pair.b as usize)))
    }

    fn touches(&self, place: usize) -> bool {
        let atoms = self.pairs.atoms.len();
        if place < atoms { self.atoms.is_touching(place) } else { self.surfaces.is_touching(place - atoms) }
    }

    /// Places of contacts that touch and do not sleep: no other belongs to a body that moves.
    fn awake(&self) -> impl Iterator<Item = usize> + '_ {
        let atoms = self.pairs.atoms.len();
        self.atoms.awake_touching().chain(self.surfaces.awake_touching().map(move |index| atoms + index))
    }
}

impl Waking {
    /// Wakes the bodies at rest that touch one of those that move, and so on through all that wake. Returns whether there were any.
    pub fn spread(&mut self, lists: Lists, rest: &mut Rest, moves: impl Fn(usize, &Rest) -> bool) -> bool {
        self.woken.clear();
        for (a, b) in lists.awake().filter_map(|place| lists.ends(place)) {
            if moves(a, rest) && rest.wake(b) {
                self.woken.push(b);
            } else if moves(b, rest) && rest.wake(a) {
                self.woken.push(a);
            }
        }
        if self.woken.is_empty() {
            return false;
        }
        self.sort(lists);
        let mut next = 0;
        while let Some(&body) = self.woken.get(next) {
            next += 1;
            for &place in &self.pairs[self.first[body] as usize..self.first[body + 1] as usize] {
                let Some((a, b)) = lists.ends(place as usize).filter(|_| lists.touches(place as usize)) else {
                    continue;
                };
                let other = if a == body { b } else { a };
                if rest.wake(other) {
                    self.woken.push(other);
                }
            }
        }
        true
    }

    /// Sorts the pairs by body, unless they are those of the last time (counting sort).
    fn sort(&mut self, lists: Lists) {
        let told = (lists.pairs.version, lists.bodies.len(), lists.count());
        if std::mem::replace(&mut self.lists, told) == told {
            return;
        }
        let Self { first, pairs, .. } = self;
        first.clear();
        first.resize(lists.bodies.len() + 1, 0);
        let all = || (0..lists.count()).filter_map(|place| Some((place, lists.ends(place)?)));
        for (_, (a, b)) in all() {
            first[a] += 1;
            first[b] += 1;
        }
        let mut sum = 0;
        for first in &mut *first {
            sum += *first;
            *first = sum;
        }
        pairs.clear();
        pairs.resize(sum as usize, 0);
        for (place, (a, b)) in all() {
            for body in [a, b] {
                first[body] -= 1;
                pairs[first[body] as usize] = place as u32;
            }
        }
    }
}
