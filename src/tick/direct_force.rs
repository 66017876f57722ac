//! The direct form of forces that are one system each, and know nothing but the bodies.

use bevy_app::App;
use bevy_ecs::component::Mutable;
use bevy_ecs::prelude::*;

use super::balance::EnergyTerms;
use super::direct::{Asked, Direct, Energies, Part, State, exchange};
use super::registered::Registered;
use super::{Balance, Dependence, EvaluateStage, TickAppExt};
use crate::world::Bodies;

/// All entries of a kind of force.
pub(crate) trait ForceOnBodies: Resource<Mutability = Mutable> + Default {
    /// What the force depends on.
    const DEPENDENCE: Dependence;
    /// Whether [`ForceOnBodies::energy`] is more than nothing.
    const HAS_ENERGY: bool = false;

    /// Adds to the sums of the bodies, and keeps its account.
    fn act(&mut self, bodies: &mut Bodies, balance: &mut Balance);

    /// Potential energy in J.
    fn energy(&self, _: &Bodies) -> f64 {
        0.0
    }
}

/// Installs a force: its entries, its system, its energy and the direct form of both.
pub(crate) fn add_force_on_bodies<F: ForceOnBodies>(app: &mut App, force: F) {
    // Two systems of one resource have no direct form together.
    let first = !app.world().contains_resource::<F>();
    app.insert_resource(force);
    let mark = Registered::mark(app.world());
    app.add_packed_force(F::DEPENDENCE, apply::<F>);
    if F::HAS_ENERGY {
        let energy = |world: &World| world.resource::<F>().energy(world.resource());
        app.world_mut().get_resource_or_init::<EnergyTerms>().potential.push(energy);
    }
    if !first {
        return;
    }
    let asked = Asked { energies: usize::from(F::HAS_ENERGY), ..Asked::default() };
    Direct::add(app.world_mut(), mark, asked, Held(F::default()));
}

fn apply<F: ForceOnBodies>(mut force: ResMut<F>, mut bodies: ResMut<Bodies>, mut balance: ResMut<Balance>) {
    force.act(&mut bodies, &mut balance);
}

struct Held<F>(F);

impl<F: ForceOnBodies> Part for Held<F> {
    fn exchange(&mut self, world: &mut World) {
        exchange(world, &mut self.0);
    }

    fn evaluate(&mut self, stage: EvaluateStage, state: &mut State) {
        if stage == EvaluateStage::Forces {
            self.0.act(&mut state.bodies, &mut state.balance);
        }
    }

    fn energies(&self, state: &State) -> Energies {
        Energies { potential: self.0.energy(&state.bodies), elastic: 0.0 }
    }
}
