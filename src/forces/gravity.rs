//! Gravity: a uniform field, `F = m g`, potential energy `-m g . x`.

use bevy_app::App;
use bevy_ecs::prelude::*;
use glam::DVec2;
use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::Deserialize;

use crate::scene::units::AccelerationPair;
use crate::scene::{Outline, SceneAppExt, Section};
use crate::simd::{self, BLOCK, Kernel, Lanes};
use crate::tick::balance::EnergyTerms;
use crate::tick::{Balance, Dependence, TickAppExt};
use crate::world::Bodies;
use crate::world::motion::PerBody;

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
    let level = bodies.level;
    let (mass, moment) = simd::run(level, Weigh { bodies: &mut bodies, gravity: gravity.0, sums: [[0.0; BLOCK]; 3] });
    balance.force += gravity.0 * mass;
    balance.torque += moment.perp_dot(gravity.0);
}

/// Adds the weight of each body that is not asleep; returns their mass, and the sum of mass times place.
struct Weigh<'a> {
    bodies: &'a mut Bodies,
    gravity: DVec2,
    sums: [[f64; BLOCK]; 3],
}

impl Kernel for Weigh<'_> {
    type Output = (f64, DVec2);

    #[inline(always)]
    fn run<V: Lanes>(mut self) -> (f64, DVec2) {
        self.all::<V>();
        let [mass, x, y] = self.sums.map(|partial| partial.into_iter().fold(0.0, |sum, part| sum + part));
        (mass, DVec2::new(x, y))
    }
}

impl PerBody for Weigh<'_> {
    #[inline(always)]
    fn whose(&self) -> &Bodies {
        self.bodies
    }

    #[inline(always)]
    fn bodies<V: Lanes>(&mut self, first: usize) {
        let bodies = &mut *self.bodies;
        let lane = first % BLOCK;
        let mut moves = V::load(&bodies.inverse_mass[first..]).gt(V::splat(0.0));
        if let Some(asleep) = bodies.asleep.get(first / BLOCK) {
            moves = moves & V::mask(!asleep >> lane);
        }
        let mass = V::load(&bodies.mass[first..]).only(moves);
        let (x, y) = V::load_pairs(&bodies.position[first..]);
        let (force_x, force_y) = V::load_pairs(&bodies.force[first..]);
        let (gravity_x, gravity_y) = (V::splat(self.gravity.x), V::splat(self.gravity.y));
        V::store_pairs(force_x + gravity_x * mass, force_y + gravity_y * mass, &mut bodies.force[first..]);
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
