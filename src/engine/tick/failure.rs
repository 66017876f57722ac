//! A run that went wrong.

use super::Clock;
use super::guard::Created;
use crate::scene::number;

/// A run that went wrong.
#[derive(Clone, Debug, PartialEq)]
pub struct Failure {
    /// Name of the first body that went wrong, or of the one that has most of the energy.
    pub body: String,
    /// What is wrong.
    pub wrong: Wrong,
    /// The tick that made it.
    pub tick: u64,
    /// Its time in seconds.
    pub time: f64,
}

/// What went wrong, before it is told: of the body at a place in canonical order, if it is one's.
#[derive(Clone, Copy, Debug)]
pub(super) struct Trouble {
    pub body: Option<usize>,
    pub wrong: Wrong,
    pub tick: u64,
    pub time: f64,
}

impl Trouble {
    /// At the end of the last tick.
    pub fn at(clock: &Clock, body: Option<usize>, wrong: Wrong) -> Self {
        Self { body, wrong, tick: clock.ticks, time: clock.time() }
    }
}

/// What can go wrong.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Wrong {
    /// This quantity is no longer a finite number.
    NotFinite(&'static str),
    /// Energy came out of nowhere.
    Energy(Created),
    /// Steps of so many seconds, as short as their error asks for, would not come to an end.
    Steps(f64),
    /// A joint could not be closed: so many metres are left.
    Joint {
        /// The largest gap.
        meters: f64,
    },
}

impl std::fmt::Display for Failure {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        let Self { body, wrong, tick, time } = self;
        match wrong {
            Wrong::NotFinite(quantity) => write!(f, "the {quantity} of `{body}` is no longer a finite number")?,
            Wrong::Steps(step) => {
                let short =
                    if *step > 0.0 { format!("as short as {step:.1e} s") } else { "too short to pass time".to_owned() };
                write!(f, "steps have become {short}, for the acceleration of `{body}` grows beyond all bounds,")?;
            }
            Wrong::Joint { meters } => {
                let gap = number(*meters);
                write!(
                    f,
                    "a joint of `{body}` cannot be closed, {gap} m are left: its bodies turn too far in a step,"
                )?;
            }
            Wrong::Energy(Created { energy, put_in }) => {
                write!(
                    f,
                    "energy came out of nowhere, {energy:.1e} J where {put_in:.1e} J were put in, most of it in `{body}`,"
                )?;
            }
        }
        write!(f, " at t = {} s (tick {tick})", number(*time))
    }
}

impl std::error::Error for Failure {}
