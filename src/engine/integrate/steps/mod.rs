//! One-step maps of ordinary differential equations, one method per file, each with its order of accuracy.
//!
//! They are independent of bodies. A [`Flow`] gives the rates of a state. A [`OneStep`] gives the change of a state
//! from one time to another. The same map makes a step and any part of it, which serves to locate events.

mod convergence;
mod divided;
mod dop853;
mod elimination;
mod explicit_euler;
mod fixed_point;
mod implicit_midpoint;
#[cfg(test)]
mod problems;
#[cfg(test)]
mod rooted_trees;
mod runge_kutta4;
mod semi_implicit_euler;
mod splitting;
mod symplectic4;
#[cfg(test)]
mod trials;
mod velocity_verlet;

use crate::tick::snapshot::{Memory, UnfitSnapshot};

pub use crate::tick::Flow;

pub use divided::Divided;
pub use dop853::Dop853;
pub use explicit_euler::ExplicitEuler;
pub use implicit_midpoint::ImplicitMidpoint;
pub use runge_kutta4::RungeKutta4;
pub use semi_implicit_euler::SemiImplicitEulerStep;
pub use symplectic4::Symplectic4;
pub use velocity_verlet::VelocityVerletStep;

/// The beginning of a step.
#[derive(Clone, Copy, Debug)]
pub struct Start<'a> {
    /// Time in seconds.
    pub time: f64,
    /// The state.
    pub state: &'a [f64],
    /// Its rates.
    pub rates: &'a [f64],
}

/// A method that makes steps. It may keep working memory, nothing else: a step is a function of its start and length.
pub trait OneStep: Send + Sync {
    /// The change of the state over `length` seconds, to be added to it.
    fn step(&mut self, flow: &mut dyn Flow, start: Start, length: f64, change: &mut [f64]);

    /// After a step: its estimated error divided by the allowed one. The allowed error of each number of the state is
    /// `scale`; numbers with an infinite scale are ignored. A result of at most 1 is good. `None`: the method has no
    /// estimate.
    fn error(&self, scale: &[f64]) -> Option<f64> {
        let _ = scale;
        None
    }

    /// The order of the estimate of the error: it falls with this power of the length.
    fn order_of_error(&self) -> u32 {
        0
    }

    /// After a step: prepares the evaluation of states inside it. A method that estimates its error can do it, perhaps
    /// with further rates.
    fn make_dense(&mut self, flow: &mut dyn Flow, start: Start, length: f64) {
        let _ = (flow, start, length);
    }

    /// After [`OneStep::make_dense`]: the change of the state over the `share` (0 to 1) of the step.
    fn dense(&self, share: f64, change: &mut [f64]) {
        let _ = (share, change);
    }

    /// The memory of the last step for [`OneStep::dense`]. Default: nothing.
    fn save(&self) -> Memory {
        Memory::Nothing
    }

    /// Remembers what [`OneStep::save`] gave. Called only if that gave bytes.
    ///
    /// # Errors
    /// If the bytes are not its own.
    fn load(&mut self, bytes: &[u8]) -> Result<(), UnfitSnapshot> {
        let _ = bytes;
        Ok(())
    }
}
