//! Drag: `F = -c v` (linear, Stokes) and `F = -c |v| v` (quadratic, Newton), on the centre of mass.

use bevy_app::App;
use bevy_ecs::prelude::*;

use super::Targets;
use crate::tick::{Balance, Dependence, TickAppExt};
use crate::world::Bodies;

/// One entry, ready to be applied.
#[derive(Clone, Debug)]
pub struct DragForce {
    /// Linear coefficient in N s/m.
    pub linear: f64,
    /// Quadratic coefficient in N s2/m2.
    pub quadratic: f64,
    /// The bodies it acts on.
    pub of: Targets,
}

#[derive(Resource)]
struct Drags(Vec<DragForce>);

/// Installs drag.
pub fn install(drags: Vec<DragForce>, app: &mut App) {
    app.insert_resource(Drags(drags));
    app.add_packed_force(Dependence::Velocity, apply_drag);
}

fn apply_drag(mut drags: ResMut<Drags>, mut bodies: ResMut<Bodies>, mut balance: ResMut<Balance>) {
    for drag in &mut drags.0 {
        for body in drag.of.places(&bodies) {
            let velocity = bodies.velocity[body];
            let force = velocity * -(drag.linear + drag.quadratic * velocity.length());
            bodies.force[body] += force;
            balance.outside(bodies.position[body], force, 0.0);
            balance.drag -= force.dot(velocity);
        }
    }
}
