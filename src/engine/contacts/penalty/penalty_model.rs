//! Penalty contacts as a model of the run.

use std::any::Any;
use std::marker::PhantomData;

use bevy_ecs::prelude::*;

use super::apply::{Own, PenaltyContacts, Shared, Sink, apply};
use super::at_rest::{self, AtRest};
use super::contradicted::Contradicted;
use super::modes::{Scratch, choose};
use super::normal::NormalForce;
use super::rolling::{self, RollingContacts};
use super::switching::View;
use super::wedged::Wedged;
use super::{
    Penalty, RollingLaw, TangentialLaw, contact_stages, features, handover, limits, meetings, saved, search_schedule,
    standing, watched,
};
use crate::tick::snapshot::{Memory, UnfitSnapshot, demand, recall};
use crate::tick::touch::ContactPoint;
use crate::tick::{
    Dependence, Energies, EvaluationMode, Events, Foreseen, Holder, Model, Notes, Objection, State, SteadySpring,
    TimeScales,
};
use crate::world::Materials;
use serde::{Deserialize, Serialize};

/// All contacts and rolling springs of a run.
#[derive(Debug, Default, Serialize, Deserialize)]
pub struct PenaltyState {
    /// Contacts.
    pub contacts: PenaltyContacts,
    /// Rolling springs, if the scene has them.
    pub rolling: Option<RollingContacts>,
}

impl PenaltyState {
    /// The contacts at rest, for the card.
    pub fn at_rest(&self, state: &State) -> AtRest {
        at_rest::look(&self.contacts, state)
    }

    /// The body that came to rest in one of several ways and gives most, if there is one.
    pub fn wedged(&self) -> Option<Wedged> {
        self.contacts.wedged
    }

    /// The body whose rigid friction contradicted other rows first, if there is one. The run is wrong from then on.
    pub fn contradicted(&self) -> Option<Contradicted> {
        self.contacts.contradicted
    }

    /// The section of the scene for contacts.
    pub fn settings(&self) -> &Penalty {
        &self.contacts.settings
    }
}

/// Contacts with a normal law.
pub(super) struct Contacts<N> {
    pub own: PenaltyState,
    scratch: Scratch,
    law: PhantomData<fn() -> N>,
}

impl<N> Contacts<N> {
    pub fn new(settings: Penalty) -> Self {
        let rolling = match settings.rolling {
            RollingLaw::None => None,
            RollingLaw::Spring { friction, ratio } => Some(RollingContacts::new(friction, ratio)),
        };
        let mut contacts = PenaltyContacts::default();
        contacts.settings = settings;
        Self { own: PenaltyState { contacts, rolling }, scratch: Scratch::default(), law: PhantomData }
    }
}

impl<N: NormalForce> Model for Contacts<N> {
    fn save(&self) -> Memory {
        Memory::of(&self.own)
    }

    fn load(&mut self, bytes: &[u8]) -> Result<(), UnfitSnapshot> {
        let PenaltyState { contacts, rolling } = recall(bytes)?;
        let same =
            |own: &RollingContacts, saved: &RollingContacts| (own.friction, own.ratio) == (saved.friction, saved.ratio);
        let rolls = match (&self.own.rolling, &rolling) {
            (Some(own), Some(saved)) => same(own, saved),
            (own, saved) => own.is_none() && saved.is_none(),
        };
        demand(rolls, "the laws of rolling contacts")?;
        self.own.rolling = rolling;
        self.own.contacts.take_over(contacts);
        // It knows lists of pairs by their version.
        self.scratch = Scratch::default();
        Ok(())
    }

    fn fits(&self, state: &State) -> Result<(), UnfitSnapshot> {
        saved::demand_fit::<N>(&self.own, state)
    }

    fn contact_law(&self) -> Option<&'static str> {
        Some("Penalty")
    }

    /// Friction that sticks without compliance turns with its body. So it depends on the spin of the body.
    fn dependence(&self) -> Dependence {
        let turns = self.own.contacts.settings.tangential == TangentialLaw::Exact;
        if N::DEPENDS_ON_VELOCITY || turns { Dependence::Velocity } else { Dependence::Position }
    }

    fn flies(&self) -> bool {
        self.own.rolling.is_none()
    }

    /// Takes the materials of the scene.
    fn start(&mut self, world: &mut World) {
        let contacts = &mut self.own.contacts;
        contacts.materials = world.get_resource::<Materials>().cloned().unwrap_or_default();
        let (settings, materials) = (contacts.settings, &contacts.materials);
        let mut state = world.resource_mut::<State>();
        let notes = limits::notes(&settings, materials, &state.bodies);
        let angular_frequency = limits::stiffest_contact::<N>(&state.bodies, materials, &settings);
        state.stability.foreseen.push(Foreseen { angular_frequency, holder: Holder::Contacts });
        world.resource_mut::<Notes>().0.extend(notes);
    }

    fn energies(&self, state: &State) -> Energies {
        let PenaltyState { contacts, rolling } = &self.own;
        let pairs = state.pairs.as_ref();
        let rolling = rolling.as_ref().zip(pairs);
        let rolling = rolling.map_or(0.0, |(rolling, pairs)| rolling.energy(&state.bodies, pairs, contacts));
        Energies { potential: 0.0, elastic: contacts.energy() + rolling }
    }

    /// It measures how fast contacts respond by itself.
    fn stiffness(&self, _: &State, _: &mut Vec<SteadySpring>) {}

    fn time_scales(&self) -> TimeScales {
        self.own.contacts.watch.found
    }

    fn has_modes(&self) -> bool {
        true
    }

    /// It applies the kick that waits itself, and only if a contact may change.
    fn begins_with_velocities(&self) -> bool {
        false
    }

    fn begin_step(&mut self, state: &mut State) {
        let State { bodies, rates, ledger, evaluation, rows, clock, span, pairs: Some(pairs), .. } = state else {
            return;
        };
        let (forces, known) = (state.contact_forces.as_mut(), (&state.stability, &state.springs));
        let PenaltyState { contacts, rolling } = &mut self.own;
        if evaluation.mode == EvaluationMode::Frozen {
            features::keep(pairs, &contacts.surfaces, bodies);
            evaluation.stale |= standing::hold::<N>(contacts, bodies, pairs);
        } else {
            features::release(pairs);
        }
        let mut view = View { bodies, pairs, contacts, rolling: rolling.as_mut() };
        let staged = evaluation.mode.is_staged();
        evaluation.stale |= view.share_cones(staged) && staged;
        let shared = Shared { bodies, rates, ledger, evaluation, rows };
        let own = Own { pairs, contacts, rolling: rolling.as_mut(), forces };
        let changed = choose::<N>(shared, (clock, span), own, known, &mut self.scratch);
        // Joints still have the forces of the state before. A motor with a limit would take the difference by an
        // impulse beyond its limit.
        if changed && state.rows.some_yield() {
            state.change_rows();
        }
    }

    fn apply_forces(&mut self, state: &mut State) {
        let alone = state.is_alone();
        let State { bodies, rates, ledger, evaluation, rows, pairs: Some(pairs), .. } = state else { return };
        let PenaltyState { contacts, rolling } = &mut self.own;
        let shared = Shared { bodies, rates, ledger, evaluation, rows };
        let own = Own { pairs, contacts, rolling: rolling.as_mut(), forces: state.contact_forces.as_mut() };
        apply::<N>(shared, own, &mut state.deepest, state.touches.as_mut());
        if alone {
            contacts.records.lend(bodies);
        }
        if let Some(rolling) = rolling {
            let shared = Shared { bodies, rates, ledger, evaluation, rows };
            rolling::apply::<N>(shared, pairs, contacts, rolling);
        }
    }

    fn has_rows(&self) -> bool {
        true
    }

    fn after_blow(&mut self, state: &mut State) {
        let State { bodies, pairs: Some(pairs), evaluation, .. } = state else { return };
        let PenaltyState { contacts, rolling } = &mut self.own;
        if evaluation.mode == EvaluationMode::Frozen && contacts.version == pairs.version {
            View { bodies, pairs, contacts, rolling: rolling.as_mut() }.come_loose_by_blow();
        }
    }

    fn take_rows(&mut self, state: &mut State) {
        let PenaltyState { contacts, rolling } = &mut self.own;
        let State { bodies, rates, rows, .. } = state;
        let mut sink = Sink { bodies, rates, forces: state.contact_forces.as_mut() };
        contact_stages::take_rows(contacts, rolling.as_mut(), rows, &mut sink);
    }

    fn settles(&self) -> bool {
        true
    }

    fn settle(&mut self, state: &mut State) {
        let changing = state.changing_forces() || state.evaluation.mode.is_staged();
        let State { bodies, rates, pairs: Some(pairs), .. } = state else { return };
        let forces = state.contact_forces.as_mut();
        self.own.contacts.settle((bodies, rates), pairs, forces, changing);
    }

    fn events(&mut self) -> Option<&mut dyn Events> {
        Some(self)
    }

    fn objection(&self, mode: EvaluationMode) -> Option<Objection> {
        let PenaltyContacts { settings, materials, .. } = &self.own.contacts;
        watched::objection(settings, materials, mode)
    }

    fn remarks(&self, state: &State) -> Vec<String> {
        let ticks = state.clock.ticks;
        let waits = search_schedule::remark(&self.own.contacts.schedule, ticks);
        waits.into_iter().chain(meetings::remark(&state.bodies, ticks)).collect()
    }

    fn contact_points(&self, state: &State) -> Option<Vec<ContactPoint>> {
        let (contacts, bodies, pairs) = (&self.own.contacts, &state.bodies, state.pairs.as_ref()?);
        let atoms = contacts.atom_points(bodies, pairs);
        Some(atoms.chain(contacts.surface_points(bodies, pairs)).map(|(_, point)| point).collect())
    }

    fn inner(&self) -> Option<&dyn Any> {
        Some(&self.own)
    }

    fn inner_mut(&mut self) -> Option<&mut dyn Any> {
        Some(&mut self.own)
    }
}

/// Whether contacts are too many to be resolved from event to event.
pub(super) fn is_overloaded(own: &PenaltyState) -> bool {
    handover::overloaded(&own.contacts, own.rolling.as_ref())
}
