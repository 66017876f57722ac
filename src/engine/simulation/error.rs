//! The error of a run in numbers: an estimate, or knowledge from trials.

use std::fmt;

use bevy_ecs::prelude::*;
use serde::Serialize;

use crate::tick::State;
use jostle_language::numbers::{LEAST, number, rough};

/// The remedy where runs locate too few of their events to tell an error.
pub(super) const COMPARE_TICKS: &str = "Write a tick, and compare with a tenth of it";

/// An error and its sources; `null` until it is estimated.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct ErrorParts {
    /// From the finite tick.
    pub discretisation: Option<f64>,
    /// From finite digits.
    pub rounding: Option<f64>,
    /// From the model.
    pub model: Option<f64>,
}

impl ErrorParts {
    /// The sum of all known parts; `None` without that of the tick.
    pub fn sum(&self) -> Option<f64> {
        Some(self.discretisation? + self.rounding.unwrap_or(0.0) + self.model.unwrap_or(0.0))
    }
}

/// The estimated error of a run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct ErrorEstimate {
    /// Of positions in metres.
    pub position: ErrorParts,
    /// Of velocities in m/s.
    pub velocity: ErrorParts,
    /// Order of accuracy that was seen.
    pub observed_order: Option<f64>,
    /// Time in seconds until which the error holds. Later chaos has destroyed all digits, or no second run was made.
    pub horizon: Option<f64>,
}

impl fmt::Display for ErrorEstimate {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let size = |part: f64| if part < LEAST { "0".to_owned() } else { rough(part) };
        let parts = |parts: ErrorParts, unit: &str| {
            let named = [(parts.discretisation, "tick"), (parts.rounding, "rounding"), (parts.model, "model")];
            let told = named.into_iter().filter_map(|(part, from)| Some(format!("+- {} ({from})", size(part?))));
            let told: Vec<String> = told.collect();
            if told.is_empty() { "unknown".to_owned() } else { format!("{} {unit}", told.join(" ")) }
        };
        write!(f, "places {}, velocities {}", parts(self.position, "m"), parts(self.velocity, "m/s"))?;
        if let Some(order) = self.observed_order {
            write!(f, ", order {order:.1}")?;
        }
        self.horizon.map_or(Ok(()), |horizon| write!(f, ", until t = {} s", number(horizon)))
    }
}

/// The error that a run is known to have.
#[derive(Resource, Clone, Debug, Default)]
pub struct KnownError {
    /// The error; `None` if no runs were compared.
    pub estimate: Option<ErrorEstimate>,
    /// The reason why it differs from the request.
    pub warning: Option<String>,
    /// The requested tolerance; `None` if the smallest possible error was requested.
    pub tolerance: Option<f64>,
}

impl KnownError {
    /// That of a run as far as it went. The trials that gave the error located all events. So they tell nothing of a run that gave
    /// up some.
    pub fn of(world: &World) -> Option<Self> {
        let mut known = world.get_resource::<Self>()?.clone();
        if world.resource::<State>().located().given_up > 0
            && known.warning.is_none()
            && let Some(estimate) = &mut known.estimate
        {
            (estimate.position.discretisation, estimate.velocity.discretisation) = (None, None);
            let missed = known.tolerance.map_or_else(String::new, |tolerance| {
                format!("the tolerance of {} is not reached: ", number(tolerance))
            });
            known.warning = Some(format!(
                "{missed}some ticks had too many events to locate them all. The compared runs located theirs, so the error of this one \
                 is not known. {COMPARE_TICKS}"
            ));
        }
        Some(known)
    }
}
