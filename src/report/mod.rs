//! How wrong the result is.

mod advice;
pub mod card;
pub mod energy;
mod warnings;

pub use card::Card;
