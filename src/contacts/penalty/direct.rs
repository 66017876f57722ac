//! The direct form of the systems of penalty contacts, and of the search that they add.

use std::marker::PhantomData;

use bevy_ecs::prelude::*;

use super::apply::{Own, PenaltyContacts, Shared, apply};
use super::modes::{Scratch, choose};
use super::normal::NormalForce;
use super::rolling::{self, RollingContacts};
use crate::contacts::events::Touches;
use crate::contacts::{CandidatePairs, ContactForces, DeepestOverlap};
use crate::tick::direct::{Energies, Part, State, exchange, exchange_any};
use crate::tick::steady::SteadySprings;
use crate::tick::{Census, EvaluateStage, Responses, Stability, Stages, stopwatch};

/// What they work on.
pub(super) struct Contacts<N> {
    pub pairs: CandidatePairs,
    pub contacts: PenaltyContacts,
    pub deepest: DeepestOverlap,
    stability: Stability,
    pub rolling: Option<RollingContacts>,
    forces: Option<ContactForces>,
    pub touches: Option<Touches>,
    steady: Option<SteadySprings>,
    changing_forces: bool,
    scratch: Scratch,
    law: PhantomData<N>,
}

impl<N> Default for Contacts<N> {
    fn default() -> Self {
        Self {
            pairs: CandidatePairs::default(),
            contacts: PenaltyContacts::default(),
            deepest: DeepestOverlap::default(),
            stability: Stability::default(),
            rolling: None,
            forces: None,
            touches: None,
            steady: None,
            changing_forces: false,
            scratch: Scratch::default(),
            law: PhantomData,
        }
    }
}

impl<N: NormalForce> Part for Contacts<N> {
    fn exchange(&mut self, world: &mut World) {
        exchange(world, &mut self.pairs);
        exchange(world, &mut self.contacts);
        exchange(world, &mut self.deepest);
        exchange(world, &mut self.stability);
        exchange_any(world, &mut self.rolling);
        exchange_any(world, &mut self.forces);
        exchange_any(world, &mut self.touches);
        exchange_any(world, &mut self.steady);
        self.changing_forces = world.resource::<Census>().changing_forces();
    }

    fn energies(&self, state: &State) -> Energies {
        let rolling = self.rolling.as_ref();
        let rolling = rolling.map_or(0.0, |rolling| rolling.energy(&state.bodies, &self.pairs, &self.contacts));
        Energies { potential: 0.0, elastic: self.contacts.energy() + rolling }
    }

    fn stages(&mut self) -> Option<&mut dyn Stages> {
        Some(self)
    }

    fn responses(&self) -> Responses {
        self.contacts.watch.found
    }

    fn choose_modes(&mut self, state: &mut State) {
        let State { bodies, balance, ledger, evaluation, clock, span, .. } = state;
        let shared = Shared { bodies, balance, ledger, evaluation };
        let (rolling, forces) = (self.rolling.as_mut(), self.forces.as_mut());
        let own = Own { pairs: &self.pairs, contacts: &mut self.contacts, rolling, forces };
        choose::<N>(shared, (clock, span), own, (&self.stability, self.steady.as_ref()), &mut self.scratch);
    }

    fn evaluate(&mut self, stage: EvaluateStage, state: &mut State) {
        match stage {
            EvaluateStage::Bounds => {
                if let State { bounds: Some(bounds), bodies, evaluation, .. } = state {
                    bounds.update(bodies, evaluation);
                }
            }
            EvaluateStage::Forces => {}
            EvaluateStage::Contacts => {
                if let State { bounds: Some(bounds), bodies, .. } = state {
                    self.pairs.update(bodies, bounds);
                }
                state.turn_to(stopwatch::Part::Contacts);
                let State { bodies, balance, ledger, evaluation, .. } = state;
                let shared = Shared { bodies, balance, ledger, evaluation };
                let (rolling, forces) = (self.rolling.as_mut(), self.forces.as_mut());
                let own = Own { pairs: &self.pairs, contacts: &mut self.contacts, rolling, forces };
                apply::<N>(shared, own, &mut self.deepest, self.touches.as_mut());
                self.contacts.records.lend(bodies);
                if let Some(rolling) = &mut self.rolling {
                    let shared = Shared { bodies, balance, ledger, evaluation };
                    rolling::apply(shared, &self.pairs, &self.contacts, rolling);
                }
            }
            EvaluateStage::Joints => {
                let changing = self.changing_forces || state.evaluation.style.is_staged();
                let state = (&mut state.bodies, &mut state.balance);
                self.contacts.settle(state, &self.pairs, self.forces.as_mut(), changing);
            }
        }
    }
}
