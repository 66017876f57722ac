//! Gravity: a uniform field, `F = m g`, potential energy `-m g . x`.

use bevy_app::App;
use bevy_ecs::prelude::*;
use glam::DVec2;
use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::Deserialize;

use crate::scene::units::AccelerationPair;
use crate::scene::{Outline, SceneAppExt, Section};
use crate::tick::balance::EnergyTerms;
use crate::tick::{Balance, Dependence, TickAppExt};
use crate::world::Bodies;

/// The acceleration of free fall. A scene without this section has no gravity.
#[derive(Deserialize, JsonSchema)]
#[serde(transparent)]
struct GravitySection(AccelerationPair);

impl Section for GravitySection {
    const NAME: &'static str = "gravity";
    const EXAMPLE: &'static str = "gravity: (0, -9.81)";

    fn schema(generator: &mut SchemaGenerator) -> Option<Schema> {
        Some(generator.subschema_for::<Self>())
    }

    fn install(self, _: &Outline, app: &mut App) {
        install(Gravity(self.0.si()), app);
    }
}

/// The acceleration of free fall in m/s2.
#[derive(Resource, Clone, Copy, Debug, PartialEq)]
pub struct Gravity(pub DVec2);

/// Installs the field.
pub fn install(gravity: Gravity, app: &mut App) {
    app.insert_resource(gravity);
    app.add_packed_force(Dependence::Nothing, apply_gravity);
    app.world_mut().get_resource_or_init::<EnergyTerms>().potential.push(potential_energy);
}

pub(super) fn plugin(app: &mut App) {
    app.register_section::<GravitySection>();
}

fn apply_gravity(gravity: Res<Gravity>, mut bodies: ResMut<Bodies>, mut balance: ResMut<Balance>) {
    let bodies = &mut *bodies;
    let (mut mass, mut moment) = (0.0, DVec2::ZERO);
    for body in (0..bodies.dynamic.len()).filter(|&body| bodies.dynamic[body]) {
        bodies.force[body] += gravity.0 * bodies.mass[body];
        mass += bodies.mass[body];
        moment += bodies.position[body] * bodies.mass[body];
    }
    balance.force += gravity.0 * mass;
    balance.torque += moment.perp_dot(gravity.0);
}

fn potential_energy(world: &World) -> f64 {
    let (bodies, gravity) = (world.resource::<Bodies>(), world.resource::<Gravity>());
    let of = |body: usize| -bodies.mass[body] * gravity.0.dot(bodies.position[body]);
    (0..bodies.len()).filter(|&body| bodies.dynamic[body]).map(of).sum()
}
