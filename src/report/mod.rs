//! How wrong the result is.

pub mod card;
pub mod energy;
pub mod warnings;

pub use card::Card;
