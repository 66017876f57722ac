//! Gravity: a uniform field, `F = m g`, potential energy `-m g . x`.

use bevy_app::App;
use bevy_ecs::prelude::*;
use glam::DVec2;
use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::Deserialize;

use crate::scene::units::AccelerationPair;
use crate::scene::{Outline, SceneAppExt, Section};
use crate::tick::balance::EnergyTerms;
use crate::tick::direct::{Asked, Direct, Energies, Part, State};
use crate::tick::registered::Registered;
use crate::tick::{Balance, Census, Evaluate, EvaluateStage, ForceSlot, TickAppExt};
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
    app.world_mut().get_resource_or_init::<EnergyTerms>().potential.push(potential_energy);
    let mark = Registered::mark(app.world());
    app.add_flight_systems(Evaluate, apply_gravity.in_set(EvaluateStage::Forces).before(ForceSlot(0)));
    // Direct forms act in the order in which they are added, and the weight before all other forces.
    if app.world().get_resource::<Census>().is_some_and(|census| census.force_slots > 0) {
        return;
    }
    Direct::add(app.world_mut(), mark, Asked { energies: 1, ..Asked::default() }, Weight(gravity));
}

pub(super) fn plugin(app: &mut App) {
    app.register_section::<GravitySection>();
}

fn apply_gravity(gravity: Res<Gravity>, mut bodies: ResMut<Bodies>, mut balance: ResMut<Balance>) {
    weigh(*gravity, &mut bodies, &mut balance);
}

/// The direct form.
struct Weight(Gravity);

impl Part for Weight {
    fn exchange(&mut self, world: &mut World) {
        self.0 = *world.resource();
    }

    fn evaluate(&mut self, stage: EvaluateStage, state: &mut State) {
        if stage == EvaluateStage::Forces {
            weigh(self.0, &mut state.bodies, &mut state.balance);
        }
    }

    fn energies(&self, state: &State) -> Energies {
        Energies { potential: energy_in(self.0, &state.bodies), elastic: 0.0 }
    }
}

/// The weight is where the sum of forces begins: bodies have it as soon as their forces are cleared. It is left to be told
/// which, and to be booked.
fn weigh(gravity: Gravity, bodies: &mut Bodies, balance: &mut Balance) {
    if bodies.field != Some(gravity.0) {
        bodies.field = Some(gravity.0);
        bodies.posed = false;
        bodies.pose();
    }
    let (mass, moment) = bodies.weighed;
    balance.force += gravity.0 * mass;
    balance.torque += moment.perp_dot(gravity.0);
}

fn potential_energy(world: &World) -> f64 {
    energy_in(*world.resource(), world.resource())
}

fn energy_in(gravity: Gravity, bodies: &Bodies) -> f64 {
    let of = |body: usize| -bodies.mass[body] * gravity.0.dot(bodies.position[body]);
    (0..bodies.len()).filter(|&body| bodies.dynamic[body]).map(of).sum()
}
