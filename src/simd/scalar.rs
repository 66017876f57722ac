//! One lane: plain numbers, on any processor.

use glam::DVec2;

use super::{BLOCK, Lanes, Record};

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
    fn load_pairs(pairs: &[DVec2]) -> (Self, Self) {
        (pairs[0].x, pairs[0].y)
    }

    #[inline(always)]
    fn store_pairs(first: Self, second: Self, pairs: &mut [DVec2]) {
        pairs[0] = DVec2::new(first, second);
    }

    #[inline(always)]
    fn records(records: &[Record], places: &[u32]) -> [Self; BLOCK] {
        records[places[0] as usize].0
    }

    #[inline(always)]
    fn store_records(numbers: [Self; BLOCK], records: &mut [Record]) {
        records[0] = Record(numbers);
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
