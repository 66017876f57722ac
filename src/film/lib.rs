//! Plain frames -> pictures -> files. Nothing in here knows the ECS.

pub mod raster;

pub mod output;
