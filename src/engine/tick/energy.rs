//! The energy ledger of a run: current energies, losses, and the residual.

use std::collections::BTreeMap;

use serde::Serialize;

use super::State;
use crate::tick::ledger::Totals;
use crate::tick::{Ledger, energy_seen};

/// The open list of channels that belong to no body, such as `energy.total`.
pub const CHANNELS: &str = "channel";

/// Energies in J. The sum `kinetic + potential + elastic - work` and all losses would be constant without `residual`,
/// the error of the integration.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
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
    /// The present energies and losses, minus the energy at the beginning and the work.
    pub residual: f64,
    /// Lost to accounts of models since the beginning, by their names: `damping` of springs. Only those that the scene has.
    #[serde(flatten)]
    pub accounts: BTreeMap<&'static str, f64>,
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
        let accounts: BTreeMap<_, _> = ledger.accounts.iter().map(|(name, lost)| (*name, lost.value())).collect();
        let lost = friction + inelasticity + drag + accounts.values().sum::<f64>();
        Self {
            kinetic: now.kinetic,
            potential: now.potential,
            elastic: now.elastic,
            friction,
            inelasticity,
            drag,
            work,
            residual: (now.energy() + lost) - (start.energy() + work),
            accounts,
        }
    }

    /// All losses with the names of their accounts.
    pub fn losses(&self) -> impl Iterator<Item = (&'static str, f64)> + '_ {
        let known = [("friction", self.friction), ("inelasticity", self.inelasticity), ("drag", self.drag)];
        known.into_iter().chain(self.accounts.iter().map(|(name, lost)| (*name, *lost)))
    }

    /// Energy in J that friction and contacts have given, though they can only take. It is a loss below zero, or the fall of a
    /// loss. Drag may give energy, because wind drives bodies. Losses are sampled every few hundred ticks.
    pub fn given_back(&self, state: &State) -> f64 {
        let back = state.progress.energy.given_back(self.friction + self.inelasticity);
        back.max((-self.friction).max(0.0) + (-self.inelasticity).max(0.0))
    }

    /// The turnover of energy in the run, in J, which is the scale of the residual. The zero of potential energy is
    /// arbitrary, so only its change counts. Work counts in both directions.
    pub fn turned_over(&self, state: &State) -> f64 {
        let ledger = &state.ledger;
        let start = ledger.start.unwrap_or_default();
        let fallen = (self.potential - start.potential).abs();
        let lost = self.losses().map(|(_, lost)| lost.abs()).sum::<f64>();
        let present = start.kinetic.max(self.kinetic) + fallen + self.elastic;
        present.max(energy_seen(state)) + lost + ledger.gross_work
    }
}
