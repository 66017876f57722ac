//! The standard plugins, in the order of the tick: the table of contents of the physics.
//!
//! Here they only register what a scene may name. What a scene names is installed when it is read, in this order;
//! what it does not name is not scheduled, not stored, not paid for.

use bevy_app::App;

use crate::{contacts, expect, forces, integrate, record, scene, sensors, world};

/// Registers everything the scene language offers.
pub fn standard(app: &mut App) {
    scene::sections::plugin(app);
    integrate::plugin(app);
    world::plugin(app);
    forces::plugin(app);
    contacts::plugin(app);
    sensors::plugin(app);
    expect::plugin(app);
    record::layers::plugin(app);
}
