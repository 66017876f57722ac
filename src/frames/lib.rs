//! Films and plots, as plain data. The engine makes it and the painter draws it, independently of each other.

pub mod color_names;
pub mod follow_camera;
pub mod frame;
pub mod frame_spool;
pub mod mark;
pub mod plot;
mod schedule;

pub use mark::{Corner, Mark, MarkShape};
pub use schedule::Schedule;
