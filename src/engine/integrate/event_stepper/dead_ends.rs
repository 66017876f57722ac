//! Steps that cannot go on as they are: contacts exclude each other, or steps have become too short.

use super::super::control::{Control, MOST_STEPS};
use super::EventStepper;
use crate::tick::Tick;

/// Steps between two looks at how far they lead.
const STEPS_BETWEEN_LOOKS: u64 = 4096;

impl EventStepper {
    /// Contacts and limits exclude each other from `now` seconds on. The rest of the tick follows their springs.
    pub(super) fn exclude(&mut self, tick: &mut Tick, now: f64) {
        tick.located().excluded += 1;
        self.overload.begin(tick, now);
    }

    /// Whether steps have become so short that the end of the tick, at `end` seconds, is out of reach.
    pub(super) fn leads_nowhere(&mut self, now: f64, end: f64) -> bool {
        self.steps += 1;
        if !self.steps.is_multiple_of(STEPS_BETWEEN_LOOKS) {
            return false;
        }
        let way = now - std::mem::replace(&mut self.looked, now);
        let most = self.control.as_ref().map_or(MOST_STEPS, Control::most_steps);
        STEPS_BETWEEN_LOOKS as f64 * (end - now) > most * way
    }
}
