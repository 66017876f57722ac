//! Thrust: a force at a point of a body, constant in the body's frame or in the world's, between two times.

use bevy_app::App;
use bevy_ecs::prelude::*;
use glam::DVec2;

use super::Targets;
use crate::tick::{Balance, Dependence, Evaluation, TickAppExt};
use crate::world::Bodies;

/// One entry, ready to be applied.
#[derive(Clone, Debug)]
pub struct ThrustForce {
    /// The bodies it acts on.
    pub of: Targets,
    /// Where it acts, in the body's frame from its centre of mass, in metres.
    pub at: DVec2,
    /// Force in newtons.
    pub force: DVec2,
    /// Whether the force turns with the body.
    pub turns: bool,
    /// It acts from this time on, in seconds.
    pub from: f64,
    /// It no longer acts at this time, in seconds.
    pub to: f64,
}

#[derive(Resource)]
struct Thrusts(Vec<ThrustForce>);

/// Installs thrust.
pub fn install(thrusts: Vec<ThrustForce>, app: &mut App) {
    app.insert_resource(Thrusts(thrusts));
    app.add_packed_force(Dependence::Position, apply_thrust);
}

fn apply_thrust(
    mut thrusts: ResMut<Thrusts>,
    mut bodies: ResMut<Bodies>,
    mut balance: ResMut<Balance>,
    evaluation: Res<Evaluation>,
) {
    for thrust in &mut thrusts.0 {
        if !(thrust.from..thrust.to).contains(&evaluation.time) {
            continue;
        }
        for body in thrust.of.places(&bodies) {
            let (sin, cos) = libm::sincos(bodies.angle[body]);
            let rotation = DVec2::new(cos, sin);
            let force = if thrust.turns { rotation.rotate(thrust.force) } else { thrust.force };
            let arm = rotation.rotate(thrust.at);
            bodies.push(body, arm, force);
            balance.outside(bodies.position[body], force, arm.perp_dot(force));
            balance.work += force.dot(bodies.velocity_at(body, arm));
        }
    }
}
