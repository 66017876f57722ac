//! DOP853: the explicit Runge-Kutta method of order 8 of Dormand and Prince, with an error estimate and dense output.
//!
//! Order 8, twelve evaluations per step, of which the first is that of the beginning. Not symplectic: an oscillation loses
//! `2.4e-8 (omega h)^10` of its amplitude in each step. It is stable for `omega h < 5.97`, and damping alone for `h c/m < 6.39`;
//! but its error bounds the step earlier. Sources: Prince and Dormand 1981. Hairer, Norsett, Wanner, Solving Ordinary
//! Differential Equations I, 2nd ed. 1993, sections II.5, II.6 and II.10.
//!
//! The estimate joins those of two embedded methods of orders 5 and 3, `e5^2/sqrt(e5^2 + 0.01 e3^2)`. It falls with
//! `h^8`, and the error with `h^9`. On the motions of `problems.rs` it is 2 to 20 times the error in the mean. The
//! factor grows as the step shrinks. If the estimate of order 5 passes through zero, the error of a step may be 25
//! times the estimate. That was measured on a fall with quadratic drag. Dense output is of order 7 and takes four more
//! evaluations: one at the end, and three inside.

mod coefficients;
#[cfg(test)]
mod tests;

use super::{OneStep, Start};
use crate::tick::Flow;
use crate::tick::snapshot::{Memory, UnfitSnapshot, demand, recall};
use coefficients::{ALL_STAGES, DENSE, ERROR_5, POLYNOMIALS, RESULT, RESULT_3, STAGES, STEP, Stage, Sum};
use serde::{Deserialize, Serialize};

/// DOP853.
#[derive(Default, Serialize, Deserialize)]
pub struct Dop853 {
    state: Vec<f64>,
    /// Rates of each stage, one stage after the other.
    rates: Vec<f64>,
    length: f64,
    /// Seven coefficients for each number of the state: those of 1, s, s(1-s), s^2(1-s) and so on, over s.
    dense: Vec<[f64; 7]>,
}

impl Dop853 {
    /// Takes the rates of `stage`, which is number `number`.
    fn evaluate(&mut self, flow: &mut dyn Flow, start: Start, number: usize, stage: &Stage) {
        let dimension = start.state.len();
        for (index, (state, start)) in self.state.iter_mut().zip(start.state).enumerate() {
            *state = start + self.length * sum(&self.rates, dimension, stage.weights, index);
        }
        let rates = &mut self.rates[number * dimension..(number + 1) * dimension];
        flow.rates(start.time + stage.node * self.length, &self.state, rates);
    }

    /// Makes the polynomials of all numbers of the state of the rates of all stages.
    fn interpolate(&mut self) {
        let (dimension, length) = (self.state.len(), self.length);
        self.dense.resize(dimension, [0.0; 7]);
        for (index, dense) in self.dense.iter_mut().enumerate() {
            let change = length * result(&self.rates, dimension, index);
            let beginning = length * self.rates[index];
            let end = length * self.rates[STAGES * dimension + index];
            dense[0] = change;
            dense[1] = beginning - change;
            dense[2] = (change - end) - dense[1];
            for (coefficient, weights) in dense[3..].iter_mut().zip(POLYNOMIALS) {
                *coefficient = length * sum(&self.rates, dimension, weights, index);
            }
        }
    }
}

/// A weighted sum of rates of stages, for one number of the state.
fn sum(rates: &[f64], dimension: usize, weights: Sum, index: usize) -> f64 {
    weights.iter().fold(0.0, |sum, (stage, weight)| sum + weight * rates[stage * dimension + index])
}

/// The mean rate of the step, for one number of the state. A constant rate is exact. The rounded weights do not add up
/// to one, and a body with a fast spin would show it.
fn result(rates: &[f64], dimension: usize, index: usize) -> f64 {
    let beginning = rates[index];
    let constant = RESULT.iter().all(|(stage, _)| rates[stage * dimension + index] == beginning);
    if constant { beginning } else { sum(rates, dimension, RESULT, index) }
}

impl OneStep for Dop853 {
    fn save(&self) -> Memory {
        Memory::of(self)
    }

    fn load(&mut self, bytes: &[u8]) -> Result<(), UnfitSnapshot> {
        let saved: Self = recall(bytes)?;
        let (rates, dimension) = (saved.rates.len(), saved.state.len());
        let dense = saved.dense.is_empty() || saved.dense.len() == dimension;
        demand(rates == ALL_STAGES * dimension && dense && saved.length.is_finite(), "the stages of the method")?;
        *self = saved;
        Ok(())
    }

    fn step(&mut self, flow: &mut dyn Flow, start: Start, length: f64, change: &mut [f64]) {
        let dimension = start.state.len();
        self.length = length;
        // Polynomials of an earlier step may be those of other numbers.
        self.dense.clear();
        self.state.resize(dimension, 0.0);
        self.rates.resize(ALL_STAGES * dimension, 0.0);
        self.rates[..dimension].copy_from_slice(start.rates);
        for (number, stage) in (1..).zip(&STEP) {
            self.evaluate(flow, start, number, stage);
        }
        for (index, change) in change.iter_mut().enumerate() {
            *change = length * result(&self.rates, dimension, index);
        }
    }

    fn error(&self, scale: &[f64]) -> Option<f64> {
        let dimension = self.state.len();
        let (mut of_5, mut of_3, mut looked_at) = (0.0, 0.0, 0);
        for (index, scale) in scale.iter().enumerate().filter(|(_, scale)| scale.is_finite()) {
            let result = sum(&self.rates, dimension, RESULT, index);
            let error_5 = sum(&self.rates, dimension, ERROR_5, index) / scale;
            let error_3 = (result - sum(&self.rates, dimension, RESULT_3, index)) / scale;
            of_5 += error_5 * error_5;
            of_3 += error_3 * error_3;
            looked_at += 1;
        }
        if of_5 == 0.0 {
            return Some(0.0);
        }
        let together = (of_5 + 0.01 * of_3) * f64::from(looked_at);
        Some(self.length.abs() * of_5 / together.sqrt())
    }

    fn order_of_error(&self) -> u32 {
        8
    }

    fn make_dense(&mut self, flow: &mut dyn Flow, start: Start, length: f64) {
        debug_assert_eq!(length, self.length, "dense output is of the step that was made last");
        for (number, stage) in (STAGES..).zip(&DENSE) {
            self.evaluate(flow, start, number, stage);
        }
        self.interpolate();
    }

    fn dense(&self, share: f64, change: &mut [f64]) {
        for (change, dense) in change.iter_mut().zip(&self.dense) {
            *change = 0.0;
            for (power, coefficient) in dense.iter().enumerate().rev() {
                let factor = if power % 2 == 0 { share } else { 1.0 - share };
                *change = (*change + coefficient) * factor;
            }
        }
    }
}
