//! The guard against created energy: a check of the energy balance (Belytschko, Liu and Moran 2000, section 6.2).
//!
//! The created energy is `kinetic + potential + elastic + losses - work - start`, the residual of the ledger. The input has three
//! parts: initial kinetic and elastic energy, energy released by fields, and all positive work of drives. Near the critical tick
//! the energy of a stable spring swings by `1/(1 - (dt/critical)^2)`. That is fifty times at 0.99 of it. So the limit must be far
//! above any factor that a stable run reaches. A run is stopped if it has created [`BEYOND`] times the input and its tick is
//! above the critical one. At [`ENORMOUS`] times the input it is stopped for any tick. Rounding of large energies counts as
//! input, and so does motion by a billionth of a size in a tick.
//!
//! It checks every [`EVERY`] ticks. It also checks when a body travels farther in a tick than the smallest radius. When
//! that way has doubled, it checks again. After contacts were seen to respond nearly as fast as a method allows, it
//! checks at each tick. That begins with the first touch, before which no energy can be created. The first tick is
//! exempt. In it a drive that begins like a sine has no work, to the method's order, but bodies move.

use super::State;
use serde::{Deserialize, Serialize};

const BEYOND: f64 = 1e3;
const ENORMOUS: f64 = 1e9;
const EVERY: u64 = 256;
/// The rounding error of energies that cancel, as a share.
const ROUNDING: f64 = 1e-9;
/// Motion by a billionth of the size of a body in a tick counts as input. This is its share of the energy of a motion
/// by the whole size. Friction that stops a body creeps at that rate.
const IDLE: f64 = 1e-18;

/// The time of the next check of energy, and the input.
#[derive(Clone, Copy, Debug, Default, Serialize, Deserialize)]
pub(super) struct EnergyGuard {
    /// A model responds nearly as fast as the tick can bear: it looks at each tick.
    pub alert: bool,
    next: u64,
    travel: f64,
    released: f64,
    /// The greatest kinetic and elastic energy together that was seen, in J.
    greatest: f64,
    /// The greatest loss to friction and inelasticity that was seen, in J.
    taken: f64,
    /// The greatest fall from there, in J.
    given: f64,
}

/// More energy than there can be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Created {
    /// Energy in J that came out of nowhere.
    pub energy: f64,
    /// Energy in J that was put in.
    pub put_in: f64,
}

impl EnergyGuard {
    /// The greatest energy that was seen to go round, in J: of motion and springs, and what fields released.
    pub fn seen(&self) -> f64 {
        self.greatest + self.released
    }

    /// Energy in J that contacts gave back: the greatest fall of the loss to friction and inelasticity. That loss is `lost` J at
    /// present.
    pub fn given_back(&self, lost: f64) -> f64 {
        self.given.max(self.taken - lost)
    }

    /// Whether it is time to look, after `ticks` ticks in which nothing travelled farther than `travel` metres per tick.
    #[inline]
    pub fn is_due(&self, ticks: u64, travel: f64) -> bool {
        ticks >= self.next || travel > self.travel || self.alert
    }

    /// Checks the energy of the current state. If there is too much, it returns the index of the body that has most of
    /// it.
    pub fn look(&mut self, state: &State, travel: f64) -> Option<(usize, Created)> {
        let State { bodies, ledger, clock, .. } = state;
        let first = self.next == 0;
        self.next = (clock.ticks / EVERY + 1) * EVERY;
        // From the smallest radius on it looks each time the travel has doubled.
        self.travel = if travel > bodies.smallest_radius { 2.0 * travel } else { bodies.smallest_radius };
        let (now, start) = (state.totals(), ledger.start?);
        let by_contacts = ledger.friction.value() + ledger.inelasticity.value();
        let lost = by_contacts + ledger.drag.value();
        self.given = self.given_back(by_contacts);
        self.taken = self.taken.max(by_contacts);
        let work = ledger.work.value();
        self.released = self.released.max(start.potential - now.potential);
        self.greatest = self.greatest.max(now.kinetic + now.elastic);
        let rounding = ROUNDING * (start.potential.abs() + now.potential.abs() + work.abs());
        let dynamic = (0..bodies.len()).filter(|body| bodies.dynamic[*body]);
        let idle: f64 = dynamic.map(|body| bodies.mass[body] * (bodies.extent(body) / clock.dt).powi(2)).sum();
        let put_in = start.kinetic + start.elastic + self.released + ledger.put_in() + rounding;
        let energy = now.energy() + lost - work - start.energy();
        let unstable =
            state.time_scales().fastest.is_some_and(|fastest| clock.dt > fastest.critical_tick(&state.stability));
        let too_much = if unstable { BEYOND } else { ENORMOUS } * (put_in + IDLE * idle);
        // In this form NaN and infinite energies are too much. Without any input there is no scale.
        if first && energy.is_finite() || put_in == 0.0 || energy <= too_much && put_in.is_finite() {
            return None;
        }
        let most = (0..bodies.len()).max_by(|&a, &b| bodies.kinetic_energy(a).total_cmp(&bodies.kinetic_energy(b)));
        Some((most?, Created { energy, put_in }))
    }
}
