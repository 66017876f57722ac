//! Vector instructions of the processor, chosen at run time, and kernels compiled for each level (function
//! multiversioning).

use std::fmt;
use std::str::FromStr;
use std::sync::OnceLock;

use super::Lanes;
#[cfg(target_arch = "x86_64")]
use super::x86::{F64x2, F64x4, F64x8};

/// A set of vector instructions.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Level {
    /// One number at a time. On any processor.
    Scalar,
    /// The instructions of every processor of the architecture: two numbers at once on x86-64. Elsewhere it is one
    /// number, unless the compiler vectorises.
    Baseline,
    /// Four numbers at once.
    Avx2,
    /// Eight numbers at once: AVX-512 F, DQ and VL.
    Avx512,
}

impl Level {
    /// All levels, the least first.
    pub const ALL: [Self; 4] = [Self::Scalar, Self::Baseline, Self::Avx2, Self::Avx512];

    /// Whether this processor has it.
    pub fn is_available(self) -> bool {
        match self {
            Self::Scalar | Self::Baseline => true,
            #[cfg(target_arch = "x86_64")]
            Self::Avx2 => is_x86_feature_detected!("avx2"),
            #[cfg(target_arch = "x86_64")]
            Self::Avx512 => {
                is_x86_feature_detected!("avx512f")
                    && is_x86_feature_detected!("avx512dq")
                    && is_x86_feature_detected!("avx512vl")
            }
            #[cfg(not(target_arch = "x86_64"))]
            Self::Avx2 | Self::Avx512 => false,
        }
    }

    /// The best that this processor has, with all below it.
    pub fn best() -> Self {
        static BEST: OnceLock<Level> = OnceLock::new();
        let available = || Self::ALL.into_iter().take_while(|level| level.is_available());
        *BEST.get_or_init(|| available().last().unwrap_or(Self::Scalar))
    }

    /// Its word on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Scalar => "scalar",
            Self::Baseline => "baseline",
            Self::Avx2 => "avx2",
            Self::Avx512 => "avx512",
        }
    }
}

impl fmt::Display for Level {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(self.name())
    }
}

impl FromStr for Level {
    type Err = String;

    /// # Errors
    /// An unknown word, or a level that this processor does not have.
    fn from_str(word: &str) -> Result<Self, String> {
        let known = Self::ALL.into_iter().find(|level| level.name() == word);
        let level = known.ok_or_else(|| "expected `scalar`, `baseline`, `avx2` or `avx512`".to_owned())?;
        if level.is_available() {
            Ok(level)
        } else {
            Err(format!(
                "this processor has no {level}. Its best is `{}`, which the program takes without the flag",
                Self::best()
            ))
        }
    }
}

impl Default for Level {
    /// The best.
    fn default() -> Self {
        Self::best()
    }
}

/// Work that can be done with any number of lanes.
pub trait Kernel {
    /// The result.
    type Output;

    /// Does it. To be marked `#[inline(always)]`, like all that it calls: only then it is compiled for each level.
    fn run<V: Lanes>(self) -> Self::Output;
}

/// Runs a kernel with the instructions of a level.
///
/// # Panics
/// If the processor does not have them.
pub fn run<K: Kernel>(level: Level, kernel: K) -> K::Output {
    assert!(level <= Level::best(), "this processor has no {level}");
    match level {
        Level::Scalar => kernel.run::<f64>(),
        #[cfg(target_arch = "x86_64")]
        Level::Baseline => kernel.run::<F64x2>(),
        // SAFETY: the assertion has checked that the processor has the instructions.
        #[cfg(target_arch = "x86_64")]
        Level::Avx2 => unsafe { with_avx2(kernel) },
        // SAFETY: likewise.
        #[cfg(target_arch = "x86_64")]
        Level::Avx512 => unsafe { with_avx512(kernel) },
        #[cfg(not(target_arch = "x86_64"))]
        _ => kernel.run::<f64>(),
    }
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
fn with_avx2<K: Kernel>(kernel: K) -> K::Output {
    kernel.run::<F64x4>()
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx512f,avx512dq,avx512vl,avx2")]
fn with_avx512<K: Kernel>(kernel: K) -> K::Output {
    kernel.run::<F64x8>()
}
