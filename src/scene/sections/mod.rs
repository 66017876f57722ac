//! The sections of the scene language that come with the engine, as plain data: one file each.
//!
//! Each has its fields with units and defaults, and says which names it brings, what types cannot exclude, and what is
//! built from it.

pub mod bodies;
pub mod camera;
pub mod clock;
pub mod fill;
pub mod film;
mod install;
pub mod kinematic;
pub mod look;
pub mod packing;
pub mod plots;
pub mod region;
pub mod walls;

pub use bodies::{BodiesSection, BodyEntry, Datum, InertiaRule};
pub use camera::{CameraChoice, FitCamera, FollowCamera, LookCamera};
pub use clock::{ClockSection, EventTiming};
pub use fill::{FillEntry, FillSection};
pub use film::{FilmSection, FreezeEntry};
pub use install::plugin;
pub use kinematic::{KinematicEntry, PathEntry};
pub use look::LookSection;
pub use packing::{PackingEntry, PackingsSection};
pub use plots::{HistogramEntry, PlotEntry, PlotsSection};
pub use region::Region;
pub use walls::{WallEntry, WallsSection};
