//! The error of results: the error card, estimates, work-precision series, and problems with known answers.

mod advice;
mod at_rest;
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

/// The text with a capital letter at its beginning, as a sentence has it.
fn capital(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}
