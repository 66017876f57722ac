//! World -> plain frames and channels. Behind this border nothing knows the ECS.

pub mod between;
pub mod frame;
mod recorder;

pub use recorder::{Recorder, Schedule};
