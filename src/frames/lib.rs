//! Films and plots, as plain data. The engine makes it and the painter draws it, independently of each other.

pub mod follow;
pub mod frame;
pub mod mark;
pub mod palette;
pub mod plot;
mod schedule;
pub mod spool;

pub use mark::{Corner, Mark, MarkShape};
pub use schedule::Schedule;
