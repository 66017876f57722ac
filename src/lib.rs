//! draft
pub mod world;
pub mod tick;
pub mod bounds;
pub mod forces;
pub mod contacts;
pub mod integrate;
pub mod record;
pub mod raster;
pub mod output;
