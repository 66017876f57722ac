//! Explicit Euler: `y' = y + h r(t, y)` for every number of the state (Euler 1768).
//!
//! Order 1, one evaluation per step, which is that of the beginning. Not symplectic: the energy of an undamped
//! oscillator grows by `1 + (omega h)^2` in each step. So no step is stable for it. Pure damping is stable for `h c/m <
//! 2`. The method is for teaching (Hairer, Norsett, Wanner, Solving Ordinary Differential Equations I, section I.7).

use super::{OneStep, Start};
use crate::tick::Flow;

/// Explicit Euler.
#[derive(Default)]
pub struct ExplicitEuler;

impl OneStep for ExplicitEuler {
    fn step(&mut self, _flow: &mut dyn Flow, start: Start, length: f64, change: &mut [f64]) {
        for (change, rate) in change.iter_mut().zip(start.rates) {
            *change = length * rate;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::problems::OSCILLATOR;
    use super::super::trials::{TrialRun, demand_order};
    use super::*;

    /// Law: order 1 on smooth motion (section I.7 of the source). Tolerance: a quarter of an order.
    #[test]
    fn the_order_is_1() {
        demand_order(&mut ExplicitEuler, 1, 40.0, 1.37);
    }

    /// Law: the energy of an undamped oscillation grows by `1 + (omega h)^2` in each step. Tolerance: rounding of the steps.
    #[test]
    fn energy_grows_as_stated() {
        let mut run = TrialRun::of(OSCILLATOR);
        for _ in 0..100 {
            run.step(&mut ExplicitEuler, 0.1);
        }
        let growth = 2.0 * (OSCILLATOR.energy)(&run.state);
        let expected = libm::pow(1.01, 100.0);
        assert!((growth / expected - 1.0).abs() < 100.0 * 4.0 * f64::EPSILON, "{growth} instead of {expected}");
        assert_eq!(run.flow.evaluations, 0);
    }
}
