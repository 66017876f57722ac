//! When so many contacts touch under a law with a dashpot that rest is not looked for at each tick.
//!
//! The search ([`crate::constraints::rest_solver`]) costs some twenty times what the contacts themselves do. Under a law whose normal force has one
//! value at rest all that it can find is whether the whole of a heap may be laid to rest: as long as one grain moves, forces
//! change everywhere, and springs hold friction without it. So among thousands of contacts it is made now and then. After a
//! search that laid nothing to rest the time to the next doubles. Under `Inelasticity` it is made at each tick, whatever
//! it costs: there the search alone knows the force of a contact that neither loads nor unloads.

use serde::{Deserialize, Serialize};
/// Contacts up to which rest is looked for at each tick; those of bodies at rest do not count.
pub const MANY: usize = 1024;
/// Ticks to the next search, at first and at most.
const SHORTEST: u64 = 256;
const LONGEST: u64 = 4096;
/// Searches in successive ticks while islands come to a stop: each brings their velocities down by a factor.
const TRIES: u32 = 8;

/// Contacts of an island beyond which it is large.
const LARGE: usize = MANY / 2;
/// Ticks from one thorough search in large islands to the next.
const EVERY: u64 = 64;

/// Whether the search in an island of so many contacts, all of which could stop, is made with conjugate gradients in this tick.
///
/// Those cost many times what the sweeps do, and find rest only where what still moves is so slow that no bound is in the way.
/// In a heap that swings they stop all contacts at once with whatever forces the bounds allow, which the next tick
/// cannot keep: pyramids of hundreds of boxes did not come to rest for that and crept. Sweeps alone take its motion away, and
/// rest is found some 64 ticks later at the most where they would take longer.
pub(super) fn is_thorough(contacts: usize, ticks: u64) -> bool {
    contacts <= LARGE || ticks.is_multiple_of(EVERY)
}

/// When rest is looked for.
#[derive(Debug, Default, Serialize, Deserialize)]
pub(super) struct Patience {
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
pub(super) fn remark(patience: &Patience, ticks: u64) -> Option<String> {
    let waited = patience.waited;
    (waited > 0).then(|| {
        format!(
            "contacts: in {waited} of {ticks} ticks more than {MANY} contacts were not at rest: no body was laid to rest there, and \
             friction was held by its springs alone; in those between rest was looked for"
        )
    })
}

/// What a search found.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Found {
    /// Something was laid to rest.
    pub rest: bool,
    /// All contacts of some large island stop.
    pub stops: bool,
}

impl Patience {
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
