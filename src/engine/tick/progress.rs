//! The progress of a run: its results so far, and its failure.

use bevy_ecs::change_detection::Tick;
use bevy_ecs::prelude::*;

use super::Method;
use super::batch::Running;
use super::failure::{FailureKind, Trouble};
use super::guard::EnergyGuard;
use super::ledger::Totals;
use super::travel::FarTravel;
use serde::{Deserialize, Serialize};

/// The progress of a run.
#[derive(Default, Serialize, Deserialize)]
pub(super) struct Progress {
    #[serde(skip)]
    pub method: Option<Method>,
    /// Counts changes of method and models.
    #[serde(skip)]
    pub version: u64,
    /// The schedule of the tick, as long as the world is not open to others.
    #[serde(skip)]
    pub sim: Option<Box<Schedule>>,
    /// Whether systems read components after each batch.
    #[serde(skip)]
    pub shown: bool,
    /// Components hold the state of an earlier tick.
    #[serde(skip)]
    pub behind: bool,
    /// The running parts of a batch, kept as long as the schedule of the tick.
    #[serde(skip)]
    pub running: Option<Box<Running>>,
    /// The totals before others changed the state, if they did since the last tick.
    pub before: Option<Totals>,
    /// No system but the engine's own takes part in the tick.
    #[serde(skip)]
    pub alone: bool,
    /// Systems in the tick look at all bodies.
    #[serde(skip)]
    pub looked_at: bool,
    /// Systems read forces at the end of each tick, also inside a step.
    #[serde(skip)]
    pub forces_read: bool,
    /// Ticks at whose ends systems look at all bodies that look at no others, in order.
    pub looks: Vec<u64>,
    /// When the state had changed last as these saw it.
    #[serde(skip)]
    pub shown_at: Option<Tick>,
    /// When components were last brought up to date.
    #[serde(skip)]
    pub published_at: Option<Tick>,
    /// Forces are those of the present state.
    pub current: bool,
    /// Greatest travel of any point of a body in one tick, in metres.
    pub travel: f64,
    /// Sum of all travels in the last tick. It is NaN or infinite as soon as one of them is.
    pub travelled: f64,
    /// Greatest travel in the last tick, in metres.
    pub farthest: f64,
    /// The first body that travelled farther than the smallest radius in one tick.
    pub far: Option<FarTravel>,
    pub energy: EnergyGuard,
    #[serde(skip)]
    pub trouble: Option<Trouble>,
    /// Asked at each step inside a tick, with its time in s, whether the run goes on.
    #[serde(skip)]
    pub goes_on: Option<fn(f64) -> bool>,
    /// Inside a tick the run ends after so much work.
    #[serde(skip)]
    pub allowed: Option<AllowedWork>,
    /// The number of indicators of each model with events at the last call, in order.
    pub told: Vec<usize>,
}

/// The work that a run may take, in the unit of [`work_of_an_evaluation`](super::work_of_an_evaluation).
#[derive(Clone, Copy, Debug)]
pub(crate) struct AllowedWork {
    pub most: f64,
    pub done: f64,
    /// Evaluations whose work is done, and multiplications of dense equations.
    pub counted: (u64, f64),
}

impl Progress {
    /// Whether the lists of bodies did not fit each other.
    pub fn is_torn(&self) -> bool {
        self.trouble.is_some_and(|trouble| matches!(trouble.wrong, FailureKind::Torn(_)))
    }
}

/// How many events were located, and how many ticks had too many.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct LocatedEvents {
    /// Events.
    pub count: u64,
    /// Ticks that continued under velocity Verlet, because contacts were too many or excluded each other.
    pub given_up: u64,
    /// Moments at which contacts or limits excluded each other: no choice of modes lets all of them push.
    pub excluded: u64,
}

/// How many steps were made, and how long they were.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct StepCount {
    /// Steps accepted.
    pub accepted: u64,
    /// Steps whose error was too large.
    pub rejected: u64,
    /// The longest accepted one, in s.
    pub longest: f64,
    /// Accepted steps that were allowed a larger error than was asked for: rounding of places leaves no smaller one.
    pub bounded: u64,
    /// The sum of the errors of velocities in m/s that accepted steps were allowed.
    pub allowed: f64,
    /// The same of bounded steps.
    pub allowed_to_bounded: f64,
    /// Steps that were made shorter than asked for, so that they resolve contacts.
    pub shortened: u64,
    /// The tick from which on each is one step, not counted yet.
    pub whole_from: Option<u64>,
}

impl StepCount {
    /// Steps accepted until that tick.
    pub fn until(&self, tick: u64) -> u64 {
        self.accepted + self.whole_from.map_or(0, |from| tick - from)
    }

    /// Whether steps that rounding bounds make more than half of the error, and more than a tenth of all steps. A finer run repeats
    /// that half, and does not show it. Few steps do not count. The first
    /// step of a run comes before any body has moved far. The last one may be a remainder of rounding.
    pub fn is_bounded(&self) -> bool {
        let many = self.bounded > 1 && 10 * self.bounded > self.accepted;
        many && 2.0 * self.allowed_to_bounded > self.allowed
    }
}
