//! World -> plain frames and channels. Behind this border nothing knows the ECS.

pub mod between;
pub mod follow;
pub mod frame;
pub mod layers;
pub mod plot;
mod recorder;
mod schedule;
pub mod spool;

pub use layers::{FilmAppExt, Layer, Mark, MarkShape};
pub use recorder::Recorder;
pub use schedule::Schedule;
