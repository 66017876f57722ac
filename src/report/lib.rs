//! The error of results: the error card, estimates, ladders of ticks, and problems with known answers.

mod advice;
pub mod bench;
pub mod card;
pub mod estimate;
pub mod ladder;
pub mod measure;
pub mod problems;
pub mod reversal;
pub mod survey;
mod verdict;
mod warnings;

pub use advice::Remedy;
pub use card::{Card, SimulationExt};
