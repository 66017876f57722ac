//! Gravity: a uniform field, `F = m g`, potential energy `-m g . x`.

use bevy_app::App;
use glam::DVec2;
use schemars::JsonSchema;
use serde::Deserialize;

use crate::scene::units::AccelerationPair;
use crate::scene::{Outline, SceneAppExt, Section};
use crate::tick::snapshot::Memory;
use crate::tick::{Dependence, Energies, Model, State, SteadySpring};

/// The acceleration of free fall. A scene without this section has no gravity.
#[derive(Deserialize, JsonSchema)]
#[serde(transparent)]
struct GravitySection(AccelerationPair);

impl Section for GravitySection {
    const NAME: &'static str = "gravity";
    const EXAMPLE: &'static str = "gravity: (0, -9.81)";

    fn install(self, _: &Outline, app: &mut App) {
        install(self.0.si(), app);
    }
}

/// The weight of all bodies in the field of the state, [`State::gravity`].
#[derive(Clone, Copy, Debug)]
struct Weight;

/// Installs the field of this acceleration in m/s2.
pub fn install(gravity: DVec2, app: &mut App) {
    let mut state = app.world_mut().resource_mut::<State>();
    state.begin_field(gravity);
    // The sum of forces begins with the weight.
    state.add_first_model(Weight);
}

pub(super) fn plugin(app: &mut App) {
    app.register_section::<GravitySection>();
}

impl Model for Weight {
    fn dependence(&self) -> Dependence {
        Dependence::Nothing
    }

    fn flies(&self) -> bool {
        true
    }

    fn save(&self) -> Memory {
        Memory::Nothing
    }

    fn energies(&self, state: &State) -> Energies {
        let (bodies, gravity) = (&state.bodies, state.gravity());
        let of = |body: usize| -bodies.mass[body] * gravity.dot(bodies.position[body]);
        let potential = (0..bodies.len()).filter(|&body| bodies.dynamic[body]).map(of).sum();
        Energies { potential, elastic: 0.0 }
    }

    fn stiffness(&self, _: &State, _: &mut Vec<SteadySpring>) {}

    /// Bodies have their weight as soon as their forces are cleared. It is left to be booked.
    fn apply_forces(&mut self, state: &mut State) {
        let gravity = state.gravity();
        let (bodies, rates) = state.bodies_and_rates();
        let (mass, moment) = bodies.weighed;
        rates.force += gravity * mass;
        rates.torque += moment.perp_dot(gravity);
    }
}
