//! The interface of an integration method to the tick.

use super::snapshot::{Memory, UnfitSnapshot};
use super::{EvaluationMode, State, Tick};

/// A method that advances the state by one tick.
pub trait Integrator: Send + Sync + 'static {
    /// Advances the state by `tick.dt`.
    fn advance(&mut self, tick: &mut Tick);

    /// The style in which it evaluates models with a history.
    fn mode(&self) -> EvaluationMode {
        EvaluationMode::Following
    }

    /// Whether each tick is one step of velocity Verlet. Then a body moves along a parabola while only its weight acts
    /// on it.
    fn flies(&self) -> bool {
        false
    }

    /// Its memory from tick to tick. Default: unknown, and snapshots refuse.
    fn save(&self) -> Memory {
        Memory::Untold
    }

    /// Remembers what [`Integrator::save`] gave. Called only if that gave bytes.
    ///
    /// # Errors
    /// If the bytes are not its own.
    fn load(&mut self, _: &[u8]) -> Result<(), UnfitSnapshot> {
        Ok(())
    }

    /// Whether its memory fits the state of a snapshot, after both were loaded: see
    /// [`Model::fits`](super::Model::fits).
    ///
    /// # Errors
    /// If it does not, with the name of the part.
    fn fits(&self, _: &State) -> Result<(), UnfitSnapshot> {
        Ok(())
    }
}

/// The integrator of a run.
pub struct Method(pub Box<dyn Integrator>);
