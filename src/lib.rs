//! draft
#![allow(missing_docs)]
pub mod output;
pub mod raster;
pub mod record;
pub mod scene;
pub mod shapes;
pub mod world;
