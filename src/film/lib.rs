//! From plain frames to pictures to files. This crate does not use the ECS.

pub mod raster;

pub mod output;
