//! A constant torque on a body.

use bevy_app::App;
use bevy_ecs::prelude::*;

use super::Targets;
use crate::tick::{Balance, Dependence, TickAppExt};
use crate::world::Bodies;

/// One entry, ready to be applied.
#[derive(Clone, Debug)]
pub struct ConstantTorque {
    /// The bodies it acts on.
    pub of: Targets,
    /// Torque in N m, counter-clockwise.
    pub value: f64,
}

#[derive(Resource)]
struct Torques(Vec<ConstantTorque>);

/// Installs torques.
pub fn install(torques: Vec<ConstantTorque>, app: &mut App) {
    app.insert_resource(Torques(torques));
    app.add_packed_force(Dependence::Position, apply_torque);
}

fn apply_torque(mut torques: ResMut<Torques>, mut bodies: ResMut<Bodies>, mut balance: ResMut<Balance>) {
    for torque in &mut torques.0 {
        for body in torque.of.places(&bodies) {
            bodies.torque[body] += torque.value;
            balance.torque += torque.value;
            balance.work += torque.value * bodies.spin[body];
        }
    }
}
