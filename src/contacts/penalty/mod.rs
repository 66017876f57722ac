//! Penalty contacts: overlap makes force. A normal law, a tangential law and a rolling law are chosen one by one.

pub mod apply;
pub mod contact;
mod critical;
mod frame;
pub mod hold;
pub mod inelasticity;
pub mod law;
mod modes;
mod rest;
pub mod tangential;

use bevy_app::App;
use bevy_ecs::prelude::*;
use serde::Deserialize;

pub use apply::PenaltyContacts;

use super::search::{self, FindPairs};
use super::{ContactLaw, DeepestOverlap, StiffestContact};
use crate::scene::{Entry, Outline, Report, SceneAppExt, Written};
use crate::simulation::Finishers;
use crate::tick::balance::EnergyTerms;
use crate::tick::{Evaluate, EvaluateStage, Modes, Stability, TickAppExt};
use crate::world::{Bodies, Materials};

/// `contacts: Penalty(normal: Inelasticity, tangential: Spring(ratio: 0.8), rolling: None)`.
#[derive(Resource, Clone, Copy, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Penalty {
    /// Force along the normal. Default: `Inelasticity`.
    pub normal: NormalLaw,
    /// Force along the tangent. Default: `Spring(ratio: 0.8)`.
    pub tangential: TangentialLaw,
    /// Torque against rolling. Default: `None`.
    pub rolling: RollingLaw,
}

/// The normal law.
#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum NormalLaw {
    /// A spring that is stiffer while loading; see [`inelasticity`].
    #[default]
    Inelasticity,
}

/// The tangential law.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum TangentialLaw {
    /// No friction, whatever the materials say.
    None,
    /// A spring with a Coulomb limit; see [`tangential`].
    Spring {
        /// Stiffness of the tangential spring over that of the normal one. Between 2/3 and 1 for equal elastic solids
        /// (Mindlin 1949). Default 0.8.
        ratio: f64,
    },
}

impl Default for TangentialLaw {
    fn default() -> Self {
        Self::Spring { ratio: 0.8 }
    }
}

impl TangentialLaw {
    /// Tangential over normal stiffness, if there is friction.
    pub fn ratio(self) -> Option<f64> {
        match self {
            Self::None => None,
            Self::Spring { ratio } => Some(ratio),
        }
    }
}

/// The rolling law.
#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum RollingLaw {
    /// No resistance against rolling.
    #[default]
    None,
}

/// Installs penalty contacts with these settings.
pub fn install(settings: Penalty, app: &mut App) {
    search::plugin(app);
    app.insert_resource(settings)
        .insert_resource(ContactLaw("Penalty"))
        .init_resource::<Materials>()
        .init_resource::<PenaltyContacts>()
        .init_resource::<DeepestOverlap>();
    let system = apply::apply_penalty.after(FindPairs).in_set(EvaluateStage::Contacts);
    app.add_packed_systems(Evaluate, 1, system);
    app.add_systems(Modes, modes::choose_modes.in_set(EvaluateStage::Contacts));
    app.world_mut().get_resource_or_init::<EnergyTerms>().elastic.push(elastic_energy);
    app.world_mut()
        .get_resource_or_init::<Stability>()
        .sources
        .push(|world| world.resource::<PenaltyContacts>().watch.found);
    app.world_mut().get_resource_or_init::<Finishers>().0.push(prepare);
}

impl Entry for Penalty {
    const SECTION: &'static str = "contacts";
    const NAME: &'static str = "Penalty";
    const EXAMPLE: &'static str = "Penalty(normal: Inelasticity, tangential: Spring(ratio: 0.8), rolling: None)";

    fn check(&self, _: &Outline, report: &mut Report) {
        if let TangentialLaw::Spring { ratio } = self.tangential {
            report.positive("tangential.ratio", ratio);
        }
    }

    fn install(entries: Vec<Written<Self>>, _: &Outline, app: &mut App) {
        for entry in entries {
            install(entry.value, app);
        }
    }
}

pub(super) fn plugin(app: &mut App) {
    app.register_entry::<Penalty>();
}

/// Takes up what the scene says of materials, once all sections stand.
fn prepare(world: &mut World) {
    let (materials, settings) = (world.resource::<Materials>().clone(), *world.resource::<Penalty>());
    let mut contacts = world.resource_mut::<PenaltyContacts>();
    (contacts.materials, contacts.settings) = (materials, settings);
    let stiffest = stiffest_contact(world.resource(), world.resource(), world.resource());
    world.insert_resource(stiffest);
}

fn elastic_energy(world: &World) -> f64 {
    world.resource::<PenaltyContacts>().energy()
}

/// Greatest angular frequency that a single contact of any body can have, in rad/s.
///
/// A contact of atom `i` with something harder has `omega^2 = k w`, with the mobility `w = 1/m + r^2/I` along its
/// direction; between two moving bodies it is a weighted mean of both sides' values, so no pair exceeds the greatest.
/// Normal and tangential spring turn the same body, so their values are added. Many contacts on one body at once
/// respond faster still.
pub fn stiffest_contact(bodies: &Bodies, materials: &Materials, settings: &Penalty) -> StiffestContact {
    let inelasticity = materials.largest_inelasticity();
    let ratio = settings.tangential.ratio().filter(|_| materials.any_friction()).unwrap_or(0.0);
    let squared = |atom: usize| {
        let body = bodies.atom_body[atom] as usize;
        let distance = bodies.atom_offset[atom].length();
        let mobility = |arm: f64| bodies.inverse_mass[body] + arm * arm * bodies.inverse_inertia[body];
        let radius = bodies.atom_radius[atom];
        let normal = (1.0 + inelasticity) * mobility(distance);
        bodies.atom_stiffness[atom] * (normal + ratio * mobility(distance + radius))
    };
    let colliding = (0..bodies.atom_count()).filter(|&atom| bodies.collides[bodies.atom_body[atom] as usize]);
    StiffestContact { angular_frequency: colliding.map(squared).fold(0.0, f64::max).sqrt() }
}
