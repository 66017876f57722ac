//! World -> plain frames and channels. Behind this border nothing knows the ECS.

pub mod between;
pub mod frame;
pub mod layers;
mod recorder;

pub use layers::{FilmAppExt, Mark, MarkShape};
pub use recorder::{Recorder, Schedule};
