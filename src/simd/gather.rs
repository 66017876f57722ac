//! Pairs of indices into lists (gather and scatter). The records of both sides are loaded together, and both sides
//! receive a push.
//!
//! Indices are checked once, when the pairs are listed, and not at each access.

use glam::DVec2;

use serde::{Deserialize, Serialize};

use super::{BLOCK, Lanes, Record};

/// Eight pairs: the first index of each, then the second, in one cache line. Each index is stored times [`BLOCK`],
/// which is the index of the first number of a record. So the processor addresses records, forces and torques without a
/// multiplication.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C, align(64))]
pub struct PairBlock {
    first: [u32; BLOCK],
    second: [u32; BLOCK],
}

impl PairBlock {
    /// The two places of a pair.
    #[inline(always)]
    pub fn get(&self, lane: usize) -> (u32, u32) {
        (self.first[lane] / SCALE, self.second[lane] / SCALE)
    }
}

/// Numbers of a record.
const SCALE: u32 = BLOCK as u32;

/// Places of pairs are below that.
pub const MOST_INDICES: usize = (u32::MAX / SCALE) as usize;

/// Pairs of places in blocks; the last is filled up with pairs of the place 0 with itself.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
#[serde(into = "Listed", try_from = "Listed")]
pub struct PairBlocks {
    blocks: Vec<PairBlock>,
    /// The places are below that.
    bound: usize,
    /// The places of the records of both sides; empty where those are the same.
    sides: Vec<PairBlock>,
    /// Those are below that.
    records: usize,
}

/// The saved form of blocks. Bounds are computed from the indices, because the kernels trust them.
#[derive(Serialize, Deserialize)]
struct Listed {
    blocks: Vec<[[u32; BLOCK]; 2]>,
    sides: Vec<[[u32; BLOCK]; 2]>,
    records: usize,
}

impl From<PairBlocks> for Listed {
    fn from(PairBlocks { blocks, sides, records, .. }: PairBlocks) -> Self {
        let [blocks, sides] = [blocks, sides].map(|list| list.iter().map(|pair| [pair.first, pair.second]).collect());
        Self { blocks, sides, records }
    }
}

impl TryFrom<Listed> for PairBlocks {
    type Error = &'static str;

    fn try_from(Listed { blocks, sides, records }: Listed) -> Result<Self, Self::Error> {
        let bound = |list: &[[[u32; BLOCK]; 2]]| -> Option<usize> {
            let mut bound = 0;
            for &index in list.iter().flatten().flatten() {
                if index % SCALE != 0 {
                    return None;
                }
                bound = bound.max((index / SCALE) as usize + 1);
            }
            Some(bound)
        };
        let (indices, of_records) = (bound(&blocks).ok_or(NOT_AN_INDEX)?, bound(&sides).ok_or(NOT_AN_INDEX)?);
        let fits = sides.is_empty() || (sides.len() == blocks.len() && of_records <= records);
        if !fits || records > MOST_INDICES || (sides.is_empty() && records < indices && !blocks.is_empty()) {
            return Err(NOT_AN_INDEX);
        }
        let [blocks, sides] = [blocks, sides].map(|list| {
            list.into_iter().map(|[first, second]| PairBlock { first, second }).collect::<Vec<PairBlock>>()
        });
        Ok(Self { blocks, bound: indices, sides, records })
    }
}

const NOT_AN_INDEX: &str = "places of pairs are not among those there are";

impl PairBlocks {
    /// The two places of a pair in the list; `None` behind its last block.
    pub fn place(&self, index: usize) -> Option<(u32, u32)> {
        self.blocks.get(index / BLOCK).map(|block| block.get(index % BLOCK))
    }

    /// Replaces the list of pairs.
    ///
    /// # Panics
    /// If an index is [`MOST_INDICES`] or more, or the iterator gives more pairs than it announced. The list is then
    /// empty.
    pub fn list(&mut self, pairs: impl ExactSizeIterator<Item = (u32, u32)>) {
        // The fields that kernels trust are set when all indices have been checked.
        let Self { mut blocks, .. } = std::mem::take(self);
        blocks.clear();
        blocks.resize(pairs.len().div_ceil(BLOCK), PairBlock::default());
        let mut bound = 0;
        for (number, (first, second)) in pairs.enumerate() {
            let block = &mut blocks[number / BLOCK];
            (block.first[number % BLOCK], block.second[number % BLOCK]) =
                (SCALE.wrapping_mul(first), SCALE.wrapping_mul(second));
            bound = bound.max(first as usize + 1).max(second as usize + 1);
        }
        assert!(bound <= MOST_INDICES, "more places than can be written");
        *self = Self { blocks, bound, sides: Vec::new(), records: bound };
    }

    /// Sets other indices for the records of both sides. `of` maps each index to that of its record, and `count` is the
    /// number of records.
    ///
    /// # Panics
    /// If one is not there; then all is as before.
    pub fn find_records(&mut self, of: &[u32], count: usize) {
        let count = count.min(MOST_INDICES);
        let elsewhere = |indices: [u32; BLOCK]| {
            indices.map(|index| {
                let found = of[(index / SCALE) as usize];
                assert!((found as usize) < count, "a pair of what is not there");
                SCALE * found
            })
        };
        let side = |block: &PairBlock| PairBlock { first: elsewhere(block.first), second: elsewhere(block.second) };
        let sides = self.blocks.iter().map(side).collect();
        (self.sides, self.records) = (sides, count);
    }

    fn sides(&self) -> &[PairBlock] {
        if self.sides.is_empty() { &self.blocks } else { &self.sides }
    }

    /// The places of the records of the pairs of a block.
    pub fn side(&self, block: usize) -> &PairBlock {
        &self.sides()[block]
    }

    /// Whether so many records are all that pairs may need.
    pub fn records_fit(&self, count: usize) -> bool {
        self.blocks.is_empty() || self.records.max(1) <= count
    }

    /// The records of both sides of all pairs.
    ///
    /// # Panics
    /// If there are fewer records than that.
    pub fn records<'a>(&'a self, records: &'a [Record]) -> PairedRecords<'a> {
        assert!(self.records_fit(records.len()), "a pair of what is not there");
        PairedRecords { pairs: self, sides: self.sides(), records }
    }
}

/// Records, and pairs of which both sides are among them.
#[derive(Clone, Copy)]
pub struct PairedRecords<'a> {
    pairs: &'a PairBlocks,
    sides: &'a [PairBlock],
    records: &'a [Record],
}

impl PairedRecords<'_> {
    /// One of the blocks of pairs.
    #[inline(always)]
    pub fn pairs(&self, block: usize) -> &PairBlock {
        &self.pairs.blocks[block]
    }

    /// Both sides of some pairs of a block, from `lane` on; see [`Lanes::record_pairs`].
    #[inline(always)]
    pub fn load<V: Lanes>(&self, block: usize, lane: usize) -> ([V; BLOCK], [V; 2]) {
        let PairBlock { first, second } = &self.sides[block];
        // SAFETY: all indices were below the bound when they were listed, and the list has at least that many records.
        unsafe { V::record_pairs(self.records, &first[lane..], &second[lane..]) }
    }

    /// Prefetches the records of the second sides of a block, if there is such a block. Those of the first sides were
    /// second sides a few blocks before. Without it the loads wait for half of their time.
    #[inline(always)]
    pub fn fetch(&self, block: usize) {
        if let Some(PairBlock { second, .. }) = self.sides.get(block) {
            for &index in second {
                super::fetch(self.records.as_ptr().cast::<f64>().wrapping_add(index as usize));
            }
        }
    }

    /// Whether both sides of the pairs of a block are among `len` bodies from place `first` on.
    #[inline(always)]
    fn are_among(&self, pairs: &PairBlock, first: usize, len: usize) -> bool {
        if first == 0 && self.pairs.bound.max(1) <= len {
            return true;
        }
        if first >= MOST_INDICES {
            return false;
        }
        // A place before the first, less the first, is not below that.
        let len = len.min(MOST_INDICES - first);
        let mut farthest = 0;
        for lane in 0..BLOCK {
            let first = SCALE * first as u32;
            let (a, b) = (pairs.first[lane].wrapping_sub(first), pairs.second[lane].wrapping_sub(first));
            farthest = farthest.max(a).max(b);
        }
        ((farthest / SCALE) as usize) < len
    }
}

/// The forces and torques of the pairs of a block. The force acts on the second side, and its opposite on the first.
/// Each side has its torque.
#[derive(Clone, Debug)]
#[repr(C, align(64))]
pub struct Pushes {
    /// Forces on the second sides.
    pub force: [DVec2; BLOCK],
    /// Torques on the first sides.
    pub torque_first: [f64; BLOCK],
    /// Torques on the second sides.
    pub torque_second: [f64; BLOCK],
}

impl Pushes {
    /// No forces and no torques.
    pub const NONE: Self =
        Self { force: [DVec2::ZERO; BLOCK], torque_first: [0.0; BLOCK], torque_second: [0.0; BLOCK] };

    /// Adds the pushes of some pairs of a block, one after the other, to forces and torques of consecutive bodies.
    /// `first` is the index of the first of these bodies. If some side of the pairs is not among them, it does nothing
    /// and returns false.
    #[inline(always)]
    pub fn give(
        &self,
        pairs: &PairedRecords,
        block: usize,
        lanes: u8,
        (first, force, torque): (usize, &mut [DVec2], &mut [f64]),
    ) -> bool {
        let block = pairs.pairs(block);
        if !pairs.are_among(block, first, force.len().min(torque.len())) {
            return false;
        }
        // The address of body 0, so that no access needs a subtraction.
        let bodies = (force.as_mut_ptr().wrapping_sub(first), torque.as_mut_ptr().wrapping_sub(first));
        if lanes == u8::MAX {
            let mut lane = 0;
            while lane < BLOCK {
                // SAFETY: both sides of all pairs were checked to be in range.
                unsafe { self.give_one(block, lane, bodies) };
                lane += 1;
            }
            return true;
        }
        let mut left = lanes;
        while left != 0 {
            // SAFETY: likewise.
            unsafe { self.give_one(block, left.trailing_zeros() as usize, bodies) };
            left &= left - 1;
        }
        true
    }

    /// # Safety
    /// The indices of both sides of the pair are within the lists, counted from body 0.
    #[inline(always)]
    unsafe fn give_one(&self, block: &PairBlock, lane: usize, (force, torque): (*mut DVec2, *mut f64)) {
        let (a, b) = (block.first[lane] as usize, block.second[lane] as usize);
        // A stored index is eight times the body's index. A body has eight bytes of torque and sixteen of force.
        let force = |index: usize| force.wrapping_byte_add(index * size_of::<DVec2>() / BLOCK);
        let torque = |index: usize| torque.wrapping_byte_add(index * size_of::<f64>() / BLOCK);
        // SAFETY: as the caller promises. Both may be the same body: one is done after the other.
        unsafe {
            *force(a) -= self.force[lane];
            *torque(a) += self.torque_first[lane];
            *force(b) += self.force[lane];
            *torque(b) += self.torque_second[lane];
        }
    }
}
