//! How wrong the result is.

pub mod card;
pub mod energy;

pub use card::Card;
