//! Gravity: a uniform field, `F = m g`, potential energy `-m g . x`.

use bevy_app::App;
use bevy_ecs::prelude::*;
use glam::DVec2;
use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::Deserialize;

use crate::scene::units::AccelerationPair;
use crate::scene::{Outline, SceneAppExt, Section};
use crate::simd::{BLOCK, Lanes};
use crate::tick::balance::EnergyTerms;
use crate::tick::{Balance, Dependence, TickAppExt};
use crate::world::Bodies;
use crate::world::part::{Part, PerBody};

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
    let (mut mass, mut moment) = (0.0, DVec2::ZERO);
    bodies.each(Weigh { gravity: gravity.0, sums: [[0.0; BLOCK]; 3] }, |part| {
        let [part, x, y] = part.sums.map(|partial| partial.into_iter().fold(0.0, |sum, part| sum + part));
        mass += part;
        moment += DVec2::new(x, y);
    });
    balance.force += gravity.0 * mass;
    balance.torque += moment.perp_dot(gravity.0);
}

/// Adds the weight of each body that is not asleep, and sums their mass, and mass times place.
#[derive(Clone)]
struct Weigh {
    gravity: DVec2,
    sums: [[f64; BLOCK]; 3],
}

impl PerBody for Weigh {
    #[inline(always)]
    fn bodies<V: Lanes>(&mut self, part: &mut Part, first: usize) {
        let lane = first % BLOCK;
        let mut moves = V::load(&part.inverse_mass[first..]).gt(V::splat(0.0));
        if let Some(asleep) = part.asleep.get(first / BLOCK) {
            moves = moves & V::mask(!asleep >> lane);
        }
        let mass = V::load(&part.mass[first..]).only(moves);
        let (x, y) = V::load_pairs(&part.position[first..]);
        let (force_x, force_y) = V::load_pairs(&part.force[first..]);
        let (gravity_x, gravity_y) = (V::splat(self.gravity.x), V::splat(self.gravity.y));
        V::store_pairs(force_x + gravity_x * mass, force_y + gravity_y * mass, &mut part.force[first..]);
        let sums = &mut self.sums;
        (V::load(&sums[0][lane..]) + mass).store(&mut sums[0][lane..]);
        (V::load(&sums[1][lane..]) + x * mass).store(&mut sums[1][lane..]);
        (V::load(&sums[2][lane..]) + y * mass).store(&mut sums[2][lane..]);
    }
}

fn potential_energy(world: &World) -> f64 {
    let (bodies, gravity) = (world.resource::<Bodies>(), world.resource::<Gravity>());
    let of = |body: usize| -bodies.mass[body] * gravity.0.dot(bodies.position[body]);
    (0..bodies.len()).filter(|&body| bodies.dynamic[body]).map(of).sum()
}
