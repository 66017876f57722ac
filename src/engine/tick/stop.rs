//! The end of a run inside a tick, on request. A tick may take many steps, and a user does not wait for its end.

use super::failure::{FailureKind, Trouble};
use super::progress::AllowedWork;
use super::work::PER_MULTIPLICATION;
use super::{State, Tick, work_of_an_evaluation};
use crate::world::finite;

impl State {
    /// From now on `goes_on` is asked at each step inside a tick, with the time in s of that step. Once it answers `false`, the
    /// run ends there with [`FailureKind::Stopped`], and cannot be continued. From tick to tick it is asked between batches.
    pub fn ask_inside_ticks(&mut self, goes_on: fn(f64) -> bool) {
        self.progress.goes_on = Some(goes_on);
    }

    /// The question whether the run goes on, if a user may end it.
    pub(crate) fn asks(&self) -> Option<fn(f64) -> bool> {
        self.progress.goes_on
    }

    /// From now on the run may take so much work more, in the unit of [`work_of_an_evaluation`]. Then it ends at the next step inside a
    /// tick, with [`FailureKind::Stopped`], and cannot be continued. From tick to tick it does not end.
    pub fn end_after(&mut self, work: f64) {
        let counted = (self.evaluation.count, self.rows().multiplications());
        self.progress.allowed = Some(AllowedWork { most: work, done: 0.0, counted });
        self.rows_mut().give_up_after(counted.1 + work / PER_MULTIPLICATION);
    }

    /// Whether the run has taken more work than it may. Each evaluation since the last call counts as one of the present state. Dense
    /// equations of rows are counted as they are solved: an evaluation may solve them once or a hundred times.
    fn has_spent(&mut self) -> bool {
        let Some(AllowedWork { most, done, counted }) = self.progress.allowed else { return false };
        let (count, multiplications) = (self.evaluation.count, self.rows().multiplications());
        let evaluations = count.saturating_sub(counted.0) as f64 * work_of_an_evaluation(self);
        let done = done + evaluations + PER_MULTIPLICATION * (multiplications - counted.1).max(0.0);
        self.progress.allowed = Some(AllowedWork { most, done, counted: (count, multiplications) });
        done > most
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
    /// Whether the run is to end at `time` seconds, inside this tick. A trial from there on is then given up.
    pub fn is_asked_to_end(&mut self, time: f64) -> bool {
        self.state.has_spent() || self.state.progress.goes_on.is_some_and(|goes_on| !goes_on(time))
    }

    /// The same of the present state. Then it is noted as ended, or as failed if the present state
    /// is not finite.
    pub fn is_stopped(&mut self, time: f64) -> bool {
        let stopped = self.is_asked_to_end(time);
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
