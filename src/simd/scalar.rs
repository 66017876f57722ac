//! One lane: plain numbers, on any processor.

use super::{BLOCK, Lanes, Record, Vectors};

/// Yes or no for one lane. Unlike `bool` it has the operators that masks have, without branches.
#[derive(Clone, Copy)]
pub struct One(bool);

impl std::ops::BitAnd for One {
    type Output = Self;
    #[inline(always)]
    fn bitand(self, other: Self) -> Self {
        Self(self.0 & other.0)
    }
}

impl std::ops::BitOr for One {
    type Output = Self;
    #[inline(always)]
    fn bitor(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }
}

impl std::ops::Not for One {
    type Output = Self;
    #[inline(always)]
    fn not(self) -> Self {
        Self(!self.0)
    }
}

impl Lanes for f64 {
    const COUNT: usize = 1;
    type Half = Self;
    type Mask = One;

    #[inline(always)]
    fn splat(number: f64) -> Self {
        number
    }

    #[inline(always)]
    fn load(numbers: &[f64]) -> Self {
        numbers[0]
    }

    #[inline(always)]
    fn store(self, numbers: &mut [f64]) {
        numbers[0] = self;
    }

    #[inline(always)]
    fn interleaved(first: Self, second: Self) -> (Self, Self) {
        (first, second)
    }

    #[inline(always)]
    fn parted(low: Self, high: Self) -> (Self, Self) {
        (low, high)
    }

    #[inline(always)]
    fn records(records: &[Record], indices: &[u32]) -> [Self; BLOCK] {
        records[indices[0] as usize].0
    }

    #[inline(always)]
    fn store_records([a, b, c, d]: [Vectors<Self>; BLOCK / 2], records: &mut [Record]) {
        records[0] = Record([a.0, a.1, b.0, b.1, c.0, c.1, d.0, d.1]);
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        f64::sqrt(self)
    }

    #[inline(always)]
    fn abs(self) -> Self {
        f64::abs(self)
    }

    #[inline(always)]
    fn copysign(self, sign: Self) -> Self {
        f64::copysign(self, sign)
    }

    #[inline(always)]
    fn lt(self, other: Self) -> One {
        One(self < other)
    }

    #[inline(always)]
    fn mask(bits: u8) -> One {
        One(bits & 1 != 0)
    }

    #[inline(always)]
    fn bits(mask: One) -> u8 {
        u8::from(mask.0)
    }

    #[inline(always)]
    fn select(mask: One, yes: Self, no: Self) -> Self {
        if mask.0 { yes } else { no }
    }
}
