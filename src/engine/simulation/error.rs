//! How wrong a run is, in numbers: an estimate, or what is known of it from trials.

use std::fmt;

use bevy_ecs::prelude::*;
use serde::Serialize;

use jostle_language::numbers::{LEAST, number, rough};

/// An error and where it comes from; `null` until it is estimated.
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
    /// All parts that are known; nothing without that of the tick.
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
    /// Time in seconds until which the error is that: after it chaos has eaten all digits, or nothing was run again.
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
    /// The error; nothing, if no runs were compared.
    pub estimate: Option<ErrorEstimate>,
    /// Why it is not what was asked for.
    pub warning: Option<String>,
    /// The tolerance that was asked for; nothing, if it was the smallest error there is.
    pub tolerance: Option<f64>,
}
