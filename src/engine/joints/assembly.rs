//! Initial assembly of a scene with joints: positions and velocities that satisfy the joints.

use bevy_ecs::prelude::*;

use super::joint_model::Joint;
use crate::scene::SceneError;
use crate::tick::{FailureKind, LoadErrors, Notes, State};
use crate::world::{Name, Position, Rotation, Spin, Velocity};
use jostle_language::numbers::number;

/// Changes of less than this share of the initial value are not reported.
const TOLD: f64 = 1e-6;

/// A joint that is open by less, in metres, is closed.
const CLOSED: f64 = 1e-9;

/// Brings the bodies of the scene onto its joints. Reports each body whose position or velocity changed.
pub(super) fn assemble(world: &mut World) {
    let mut state = world.resource_mut::<State>();
    let before = state.bodies().position.clone();
    let turned = state.bodies().angle.clone();
    let moving: Vec<_> = state.bodies().velocity.iter().copied().zip(state.bodies().spin.iter().copied()).collect();
    let assembled = state.assemble();
    if let Err((FailureKind::Contradiction, body)) = assembled {
        let entity = body.map(|body| state.bodies().entity[body]);
        let name = entity.and_then(|entity| world.get::<Name>(entity)).map(Name::to_string).unwrap_or_default();
        let message = format!("motors and joints ask for different motions of `{name}`: no velocity suits them all");
        let help = "remove one of the joints or motors that hold it, or give a motor a `limit`";
        let error = SceneError::new("joints", message).with_help(help);
        world.get_resource_or_init::<LoadErrors>().0.push(error);
        return;
    }
    if assembled.is_err() {
        let open = |joint: &&Joint| joint.drift(state.bodies()).total_cmp(&CLOSED).is_gt();
        let path = state.models_of::<Joint>().find(open).map_or("joints", |joint| joint.path()).to_owned();
        let help = "move bodies or anchors nearer to where the joints meet, and see whether lengths fit";
        let error = SceneError::new(path, "no place of its bodies closes this joint").with_help(help);
        world.get_resource_or_init::<LoadErrors>().0.push(error);
        return;
    }
    let bodies = world.resource::<State>().bodies();
    let speed_of = |body: usize| bodies.velocity[body].length() + bodies.spin[body].abs() * bodies.extent(body);
    let fastest = (0..before.len()).map(speed_of).fold(0.0, f64::max);
    let mut notes = Vec::new();
    for body in 0..before.len() {
        let bodies = world.resource::<State>().bodies();
        let (entity, position, angle) = (bodies.entity[body], bodies.position[body], bodies.angle[body]);
        let (velocity, spin) = (bodies.velocity[body], bodies.spin[body]);
        if !bodies.dynamic[body] {
            continue;
        }
        let extent = bodies.extent(body);
        let (moved, turn) = (position.distance(before[body]), angle - turned[body]);
        let (faster, spun) = (velocity.distance(moving[body].0), spin - moving[body].1);
        let size = extent + position.length();
        let name = world.get::<Name>(entity).map(Name::to_string).unwrap_or_default();
        if moved + turn.abs() * extent > TOLD * size {
            notes.push(format!(
                "to close its joints, the engine moved `{name}` by {} m and turned it by {} rad",
                number(moved),
                number(turn)
            ));
        }
        if faster + spun.abs() * extent > TOLD * fastest {
            notes.push(format!(
                "`{name}` begins with ({}, {}) m/s and {} rad/s: of all motions that its joints allow, this one is nearest to \
                 the scene's",
                number(velocity.x),
                number(velocity.y),
                number(spin)
            ));
        }
        world.entity_mut(entity).insert((Position(position), Rotation(angle), Velocity(velocity), Spin(spin)));
    }
    world.resource_mut::<Notes>().0.extend(notes);
}
