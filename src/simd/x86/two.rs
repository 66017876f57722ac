//! Two lanes: SSE2, which every x86-64 processor has.

use std::arch::x86_64::*;
use std::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Not, Sub};

use super::{bit_operators, operators};
use crate::{BLOCK, Lanes, Record, Vectors};

/// Two numbers.
#[derive(Clone, Copy)]
pub struct F64x2(__m128d);

operators!(F64x2: Add add _mm_add_pd, Sub sub _mm_sub_pd, Mul mul _mm_mul_pd, Div div _mm_div_pd);
bit_operators!(F64x2, _mm_and_pd, _mm_or_pd, _mm_xor_pd, _mm_castsi128_pd(_mm_set1_epi64x(-1)));

impl F64x2 {
    #[inline(always)]
    fn flip(self, signs: Self) -> Self {
        // SAFETY: see the head of the folder.
        Self(unsafe { _mm_xor_pd(self.0, signs.0) })
    }
}

impl Lanes for F64x2 {
    const COUNT: usize = 2;
    type Half = f64;
    type Mask = Self;

    #[inline(always)]
    fn splat(number: f64) -> Self {
        // SAFETY: each x86-64 processor has SSE2.
        Self(unsafe { _mm_set1_pd(number) })
    }

    #[inline(always)]
    fn load(numbers: &[f64]) -> Self {
        let numbers = &numbers[..Self::COUNT];
        // SAFETY: the list has that many numbers.
        Self(unsafe { _mm_loadu_pd(numbers.as_ptr()) })
    }

    #[inline(always)]
    fn store(self, numbers: &mut [f64]) {
        let numbers = &mut numbers[..Self::COUNT];
        // SAFETY: the list has room for that many numbers.
        unsafe { _mm_storeu_pd(numbers.as_mut_ptr(), self.0) }
    }

    #[inline(always)]
    fn records(records: &[Record], indices: &[u32]) -> [Self; BLOCK] {
        let (first, second) = (&records[indices[0] as usize].0, &records[indices[1] as usize].0);
        let mut transposed = [Self::splat(0.0); BLOCK];
        for pair in 0..BLOCK / 2 {
            let (first, second) = (Self::load(&first[2 * pair..]), Self::load(&second[2 * pair..]));
            // SAFETY: each x86-64 processor has SSE2.
            unsafe {
                transposed[2 * pair] = Self(_mm_unpacklo_pd(first.0, second.0));
                transposed[2 * pair + 1] = Self(_mm_unpackhi_pd(first.0, second.0));
            }
        }
        transposed
    }

    #[inline(always)]
    fn store_records(numbers: [Vectors<Self>; BLOCK / 2], records: &mut [Record]) {
        let records = &mut records[..Self::COUNT];
        for (number, Vectors(first, second)) in numbers.into_iter().enumerate() {
            first.store(&mut records[0].0[2 * number..]);
            second.store(&mut records[1].0[2 * number..]);
        }
    }

    #[inline(always)]
    fn interleaved(first: Self, second: Self) -> (Self, Self) {
        // SAFETY: each x86-64 processor has SSE2.
        unsafe { (Self(_mm_unpacklo_pd(first.0, second.0)), Self(_mm_unpackhi_pd(first.0, second.0))) }
    }

    #[inline(always)]
    fn parted(low: Self, high: Self) -> (Self, Self) {
        Self::interleaved(low, high)
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        // SAFETY: each x86-64 processor has SSE2.
        Self(unsafe { _mm_sqrt_pd(self.0) })
    }

    #[inline(always)]
    fn abs(self) -> Self {
        // SAFETY: likewise.
        Self(unsafe { _mm_andnot_pd(Self::splat(-0.0).0, self.0) })
    }

    #[inline(always)]
    fn at_least_zero(self) -> Self {
        // SAFETY: likewise. If an operand is NaN, or both are zero, the instruction gives its second operand.
        Self(unsafe { _mm_max_pd(self.0, Self::splat(0.0).0) })
    }

    #[inline(always)]
    fn copysign(self, sign: Self) -> Self {
        self.abs() | (sign & Self::splat(-0.0))
    }

    #[inline(always)]
    fn lt(self, other: Self) -> Self {
        // SAFETY: likewise.
        Self(unsafe { _mm_cmplt_pd(self.0, other.0) })
    }

    #[inline(always)]
    fn mask(bits: u8) -> Self {
        let lane = |lane: u8| -i64::from((bits >> lane) & 1);
        // SAFETY: likewise.
        Self(unsafe { _mm_castsi128_pd(_mm_set_epi64x(lane(1), lane(0))) })
    }

    #[inline(always)]
    fn bits(mask: Self) -> u8 {
        // SAFETY: likewise.
        unsafe { _mm_movemask_pd(mask.0) as u8 }
    }

    #[inline(always)]
    fn select(mask: Self, yes: Self, no: Self) -> Self {
        // SAFETY: likewise.
        Self(unsafe { _mm_or_pd(_mm_and_pd(mask.0, yes.0), _mm_andnot_pd(mask.0, no.0)) })
    }
}
