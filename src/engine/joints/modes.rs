//! The modes of joints as events: limits reached and left, friction that sticks and slips, joints that break.

use super::joint_model::Joint;
use crate::tick::{Events, Indicator, State};

impl Events for Joint {
    fn tell(&mut self, state: &State, told: &mut Vec<Indicator>) {
        if let Some(pair) = self.pair(state.bodies()) {
            self.parts.tell(&*self.law, &pair, self.reaction.0.length(), state, told);
        }
    }

    fn switch(&mut self, state: &mut State, fired: &[usize]) {
        // From the last one on: each may change how many there are.
        fired.iter().rev().for_each(|index| self.parts.switch(*index, state.evaluation().time));
        self.see_whether_broken();
    }

    fn look_again(&mut self) -> bool {
        self.parts.look_again()
    }

    fn settle(&mut self, state: &State) -> bool {
        let Some(pair) = self.pair(state.bodies()) else { return false };
        let changed = self.parts.settle(&*self.law, &pair, self.reaction.0.length(), state);
        self.see_whether_broken();
        changed
    }
}
