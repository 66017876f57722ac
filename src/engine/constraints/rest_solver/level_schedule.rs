//! Level scheduling (Anderson and Saad 1989) of contacts in blocks of eight. The contacts of a block share no body that moves by
//! forces. A block stands behind all blocks with earlier contacts of its bodies. So eight contacts are relaxed side by side, with
//! the same bits as one after the other.

use jostle_simd::BLOCK;

use super::Mover;

/// Blocks that are open to be filled at the same time.
const OPEN: usize = 64;

/// Copies of the mover that never moves. Blocks use them in turns, for a block waits for the last one that wrote the same mover.
const WORLDS: usize = 16;

/// Puts contacts into blocks, in their order.
#[derive(Debug, Default)]
pub(super) struct LevelSchedule {
    /// For each mover the first block that its next contact may stand in.
    after: Vec<u32>,
    /// The number of contacts that each block has.
    counts: Vec<u8>,
    /// The first block that is not full and still open.
    first: usize,
    /// The places of both sides in each block; those without a contact are of a mover that never moves.
    pub blocks: Vec<[[u32; BLOCK]; 2]>,
}

impl LevelSchedule {
    /// Begins an empty schedule for so many movers.
    pub fn begin(&mut self, movers: usize) {
        self.after.clear();
        self.after.resize(movers, 0);
        self.blocks.clear();
        self.counts.clear();
        self.first = 0;
    }

    /// The number of contacts that a block has.
    pub fn count(&self, block: usize) -> usize {
        self.counts[block] as usize
    }

    /// The number of movers that the blocks name: all, then copies of the first of them.
    pub fn movers(&self) -> usize {
        self.after.len() + WORLDS.min(self.blocks.len())
    }

    /// The place of the mover that never moves, as a block names it.
    fn stand_in(&self, block: usize) -> u32 {
        (self.after.len() + block % WORLDS) as u32
    }

    /// Puts a contact between two movers into a block. Returns its place: eight times the block, and its lane.
    pub fn put(&mut self, (a, b): (usize, usize), movers: &[Mover]) -> usize {
        let ends = [a, b].map(|end| movers[end].moves().then_some(end));
        let earliest = ends.iter().flatten().fold(self.first, |most, &end| most.max(self.after[end] as usize));
        let free = self.counts.iter().skip(earliest).position(|&count| (count as usize) < BLOCK);
        let block = free.map_or(self.blocks.len(), |found| earliest + found);
        if block == self.blocks.len() {
            self.blocks.push([[self.stand_in(block); BLOCK]; 2]);
            self.counts.push(0);
            self.first = self.first.max(self.blocks.len().saturating_sub(OPEN));
        }
        let (lane, world) = (self.count(block), self.stand_in(block));
        let [first, second] = [a, b].map(|end| if end == 0 { world } else { end as u32 });
        (self.blocks[block][0][lane], self.blocks[block][1][lane]) = (first, second);
        self.counts[block] += 1;
        while self.counts.get(self.first).is_some_and(|&count| count as usize == BLOCK) {
            self.first += 1;
        }
        for end in ends.into_iter().flatten() {
            self.after[end] = block as u32 + 1;
        }
        BLOCK * block + lane
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec2;

    fn moving(count: usize) -> Vec<Mover> {
        let moves = Mover { velocity: DVec2::ZERO, spin: 0.0, inverse_mass: 1.0, inverse_inertia: 1.0 };
        (0..count).map(|index| if index == 0 { Mover::default() } else { moves }).collect()
    }

    #[test]
    fn contacts_that_share_a_body_stand_in_blocks_in_their_order() {
        let movers = moving(400);
        let mut schedule = LevelSchedule::default();
        schedule.begin(movers.len());
        let pairs: Vec<(usize, usize)> = (0..3000).map(|k| (k * 7 % 400, (k * k + 3 * k + 1) % 400)).collect();
        let pairs: Vec<(usize, usize)> = pairs.into_iter().filter(|(a, b)| a != b).collect();
        let indices: Vec<usize> = pairs.iter().map(|&ends| schedule.put(ends, &movers)).collect();
        let mut last = vec![None; movers.len()];
        for (index, &(a, b)) in indices.iter().zip(&pairs) {
            let (block, lane) = (index / BLOCK, index % BLOCK);
            let [first, second] = schedule.blocks[block];
            let named = |index: u32| if index < 400 { index as usize } else { 0 };
            assert_eq!((named(first[lane]), named(second[lane])), (a, b));
            for end in [a, b].into_iter().filter(|&end| end > 0) {
                assert!(last[end].is_none_or(|before| before < block));
                last[end] = Some(block);
            }
        }
        assert!(schedule.blocks.len() < pairs.len() / 4, "{} blocks", schedule.blocks.len());
    }

    #[test]
    fn contacts_of_one_body_stand_in_a_block_each() {
        let movers = moving(60);
        let mut schedule = LevelSchedule::default();
        schedule.begin(movers.len());
        let indices: Vec<usize> = (2..60).map(|other| schedule.put((1, other), &movers)).collect();
        assert!(indices.iter().enumerate().all(|(number, &index)| index == BLOCK * number));
    }
}
