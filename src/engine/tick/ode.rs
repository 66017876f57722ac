//! Equations of motion, as methods see them.

use std::ops::Range;

/// A system of ordinary differential equations of motion, `q' = v`, `v' = a(t, q, v, z)`, `z' = r(t, q, v, z)`.
///
/// A state is one list of numbers. It holds coordinates `q`, as many velocities `v`, and the states of models (`z`).
/// These are elongations, states of controllers, and accounts of energy.
pub trait Flow {
    /// Number of coordinates, and of velocities.
    fn coordinates(&self) -> usize;

    /// Length of a state.
    fn dimension(&self) -> usize;

    /// Whether accelerations depend on velocities.
    fn velocity_dependent(&self) -> bool;

    /// The rates of `state` at `time` seconds; both have [`Flow::dimension`] numbers.
    fn rates(&mut self, time: f64, state: &[f64], rates: &mut [f64]);

    /// Whether joints, and nothing else, hold coordinates: kicks and drifts then stay on the constraints.
    fn is_held(&self) -> bool {
        false
    }

    /// The rates of a kick: those of `state`, without the accelerations by which joints turn velocities as coordinates move on. Those are
    /// part of drifts.
    fn kick_rates(&mut self, time: f64, state: &[f64], rates: &mut [f64]) {
        self.rates(time, state, rates);
    }

    /// A drift from `time` over `length` seconds, also negative ones. Coordinates move by velocities and are brought
    /// back onto joints along the directions in which these pushed. Velocities follow. It is the step of RATTLE without
    /// a force, which is symplectic and symmetric in time. Sources: Andersen 1983; Hairer, Lubich, Wanner, Geometric
    /// Numerical Integration, 2nd ed. 2006, section VII.1.4. The given `state` is that of the beginning, and `change`
    /// since the step began grows.
    fn drift(&mut self, time: f64, length: f64, state: &mut [f64], change: &mut [f64]) {
        let _ = time;
        let coordinates = self.coordinates();
        for index in 0..coordinates {
            let by = length * state[index + coordinates];
            change[index] += by;
            state[index] += by;
        }
    }

    /// The number of accounts at the end of a state. They book the causes of changes of velocity, and no rate depends
    /// on them. They are advanced like velocities, so that both agree to rounding.
    fn accounts(&self) -> usize {
        0
    }

    /// Places of the velocities in a state.
    fn velocities(&self) -> Range<usize> {
        self.coordinates()..2 * self.coordinates()
    }
}
