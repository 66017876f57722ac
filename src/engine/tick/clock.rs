//! Time: the clock of ticks, and the moment at which forces are evaluated.

use serde::{Deserialize, Serialize};
/// The clock of a run.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Clock {
    /// Length of a tick in seconds.
    pub dt: f64,
    /// Ticks done.
    pub ticks: u64,
    /// Inside a tick, while sensors look there: the time in seconds.
    #[serde(skip)]
    pub(crate) now: Option<f64>,
}

impl Default for Clock {
    /// A millisecond per tick, at the beginning.
    fn default() -> Self {
        Self { dt: 1e-3, ticks: 0, now: None }
    }
}

impl Clock {
    /// Time in seconds.
    pub fn time(&self) -> f64 {
        self.now.unwrap_or_else(|| self.time_of(self.ticks))
    }

    /// The ticks that have ended or begun, so the number of the tick to which the present state belongs.
    pub fn ticks_begun(&self) -> u64 {
        self.ticks + u64::from(self.now.is_some())
    }

    /// Time of a tick's beginning in seconds: a product, so that rounding does not add up.
    pub fn time_of(&self, tick: u64) -> f64 {
        tick as f64 * self.dt
    }
}

/// The moment at which forces are being evaluated. Force systems read it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Evaluation {
    /// Time of the state in seconds.
    pub time: f64,
    /// Seconds since the state that was last accepted: how far `Bodies::drift` reaches back.
    pub elapsed: f64,
    /// The style in which methods evaluate contacts and other models with a history.
    pub mode: EvaluationMode,
    /// The number of times that forces were evaluated so far: the cost of a method.
    // It depends on how a run is cut into batches, and decides nothing.
    #[serde(skip)]
    pub count: u64,
    /// Bodies have moved on since, or a force was switched: forces are those of an earlier state.
    pub stale: bool,
    /// Whether joints hold something else than in this evaluation: the state is evaluated again before the next step.
    pub other_rows: bool,
    /// Whether only the joints' part of a kick is wanted. It omits the accelerations by which joints turn velocities as
    /// bodies move on.
    #[serde(skip)]
    pub(crate) kick: bool,
    /// While events of a step switch modes: the error of velocities in m/s that the step was allowed. 0 if the method estimates none.
    #[serde(skip)]
    pub(crate) velocity_error: f64,
    /// The state that was evaluated last is evaluated once more, with those awake that were left out.
    pub(crate) again: bool,
}

/// How models with a history are evaluated.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum EvaluationMode {
    /// The state follows the one before: history continues, and candidate lists are renewed when necessary.
    #[default]
    Following,
    /// The state is an arbitrary state of a step. Forces are a smooth function of it, and modes and candidate lists
    /// stay fixed.
    Frozen,
    /// As `Frozen`, but modes follow from the state itself, so that forces jump with the modes.
    Instant,
}

impl EvaluationMode {
    /// Whether the state is a stage of a step, from which no history may be made.
    pub fn is_staged(self) -> bool {
        self != Self::Following
    }
}

/// The stretch of time for which modes are being chosen. The systems of [`Modes`](super::Modes) read it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Span {
    /// Its beginning in seconds.
    pub begin: f64,
    /// Its end in seconds.
    pub end: f64,
    /// Its length in seconds. For a whole tick it equals that of the tick to the last bit.
    pub length: f64,
}

impl Span {
    /// Its middle in seconds.
    pub fn middle(&self) -> f64 {
        self.begin + 0.5 * (self.end - self.begin)
    }
}
