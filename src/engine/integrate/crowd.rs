//! Where events are too many to be located one by one: stretches of ticks under velocity Verlet.
//!
//! Each located event ends the step of all bodies, so hundreds of events in a tick cost thousands of evaluations and gain
//! nothing: among as many jumps no method shows its order. Contacts that are held by the dozen depend on each other, too, and
//! rigid statics alone does not say which of them bears what. So a tick that turns out too crowded goes on, from where it is,
//! as if it were under velocity Verlet with contacts that follow from state to state, and so do ticks behind it; then events
//! are tried again. Each try that ends in a crowd doubles the stretch until the next, so that trying costs little.

use super::VelocityVerlet;
use crate::tick::Integrator;
use crate::tick::Tick;
use serde::{Deserialize, Serialize};

/// Events that may be located in one tick after quiet ones.
const MOST_EVENTS: u32 = 64;
/// Events that may be located in each tick for ever; whatever a tick leaves of them, up to `MOST_EVENTS`, is for those behind.
const LASTING_EVENTS: u32 = 4;
/// Indicators that change their sign in one trial step; with more the tick is crowded.
const MOST_AT_ONCE: usize = 64;
/// Ticks in a stretch, at first and at most.
const SHORTEST: u32 = 16;
const LONGEST: u32 = 1024;
/// Product of angular frequency and step above which a tick is divided: a quarter of what the method bears, where the energy
/// of a spring swings by `(1/4)^2`, six per cent.
const FINE: f64 = 0.5;

/// Whether a run is in such a stretch, and how long it lasts.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) struct Crowd {
    following: bool,
    /// Ticks left of the stretch.
    left: u32,
    /// Ticks of the next.
    next: u32,
    /// Ticks since the last.
    calm: u32,
    /// Events that may still be located.
    credit: u32,
    /// How many times as many events a tick may have.
    patience: u32,
}

impl Crowd {
    /// One that lets `times` as many events be located in a tick.
    pub fn patient(times: u32) -> Self {
        Self { following: false, left: 0, next: SHORTEST, calm: 0, credit: times * MOST_EVENTS, patience: times }
    }

    /// Whether the tick to come is one of a stretch.
    pub fn lasts(&self) -> bool {
        self.left > 0
    }

    /// Whether the state is one of a stretch.
    pub fn follows(&self) -> bool {
        self.following
    }

    /// Whether a model says that what it holds is too much, or this many events of the tick are.
    pub fn comes(&self, tick: &mut Tick, events: u32) -> bool {
        events >= self.credit || tick.is_crowded()
    }

    /// Whether so many indicators may vanish in a step.
    pub fn bears(&self, vanishing: usize) -> bool {
        vanishing <= MOST_AT_ONCE
    }

    /// A tick went by without a crowd.
    pub fn stays_away(&mut self, events: u32) {
        self.credit =
            (self.credit.saturating_sub(events) + self.patience * LASTING_EVENTS).min(self.patience * MOST_EVENTS);
        self.calm = self.calm.saturating_add(1);
        if self.calm >= self.next {
            self.next = SHORTEST;
        }
    }

    /// A stretch begins at `now` seconds, inside a tick.
    pub fn begin(&mut self, tick: &mut Tick, now: f64) {
        (self.following, self.left, self.calm) = (true, self.next, 0);
        self.next = (2 * self.next).min(LONGEST);
        tick.begin_following(now);
    }

    /// Whether events may be tried again in the tick to come. A stretch whose contacts are too many as they are goes on.
    pub fn ends(&mut self, tick: &mut Tick) -> bool {
        if tick.is_crowded() {
            self.left = self.next;
        }
        self.left == 0
    }

    /// Events are located again.
    pub fn end(&mut self) {
        self.following = false;
        self.credit = self.patience * MOST_EVENTS / 4;
    }

    /// Advances from `from` to the end of the tick.
    pub fn advance(&mut self, tick: &mut Tick, from: f64) {
        self.left = self.left.saturating_sub(1);
        let (until, length) = (tick.end, tick.end - from);
        let fastest = tick.state().responses().fastest.map_or(0.0, |fastest| fastest.angular_frequency);
        let parts = (length * fastest / FINE).ceil().max(1.0);
        let mut begin = from;
        let mut part = 0.0;
        while part < parts {
            part += 1.0;
            let end = if part == parts { until } else { from + length * (part / parts) };
            tick.part(begin, end, |tick| {
                tick.choose_modes(begin, end);
                VelocityVerlet.advance(tick);
            });
            begin = end;
        }
    }
}
