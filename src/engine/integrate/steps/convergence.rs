//! Convergence test of an iteration at the last bits.
//!
//! Symmetric and implicit maps have their properties only if their equations are solved to rounding. A remainder breaks the
//! symmetry in time. An iteration has converged if every number moves by at most two roundings. It has also converged if it is
//! within `NEARLY` and moves no less than before, because then rounding moves it.

/// A movement that is two roundings.
const ROUNDING: f64 = 2.0 * f64::EPSILON;
/// Below this share rounding may be what moves.
const NEARLY: f64 = 1e-9;
/// A number is measured by its size, or by this share of the largest if that is more. Some numbers would be zero
/// without the rounding of others. By their own sizes they would never settle.
const SMALLEST: f64 = 1e-6;
/// An iteration that takes longer does not converge: the step is far too long for it.
pub(super) const LIMIT: usize = 60;

/// Watches an iteration.
#[derive(Default)]
pub(super) struct Convergence {
    moved: Option<f64>,
    slow: bool,
}

impl Convergence {
    /// After numbers have been moved: whether they have arrived. `movements` are how far each moved, and its size.
    pub(super) fn arrived(&mut self, movements: impl Iterator<Item = (f64, f64)> + Clone) -> bool {
        let largest = movements.clone().fold(0.0_f64, |largest, (_, size)| largest.max(size.abs()));
        let moved = movements.fold(0.0_f64, |most, (movement, size)| {
            // If all numbers are zero and stay so, there is no movement.
            if movement == 0.0 { most } else { most.max(movement.abs() / size.abs().max(SMALLEST * largest)) }
        });
        let arrived = moved <= ROUNDING || (moved < NEARLY && self.moved.is_some_and(|before| moved >= before));
        self.slow = moved >= NEARLY && self.moved.is_some_and(|before| moved > 0.1 * before);
        self.moved = Some(moved);
        arrived
    }

    /// Whether the last movement was more than a tenth of the one before, and rounding was not the reason.
    pub(super) fn slow(&self) -> bool {
        self.slow
    }
}
