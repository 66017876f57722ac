//! The three parts of splitting methods: kick, drift, and the advance of the states of models.
//!
//! - kick: `v' = v + h a(t, q, (v + v')/2, z)`;
//! - drift: `q' = q + h v`, `t' = t + h`;
//! - own: `z' = z + h r(t, q, v, (z + z')/2)`.
//!
//! Each is the inverse of itself with `-h`, so any palindrome of them is symmetric in time. Kick and own are implicit
//! midpoint rules, iterated to rounding (`fixed_point.rs`). Kicks of accelerations without velocities take one
//! evaluation. They take none if neither time nor position has changed.
//!
//! If joints hold coordinates, drifts follow them ([`Flow::drift`]). So a palindrome is symmetric and symplectic on the
//! constraints, as RATTLE is. Kicks go along joints.
//!
//! Source: Hairer, Lubich, Wanner, Geometric Numerical Integration, 2nd ed. 2006, sections II.3 to II.5.

use std::ops::Range;

use super::Start;
use super::fixed_point::FixedPoint;
use crate::tick::Flow;

/// Working memory of a step that is made of parts.
#[derive(Default)]
pub(super) struct Splitting {
    state: Vec<f64>,
    rates: Vec<f64>,
    fixed_point: FixedPoint,
}

/// A step in the making.
pub(super) struct Making<'a> {
    flow: &'a mut dyn Flow,
    start: Start<'a>,
    change: &'a mut [f64],
    work: &'a mut Splitting,
    time: f64,
    velocities: Range<usize>,
    accounts: Range<usize>,
    velocity_dependent: bool,
    held: bool,
    /// Whether the rates in working memory are those of the present time and place.
    fresh: bool,
}

impl Splitting {
    /// Begins a step whose change is to be written to `change`.
    pub(super) fn begin<'a>(
        &'a mut self,
        flow: &'a mut dyn Flow,
        start: Start<'a>,
        change: &'a mut [f64],
    ) -> Making<'a> {
        self.state.clear();
        self.state.extend_from_slice(start.state);
        self.rates.clear();
        self.rates.extend_from_slice(start.rates);
        change.fill(0.0);
        let (velocities, velocity_dependent) = (flow.velocities(), flow.velocity_dependent());
        let held = flow.is_held();
        let accounts = change.len() - flow.accounts()..change.len();
        let time = start.time;
        Making { flow, start, change, work: self, time, velocities, accounts, velocity_dependent, held, fresh: true }
    }
}

impl Making<'_> {
    /// Velocities by accelerations.
    pub(super) fn kick(&mut self, length: f64) {
        if self.velocity_dependent {
            self.settle(self.velocities.clone(), length, self.held);
            return self.add(self.accounts.clone(), length);
        }
        if !self.fresh {
            self.flow.rates(self.time, &self.work.state, &mut self.work.rates);
            self.fresh = true;
        }
        self.add(self.velocities.clone(), length);
        self.add(self.accounts.clone(), length);
    }

    /// Coordinates by velocities, and time.
    pub(super) fn drift(&mut self, length: f64) {
        let coordinates = self.velocities.start;
        if self.held {
            self.flow.drift(self.time, length, &mut self.work.state, self.change);
            self.time += length;
            self.fresh = false;
            return;
        }
        for index in 0..coordinates {
            let velocity = self.start.state[index + coordinates] + self.change[index + coordinates];
            self.change[index] += length * velocity;
            self.work.state[index] = self.start.state[index] + self.change[index];
        }
        self.time += length;
        self.fresh = false;
    }

    /// States of models by their rates.
    pub(super) fn own(&mut self, length: f64) {
        let own = self.velocities.end..self.accounts.start;
        if !own.is_empty() {
            self.settle(own, length, false);
            self.fresh = false;
        }
    }

    /// Numbers by their rates at the middle of their own change, those of a kick along joints or not. The rates at hand are the first guess.
    fn settle(&mut self, indices: Range<usize>, length: f64, kick: bool) {
        let Splitting { state, rates, fixed_point } = &mut *self.work;
        let (start, change) = (self.start.state, &*self.change);
        let middle = |index: usize, rate: f64| start[index] + (change[index] + length / 2.0 * rate);
        let (flow, time) = (&mut *self.flow, self.time);
        let evaluate = |state: &[f64], rates: &mut [f64]| match kick {
            true => flow.kick_rates(time, state, rates),
            false => flow.rates(time, state, rates),
        };
        fixed_point.find(evaluate, indices.clone(), middle, state, rates);
        self.add(indices, length);
    }

    fn add(&mut self, indices: Range<usize>, length: f64) {
        for index in indices {
            self.change[index] += length * self.work.rates[index];
            self.work.state[index] = self.start.state[index] + self.change[index];
        }
    }
}
