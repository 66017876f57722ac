//! From the world to plain frames and channels. Rooms behind this border do not use the ECS.

pub mod layers;
mod legend;
pub mod sections;

pub use jostle_frames::{Mark, MarkShape, Schedule, follow_camera, frame, frame_spool, plot};
pub use layers::{FilmAppExt, Layer};
pub use legend::{LegendAppExt, legend};
