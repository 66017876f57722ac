//! The error of results: the error card, estimates, ladders of ticks, and problems with known answers.

mod advice;
pub mod bench;
pub mod card;
pub mod document;
pub mod estimate;
pub mod measure;
pub mod problems;
pub mod reversal;
mod verdict;
mod warnings;
pub mod work_precision;

pub use advice::Remedy;
pub use card::{Card, SimulationExt};
