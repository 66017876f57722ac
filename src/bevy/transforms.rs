//! Transforms of bodies for the programs that draw them: each `Transform` follows the position and the angle of its body.

use std::f64::consts::TAU;

use bevy_app::{App, FixedPostUpdate, Plugin, PostStartup};
use bevy_ecs::prelude::*;
use bevy_transform::components::Transform;

use super::Physics;
use crate::world::{Body, Position, Rotation};

/// Gives each body a `Transform`, and updates it at the start and in each `FixedPostUpdate`, after the ticks. It sets x, y and
/// the rotation about z. The app sets z and the scale.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SyncTransforms {
    /// The length of a metre in the app, such as 100 for a hundred pixels.
    pub units_per_meter: f64,
}

impl Default for SyncTransforms {
    fn default() -> Self {
        Self { units_per_meter: 1.0 }
    }
}

impl Plugin for SyncTransforms {
    fn build(&self, app: &mut App) {
        let scale = self.units_per_meter;
        let follow = move |commands: Commands, bodies: Bodies| follow(commands, bodies, scale);
        app.add_systems(PostStartup, follow).add_systems(FixedPostUpdate, follow.after(Physics));
    }
}

type Bodies<'w, 's> =
    Query<'w, 's, (Entity, &'static Position, &'static Rotation, Option<&'static mut Transform>), With<Body>>;

fn follow(mut commands: Commands, mut bodies: Bodies, scale: f64) {
    for (body, position, rotation, transform) in &mut bodies {
        let place = position.0 * scale;
        let mut own = transform.as_deref().copied().unwrap_or_default();
        let mut at = Transform::from_xyz(place.x as f32, place.y as f32, own.translation.z);
        // Many turns leave an `f32` no digits for the angle.
        at.rotate_z((rotation.0 % TAU) as f32);
        (own.translation, own.rotation) = (at.translation, at.rotation);
        match transform {
            // A body that has not moved does not count as changed.
            Some(mut transform) => _ = transform.set_if_neq(own),
            None => _ = commands.entity(body).insert(own),
        }
    }
}
