//! Implicit midpoint rule: `y' = y + h r(t + h/2, (y + y')/2)` for every number of the state.
//!
//! Order 2, symmetric in time, symplectic. It keeps quadratic invariants (the energy of linear springs) to rounding. It
//! is stable for every step with linear springs and damping. The source is Hairer, Lubich, Wanner, Geometric Numerical
//! Integration, 2nd ed. 2006, sections II.1, IV.2 and VI.4. Unresolved motion continues: a spring with large `omega h`
//! changes sign with each step instead of coming to rest.
//!
//! The unknown is half the change of velocities, `w = h/2 a(t + h/2, q + h/2 (v + w), v + w, z)`. Positions follow from
//! it. For each `w` an iteration finds `z`, the midpoint of states of models (`fixed_point.rs`). So `z` must not depend
//! stiffly on itself: `h/2` times that rate has to be less than 1. Its coupling to velocities may be arbitrarily stiff.
//!
//! Newton's method to rounding, with differences for derivatives. It takes one evaluation first, and one per coordinate for the
//! matrix. Each of 2 to 4 iterations takes one more. States of models at least double that. The matrix is made in each step, and
//! again if an iteration gains less than a digit. A step of length 0 changes nothing.

use super::convergence::{Convergence, LIMIT};
use super::elimination::Elimination;
use super::fixed_point::FixedPoint;
use super::{OneStep, Start};
use crate::tick::Flow;

/// Implicit midpoint rule.
#[derive(Default)]
pub struct ImplicitMidpoint {
    /// Half the change of velocities.
    half_change: Vec<f64>,
    middle: Midpoint,
    disturbed: Midpoint,
    matrix: Elimination,
    correction: Vec<f64>,
}

/// A state in the middle of the step, and its rates.
#[derive(Default)]
struct Midpoint {
    state: Vec<f64>,
    rates: Vec<f64>,
    fixed_point: FixedPoint,
}

impl Midpoint {
    fn copy(&mut self, state: &[f64], rates: &[f64]) {
        self.state.clear();
        self.state.extend_from_slice(state);
        self.rates.clear();
        self.rates.extend_from_slice(rates);
    }

    /// Rates in the middle for a half change of velocities. The rates at hand are the first guess of those of models.
    fn evaluate(&mut self, flow: &mut dyn Flow, start: Start, length: f64, half_change: &[f64]) {
        let Self { state, rates, fixed_point } = self;
        let (time, half) = (start.time + length / 2.0, length / 2.0);
        let coordinates = half_change.len();
        for index in 0..coordinates {
            state[index + coordinates] = start.state[index + coordinates] + half_change[index];
            state[index] = start.state[index] + half * state[index + coordinates];
        }
        let own = 2 * coordinates..state.len();
        let middle = |index: usize, rate: f64| start.state[index] + half * rate;
        if own.is_empty() {
            flow.rates(time, state, rates);
        } else {
            let evaluate = |state: &[f64], rates: &mut [f64]| flow.rates(time, state, rates);
            fixed_point.find(evaluate, own, middle, state, rates);
        }
    }
}

impl OneStep for ImplicitMidpoint {
    fn step(&mut self, flow: &mut dyn Flow, start: Start, length: f64, change: &mut [f64]) {
        let velocities = flow.velocities();
        let coordinates = velocities.start;
        let half = length / 2.0;
        if length == 0.0 {
            return change.fill(0.0);
        }
        self.half_change.clear();
        self.half_change.resize(coordinates, 0.0);
        self.correction.resize(coordinates, 0.0);
        self.middle.copy(start.state, start.rates);
        self.middle.evaluate(flow, start, length, &self.half_change);
        let mut settling = Convergence::default();
        for iteration in 0..LIMIT {
            if iteration == 0 || settling.slow() {
                self.make_matrix(flow, start, length);
            }
            for index in 0..coordinates {
                self.correction[index] = half * self.middle.rates[index + coordinates] - self.half_change[index];
            }
            self.matrix.solve(&mut self.correction);
            for (half_change, correction) in self.half_change.iter_mut().zip(&self.correction) {
                *half_change += correction;
            }
            self.middle.evaluate(flow, start, length, &self.half_change);
            let velocities = &start.state[velocities.clone()];
            let arrived = settling.arrived(self.correction.iter().zip(&self.half_change).zip(velocities).map(
                |((correction, half_change), velocity)| {
                    (*correction, (velocity + half_change).abs() + half_change.abs())
                },
            ));
            if arrived {
                break;
            }
        }
        for index in 0..coordinates {
            change[index + coordinates] = 2.0 * self.half_change[index];
            change[index] = length * self.middle.state[index + coordinates];
        }
        for (change, rate) in change.iter_mut().zip(&self.middle.rates).skip(velocities.end) {
            *change = length * rate;
        }
    }
}

impl ImplicitMidpoint {
    /// Makes `1 - h/2 da/dw` by differences, and eliminates.
    fn make_matrix(&mut self, flow: &mut dyn Flow, start: Start, length: f64) {
        let coordinates = self.half_change.len();
        self.matrix.begin(coordinates);
        for column in 0..coordinates {
            let kept = self.half_change[column];
            self.half_change[column] += disturbance(&self.middle.state, column, coordinates, length, kept);
            let disturbance = self.half_change[column] - kept;
            self.disturbed.copy(&self.middle.state, &self.middle.rates);
            self.disturbed.evaluate(flow, start, length, &self.half_change);
            self.half_change[column] = kept;
            for row in 0..coordinates {
                let index = row + coordinates;
                let difference = self.disturbed.rates[index] - self.middle.rates[index];
                let one = if row == column { 1.0 } else { 0.0 };
                *self.matrix.entry(row, column) = one - length / 2.0 * difference / disturbance;
            }
        }
        self.matrix.eliminate();
    }
}

/// The disturbance of a velocity for a difference quotient. It changes half of the velocity's digits, or a quarter of the
/// coordinate's if that is more. So rounding leaves three digits or more in the difference.
fn disturbance(middle: &[f64], coordinate: usize, coordinates: usize, length: f64, half_change: f64) -> f64 {
    let digits = f64::EPSILON.sqrt();
    let by_velocity = digits * (middle[coordinate + coordinates].abs() + half_change.abs());
    let by_place = digits * digits.sqrt() * (2.0 * middle[coordinate] / length).abs();
    let disturbance = by_velocity.max(by_place);
    if disturbance > 0.0 { disturbance } else { digits }
}

#[cfg(test)]
mod tests {
    use super::super::problems::{ELONGATION, KEPLER, OSCILLATOR, ProblemMotion};
    use super::super::trials::{TrialRun, demand_bounded_energy, demand_no_trend, demand_order, demand_reversible};
    use super::*;

    /// Law: order 2 on smooth motion (section II.1 of the source). Tolerance: a quarter of an order.
    #[test]
    fn the_order_is_2() {
        demand_order(&mut ImplicitMidpoint::default(), 2, 6.0, 1.37);
    }

    /// Law: a symplectic method keeps the energy near its value for exponentially long (section IX.8 of the source).
    #[test]
    fn energy_stays() {
        demand_bounded_energy(&mut ImplicitMidpoint::default(), KEPLER, 200.3);
    }

    /// Law: the same on sharp ellipses with steps that resolve the passage. There the rate times the step is a third.
    #[test]
    fn energy_has_no_trend_in_ten_thousand_sharp_orbits() {
        demand_no_trend(&mut ImplicitMidpoint::default(), 600);
    }

    /// Law: a symmetric method runs back to its start (section V.1 of the source). Tolerance: rounding.
    #[test]
    fn runs_backwards() {
        demand_reversible(&mut ImplicitMidpoint::default(), 1.0);
    }

    /// Law: quadratic invariants are kept at any step (theorem IV.2.1 of the source). Here `omega h` is 0.3 and 1000.
    /// The motions are a spring, a spring as a state of a model, and a chain of five masses. The slowest mode of the
    /// chain has that `omega h`. Tolerance: four roundings for each step (both numbers of the state, squared).
    #[test]
    fn quadratic_energy_is_kept_by_stiff_springs() {
        for (motion, slowest) in [(OSCILLATOR, 1.0), (ELONGATION, 1.0), (CHAIN, 0.517)] {
            for product in [0.3, 1000.0] {
                let mut run = TrialRun::of(motion);
                let beginning = (motion.energy)(&run.state);
                let mut off = 0.0_f64;
                let mut method = ImplicitMidpoint::default();
                for _ in 0..10_000 {
                    run.step(&mut method, product / slowest);
                    off = off.max(((motion.energy)(&run.state) / beginning - 1.0).abs());
                }
                assert!(off <= 10_000.0 * 4.0 * f64::EPSILON, "{}, {product}: energy off by {off:e}", motion.name);
            }
        }
    }

    /// Five masses of 1 kg between two walls, springs of 1 N/m. The slowest frequency is `2 sin(pi/12)`, 0.518 per second.
    const CHAIN: ProblemMotion = ProblemMotion {
        name: "chain",
        coordinates: 5,
        dimension: 10,
        rates: |_, state, rates| {
            for index in 0..5 {
                let left = if index == 0 { 0.0 } else { state[index - 1] };
                let right = if index == 4 { 0.0 } else { state[index + 1] };
                rates[index] = state[index + 5];
                rates[index + 5] = (left - state[index]) + (right - state[index]);
            }
        },
        exact: |_| vec![1.0, 0.5, 0.0, -0.25, 0.125, 0.0, 0.0, 1.0, 0.0, 0.0],
        energy: |state| {
            let kinetic: f64 = state[5..].iter().map(|velocity| 0.5 * velocity * velocity).sum();
            let ends = state[0] * state[0] + state[4] * state[4];
            let springs: f64 = state[..5].windows(2).map(|pair| (pair[1] - pair[0]) * (pair[1] - pair[0])).sum();
            kinetic + 0.5 * (ends + springs)
        },
        ..OSCILLATOR
    };
}
