//! How wrong the result is.

mod advice;
pub mod bench;
pub mod card;
pub mod estimate;
pub mod ladder;
pub mod measure;
pub mod reversal;
pub mod survey;
mod verdict;
mod warnings;

pub use advice::Remedy;
pub use card::Card;
