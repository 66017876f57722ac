//! Two, four and eight lanes on x86-64.
//!
//! Each operation is one instruction of the processor. The types are made only inside [`super::run`], which checks the
//! instructions of the processor. That makes the calls below sound.

mod eight;
mod four;
mod two;

use std::arch::x86_64::{__m128d, __m256d, _mm_loadu_pd, _mm256_loadu_pd, _mm256_storeu_pd};

use super::{BLOCK, QUAD, Quad, Record};

pub use eight::F64x8;
pub use four::F64x4;
pub use two::F64x2;

macro_rules! operators {
    ($name:ident: $($operation:ident $method:ident $instruction:ident),*) => {
        $(impl $operation for $name {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                // SAFETY: see the head of the folder.
                Self(unsafe { $instruction(self.0, other.0) })
            }
        })*

        impl Neg for $name {
            type Output = Self;
            #[inline(always)]
            fn neg(self) -> Self {
                self.flip(Self::splat(-0.0))
            }
        }
    };
}

/// Masks are numbers with all bits set or no bit set.
macro_rules! bit_operators {
    ($name:ident, $and:ident, $or:ident, $xor:ident, $all:expr) => {
        impl BitAnd for $name {
            type Output = Self;
            #[inline(always)]
            fn bitand(self, other: Self) -> Self {
                // SAFETY: see the head of the folder.
                Self(unsafe { $and(self.0, other.0) })
            }
        }

        impl BitOr for $name {
            type Output = Self;
            #[inline(always)]
            fn bitor(self, other: Self) -> Self {
                // SAFETY: see the head of the folder.
                Self(unsafe { $or(self.0, other.0) })
            }
        }

        impl Not for $name {
            type Output = Self;
            #[inline(always)]
            fn not(self) -> Self {
                // SAFETY: see the head of the folder.
                Self(unsafe { $xor(self.0, $all) })
            }
        }
    };
}

use {bit_operators, operators};

/// The numbers of a record.
///
/// # Safety
/// The index is that of the first number of a record.
#[inline(always)]
unsafe fn record_at(records: &[Record], index: u32) -> &[f64; BLOCK] {
    // SAFETY: as the caller promises.
    unsafe { &*records.as_ptr().cast::<f64>().add(index as usize).cast() }
}

/// The numbers of a quad.
///
/// # Safety
/// The index is that of a quad.
#[inline(always)]
unsafe fn quad_at(quads: &[Quad], index: u32) -> __m256d {
    // SAFETY: as the caller promises.
    unsafe { _mm256_loadu_pd((*quads.as_ptr().add(index as usize)).0.as_ptr()) }
}

/// Writes the numbers of a quad.
///
/// # Safety
/// Likewise.
#[inline(always)]
unsafe fn put_quad(quads: &mut [Quad], index: u32, numbers: __m256d) {
    // SAFETY: as the caller promises; a quad has four numbers.
    unsafe { _mm256_storeu_pd(quads.as_mut_ptr().add(index as usize).cast::<[f64; QUAD]>().cast(), numbers) }
}

/// The last two numbers of a record.
///
/// # Safety
/// Likewise.
#[inline(always)]
unsafe fn last_two_of(records: &[Record], index: u32) -> __m128d {
    // SAFETY: as the caller promises; a record has two numbers from the seventh on.
    unsafe { _mm_loadu_pd(record_at(records, index).as_ptr().add(BLOCK - 2)) }
}
