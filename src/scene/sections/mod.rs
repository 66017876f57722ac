//! The sections of the scene language that come with the engine, as plain data: one file each.
//!
//! Each has its fields with units and defaults, `declare` for the names it brings and `check` for what types cannot
//! exclude. What is built from them stands with the model that needs it.

pub mod bodies;
pub mod camera;
pub mod clock;
pub mod fill;
pub mod film;
pub mod walls;

pub use bodies::{BodiesSection, BodyEntry, Datum, InertiaRule};
pub use camera::{FitCamera, LookCamera};
pub use clock::{ClockSection, EventTiming};
pub use fill::{FillEntry, FillSection};
pub use film::FilmSection;
pub use walls::{WallEntry, WallsSection};
