//! Vectors of the plane side by side, in the order of memory. It is x and y of the first vector, then of the second,
//! and so on.
//!
//! Operations that treat x and y alike need no other order. To sort x and y apart takes longer than an addition.

use std::ops::{Add, Mul, Sub};

use glam::DVec2;

use super::Lanes;

/// As many vectors as there are lanes: the first half of their numbers, and the other.
#[derive(Clone, Copy)]
pub struct Vectors<V>(pub(super) V, pub(super) V);

/// The numbers of vectors in a row.
#[inline(always)]
fn numbers(vectors: &[DVec2]) -> &[f64] {
    // SAFETY: a `DVec2` is two numbers in order and nothing else.
    unsafe { std::slice::from_raw_parts(vectors.as_ptr().cast(), 2 * vectors.len()) }
}

impl<V: Lanes> Vectors<V> {
    /// The first [`Lanes::COUNT`] vectors of a list.
    #[inline(always)]
    pub fn load(vectors: &[DVec2]) -> Self {
        let numbers = numbers(&vectors[..V::COUNT]);
        Self(V::load(numbers), V::load(&numbers[V::COUNT..]))
    }

    /// Writes the vectors to the beginning of a list.
    #[inline(always)]
    pub fn store(self, vectors: &mut [DVec2]) {
        let vectors = &mut vectors[..V::COUNT];
        // SAFETY: see `numbers`.
        let numbers: &mut [f64] =
            unsafe { std::slice::from_raw_parts_mut(vectors.as_mut_ptr().cast(), 2 * vectors.len()) };
        let (low, high) = numbers.split_at_mut(V::COUNT);
        self.0.store(low);
        self.1.store(high);
    }

    /// Those with these numbers along the first axis and along the second.
    #[inline(always)]
    pub fn of(first: V, second: V) -> Self {
        let (low, high) = V::interleaved(first, second);
        Self(low, high)
    }

    /// Their numbers along the first axis, and along the second.
    #[inline(always)]
    pub fn parted(self) -> (V, V) {
        V::parted(self.0, self.1)
    }
}

impl<V: Lanes> Add for Vectors<V> {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self(self.0 + other.0, self.1 + other.1)
    }
}

impl<V: Lanes> Sub for Vectors<V> {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self(self.0 - other.0, self.1 - other.1)
    }
}

impl<V: Lanes> Mul<V> for Vectors<V> {
    type Output = Self;

    /// Each vector times the number of its lane.
    #[inline(always)]
    fn mul(self, factors: V) -> Self {
        let (low, high) = factors.twice();
        Self(self.0 * low, self.1 * high)
    }
}
