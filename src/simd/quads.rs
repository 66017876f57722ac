//! Four numbers that belong together, such as three velocities and a mass. Those of both sides are loaded, changed and
//! written back, for several pairs at once.
//!
//! Indices are checked once, when the pairs are listed, and not at each access.

use super::{BLOCK, Lanes};

/// Four numbers that belong together.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C, align(32))]
pub struct Quad(pub [f64; QUAD]);

/// Numbers of a quad.
pub const QUAD: usize = 4;

/// Pairs of places in a list of quads, in blocks of eight.
#[derive(Clone, Debug, Default)]
pub struct QuadPairs {
    blocks: Vec<[[u32; BLOCK]; 2]>,
    /// The places are below that.
    bound: usize,
}

impl QuadPairs {
    /// Forgets all.
    pub fn clear(&mut self) {
        self.blocks.clear();
        self.bound = 0;
    }

    /// The number of blocks.
    pub fn len(&self) -> usize {
        self.blocks.len()
    }

    /// Whether the list is empty.
    pub fn is_empty(&self) -> bool {
        self.blocks.is_empty()
    }

    /// Adds a block: the first places of its pairs, and the second ones.
    pub fn push(&mut self, block: [[u32; BLOCK]; 2]) {
        let farthest = block.iter().flatten().fold(0, |most, &index| most.max(index as usize));
        self.bound = self.bound.max(farthest + 1);
        self.blocks.push(block);
    }

    /// The quads of these pairs.
    ///
    /// # Panics
    /// If `quads` is shorter than the indices require.
    pub fn of<'a>(&'a self, quads: &'a mut [Quad]) -> PairedQuads<'a> {
        assert!(self.bound <= quads.len(), "a pair of what is not there");
        PairedQuads { blocks: &self.blocks, quads }
    }
}

/// Quads, and pairs of which both sides are among them.
#[derive(Debug)]
pub struct PairedQuads<'a> {
    blocks: &'a [[[u32; BLOCK]; 2]],
    quads: &'a mut [Quad],
}

impl PairedQuads<'_> {
    /// Both sides of some pairs of a block, from `lane` on: item `k` holds the `k`th number of each.
    #[inline(always)]
    pub fn load<V: Lanes>(&self, block: usize, lane: usize) -> [[V; QUAD]; 2] {
        let [first, second] = &self.blocks[block];
        // SAFETY: all indices are below the bound, and the list has at least that many quads.
        unsafe { [V::quads(self.quads, &first[lane..]), V::quads(self.quads, &second[lane..])] }
    }

    /// The inverse of [loading](PairedQuads::load): writes the first sides, then the second ones. If an index occurs
    /// several times, the last write remains.
    #[inline(always)]
    pub fn store<V: Lanes>(&mut self, block: usize, lane: usize, [a, b]: [[V; QUAD]; 2]) {
        let [first, second] = &self.blocks[block];
        // SAFETY: likewise.
        unsafe {
            V::store_quads(a, self.quads, &first[lane..]);
            V::store_quads(b, self.quads, &second[lane..]);
        }
    }
}
