//! A constant torque on a body.

use bevy_app::App;
use bevy_ecs::prelude::*;
use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::Deserialize;

use super::{Targets, check_targets};
use crate::scene::values::Names;
use crate::scene::{Entry, Outline, Report, SceneAppExt, Written, units};
use crate::tick::direct_force::{ForceOnBodies, add_force_on_bodies};
use crate::tick::{Balance, Dependence};
use crate::world::Bodies;

/// A constant torque.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Torque {
    /// The bodies it acts on, `*` matches.
    of: Names,
    /// Torque in N m, counter-clockwise.
    value: units::Torque,
}

impl Entry for Torque {
    const SECTION: &'static str = "forces";
    const NAME: &'static str = "Torque";
    const EXAMPLE: &'static str = "Torque(of: \"flywheel\", value: 0.05)";

    fn schema(generator: &mut SchemaGenerator) -> Option<Schema> {
        Some(generator.subschema_for::<Self>())
    }

    fn check(&self, outline: &Outline, report: &mut Report) {
        check_targets(Some(&self.of), outline, report);
    }

    fn install(entries: Vec<Written<Self>>, outline: &Outline, app: &mut App) {
        let torque = |Written { value, .. }: Written<Self>| ConstantTorque {
            of: Targets::named(Some(&value.of), outline),
            value: value.value.si(),
        };
        install(entries.into_iter().map(torque).collect(), app);
    }
}

/// One entry, ready to be applied.
#[derive(Clone, Debug)]
pub struct ConstantTorque {
    /// The bodies it acts on.
    pub of: Targets,
    /// Torque in N m, counter-clockwise.
    pub value: f64,
}

#[derive(Resource, Default)]
struct Torques(Vec<ConstantTorque>);

/// Installs torques.
pub fn install(torques: Vec<ConstantTorque>, app: &mut App) {
    add_force_on_bodies(app, Torques(torques));
}

pub(super) fn plugin(app: &mut App) {
    app.register_entry::<Torque>();
}

impl ForceOnBodies for Torques {
    // The torque does not depend on velocities, its power does.
    const DEPENDENCE: Dependence = Dependence::Velocity;

    fn act(&mut self, bodies: &mut Bodies, balance: &mut Balance) {
        for torque in &mut self.0 {
            for body in torque.of.places(bodies) {
                bodies.torque[body] += torque.value;
                balance.torque += torque.value;
                balance.work += torque.value * bodies.spin[body];
            }
        }
    }
}
