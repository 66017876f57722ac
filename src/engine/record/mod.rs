//! From the world to plain frames and channels. Rooms behind this border do not use the ECS.

pub mod layers;
mod legend;
pub mod sections;

pub use jostle_frames::{Mark, MarkShape, Schedule, follow, frame, plot, spool};
pub use layers::{FilmAppExt, Layer};
pub use legend::{LegendAppExt, legend};
