//! What films and plots show, as plain data. The engine makes it, the painter draws it; neither knows the other.

pub mod follow;
pub mod frame;
pub mod mark;
pub mod palette;
pub mod plot;
mod schedule;
pub mod spool;

pub use mark::{Corner, Mark, MarkShape};
pub use schedule::Schedule;
