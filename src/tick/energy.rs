//! The energy ledger of a run: what is there, what was lost, and what is missing.

use serde::Serialize;

use super::State;
use crate::tick::balance::Totals;
use crate::tick::{Ledger, energy_seen};

/// Energies in J. `kinetic + potential + elastic + friction + inelasticity + drag - work` was constant but for
/// `residual`: the error of the integration.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct EnergyLedger {
    /// Energy of motion.
    pub kinetic: f64,
    /// Energy in fields.
    pub potential: f64,
    /// Energy in springs and contacts.
    pub elastic: f64,
    /// Lost to friction since the beginning.
    pub friction: f64,
    /// Lost to the inelasticity of contacts since the beginning.
    pub inelasticity: f64,
    /// Lost to drag since the beginning.
    pub drag: f64,
    /// Brought by drives since the beginning.
    pub work: f64,
    /// What the present energies and the losses exceed the energy at the beginning and the work by.
    pub residual: f64,
}

impl EnergyLedger {
    /// The ledger of the present state.
    pub fn of(state: &State) -> Self {
        Self::with(state.totals(), state.ledger())
    }

    /// The ledger of a state with these totals.
    fn with(now: Totals, ledger: &Ledger) -> Self {
        let start = ledger.start.unwrap_or(now);
        let (friction, inelasticity) = (ledger.friction.value(), ledger.inelasticity.value());
        let (drag, work) = (ledger.drag.value(), ledger.work.value());
        let lost = friction + inelasticity + drag;
        Self {
            kinetic: now.kinetic,
            potential: now.potential,
            elastic: now.elastic,
            friction,
            inelasticity,
            drag,
            work,
            residual: (now.energy() + lost) - (start.energy() + work),
        }
    }

    /// The energy that went round in the run, in J: what the residual is to be compared with. The zero of potential
    /// energy is a matter of taste, so only its change counts; work counts whichever way it went.
    pub fn turned_over(&self, state: &State) -> f64 {
        let ledger = &state.ledger;
        let start = ledger.start.unwrap_or_default();
        let fallen = (self.potential - start.potential).abs();
        let lost = self.friction.abs() + self.inelasticity.abs() + self.drag.abs();
        let present = start.kinetic.max(self.kinetic) + fallen + self.elastic;
        present.max(energy_seen(state)) + lost + ledger.gross_work
    }
}
