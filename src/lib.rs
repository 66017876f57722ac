//! draft
#![allow(missing_docs)]
pub mod record;
pub mod raster;
pub mod output;
