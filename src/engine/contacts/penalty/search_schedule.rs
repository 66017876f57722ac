//! Exponential back-off of the search for rest ([`crate::constraints::rest_solver`]).
//!
//! The search costs several times as much as the contacts themselves. Some laws have a single normal force at rest. Under these
//! the search only finds whether a whole heap may be laid to rest. While one grain moves, forces change everywhere, and springs
//! hold friction without the search. So among thousands of contacts it runs now and then. After a search that laid nothing to
//! rest the time to the next one doubles. Under `Inelasticity` the search runs at each tick. It alone finds the force of a
//! contact that neither loads nor unloads.

use serde::{Deserialize, Serialize};
/// Up to this number of contacts the search runs at each tick. Contacts of bodies at rest do not count.
pub const MANY: usize = 1024;
/// Ticks to the next search, at first and at most.
const SHORTEST: u64 = 256;
const LONGEST: u64 = 4096;
/// Searches in successive ticks while islands come to a stop: each brings their velocities down by a factor.
const TRIES: u32 = 8;

/// Ticks without conjugate gradients in large islands, after as many tries in a row as [`TRIES`] laid nothing to rest.
const PAUSE: u64 = 64;

/// The schedule of the search for rest.
#[derive(Debug, Default, Serialize, Deserialize)]
pub(super) struct SearchSchedule {
    /// The tick from which conjugate gradients are tried again in large islands.
    thorough_from: u64,
    /// Ticks in a row in which they were tried.
    thorough_tries: u32,
    /// The tick of the next search.
    until: u64,
    /// Ticks to the one after.
    wait: u64,
    /// Searches in a row.
    tries: u32,
    /// Ticks without a search so far.
    pub waited: u64,
}

/// For the card: in how many ticks rest was not looked for.
pub(super) fn remark(schedule: &SearchSchedule, ticks: u64) -> Option<String> {
    let waited = schedule.waited;
    (waited > 0).then(|| {
        format!(
            "contacts: in {waited} of {ticks} ticks more than {MANY} contacts were not at rest. The engine did not look for \
             rest in these ticks, and springs alone held friction. It looked for rest in the others"
        )
    })
}

/// The result of a search.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Found {
    /// The search laid a body to rest.
    pub rest: bool,
    /// All contacts of some large island stop.
    pub stops: bool,
    /// Conjugate gradients were tried in a large island that does not rest.
    pub tried: bool,
}

impl SearchSchedule {
    /// Whether rest is looked for in a tick with so many contacts of bodies that are not at rest.
    pub fn searches(&mut self, contacts: usize, ticks: u64) -> bool {
        if contacts <= MANY {
            self.wait = 0;
            return true;
        }
        if self.wait == 0 {
            (self.wait, self.until) = (SHORTEST, ticks + SHORTEST);
        }
        let waits = ticks < self.until;
        self.waited += u64::from(waits);
        !waits
    }

    /// Whether large islands try conjugate gradients. These do harm if bounds are in the way. They then stop all contacts at
    /// once, with forces that the next tick cannot keep.
    pub fn tries_thoroughly(&self, ticks: u64) -> bool {
        ticks >= self.thorough_from
    }

    /// After a search among contacts of which each could stop.
    pub fn note_tries(&mut self, found: Found, ticks: u64) {
        self.thorough_tries = if found.tried { self.thorough_tries + 1 } else { 0 };
        if self.thorough_tries == TRIES {
            (self.thorough_from, self.thorough_tries) = (ticks + PAUSE, 0);
        }
    }

    /// After a search among many contacts.
    pub fn note(&mut self, found: Found, contacts: usize, ticks: u64) {
        if contacts <= MANY {
            return;
        }
        self.tries += 1;
        if found.stops && self.tries < TRIES {
            return;
        }
        self.wait = if found.rest { SHORTEST } else { (2 * self.wait).min(LONGEST) };
        (self.until, self.tries) = (ticks + self.wait, 0);
    }
}
