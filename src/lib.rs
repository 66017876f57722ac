//! draft
#![allow(missing_docs)]
pub mod output;
pub mod raster;
pub mod record;
