//! What stands in the world.

pub mod material;
