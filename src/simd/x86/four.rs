//! Four lanes, with AVX2.

use std::arch::x86_64::*;
use std::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Not, Sub};

use super::{F64x2, bit_operators, last_two_of, operators, put_quad, quad_at, record_at};
use crate::{BLOCK, Lanes, QUAD, Quad, Record, Vectors};

/// Four numbers.
#[derive(Clone, Copy)]
pub struct F64x4(__m256d);

operators!(F64x4: Add add _mm256_add_pd, Sub sub _mm256_sub_pd, Mul mul _mm256_mul_pd, Div div _mm256_div_pd);
bit_operators!(F64x4, _mm256_and_pd, _mm256_or_pd, _mm256_xor_pd, _mm256_castsi256_pd(_mm256_set1_epi64x(-1)));

impl F64x4 {
    #[inline(always)]
    fn flip(self, signs: Self) -> Self {
        // SAFETY: see the head of the folder.
        Self(unsafe { _mm256_xor_pd(self.0, signs.0) })
    }
}

impl F64x4 {
    /// A transposition of four records, each in two halves.
    #[inline(always)]
    fn transposed(rows: [(Self, Self); 4]) -> [Self; BLOCK] {
        let [a, b, c, d] = rows;
        let (low, high) = (quarters([a.0, b.0, c.0, d.0]), quarters([a.1, b.1, c.1, d.1]));
        [low[0], low[1], low[2], low[3], high[0], high[1], high[2], high[3]]
    }
}

/// A transposition of four numbers of four records.
#[inline(always)]
fn quarters([a, b, c, d]: [F64x4; 4]) -> [F64x4; 4] {
    // SAFETY: see the head of the folder.
    unsafe {
        let (even, odd) = (_mm256_unpacklo_pd(a.0, b.0), _mm256_unpackhi_pd(a.0, b.0));
        let (even_too, odd_too) = (_mm256_unpacklo_pd(c.0, d.0), _mm256_unpackhi_pd(c.0, d.0));
        let (first, third) = halves(F64x4(even), F64x4(even_too));
        let (second, fourth) = halves(F64x4(odd), F64x4(odd_too));
        [first, second, third, fourth]
    }
}

/// The first halves of two, and the second ones.
#[inline(always)]
fn halves(a: F64x4, b: F64x4) -> (F64x4, F64x4) {
    // SAFETY: see the head of the folder.
    unsafe { (F64x4(_mm256_permute2f128_pd::<0x20>(a.0, b.0)), F64x4(_mm256_permute2f128_pd::<0x31>(a.0, b.0))) }
}

impl Lanes for F64x4 {
    const COUNT: usize = 4;
    type Half = F64x2;
    type Mask = Self;

    #[inline(always)]
    fn splat(number: f64) -> Self {
        // SAFETY: see the head of the folder.
        Self(unsafe { _mm256_set1_pd(number) })
    }

    #[inline(always)]
    fn load(numbers: &[f64]) -> Self {
        let numbers = &numbers[..Self::COUNT];
        // SAFETY: the list has that many numbers.
        Self(unsafe { _mm256_loadu_pd(numbers.as_ptr()) })
    }

    #[inline(always)]
    fn store(self, numbers: &mut [f64]) {
        let numbers = &mut numbers[..Self::COUNT];
        // SAFETY: the list has room for that many numbers.
        unsafe { _mm256_storeu_pd(numbers.as_mut_ptr(), self.0) }
    }

    #[inline(always)]
    fn records(records: &[Record], indices: &[u32]) -> [Self; BLOCK] {
        let mut rows = [(Self::splat(0.0), Self::splat(0.0)); Self::COUNT];
        let mut lane = 0;
        while lane < Self::COUNT {
            let row = &records[indices[lane] as usize].0;
            rows[lane] = (Self::load(row), Self::load(&row[Self::COUNT..]));
            lane += 1;
        }
        Self::transposed(rows)
    }

    #[inline(always)]
    fn store_records([a, b, c, d]: [Vectors<Self>; BLOCK / 2], records: &mut [Record]) {
        let records = &mut records[..Self::COUNT];
        let ((ab, ab_too), (cd, cd_too)) = (halves(a.0, b.0), halves(c.0, d.0));
        ab.store(&mut records[0].0);
        cd.store(&mut records[0].0[4..]);
        ab_too.store(&mut records[1].0);
        cd_too.store(&mut records[1].0[4..]);
        let ((ab, ab_too), (cd, cd_too)) = (halves(a.1, b.1), halves(c.1, d.1));
        ab.store(&mut records[2].0);
        cd.store(&mut records[2].0[4..]);
        ab_too.store(&mut records[3].0);
        cd_too.store(&mut records[3].0[4..]);
    }

    #[inline(always)]
    unsafe fn record_pairs(records: &[Record], first: &[u32], second: &[u32]) -> ([Self; BLOCK], [Self; 2]) {
        let (first, second) = (&first[..Self::COUNT], &second[..Self::COUNT]);
        let mut rows = [(Self::splat(0.0), Self::splat(0.0)); Self::COUNT];
        let mut lane = 0;
        // SAFETY: the indices are those of records, as the caller promises; see the head of the folder.
        unsafe {
            while lane < Self::COUNT {
                let own = record_at(records, first[lane]);
                let other = record_at(records, second[lane]);
                let high = Self::load(&other[Self::COUNT..]);
                let less = high - Self::load(&own[Self::COUNT..]);
                rows[lane] = (Self::load(other) - Self::load(own), Self(_mm256_blend_pd::<0b1100>(less.0, high.0)));
                lane += 1;
            }
            let even = _mm256_set_m128d(last_two_of(records, first[2]), last_two_of(records, first[0]));
            let odd = _mm256_set_m128d(last_two_of(records, first[3]), last_two_of(records, first[1]));
            (Self::transposed(rows), [Self(_mm256_unpacklo_pd(even, odd)), Self(_mm256_unpackhi_pd(even, odd))])
        }
    }

    #[inline(always)]
    unsafe fn quads(quads: &[Quad], indices: &[u32]) -> [Self; QUAD] {
        let indices = &indices[..Self::COUNT];
        // SAFETY: the indices are those of quads, as the caller promises.
        let row = |lane: usize| Self(unsafe { quad_at(quads, indices[lane]) });
        quarters([row(0), row(1), row(2), row(3)])
    }

    #[inline(always)]
    unsafe fn store_quads(numbers: [Self; QUAD], quads: &mut [Quad], indices: &[u32]) {
        let (indices, rows) = (&indices[..Self::COUNT], quarters(numbers));
        let mut lane = 0;
        while lane < Self::COUNT {
            // SAFETY: likewise.
            unsafe { put_quad(quads, indices[lane], rows[lane].0) };
            lane += 1;
        }
    }

    #[inline(always)]
    fn interleaved(first: Self, second: Self) -> (Self, Self) {
        // SAFETY: see the head of the folder.
        let (even, odd) = unsafe { (_mm256_unpacklo_pd(first.0, second.0), _mm256_unpackhi_pd(first.0, second.0)) };
        halves(Self(even), Self(odd))
    }

    #[inline(always)]
    fn parted(low: Self, high: Self) -> (Self, Self) {
        let (even, odd) = halves(low, high);
        // SAFETY: likewise.
        unsafe { (Self(_mm256_unpacklo_pd(even.0, odd.0)), Self(_mm256_unpackhi_pd(even.0, odd.0))) }
    }

    #[inline(always)]
    fn twice(self) -> (Self, Self) {
        // SAFETY: likewise.
        unsafe {
            (Self(_mm256_permute4x64_pd::<0b0101_0000>(self.0)), Self(_mm256_permute4x64_pd::<0b1111_1010>(self.0)))
        }
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        // SAFETY: see the head of the folder.
        Self(unsafe { _mm256_sqrt_pd(self.0) })
    }

    #[inline(always)]
    fn abs(self) -> Self {
        // SAFETY: likewise.
        Self(unsafe { _mm256_andnot_pd(Self::splat(-0.0).0, self.0) })
    }

    #[inline(always)]
    fn at_least_zero(self) -> Self {
        // SAFETY: likewise. If an operand is NaN, or both are zero, the instruction gives its second operand.
        Self(unsafe { _mm256_max_pd(self.0, Self::splat(0.0).0) })
    }

    #[inline(always)]
    fn copysign(self, sign: Self) -> Self {
        self.abs() | (sign & Self::splat(-0.0))
    }

    #[inline(always)]
    fn lt(self, other: Self) -> Self {
        // SAFETY: likewise.
        Self(unsafe { _mm256_cmp_pd::<_CMP_LT_OQ>(self.0, other.0) })
    }

    #[inline(always)]
    fn mask(bits: u8) -> Self {
        // SAFETY: likewise.
        unsafe {
            let places = _mm256_set_epi64x(8, 4, 2, 1);
            let chosen = _mm256_and_si256(_mm256_set1_epi64x(i64::from(bits)), places);
            Self(_mm256_castsi256_pd(_mm256_cmpeq_epi64(chosen, places)))
        }
    }

    #[inline(always)]
    fn bits(mask: Self) -> u8 {
        // SAFETY: likewise.
        unsafe { _mm256_movemask_pd(mask.0) as u8 }
    }

    #[inline(always)]
    fn select(mask: Self, yes: Self, no: Self) -> Self {
        // SAFETY: likewise.
        Self(unsafe { _mm256_blendv_pd(no.0, yes.0, mask.0) })
    }
}
