//! Penalty contacts: forces from overlaps (soft-sphere discrete element method). Normal, tangential and rolling law are
//! independent choices.

mod after_blow;
pub mod apply;
pub mod at_rest;
mod begun;
mod case;
pub mod contact;
pub mod contact_list;
mod contact_stages;
pub mod contradicted;
pub mod coulomb;
mod critical;
pub mod dashpot;
mod equilibrium;
mod equilibrium_joint;
mod equilibrium_part;
mod equilibrium_search;
mod features;
mod follow;
mod handover;
mod held;
mod hull_kernel;
mod indeterminate;
mod indicators;
pub mod inelasticity;
mod joined;
mod kernel;
mod limits;
mod meetings;
mod modes;
pub mod normal;
mod one_by_one;
pub mod pair_law;
mod partial_slip;
mod penalty_model;
mod records;
mod remembered;
mod rest;
pub mod rolling;
mod rolling_stages;
mod saved;
mod search_schedule;
mod settling;
mod standing;
mod surfaces;
mod switching;
mod waking;
mod watched;
pub mod wedged;

use bevy_app::App;
use bevy_ecs::world::World;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

pub use apply::PenaltyContacts;
pub use dashpot::Dashpot;
pub use inelasticity::Inelasticity;
pub use inelasticity::{inelasticity_of, restitution_of};
use penalty_model::Contacts;
pub use penalty_model::PenaltyState;
pub use rolling::RollingContacts;

use super::search;
use crate::scene::units::{Damping, Rate};
use crate::scene::{Diagnostics, Entry, Outline, SceneAppExt, WrittenEntry};
use crate::tick::{AfterLoad, TickAppExt};
use crate::world::Materials;

/// Contacts as springs: overlap makes force.
///
/// The three laws are independent choices, and all combinations are possible.
#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Penalty {
    /// The law across the surface. Default: `Inelasticity`.
    pub normal: NormalLaw,
    /// Damping of `normal: Dashpot` in N s/m, the same for all pairs. Default: from the restitution of the pair.
    pub damping: Option<Damping>,
    /// Damping of `normal: Dashpot` over the effective mass of each contact, in 1/s, in place of `damping`. While bodies
    /// touch, the amplitude of each contact then decays at half this rate. Heavier bodies touch for longer, and so they lose more.
    /// It is the `gamma_n` of LAMMPS. Default: none.
    pub damping_rate: Option<Rate>,
    /// The law along the surface, friction. Default: `Spring(ratio: 0.8)`.
    pub tangential: TangentialLaw,
    /// The law against rolling. Default: `None`.
    pub rolling: RollingLaw,
    /// How bodies begin that touch at the start. Default: `Equilibrium`.
    pub start: Start,
}

/// How bodies begin that touch at the start and do not move.
#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub enum Start {
    /// In equilibrium if there is one. The engine moves them into the springs of their contacts, which then bear the
    /// loads. The card says by how far.
    #[default]
    Equilibrium,
    /// As the scene places them. Bodies that just touch drop onto the springs of their contacts.
    AsPlaced,
}

/// The normal law.
#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub enum NormalLaw {
    /// A spring that is stiffer while loading than while unloading, so that the restitution is the same at any speed.
    #[default]
    Inelasticity,
    /// A spring and a dashpot that never pull.
    Dashpot,
}

/// The law along the surface.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub enum TangentialLaw {
    /// No friction, even if materials have some.
    None,
    /// A spring that holds up to the static friction and then slips with the dynamic one.
    Spring {
        /// Stiffness of the tangential spring over that of the normal one. Between 2/3 and 1 for equal elastic solids
        /// (Mindlin 1949).
        ratio: f64,
    },
    /// Dry friction that sticks without compliance, up to the static friction, and slips with the dynamic one. For few
    /// contacts, under methods that locate events.
    Exact,
}

impl Default for TangentialLaw {
    fn default() -> Self {
        Self::Spring { ratio: default_ratio() }
    }
}

impl TangentialLaw {
    /// Tangential over normal stiffness, if there is friction.
    pub fn ratio(self) -> Option<f64> {
        match self {
            Self::None => None,
            Self::Spring { ratio } => Some(ratio),
            // No spring; the number serves estimates of how fast contacts respond.
            Self::Exact => Some(0.0),
        }
    }
}

/// The law against turning one side relative to the other.
#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub enum RollingLaw {
    /// No resistance against rolling.
    #[default]
    None,
    /// A spring that gives way at a torque of `friction` times normal force and rolling radius.
    Spring {
        /// Torque over normal force and rolling radius at which the spring gives way. It is the tangent of the steepest
        /// slope on which a disc stays. Not negative. With 0 bodies roll freely, as with `None`.
        friction: f64,
        /// Stiffness of the spring at the rim over that of the normal one. Default: 0.8.
        #[serde(default = "default_ratio")]
        ratio: f64,
    },
}

impl RollingLaw {
    /// The law that acts: a spring that gives way at once is none.
    fn acting(self) -> Self {
        match self {
            Self::Spring { friction: 0.0, .. } => Self::None,
            _ => self,
        }
    }

    fn ratio(self) -> Option<f64> {
        match self {
            Self::None => None,
            Self::Spring { ratio, .. } => Some(ratio),
        }
    }
}

fn default_ratio() -> f64 {
    0.8
}

/// Installs penalty contacts with these settings.
pub fn install(settings: Penalty, app: &mut App) {
    let settings = Penalty { rolling: settings.rolling.acting(), ..settings };
    search::plugin(app);
    app.init_resource::<Materials>();
    let begin: fn(&mut World) = match settings.normal {
        NormalLaw::Inelasticity => {
            app.add_model(Contacts::<Inelasticity>::new(settings));
            equilibrium::begin::<Inelasticity>
        }
        NormalLaw::Dashpot => {
            app.add_model(Contacts::<Dashpot>::new(settings));
            equilibrium::begin::<Dashpot>
        }
    };
    app.world_mut().get_resource_or_init::<AfterLoad>().0.push(begin);
}

impl Entry for Penalty {
    const SECTION: &'static str = "contacts";
    const NAME: &'static str = "Penalty";
    const EXAMPLE: &'static str = "Penalty(normal: Inelasticity, tangential: Spring(ratio: 0.8), rolling: None)";

    fn check(&self, _: &Outline, report: &mut Diagnostics) {
        if let TangentialLaw::Spring { ratio } = self.tangential {
            report.positive("tangential.ratio", ratio);
        }
        if let RollingLaw::Spring { friction, ratio } = self.rolling {
            report.not_negative("rolling.friction", friction);
            report.positive("rolling.ratio", ratio);
        }
        let given = [("damping", self.damping.map(|d| d.si())), ("damping_rate", self.damping_rate.map(|d| d.si()))];
        for (field, number) in given.iter().filter_map(|(field, number)| Some((*field, (*number)?))) {
            if report.not_negative(field, number) && self.normal != NormalLaw::Dashpot {
                let help = format!("write `normal: Dashpot` beside it, or remove `{field}`");
                report.error(field, format!("`{field}` belongs to the normal law `Dashpot`")).help(help);
            }
        }
        if self.damping.is_some() && self.damping_rate.is_some() {
            let help = "remove one of them; `damping_rate` is `damping` over the effective mass of a contact";
            report.error("damping_rate", "there is `damping` already").help(help);
        }
    }

    fn install(entries: Vec<WrittenEntry<Self>>, _: &Outline, app: &mut App) {
        for entry in entries {
            install(entry.value, app);
        }
    }
}

pub(super) fn plugin(app: &mut App) {
    app.register_entry::<Penalty>();
}
