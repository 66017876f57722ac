//! Eight lanes, with AVX-512.

use std::arch::x86_64::*;
use std::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Not, Sub};

use super::{F64x4, last_two_of, operators, put_quad, quad_at, record_at};
use crate::{BLOCK, Lanes, QUAD, Quad, Record, Vectors};

/// Eight numbers.
#[derive(Clone, Copy)]
pub struct F64x8(__m512d);

/// Eight times yes or no.
#[derive(Clone, Copy)]
pub struct Bits8(u8);

operators!(F64x8: Add add _mm512_add_pd, Sub sub _mm512_sub_pd, Mul mul _mm512_mul_pd, Div div _mm512_div_pd);

impl F64x8 {
    #[inline(always)]
    fn flip(self, signs: Self) -> Self {
        // SAFETY: see the head of the folder.
        Self(unsafe { _mm512_xor_pd(self.0, signs.0) })
    }
}

impl BitAnd for Bits8 {
    type Output = Self;
    #[inline(always)]
    fn bitand(self, other: Self) -> Self {
        Self(self.0 & other.0)
    }
}

impl BitOr for Bits8 {
    type Output = Self;
    #[inline(always)]
    fn bitor(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }
}

impl Not for Bits8 {
    type Output = Self;
    #[inline(always)]
    fn not(self) -> Self {
        Self(!self.0)
    }
}

impl F64x8 {
    /// The first six numbers less those of another.
    #[inline(always)]
    fn less_in_six(self, other: Self) -> Self {
        // SAFETY: see the head of the folder.
        Self(unsafe { _mm512_mask_sub_pd(self.0, 0b0011_1111, self.0, other.0) })
    }

    /// The last two numbers of four records. Their indices are the first, third, fifth and seventh of a list.
    ///
    /// # Safety
    /// The places are those of records.
    #[inline(always)]
    unsafe fn last_two(records: &[Record], indices: &[u32]) -> __m512d {
        // SAFETY: as the caller promises; a record has two numbers from the seventh on.
        unsafe {
            let quarter = _mm512_castpd128_pd512(last_two_of(records, indices[0]));
            let half = _mm512_insertf64x2::<1>(quarter, last_two_of(records, indices[2]));
            let three = _mm512_insertf64x2::<2>(half, last_two_of(records, indices[4]));
            _mm512_insertf64x2::<3>(three, last_two_of(records, indices[6]))
        }
    }

    /// A transposition of eight lines: pairs of numbers within quarters, then quarters, then halves.
    #[inline(always)]
    fn transposed(rows: [Self; BLOCK]) -> [Self; BLOCK] {
        let [a, b, c, d, e, f, g, h] =
            [rows[0].0, rows[1].0, rows[2].0, rows[3].0, rows[4].0, rows[5].0, rows[6].0, rows[7].0];
        // SAFETY: see the head of the folder.
        unsafe {
            let (even_ab, odd_ab) = (_mm512_unpacklo_pd(a, b), _mm512_unpackhi_pd(a, b));
            let (even_cd, odd_cd) = (_mm512_unpacklo_pd(c, d), _mm512_unpackhi_pd(c, d));
            let (even_ef, odd_ef) = (_mm512_unpacklo_pd(e, f), _mm512_unpackhi_pd(e, f));
            let (even_gh, odd_gh) = (_mm512_unpacklo_pd(g, h), _mm512_unpackhi_pd(g, h));
            let pair = |a, b| quarters(Self(a), Self(b));
            let ((even_02, even_13), (even_02_too, even_13_too)) = (pair(even_ab, even_cd), pair(even_ef, even_gh));
            let ((odd_02, odd_13), (odd_02_too, odd_13_too)) = (pair(odd_ab, odd_cd), pair(odd_ef, odd_gh));
            let ((a, e), (b, f)) = (quarters(even_02, even_02_too), quarters(odd_02, odd_02_too));
            let ((c, g), (d, h)) = (quarters(even_13, even_13_too), quarters(odd_13, odd_13_too));
            [a, b, c, d, e, f, g, h]
        }
    }
}

/// Quarters 0 and 2 of two, then quarters 1 and 3.
#[inline(always)]
fn quarters(a: F64x8, b: F64x8) -> (F64x8, F64x8) {
    // SAFETY: see the head of the folder.
    unsafe { (F64x8(_mm512_shuffle_f64x2::<0x88>(a.0, b.0)), F64x8(_mm512_shuffle_f64x2::<0xdd>(a.0, b.0))) }
}

/// A transposition of four by four numbers in each half.
#[inline(always)]
fn in_halves([a, b, c, d]: [F64x8; QUAD]) -> [F64x8; QUAD] {
    // SAFETY: see the head of the folder.
    unsafe {
        let (even_ab, odd_ab) = (_mm512_unpacklo_pd(a.0, b.0), _mm512_unpackhi_pd(a.0, b.0));
        let (even_cd, odd_cd) = (_mm512_unpacklo_pd(c.0, d.0), _mm512_unpackhi_pd(c.0, d.0));
        let low = _mm512_set_epi64(13, 12, 5, 4, 9, 8, 1, 0);
        let high = _mm512_set_epi64(15, 14, 7, 6, 11, 10, 3, 2);
        [
            F64x8(_mm512_permutex2var_pd(even_ab, low, even_cd)),
            F64x8(_mm512_permutex2var_pd(odd_ab, low, odd_cd)),
            F64x8(_mm512_permutex2var_pd(even_ab, high, even_cd)),
            F64x8(_mm512_permutex2var_pd(odd_ab, high, odd_cd)),
        ]
    }
}

/// A transposition of four by four quarters.
#[inline(always)]
fn rows([a, b, c, d]: [F64x8; 4]) -> [F64x8; 4] {
    let ((ab_02, ab_13), (cd_02, cd_13)) = (quarters(a, b), quarters(c, d));
    let ((first, third), (second, fourth)) = (quarters(ab_02, cd_02), quarters(ab_13, cd_13));
    [first, second, third, fourth]
}

impl Lanes for F64x8 {
    const COUNT: usize = 8;
    type Half = F64x4;
    type Mask = Bits8;

    #[inline(always)]
    fn splat(number: f64) -> Self {
        // SAFETY: see the head of the folder.
        Self(unsafe { _mm512_set1_pd(number) })
    }

    #[inline(always)]
    fn load(numbers: &[f64]) -> Self {
        let numbers = &numbers[..Self::COUNT];
        // SAFETY: the list has that many numbers.
        Self(unsafe { _mm512_loadu_pd(numbers.as_ptr()) })
    }

    #[inline(always)]
    fn store(self, numbers: &mut [f64]) {
        let numbers = &mut numbers[..Self::COUNT];
        // SAFETY: the list has room for that many numbers.
        unsafe { _mm512_storeu_pd(numbers.as_mut_ptr(), self.0) }
    }

    #[inline(always)]
    fn records(records: &[Record], indices: &[u32]) -> [Self; BLOCK] {
        let row = |lane: usize| Self::load(&records[indices[lane] as usize].0);
        Self::transposed([row(0), row(1), row(2), row(3), row(4), row(5), row(6), row(7)])
    }

    #[inline(always)]
    fn store_records([a, b, c, d]: [Vectors<Self>; BLOCK / 2], records: &mut [Record]) {
        let records = &mut records[..Self::COUNT];
        let [first, second, third, fourth] = rows([a.0, b.0, c.0, d.0]);
        first.store(&mut records[0].0);
        second.store(&mut records[1].0);
        third.store(&mut records[2].0);
        fourth.store(&mut records[3].0);
        let [first, second, third, fourth] = rows([a.1, b.1, c.1, d.1]);
        first.store(&mut records[4].0);
        second.store(&mut records[5].0);
        third.store(&mut records[6].0);
        fourth.store(&mut records[7].0);
    }

    #[inline(always)]
    unsafe fn record_pairs(records: &[Record], first: &[u32], second: &[u32]) -> ([Self; BLOCK], [Self; 2]) {
        let (first, second) = (&first[..BLOCK], &second[..BLOCK]);
        let mut rows = [Self::splat(0.0); BLOCK];
        let mut lane = 0;
        // SAFETY: the indices are those of records, as the caller promises; see the head of the folder.
        unsafe {
            while lane < BLOCK {
                let own = Self::load(record_at(records, first[lane]));
                rows[lane] = Self::load(record_at(records, second[lane])).less_in_six(own);
                lane += 1;
            }
            let (even, odd) = (Self::last_two(records, first), Self::last_two(records, &first[1..]));
            let rest = [Self(_mm512_unpacklo_pd(even, odd)), Self(_mm512_unpackhi_pd(even, odd))];
            (Self::transposed(rows), rest)
        }
    }

    #[inline(always)]
    unsafe fn quads(quads: &[Quad], indices: &[u32]) -> [Self; QUAD] {
        let indices = &indices[..BLOCK];
        // SAFETY: the indices are those of quads, as the caller promises.
        let row = |lane: usize| unsafe {
            let low = _mm512_castpd256_pd512(quad_at(quads, indices[lane]));
            Self(_mm512_insertf64x4::<1>(low, quad_at(quads, indices[lane + QUAD])))
        };
        in_halves([row(0), row(1), row(2), row(3)])
    }

    #[inline(always)]
    unsafe fn store_quads(numbers: [Self; QUAD], quads: &mut [Quad], indices: &[u32]) {
        let (indices, rows) = (&indices[..BLOCK], in_halves(numbers));
        let mut lane = 0;
        while lane < QUAD {
            // SAFETY: likewise.
            unsafe {
                put_quad(quads, indices[lane], _mm512_castpd512_pd256(rows[lane].0));
                put_quad(quads, indices[lane + QUAD], _mm512_extractf64x4_pd::<1>(rows[lane].0));
            }
            lane += 1;
        }
    }

    #[inline(always)]
    fn interleaved(first: Self, second: Self) -> (Self, Self) {
        // SAFETY: see the head of the folder.
        unsafe {
            let low = _mm512_set_epi64(11, 3, 10, 2, 9, 1, 8, 0);
            let high = _mm512_set_epi64(15, 7, 14, 6, 13, 5, 12, 4);
            (
                Self(_mm512_permutex2var_pd(first.0, low, second.0)),
                Self(_mm512_permutex2var_pd(first.0, high, second.0)),
            )
        }
    }

    #[inline(always)]
    fn parted(low: Self, high: Self) -> (Self, Self) {
        // SAFETY: likewise.
        unsafe {
            let first = _mm512_set_epi64(14, 12, 10, 8, 6, 4, 2, 0);
            let second = _mm512_set_epi64(15, 13, 11, 9, 7, 5, 3, 1);
            (Self(_mm512_permutex2var_pd(low.0, first, high.0)), Self(_mm512_permutex2var_pd(low.0, second, high.0)))
        }
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        // SAFETY: see the head of the folder.
        Self(unsafe { _mm512_sqrt_pd(self.0) })
    }

    #[inline(always)]
    fn abs(self) -> Self {
        // SAFETY: likewise.
        Self(unsafe { _mm512_andnot_pd(Self::splat(-0.0).0, self.0) })
    }

    #[inline(always)]
    fn at_least_zero(self) -> Self {
        // SAFETY: likewise. If an operand is NaN, or both are zero, the instruction gives its second operand.
        Self(unsafe { _mm512_max_pd(self.0, Self::splat(0.0).0) })
    }

    #[inline(always)]
    fn copysign(self, sign: Self) -> Self {
        // SAFETY: likewise.
        Self(unsafe { _mm512_or_pd(self.abs().0, _mm512_and_pd(sign.0, Self::splat(-0.0).0)) })
    }

    #[inline(always)]
    fn lt(self, other: Self) -> Bits8 {
        // SAFETY: likewise.
        Bits8(unsafe { _mm512_cmp_pd_mask::<_CMP_LT_OQ>(self.0, other.0) })
    }

    #[inline(always)]
    fn mask(bits: u8) -> Bits8 {
        Bits8(bits)
    }

    #[inline(always)]
    fn bits(mask: Bits8) -> u8 {
        mask.0
    }

    #[inline(always)]
    fn select(mask: Bits8, yes: Self, no: Self) -> Self {
        // SAFETY: likewise.
        Self(unsafe { _mm512_mask_blend_pd(mask.0, no.0, yes.0) })
    }
}
