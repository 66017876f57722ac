//! The classical Runge-Kutta method (Kutta 1901). Rates at the beginning, twice in the middle and at the end have
//! weights 1, 2, 2, 1 over 6.
//!
//! Order 4, four evaluations per step, of which the first is that of the beginning. Not symplectic: an oscillation
//! loses `(omega h)^6/72` of its energy with each step. It is stable for `omega h < 2.83`, and damping alone for `h c/m
//! < 2.78`. The source is Hairer, Norsett, Wanner, Solving Ordinary Differential Equations I, section II.1.

use super::{OneStep, Start};
use crate::tick::Flow;

/// The classical Runge-Kutta method.
#[derive(Default)]
pub struct RungeKutta4 {
    state: Vec<f64>,
    rates: Vec<f64>,
}

impl OneStep for RungeKutta4 {
    fn step(&mut self, flow: &mut dyn Flow, start: Start, length: f64, change: &mut [f64]) {
        self.rates.clear();
        self.rates.extend_from_slice(start.rates);
        self.state.resize(start.state.len(), 0.0);
        change.fill(0.0);
        for (share, weight) in [(0.5, 2.0), (0.5, 2.0), (1.0, 1.0)] {
            for ((state, start), rate) in self.state.iter_mut().zip(start.state).zip(&self.rates) {
                *state = start + share * length * rate;
            }
            flow.rates(start.time + share * length, &self.state, &mut self.rates);
            // Weights multiply differences from the rate at the beginning, so that a constant rate is exact.
            for ((change, rate), beginning) in change.iter_mut().zip(&self.rates).zip(start.rates) {
                *change += weight * (rate - beginning);
            }
        }
        for (change, beginning) in change.iter_mut().zip(start.rates) {
            *change = length * (beginning + *change / 6.0);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::problems::{KEPLER, OSCILLATOR};
    use super::super::trials::{TrialRun, demand_order};
    use super::*;

    /// Law: order 4 on smooth motion (section II.1 of the source). Tolerance: a quarter of an order.
    #[test]
    fn the_order_is_4() {
        demand_order(&mut RungeKutta4::default(), 4, 1.0, 1.37);
    }

    /// Law: a step multiplies an oscillation by `1 + iz - z^2/2 - iz^3/6 + z^4/24`, `z = omega h`: its energy by
    /// `1 - z^6/72 + z^8/576`, which is 1 at `z = sqrt(8)`. Tolerance: rounding of the steps.
    #[test]
    fn loses_energy_as_stated() {
        for length in [0.3, 1.0, 2.82, 2.84] {
            let mut run = TrialRun::of(OSCILLATOR);
            for _ in 0..100 {
                run.step(&mut RungeKutta4::default(), length);
            }
            let factor = 1.0 - libm::pow(length, 6.0) / 72.0 + libm::pow(length, 8.0) / 576.0;
            assert_eq!(factor < 1.0, length < 2.83);
            let (energy, expected) = (2.0 * (OSCILLATOR.energy)(&run.state), libm::pow(factor, 100.0));
            assert!((energy / expected - 1.0).abs() < 100.0 * 16.0 * f64::EPSILON, "{energy} instead of {expected}");
        }
    }

    #[test]
    fn three_evaluations_beside_the_first() {
        let mut run = TrialRun::of(KEPLER);
        run.step(&mut RungeKutta4::default(), 0.1);
        assert_eq!(run.flow.evaluations, 3);
    }
}
