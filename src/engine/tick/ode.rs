//! Equations of motion as methods see them.

use std::ops::Range;

/// A system of ordinary differential equations of motion, `q' = v`, `v' = a(t, q, v, z)`, `z' = r(t, q, v, z)`.
///
/// A state is one list of numbers: coordinates `q`, as many velocities `v`, and behind them whatever models keep of their
/// own (`z`): elongations, states of controllers, accounts of energy.
pub trait Flow {
    /// Number of coordinates, and of velocities.
    fn coordinates(&self) -> usize;

    /// Length of a state.
    fn dimension(&self) -> usize;

    /// Whether accelerations depend on velocities.
    fn velocity_dependent(&self) -> bool;

    /// The rates of `state` at `time` seconds; both have [`Flow::dimension`] numbers.
    fn rates(&mut self, time: f64, state: &[f64], rates: &mut [f64]);

    /// How many numbers at the end of a state are accounts of what makes the velocities change, on which no rate depends: they
    /// are advanced as velocities are, so that both agree to rounding.
    fn accounts(&self) -> usize {
        0
    }

    /// Places of the velocities in a state.
    fn velocities(&self) -> Range<usize> {
        self.coordinates()..2 * self.coordinates()
    }
}
