//! Fixed-point iteration with Anderson acceleration for `x = m(r(x))`, the equation of an implicit midpoint rule. Here
//! `r` are the rates of some numbers of a state. The function `m` maps rates to the numbers in the middle of the step.
//!
//! The acceleration has depth one, which is the secant rule for a single number (Anderson 1965; Walker, Ni 2011). The
//! next try is a mixture of the last two. It would have the least residual if the residual were linear. The iteration
//! ends at rounding (`settling.rs`). Let the rates depend on the numbers by `rho` over half the step. Plain iteration
//! then gains a factor `rho` with each evaluation, and diverges if `rho` is 1 or more. Acceleration needs a third to a
//! half of the evaluations. For single numbers it converges even if `rho` is larger than 1.

use std::ops::Range;

use super::convergence::{Convergence, LIMIT};
/// Working memory of the iteration.
#[derive(Default)]
pub(super) struct FixedPoint {
    /// The result of the last try, and its distance from the try.
    images: Vec<f64>,
    residuals: Vec<f64>,
}

impl FixedPoint {
    /// Finds the numbers at `places` of `state`, with their `rates`. The given rates are the first guess, and
    /// `evaluate` computes them. `middle` gives the value of a number in the middle of the step from its rate.
    pub(super) fn find(
        &mut self,
        mut evaluate: impl FnMut(&[f64], &mut [f64]),
        indices: Range<usize>,
        middle: impl Fn(usize, f64) -> f64,
        state: &mut [f64],
        rates: &mut [f64],
    ) {
        self.images.resize(indices.len(), 0.0);
        self.residuals.resize(indices.len(), 0.0);
        for index in indices.clone() {
            state[index] = middle(index, rates[index]);
        }
        let mut settling = Convergence::default();
        for number in 0..LIMIT {
            evaluate(state, rates);
            let arrived = settling.arrived(indices.clone().map(|index| {
                let image = middle(index, rates[index]);
                (image - state[index], image)
            }));
            if arrived {
                return;
            }
            let (mut above, mut below) = (0.0, 0.0);
            for (index, before) in indices.clone().zip(&self.residuals) {
                let residual = middle(index, rates[index]) - state[index];
                above += residual * (residual - before);
                below += (residual - before) * (residual - before);
            }
            let share = if number == 0 || below == 0.0 { 0.0 } else { above / below };
            for ((index, before), residual) in indices.clone().zip(&mut self.images).zip(&mut self.residuals) {
                let image = middle(index, rates[index]);
                *residual = image - state[index];
                state[index] = image - share * (image - *before);
                *before = image;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::problems::{Counted, OSCILLATOR, ProblemMotion};
    use super::*;
    use crate::tick::Flow;

    /// Ten numbers that are damped, by up to half of themselves over half the step, and turned into each other.
    const DAMPED: ProblemMotion = ProblemMotion {
        name: "damped",
        coordinates: 5,
        dimension: 10,
        velocity_dependent: true,
        rates: |_, state, rates| {
            for index in 0..10 {
                let next = state[(index + 1) % 10] - state[(index + 9) % 10];
                rates[index] = 0.05 * next - 0.05 * (index as f64) * state[index];
            }
        },
        ..OSCILLATOR
    };

    /// Law: plain iteration of a contraction gains the factor `rho` with each evaluation. So it reaches rounding after
    /// `log(eps)/log(rho)` of them; `rho` is at most 0.45 + 0.1. Acceleration must not be slower. Tolerance: two
    /// roundings of the terms of the residual.
    #[test]
    fn arrives_at_rounding_no_later_than_plain_iteration() {
        let base: Vec<f64> = (0..10).map(|number| 1.0 - 0.3 * f64::from(number)).collect();
        let (mut state, mut rates) = (base.clone(), vec![0.0; 10]);
        let mut flow = Counted { motion: DAMPED, evaluations: 0 };
        let middle = |index: usize, rate: f64| base[index] + rate;
        let evaluate = |state: &[f64], rates: &mut [f64]| flow.rates(0.0, state, rates);
        FixedPoint::default().find(evaluate, 0..10, middle, &mut state, &mut rates);
        for (index, number) in state.iter().enumerate() {
            let off = (middle(index, rates[index]) - number).abs();
            assert!(off <= 2.0 * f64::EPSILON * 4.0, "{index}: {off:e}");
        }
        let plain = libm::log(f64::EPSILON) / libm::log(0.55);
        assert!(flow.evaluations as f64 <= plain, "{} evaluations, plain iteration {plain}", flow.evaluations);
    }
}
