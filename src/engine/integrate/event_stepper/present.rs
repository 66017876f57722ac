//! The present state of a run. A step takes it from the world at its beginning. At its end it carries the state on, with compensated
//! sums (Kahan 1965).

use super::EventStepper;
use crate::tick::WorldFlow;

impl EventStepper {
    /// Adds the change of a step to the state, with compensation.
    pub(super) fn accept(&mut self) {
        for ((state, rest), change) in self.state.iter_mut().zip(&mut self.rest).zip(&self.work.change) {
            let step = change + *rest;
            let after = *state + step;
            *rest = step - (after - *state);
            *state = after;
        }
    }

    /// Takes the current state. The rounding remainder is kept if the state is the one that was left.
    pub(super) fn take_up(&mut self, flow: &mut WorldFlow) {
        let before = std::mem::take(&mut self.state);
        flow.read(&mut self.state);
        self.rest.resize(self.state.len(), 0.0);
        let same = |index: usize| before.get(index) == Some(&self.state[index]);
        let accounts = flow.indices_of_accounts();
        for index in 0..self.state.len() {
            if !same(index) || accounts.contains(&index) {
                self.rest[index] = 0.0;
            }
        }
    }
}
