//! How wrong the result is: the error card, estimates, ladders of ticks, and problems whose answers are known.

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
