//! Whether a list of contacts from a file belongs together.

use super::ContactList;
use jostle_simd::BLOCK;

impl ContactList {
    /// Whether all lists are as long as its blocks, and all places and laws are among those there are.
    pub(in super::super) fn fits(&self, laws: usize, bodies: usize) -> bool {
        let Self { len, law, only_law, histories, held, damping, phases, due, each_due, remembered, .. } = self;
        let (blocks, is_law) = (len.div_ceil(BLOCK), |law: u32| (law as usize) < laws.max(1));
        let whole = |list: usize| list == 0 || list == blocks;
        let lengths = [law.len(), histories.len(), held.len(), phases.len(), due.len()];
        let of_bits = [&self.looked_at, &self.asleep].map(Vec::len);
        let places = |list: &[u32]| list.is_sorted_by(|a, b| a < b) && list.iter().all(|at| (*at as usize) < blocks);
        let numbers = histories.iter().flat_map(|one| [one.overlap, one.normal_force, one.elongation]);
        // Lanes behind the last contact hold nothing.
        let rest = |block: usize| (BLOCK * (block + 1)).saturating_sub(*len).min(BLOCK);
        let empty = |(block, phases): (usize, &super::Phases)| {
            let bits = phases.loading | phases.unloading | phases.slips | phases.slides;
            u32::from(bits) >> (BLOCK - rest(block)) == 0
        };
        lengths.into_iter().all(|length| length == blocks)
            && [damping.len(), each_due.len()].into_iter().chain(of_bits).all(whole)
            && (laws > 0 || *len == 0)
            && law.iter().flatten().copied().chain(*only_law).all(is_law)
            && phases.iter().enumerate().all(empty)
            && numbers.flatten().chain(held.iter().copied().flatten()).all(f64::is_finite)
            && (remembered.records.is_empty() || remembered.records.len() == *len)
            && remembered.sides.len() == remembered.records.len()
            && remembered.sides.iter().flat_map(|sides| sides.bodies).all(|body| (body as usize) < bodies)
            && places(&self.watched)
            && places(&self.awake)
            && (self.looked_at.is_empty() || self.watched.len() <= blocks)
            && self.asleep_touching <= *len
    }
}
