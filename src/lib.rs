//! draft
pub mod scene;
pub mod world;
pub mod tick;
pub mod forces;
pub mod contacts;
pub mod integrate;
pub mod bounds;
pub mod sensors;
pub mod expect;
pub mod record;
pub mod raster;
pub mod output;
pub mod report;
