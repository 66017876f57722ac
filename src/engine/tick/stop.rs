//! The end of a run inside a tick, on request. A tick may take many steps, and a user does not wait for its end.

use super::failure::{FailureKind, Trouble};
use super::{State, Tick};
use crate::world::finite;

impl State {
    /// From now on `goes_on` is asked at each step inside a tick, with the time in s of that step. Once it answers `false`, the
    /// run ends there with [`FailureKind::Stopped`], and cannot be continued. Without it, and from tick to tick, nothing is asked.
    pub fn ask_inside_ticks(&mut self, goes_on: fn(f64) -> bool) {
        self.progress.goes_on = Some(goes_on);
    }

    /// From now on the run ends inside a tick, with [`FailureKind::Stopped`], at the first step behind so many evaluations in all. It
    /// cannot be continued. From tick to tick nothing is counted.
    pub fn end_after(&mut self, evaluations: u64) {
        self.progress.most_evaluations = Some(evaluations);
    }

    /// The time in s that the run has reached. It is that of the last tick, or the moment inside one at which the run was ended.
    pub fn reached(&self) -> f64 {
        self.stopped_at().unwrap_or(self.time())
    }

    /// The time in s at which the run was ended inside a tick, if it was.
    pub fn stopped_at(&self) -> Option<f64> {
        let trouble = self.progress.trouble.filter(|trouble| matches!(trouble.wrong, FailureKind::Stopped))?;
        Some(trouble.time)
    }
}

impl Tick<'_> {
    /// Whether the run is to end at `time` seconds, inside this tick. Then it is noted as ended, or as failed if the present state
    /// is not finite.
    pub fn is_stopped(&mut self, time: f64) -> bool {
        let progress = &self.state.progress;
        let spent = progress.most_evaluations.is_some_and(|most| self.state.evaluation.count > most);
        let stopped = spent || progress.goes_on.is_some_and(|goes_on| !goes_on(time));
        if stopped {
            let state = &mut *self.state;
            state.bodies.catch_up();
            state.land();
            // No tick that ends looks at this state.
            let (body, wrong) = match finite::first_not_finite(&state.bodies) {
                Some((body, quantity)) => (Some(body), FailureKind::NotFinite(quantity)),
                None => (None, FailureKind::Stopped),
            };
            let trouble = Trouble { body, entity: None, wrong, tick: state.clock.ticks + 1, time };
            state.progress.trouble.get_or_insert(trouble);
        }
        stopped
    }
}
