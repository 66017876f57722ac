//! Penalty contacts: overlap makes force. A normal law, a tangential law and a rolling law are chosen one by one.

pub mod apply;
mod case;
pub mod contact;
pub mod coulomb;
mod critical;
pub mod dashpot;
mod direct;
mod follow;
mod frame;
mod handover;
pub mod hold;
mod indicators;
pub mod inelasticity;
mod islands;
mod kernel;
pub mod law;
pub mod list;
mod meetings;
mod modes;
pub mod normal;
mod patience;
mod records;
mod rest;
pub mod rolling;
mod rolling_stages;
mod rows;
mod settling;
mod split;
mod staged;
mod switching;
mod watched;

use bevy_app::App;
use bevy_ecs::prelude::*;
use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::{Deserialize, Serialize};

pub use apply::PenaltyContacts;
pub use dashpot::Dashpot;
pub use inelasticity::Inelasticity;
use inelasticity::largest_inelasticity;
pub(crate) use inelasticity::{inelasticity_of, restitution_of};
pub use rolling::RollingContacts;

use law::PairLaw;
use normal::NormalForce;

use super::points::TellContacts;
use super::search::{self, FindPairs};
use super::{ContactLaw, DeepestOverlap};
use crate::scene::units::{Damping, Rate};
use crate::scene::{Entry, Outline, Report, SceneAppExt, Written};
use crate::tick::AfterLoad;
use crate::tick::Notes;
use crate::tick::balance::EnergyTerms;
use crate::tick::direct::{Asked, Direct};
use crate::tick::registered::Registered;
use crate::tick::{Evaluate, EvaluateStage, Foreseen, Holder, Models, Modes, Stability, TickAppExt};
use crate::world::{Bodies, Materials};

/// Contacts as springs: overlap makes force.
///
/// The three laws are chosen one by one; each may stand with each.
#[derive(Resource, Clone, Copy, Debug, Default, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Penalty {
    /// What acts across the surface. Default: `Inelasticity`.
    pub normal: NormalLaw,
    /// Damping of `normal: Dashpot` in N s/m, the same for all pairs. Default: what gives the restitution of the pair.
    pub damping: Option<Damping>,
    /// Damping of `normal: Dashpot` over the effective mass of each contact, in 1/s, in place of `damping`: all contacts
    /// lose their speed alike. The `gamma_n` of LAMMPS. Default: none, `damping` or the restitution counts.
    pub damping_rate: Option<Rate>,
    /// What acts along the surface, friction. Default: `Spring(ratio: 0.8)`.
    pub tangential: TangentialLaw,
    /// What acts against rolling. Default: `None`.
    pub rolling: RollingLaw,
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

/// What acts along the surface.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub enum TangentialLaw {
    /// No friction, whatever the materials say.
    None,
    /// A spring that holds up to the static friction and then slips with the dynamic one.
    Spring {
        /// Stiffness of the tangential spring over that of the normal one. Between 2/3 and 1 for equal elastic solids
        /// (Mindlin 1949).
        ratio: f64,
    },
    /// Dry friction that sticks without any give, up to the static friction, and slips with the dynamic one. For few
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

/// What acts against turning one side over the other.
#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub enum RollingLaw {
    /// No resistance against rolling.
    #[default]
    None,
    /// A spring that gives way at a torque of `friction` times normal force and rolling radius.
    Spring {
        /// Torque over normal force and rolling radius at which the spring gives way: the tangent of the steepest slope
        /// on which a disc stays.
        friction: f64,
        /// Stiffness of the spring at the rim over that of the normal one. Default: 0.8.
        #[serde(default = "default_ratio")]
        ratio: f64,
    },
}

impl RollingLaw {
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

impl NormalLaw {
    fn add_systems(self, app: &mut App, mark: usize) {
        match self {
            Self::Inelasticity => add_systems::<Inelasticity>(app, mark),
            Self::Dashpot => add_systems::<Dashpot>(app, mark),
        }
    }
}

fn add_systems<N: NormalForce>(app: &mut App, mark: usize) {
    let system = apply::apply_penalty::<N>.in_set(ApplyPenalty).after(FindPairs).in_set(EvaluateStage::Contacts);
    app.add_flight_systems(Evaluate, system);
    app.add_flight_systems(Modes, modes::choose_modes::<N>.in_set(EvaluateStage::Contacts));
    let asked = Asked { energies: 1, ..Asked::default() };
    Direct::add(app.world_mut(), mark, asked, direct::Contacts::<N>::default());
    if N::DEPENDS_ON_VELOCITY {
        app.need_velocities();
    }
    app.world_mut().get_resource_or_init::<AfterLoad>().0.push(prepare::<N>);
}

/// Where penalty contacts are applied.
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
struct ApplyPenalty;

/// Installs penalty contacts with these settings.
pub fn install(settings: Penalty, app: &mut App) {
    // Bounds, search, contacts, rolling and rest.
    let mark = Registered::mark(app.world());
    search::plugin(app);
    app.insert_resource(settings)
        .insert_resource(ContactLaw::of_engine("Penalty"))
        .init_resource::<Materials>()
        .init_resource::<PenaltyContacts>()
        .init_resource::<DeepestOverlap>()
        .insert_resource(TellContacts(apply::contact_points));
    settings.normal.add_systems(app, mark);
    app.add_flight_systems(Evaluate, rest::settle_rest.after(EvaluateStage::Joints));
    app.world_mut().get_resource_or_init::<EnergyTerms>().elastic.push(elastic_energy);
    if let RollingLaw::Spring { friction, ratio } = settings.rolling {
        app.insert_resource(RollingContacts::new(friction, ratio));
        let system = rolling::apply_rolling.after(ApplyPenalty).in_set(EvaluateStage::Contacts);
        app.add_packed_systems(Evaluate, system);
        app.world_mut().get_resource_or_init::<Direct>().answer(Asked { energies: 1, ..Asked::default() });
        app.world_mut().get_resource_or_init::<EnergyTerms>().elastic.push(rolling_energy);
    }
    app.world_mut()
        .get_resource_or_init::<Stability>()
        .sources
        .push(|world| world.resource::<PenaltyContacts>().watch.found);
    app.world_mut().get_resource_or_init::<Direct>().answer(Asked { sources: 1, ..Asked::default() });
    Registered::cover(app.world_mut(), mark);
}

impl Entry for Penalty {
    const SECTION: &'static str = "contacts";
    const NAME: &'static str = "Penalty";
    const EXAMPLE: &'static str = "Penalty(normal: Inelasticity, tangential: Spring(ratio: 0.8), rolling: None)";

    fn schema(generator: &mut SchemaGenerator) -> Option<Schema> {
        Some(generator.subschema_for::<Self>())
    }

    fn check(&self, _: &Outline, report: &mut Report) {
        if let TangentialLaw::Spring { ratio } = self.tangential {
            report.positive("tangential.ratio", ratio);
        }
        if let RollingLaw::Spring { friction, ratio } = self.rolling {
            report.positive("rolling.friction", friction);
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
fn prepare<N: NormalForce>(world: &mut World) {
    let (materials, settings) = (world.resource::<Materials>().clone(), *world.resource::<Penalty>());
    let mut contacts = world.resource_mut::<PenaltyContacts>();
    (contacts.materials, contacts.settings) = (materials, settings);
    note_limits(world);
    world.resource_mut::<Models>().remarks.push(patience::remark);
    world.resource_mut::<Models>().remarks.push(meetings::remark);
    watched::install::<N>(world);
    let angular_frequency = stiffest_contact::<N>(world.resource(), world.resource(), world.resource());
    let foreseen = Foreseen { angular_frequency, holder: Holder::Contacts };
    world.resource_mut::<Stability>().foreseen.push(foreseen);
}

fn elastic_energy(world: &World) -> f64 {
    world.resource::<PenaltyContacts>().energy()
}

fn rolling_energy(world: &World) -> f64 {
    world.resource::<RollingContacts>().energy(world.resource(), world.resource(), world.resource())
}

/// What the law cannot give is said on the card.
fn note_limits(world: &mut World) {
    let settings = *world.resource::<Penalty>();
    if settings.tangential == TangentialLaw::None && world.resource::<Materials>().any_friction() {
        let note = "contacts: with `tangential: None` the friction of the materials does not act";
        world.resource_mut::<Notes>().0.push(note.to_owned());
    }
    if settings.normal != NormalLaw::Dashpot {
        return;
    }
    let bodies = world.resource::<Bodies>();
    let clumps = (0..bodies.len()).any(|body| bodies.atoms_of(body).len() > 1);
    let least = restitution_of(largest_inelasticity(world.resource()));
    let mut notes = Vec::new();
    if clumps {
        notes.push("contacts: under Dashpot the restitution is that of one atom; a body that lands on n at once rebounds less, its damping ratio is up to sqrt(n) times as large".to_owned());
    }
    if settings.damping.is_none() && settings.damping_rate.is_none() && least < dashpot::LEAST_RESTITUTION {
        let limit = dashpot::LEAST_RESTITUTION;
        notes.push(format!("contacts: Dashpot cannot give the restitution {least}; {limit} is used"));
    }
    world.resource_mut::<Notes>().0.extend(notes);
}

/// Greatest angular frequency that a single contact of any body can have, in rad/s.
///
/// A contact of atom `i` with something harder has `omega^2 = k w`, with the mobility `w = 1/m + r^2/I` along its
/// direction; between two moving bodies it is a weighted mean of both sides' values, so no pair exceeds the greatest.
/// Normal and tangential spring turn the same body, so their values are added. Many contacts on one body at once
/// respond faster still.
///
/// Damping counts as if the method were the default one, the strictest: with `g = 2 c w` the frequency is
/// `g/2 + sqrt(g^2/4 + omega^2)` (see [`Stability::damping_limit`]).
fn stiffest_contact<N: NormalForce>(bodies: &Bodies, materials: &Materials, settings: &Penalty) -> f64 {
    let ratio = settings.tangential.ratio().filter(|_| materials.any_friction()).unwrap_or(0.0);
    let turning = settings.rolling.ratio().unwrap_or(0.0);
    let weight = Stability::default().weight_of_damping();
    let mut law = PairLaw::default();
    N::set_up(&mut law, largest_inelasticity(materials), settings);
    let mut frequency = |atom: usize| {
        let body = bodies.atom_body(atom);
        let distance = bodies.atom_offset(atom).length();
        let mobility = |arm: f64| bodies.inverse_mass(body) + arm * arm * bodies.inverse_inertia(body);
        law.stiffness = bodies.atom_stiffness(atom);
        let (stiffness, damping) = N::response(&law, mobility(distance));
        let radius = bodies.atom_radius[atom];
        let rolling = rolling::stiffness(turning, law.stiffness, radius) * bodies.inverse_inertia(body);
        let across = ratio * law.stiffness * mobility(distance + radius) + rolling;
        let damped = 0.5 * weight * damping * mobility(distance);
        damped + (damped * damped + stiffness * mobility(distance) + across).sqrt()
    };
    let colliding = (0..bodies.atom_count()).filter(|&atom| bodies.collides[bodies.atom_body(atom)]);
    colliding.map(&mut frequency).fold(0.0, f64::max)
}
