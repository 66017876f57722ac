//! Time: the clock of ticks, and the moment at which forces are evaluated.

use bevy_ecs::prelude::*;

/// The clock of a run.
#[derive(Resource, Clone, Copy, Debug, PartialEq)]
pub struct Clock {
    /// Length of a tick in seconds.
    pub dt: f64,
    /// Ticks done.
    pub ticks: u64,
}

impl Default for Clock {
    /// A millisecond per tick, at the beginning.
    fn default() -> Self {
        Self { dt: 1e-3, ticks: 0 }
    }
}

impl Clock {
    /// Time in seconds.
    pub fn time(&self) -> f64 {
        self.time_of(self.ticks)
    }

    /// Time of a tick's beginning in seconds: a product, so that rounding does not add up.
    pub fn time_of(&self, tick: u64) -> f64 {
        tick as f64 * self.dt
    }
}

/// The moment at which forces are being evaluated. Force systems read it.
#[derive(Resource, Clone, Copy, Debug, Default, PartialEq)]
pub struct Evaluation {
    /// Time of the state in seconds.
    pub time: f64,
    /// Seconds since the state that was last accepted: how far `Bodies::drift` reaches back.
    pub elapsed: f64,
}
