//! The physics of Jostle: a scene becomes a world, and the world moves. Use it through the crate `jostle`.
//!
//! The modules are listed in the order of their dependence. A module uses those above it in the list below and none
//! under it, and a test checks that. A physical model is independent of pictures.

pub mod threads;

pub mod scene;

pub mod shapes;
pub mod world;

pub mod constraints;
pub mod tick;

pub mod contacts;
pub mod forces;
pub mod joints;

pub mod controllers;

pub mod integrate;

pub mod sensors;

pub mod expect;

pub mod record;

pub mod plugins;
pub mod simulation;

pub use simulation::Simulation;
