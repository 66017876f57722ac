//! When an iteration has arrived at the last bits.
//!
//! Symmetric and implicit maps are what they claim only if their equations are solved to rounding: what is left over breaks
//! the symmetry in time. An iteration has arrived when nothing moves by more than two roundings, or when it is within
//! `NEARLY` and moves no less than before: then rounding moves it.

/// A movement that is two roundings.
const ROUNDING: f64 = 2.0 * f64::EPSILON;
/// Below this share rounding may be what moves.
const NEARLY: f64 = 1e-9;
/// A number is measured by its own size, or by this share of the largest if that is more: a number that would be zero but
/// for the rounding of others never settles by its own measure.
const SMALLEST: f64 = 1e-6;
/// An iteration that has not arrived by then does not converge: the step is far too long for it.
pub(super) const LIMIT: usize = 60;

/// Watches an iteration.
#[derive(Default)]
pub(super) struct Settling {
    moved: Option<f64>,
    slow: bool,
}

impl Settling {
    /// After numbers have been moved: whether they have arrived. `movements` are how far each moved, and its size.
    pub(super) fn arrived(&mut self, movements: impl Iterator<Item = (f64, f64)> + Clone) -> bool {
        let largest = movements.clone().fold(0.0_f64, |largest, (_, size)| largest.max(size.abs()));
        let moved = movements.fold(0.0_f64, |most, (movement, size)| {
            // Nothing moves where all numbers are zero and stay so.
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
