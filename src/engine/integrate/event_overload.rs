//! Event overload: if events are too many to be located one by one, stretches of ticks run under velocity Verlet.
//!
//! Each located event ends the step of all bodies. So hundreds of events in a tick cost thousands of evaluations and
//! gain nothing. Among so many jumps no method shows its order. Dozens of held contacts depend on each other too, and
//! rigid statics alone does not determine their loads. So an overloaded tick continues from its current state under
//! velocity Verlet, with contacts that follow from state to state. The ticks behind it do the same, and then events are
//! tried again. Each failed try doubles the stretch until the next, so that trying costs little.

use super::VelocityVerlet;
use crate::tick::Integrator;
use crate::tick::Tick;
use serde::{Deserialize, Serialize};

/// Events that may be located in one tick after quiet ones.
const MOST_EVENTS: u32 = 64;
/// Events that may be located in each tick forever. Unused ones are saved for later ticks, up to `MOST_EVENTS`.
const LASTING_EVENTS: u32 = 4;
/// Indicators that change their sign in one trial step; with more the tick is crowded.
const MOST_AT_ONCE: usize = 64;
/// Ticks in a stretch, at first and at most.
const SHORTEST: u32 = 16;
const LONGEST: u32 = 1024;
/// A tick is divided if the product of angular frequency and step exceeds this. It is a quarter of the method's limit.
/// The energy of a spring then swings by `(1/4)^2`.
const FINE: f64 = 0.5;

/// Whether a run is in such a stretch, and how long it lasts.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) struct EventOverload {
    following: bool,
    /// Ticks left of the stretch.
    left: u32,
    /// Ticks of the next.
    next: u32,
    /// Ticks since the last.
    calm: u32,
    /// Events that may still be located, in parts of one.
    credit: u32,
    /// The factor on the number of events that a frame may have.
    patience: u32,
    /// The ticks of a frame, and the parts of an event that are counted. So all divisions of a frame admit the same.
    ticks: u32,
}

impl EventOverload {
    /// Whether another one, from a file, admits as many events.
    pub fn is_as_patient_as(&self, saved: &Self) -> bool {
        (self.patience, self.ticks) == (saved.patience, saved.ticks)
            && saved.left <= LONGEST
            && saved.next <= LONGEST
            && saved.next > 0
    }

    /// An overload control that admits `times` as many events in a frame of so many ticks as in other ticks.
    pub fn shared(times: u32, ticks: u32) -> Self {
        let fresh = Self {
            following: false,
            left: 0,
            next: SHORTEST,
            calm: 0,
            credit: 0,
            patience: times,
            ticks: ticks.max(1),
        };
        Self { credit: fresh.most(), ..fresh }
    }

    /// The parts of so many events.
    fn parts(&self, events: u32) -> u32 {
        events.saturating_mul(self.ticks)
    }

    /// The parts of the events that may be located after quiet ticks.
    fn most(&self) -> u32 {
        self.patience.saturating_mul(MOST_EVENTS).saturating_mul(self.ticks)
    }

    /// Whether the tick to come is one of a stretch.
    pub fn lasts(&self) -> bool {
        self.left > 0
    }

    /// Whether the state is one of a stretch.
    pub fn follows(&self) -> bool {
        self.following
    }

    /// Whether a model reports too many held contacts, or this number of events in the tick is too large.
    pub fn comes(&self, tick: &mut Tick, events: u32) -> bool {
        self.parts(events) >= self.credit || tick.is_overloaded()
    }

    /// Whether so many indicators may vanish in a step.
    pub fn bears(&self, vanishing: usize) -> bool {
        vanishing <= MOST_AT_ONCE
    }

    /// A tick ended without an overload.
    pub fn stays_away(&mut self, events: u32) {
        let left = self.credit.saturating_sub(self.parts(events));
        self.credit = left.saturating_add(self.patience * LASTING_EVENTS).min(self.most());
        self.calm = self.calm.saturating_add(1);
        if self.calm >= self.next {
            self.next = SHORTEST;
        }
    }

    /// Begins a stretch at `now` seconds, inside a tick.
    pub fn begin(&mut self, tick: &mut Tick, now: f64) {
        (self.following, self.left, self.calm) = (true, self.next, 0);
        self.next = (2 * self.next).min(LONGEST);
        tick.begin_following(now);
    }

    /// Whether events may be tried again in the next tick. A stretch continues while there are too many contacts.
    pub fn ends(&mut self, tick: &mut Tick) -> bool {
        if tick.is_overloaded() {
            self.left = self.next;
        }
        self.left == 0
    }

    /// Events are located again.
    pub fn end(&mut self) {
        self.following = false;
        self.credit = self.most() / 4;
    }

    /// Advances from `from` to the end of the tick.
    pub fn advance(&mut self, tick: &mut Tick, from: f64) {
        self.left = self.left.saturating_sub(1);
        let (until, length) = (tick.end, tick.end - from);
        let fastest = tick.state().time_scales().fastest.map_or(0.0, |fastest| fastest.angular_frequency);
        // A stretch that begins at the end of a tick has nothing to do in it.
        let parts = if length > 0.0 { (length * fastest / FINE).ceil().max(1.0) } else { 0.0 };
        let mut begin = from;
        let mut part = 0.0;
        while part < parts && !tick.is_stopped(begin) {
            part += 1.0;
            let end = if part == parts { until } else { from + length * (part / parts) };
            tick.part(begin, end, |tick| {
                tick.choose_modes(begin, end);
                VelocityVerlet.advance(tick);
            });
            if part < parts {
                tick.look(end);
            }
            begin = end;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Events that are located in so many frames of so many ticks. Each tick has as many as it may.
    fn located(frames: u32, ticks: u32) -> u32 {
        let mut overload = EventOverload::shared(16, ticks);
        let mut sum = 0;
        for _ in 0..frames * ticks {
            let events = overload.credit / ticks;
            overload.stays_away(events);
            sum += events;
        }
        sum
    }

    #[test]
    fn frames_locate_as_many_events_however_their_ticks_divide_them() {
        let whole = located(10, 1);
        assert!([2, 7, 16, 40].into_iter().all(|ticks| located(10, ticks).abs_diff(whole) <= 64), "{whole}");
    }
}
