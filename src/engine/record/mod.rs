//! World -> plain frames and channels. Behind this border nothing knows the ECS.

pub mod layers;
mod legend;
pub mod sections;

pub use jostle_frames::{Mark, MarkShape, Schedule, follow, frame, plot, spool};
pub use layers::{FilmAppExt, Layer};
pub use legend::{LegendAppExt, legend};
