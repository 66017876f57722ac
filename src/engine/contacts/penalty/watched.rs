//! The states and events of contacts for methods with several stages: elongations that the integrator advances, and
//! indicators.

use super::handover;
use super::normal::NormalForce;
use super::penalty_model::{Contacts, PenaltyState, is_overloaded};
use super::switching::{self, View};
use super::{Penalty, RollingLaw, TangentialLaw, features, rolling_stages};
use crate::tick::{EvaluationMode, Events, Indicator, Objection, State};
use crate::world::Materials;

/// The abilities that these contacts lack.
pub(super) fn objection(settings: &Penalty, materials: &Materials, mode: EvaluationMode) -> Option<Objection> {
    let friction = materials.any_friction();
    let (path, message, help) = match (mode, settings.tangential) {
        (EvaluationMode::Following, TangentialLaw::Exact) => (
            "contacts.Penalty.tangential",
            "`Exact` friction needs a method that locates events inside a tick",
            "write `clock: (.., method: RungeKutta4)`, `method: Dop853` or `events: Located`; or `tangential: Spring(ratio: 0.8)`",
        ),
        (EvaluationMode::Instant, TangentialLaw::Spring { .. }) if friction => (
            "clock.events",
            "tangential springs need their events located under a method with several stages",
            "write `events: Located`, or `tangential: Exact` or `None`, or `method: VelocityVerlet`",
        ),
        (EvaluationMode::Instant, _) if settings.rolling != RollingLaw::None => (
            "clock.events",
            "rolling springs need their events located under a method with several stages",
            "write `events: Located`, or `rolling: None`, or `method: VelocityVerlet`",
        ),
        _ => return None,
    };
    Some(Objection { path, message: message.to_owned(), help })
}

/// All candidate pairs, and the bodies that they are of.
fn view<'a>(own: &'a mut PenaltyState, state: &'a State) -> Option<View<'a>> {
    let (bodies, pairs) = (&state.bodies, state.pairs.as_ref()?);
    Some(View { bodies, pairs, contacts: &mut own.contacts, rolling: own.rolling.as_mut() })
}

/// Elongations of tangential springs first, then angles of rolling ones.
impl<N: NormalForce> Events for Contacts<N> {
    fn length(&self) -> usize {
        let PenaltyState { contacts, rolling } = &self.own;
        let rolling = rolling.as_ref();
        switching::length(contacts) + rolling.map_or(0, |rolling| rolling_stages::length(contacts, rolling))
    }

    fn read(&self, numbers: &mut [f64]) {
        let PenaltyState { contacts, rolling } = &self.own;
        let (elongations, angles) = numbers.split_at_mut(switching::length(contacts));
        switching::read(contacts, elongations);
        if let Some(rolling) = rolling {
            rolling_stages::read(contacts, rolling, angles);
        }
    }

    fn write(&mut self, numbers: &[f64]) {
        let PenaltyState { contacts, rolling } = &mut self.own;
        let (elongations, angles) = numbers.split_at(switching::length(contacts));
        switching::write(contacts, elongations);
        if let Some(rolling) = rolling {
            rolling_stages::write(contacts, rolling, angles);
        }
    }

    fn rates(&self, state: &State, rates: &mut [f64]) {
        let Some(pairs) = &state.pairs else { return };
        let PenaltyState { contacts, rolling } = &self.own;
        let (elongations, angles) = rates.split_at_mut(switching::length(contacts));
        switching::rates((&state.bodies, pairs), contacts, elongations);
        if let Some(rolling) = rolling {
            rolling_stages::rates((&state.bodies, pairs), (contacts, rolling), angles);
        }
    }

    fn tell(&mut self, state: &State, told: &mut Vec<Indicator>) {
        if self.own.contacts.is_idle() {
            return self.own.contacts.told.clear();
        }
        if let Some(mut view) = view(&mut self.own, state) {
            view.tell::<N>(told);
        }
    }

    fn switch(&mut self, state: &mut State, fired: &[usize]) {
        let State { bodies, evaluation, ledger, rows, clock, touches, pairs: Some(pairs), .. } = state else { return };
        let PenaltyState { contacts, rolling } = &mut self.own;
        View { bodies, pairs, contacts, rolling: rolling.as_mut() }.hold_stopped(fired, rows);
        switching::stand_still((bodies, ledger, rows), contacts, clock.dt);
        let mut view = View { bodies, pairs, contacts, rolling: rolling.as_mut() };
        view.switch::<N>(fired, evaluation.velocity_error, ledger, touches.as_mut());
        features::cross(fired, (bodies, pairs), contacts, rolling.as_mut());
    }

    fn settle(&mut self, state: &State) -> bool {
        view(&mut self.own, state).is_some_and(|mut view| view.settle::<N>(state.rows()))
    }

    fn take_stock(&mut self, state: &State) {
        if let Some(mut view) = view(&mut self.own, state) {
            view.take_stock::<N>();
        }
    }

    fn begin_account(&mut self, state: &State) {
        if let Some(mut view) = view(&mut self.own, state) {
            view.contacts.held_before = None;
            view.contacts.slid = view.sliding_energy();
        }
    }

    fn unbooked(&mut self, state: &State) -> f64 {
        if self.own.contacts.is_idle() {
            return 0.0;
        }
        view(&mut self.own, state).map_or(0.0, |mut view| view.contacts.slid - view.sliding_energy())
    }

    fn tidy(&mut self, state: &mut State) -> bool {
        let State { bodies, ledger, rows, evaluation, clock, deepest, pairs: Some(pairs), .. } = state else {
            return false;
        };
        let PenaltyState { contacts, rolling } = &mut self.own;
        let times = (evaluation.time, clock.dt);
        if contacts.is_idle() {
            return false;
        }
        let moved = switching::tidy((bodies, ledger, rows), times, (pairs, contacts, rolling.as_mut()), deepest);
        let mut view = View { bodies, pairs, contacts, rolling: rolling.as_mut() };
        view.note_wedged::<N>(times.0);
        view.note_contradicted(rows, times.0);
        moved
    }

    fn hand_over(&mut self, state: &State, mode: EvaluationMode) {
        if let Some(mut view) = view(&mut self.own, state) {
            handover::hand_over::<N>(&mut view, mode, state.clock.dt);
        }
    }

    fn is_overloaded(&self) -> bool {
        is_overloaded(&self.own)
    }
}
