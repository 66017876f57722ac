//! Vectors of numbers (SIMD): the same arithmetic on one, two, four or eight numbers at once.
//!
//! A kernel is written once, generic over [`Lanes`], and compiled for each [`Level`] of the processor. The program
//! chooses the level when it starts. All levels give the same bits. Each operation is that of IEEE 754 on each lane,
//! and no operations are fused. Sums over lanes are eight partial sums, whatever the width.
//!
//! Only this crate of the project uses `unsafe`. Vector instructions are sound only on processors that have them, and
//! [`run`] checks that before it calls.
#![expect(
    unsafe_code,
    reason = "vector instructions, and an allocator that aligns, cannot be called otherwise; each call says why it is sound"
)]

mod allocator;
mod counting;
mod gather;
mod level;
mod quads;
mod scalar;
#[cfg(test)]
mod tests;
mod vectors;
#[cfg(target_arch = "x86_64")]
mod x86;

use std::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Not, Sub};

use glam::DVec2;
use serde::{Deserialize, Serialize};

pub use allocator::Lines;
pub use allocator::give_back;
pub use counting::Counting;
pub use gather::{PairBlock, PairBlocks, PairedRecords, Pushes};
pub use level::{Kernel, Level, run};
pub use quads::{PairedQuads, QUAD, Quad, QuadPairs};
pub use vectors::Vectors;

/// Eight numbers that belong together and are loaded as one: a line of the cache.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[repr(C, align(64))]
pub struct Record(pub [f64; BLOCK]);

/// Prefetches a cache line that will be read soon. The pointer may be invalid: nothing is read through it.
#[inline(always)]
pub fn fetch<T>(place: *const T) {
    #[cfg(target_arch = "x86_64")]
    // SAFETY: each x86-64 processor has the instruction, which does nothing but a hint.
    unsafe {
        std::arch::x86_64::_mm_prefetch::<{ std::arch::x86_64::_MM_HINT_T0 }>(place.cast());
    }
    #[cfg(not(target_arch = "x86_64"))]
    let _ = place;
}

/// The count of numbers in a block. It is also the count of partial sums, whatever the number of lanes.
pub const BLOCK: usize = 8;

/// Several numbers side by side.
pub trait Lanes:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self> + Neg<Output = Self>
{
    /// The number of lanes: a divisor of [`BLOCK`].
    const COUNT: usize;

    /// Half the number of lanes, for the rest of a list. One lane stays one.
    type Half: Lanes;

    /// One truth value for each lane.
    type Mask: Copy + BitAnd<Output = Self::Mask> + BitOr<Output = Self::Mask> + Not<Output = Self::Mask>;

    /// The same number in all lanes.
    fn splat(number: f64) -> Self;

    /// The first [`Lanes::COUNT`] numbers of a list.
    fn load(numbers: &[f64]) -> Self;

    /// Writes the lanes to the beginning of a list.
    fn store(self, numbers: &mut [f64]);

    /// Numbers of two in turns, first of the first: the first half of them, and the other.
    fn interleaved(first: Self, second: Self) -> (Self, Self);

    /// The inverse of [interleaving](Lanes::interleaved).
    fn parted(low: Self, high: Self) -> (Self, Self);

    /// Each number twice in a row: the first half of them, and the other.
    #[inline(always)]
    fn twice(self) -> (Self, Self) {
        Self::interleaved(self, self)
    }

    /// As many vectors from the beginning of a list: their numbers along the first axis, and along the second.
    #[inline(always)]
    fn load_pairs(vectors: &[DVec2]) -> (Self, Self) {
        Vectors::load(vectors).parted()
    }

    /// Writes vectors to the beginning of a list.
    #[inline(always)]
    fn store_pairs(first: Self, second: Self, vectors: &mut [DVec2]) {
        Vectors::of(first, second).store(vectors);
    }

    /// The records at the first [`Lanes::COUNT`] places of a list, transposed: item `k` holds the `k`th number of each.
    fn records(records: &[Record], indices: &[u32]) -> [Self; BLOCK];

    /// The records of pairs, transposed. `first` and `second` hold their indices times [`BLOCK`]. The result holds the
    /// first six numbers of the second record minus those of the first. The last two numbers of the second record
    /// follow, and then those of the first.
    ///
    /// # Safety
    /// The first [`Lanes::COUNT`] places of both lists are those of records.
    #[inline(always)]
    unsafe fn record_pairs(records: &[Record], first: &[u32], second: &[u32]) -> ([Self; BLOCK], [Self; 2]) {
        let (mut own, mut other) = ([0; BLOCK], [0; BLOCK]);
        let mut lane = 0;
        while lane < Self::COUNT {
            (own[lane], other[lane]) = (first[lane] / BLOCK as u32, second[lane] / BLOCK as u32);
            lane += 1;
        }
        let (first, mut second) = (Self::records(records, &own), Self::records(records, &other));
        let mut number = 0;
        while number < BLOCK - 2 {
            second[number] = second[number] - first[number];
            number += 1;
        }
        (second, [first[BLOCK - 2], first[BLOCK - 1]])
    }

    /// Writes [`Lanes::COUNT`] records to the beginning of a list. Item `k` holds the `k`th two numbers of each record.
    fn store_records(numbers: [Vectors<Self>; BLOCK / 2], records: &mut [Record]);

    /// The quads at the first [`Lanes::COUNT`] places of a list, transposed: item `k` holds the `k`th number of each.
    ///
    /// # Safety
    /// The places are those of quads.
    #[inline(always)]
    unsafe fn quads(quads: &[Quad], indices: &[u32]) -> [Self; QUAD] {
        let mut numbers = [[0.0; BLOCK]; QUAD];
        let mut lane = 0;
        while lane < Self::COUNT {
            let Quad(quad) = quads[indices[lane] as usize];
            let mut number = 0;
            while number < QUAD {
                numbers[number][lane] = quad[number];
                number += 1;
            }
            lane += 1;
        }
        [Self::load(&numbers[0]), Self::load(&numbers[1]), Self::load(&numbers[2]), Self::load(&numbers[3])]
    }

    /// Writes quads to the given indices of a list, one after the other.
    ///
    /// # Safety
    /// The places are those of quads.
    #[inline(always)]
    unsafe fn store_quads(numbers: [Self; QUAD], quads: &mut [Quad], indices: &[u32]) {
        let mut rows = [[0.0; BLOCK]; QUAD];
        let mut number = 0;
        while number < QUAD {
            numbers[number].store(&mut rows[number]);
            number += 1;
        }
        let mut lane = 0;
        while lane < Self::COUNT {
            quads[indices[lane] as usize] = Quad([rows[0][lane], rows[1][lane], rows[2][lane], rows[3][lane]]);
            lane += 1;
        }
    }

    /// The square root of each.
    fn sqrt(self) -> Self;

    /// The magnitude of each.
    fn abs(self) -> Self;

    /// The magnitude of each with the sign of the other.
    fn copysign(self, sign: Self) -> Self;

    /// True in each lane whose number is less.
    fn lt(self, other: Self) -> Self::Mask;

    /// True in each lane whose number is greater.
    #[inline(always)]
    fn gt(self, other: Self) -> Self::Mask {
        other.lt(self)
    }

    /// The lower bits as a mask, the lowest for the first lane.
    fn mask(bits: u8) -> Self::Mask;

    /// A mask as bits.
    fn bits(mask: Self::Mask) -> u8;

    /// The first number in lanes whose mask is true, else the second.
    fn select(mask: Self::Mask, yes: Self, no: Self) -> Self;

    /// Zero in place of negative numbers and of NaN.
    #[inline(always)]
    fn at_least_zero(self) -> Self {
        let zero = Self::splat(0.0);
        Self::select(self.gt(zero), self, zero)
    }

    /// The number in lanes whose mask is true, else zero.
    #[inline(always)]
    fn only(self, mask: Self::Mask) -> Self {
        Self::select(mask, self, Self::splat(0.0))
    }
}
