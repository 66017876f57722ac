//! Evaluation of contacts one by one: the time at which each is due, and histories at scattered indices.

use super::contact_list::{ContactList, Phases, lanes, split};
use super::follow::Followed;
use jostle_simd::{BLOCK, Lanes};

impl ContactList {
    /// The pairs of a block that cannot have begun to touch, as far as it is known.
    #[inline(always)]
    pub(super) fn early_in(&self, block: usize, path: f64) -> u8 {
        let bit = |lane: usize, due: &f64| u8::from(path < *due) << lane;
        let bits = |due: &[f64; BLOCK]| due.iter().enumerate().fold(0, |bits, (lane, due)| bits | bit(lane, due));
        self.each_due.get(block).map_or(0, bits)
    }

    /// The way in metres that any point may go until one of the `early` pairs of a block can touch.
    #[inline]
    pub(super) fn way_left(&self, block: usize, early: u8, path: f64) -> f64 {
        lanes(early).fold(f64::INFINITY, |left, lane| left.min(self.each_due[block][lane] - path))
    }

    /// Makes room for the time at which each pair can begin to touch.
    pub(super) fn tell_each(&mut self) {
        self.each_due.resize(self.phases.len(), [f64::NEG_INFINITY; BLOCK]);
    }

    /// The histories of contacts at some places.
    #[inline(always)]
    pub(super) fn gather<V: Lanes>(&self, indices: &[u32]) -> Followed<V> {
        let mut numbers = [[0.0; BLOCK]; 4];
        let mut bits = Phases::default();
        for lane in 0..V::COUNT {
            let (block, from) = split(indices[lane] as usize);
            let (history, phases) = (&self.histories[block], self.phases[block]);
            numbers[0][lane] = history.overlap[from];
            numbers[1][lane] = history.normal_force[from];
            numbers[2][lane] = history.elongation[from];
            numbers[3][lane] = self.held[block][from];
            bits.loading |= (phases.loading >> from & 1) << lane;
            bits.unloading |= (phases.unloading >> from & 1) << lane;
            bits.slips |= (phases.slips >> from & 1) << lane;
            bits.slides |= (phases.slides >> from & 1) << lane;
        }
        Followed {
            overlap: V::load(&numbers[0]),
            normal_force: V::load(&numbers[1]),
            elongation: V::load(&numbers[2]),
            held: V::load(&numbers[3]),
            loading: V::mask(bits.loading),
            unloading: V::mask(bits.unloading),
            slips: V::mask(bits.slips),
            slides: V::mask(bits.slides),
        }
    }

    /// Writes the histories of contacts at some places, of those `among`.
    #[inline(always)]
    pub(super) fn scatter<V: Lanes>(&mut self, indices: &[u32], among: u8, contacts: &Followed<V>) {
        let mut numbers = [[0.0; BLOCK]; 4];
        contacts.overlap.store(&mut numbers[0]);
        contacts.normal_force.store(&mut numbers[1]);
        contacts.elongation.store(&mut numbers[2]);
        contacts.held.store(&mut numbers[3]);
        let (loading, unloading) = (V::bits(contacts.loading), V::bits(contacts.unloading));
        let (slips, slides) = (V::bits(contacts.slips), V::bits(contacts.slides));
        for lane in lanes(among) {
            let (block, to) = split(indices[lane] as usize);
            let history = &mut self.histories[block];
            history.overlap[to] = numbers[0][lane];
            history.normal_force[to] = numbers[1][lane];
            history.elongation[to] = numbers[2][lane];
            self.held[block][to] = numbers[3][lane];
            let phases = &mut self.phases[block];
            let write = |byte: &mut u8, bits: u8| *byte = *byte & !(1 << to) | (bits >> lane & 1) << to;
            write(&mut phases.loading, loading);
            write(&mut phases.unloading, unloading);
            write(&mut phases.slips, slips);
            write(&mut phases.slides, slides);
        }
    }
}
