//! World -> plain frames and channels. Behind this border nothing knows the ECS.

pub mod follow;
pub mod frame;
pub mod layers;
pub mod plot;
mod schedule;
pub mod sections;
pub mod spool;

pub use layers::{FilmAppExt, Layer, Mark, MarkShape};
pub use schedule::Schedule;
