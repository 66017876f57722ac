//! Parts of a run that a verdict trusts or doubts one by one.

use std::fmt;

use super::at;

/// A part of the results of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum VerdictPart {
    /// The numbers belong to the scene, but its springs give way too far for the model to mean hard bodies.
    Model,
    /// Gains and losses of energy, and which bodies are at rest.
    Energy,
    /// Motion within contacts.
    Impacts,
    /// Whether each contact was seen at all.
    Meetings,
    /// Places.
    Places,
    /// Places after a time in s, from which on finer runs go elsewhere.
    PlacesAfter(f64),
    /// Places after a time in s whose error is not known.
    UnknownAfter(f64),
    /// Places whose error is not known.
    UnknownPlaces,
    /// Places that differ from those of finer runs by a hundredth of the motion or more.
    FinePlaces,
    /// The digits that a tolerance asked for.
    LastDigits,
}

impl VerdictPart {
    /// The time in s until which places can be trusted, if not to the end.
    pub fn places_until(&self) -> Option<f64> {
        match self {
            Self::PlacesAfter(time) | Self::UnknownAfter(time) => Some(*time),
            _ => None,
        }
    }

    /// Whether the part is doubted only because its error is not known.
    pub fn is_unknown(&self) -> bool {
        matches!(self, Self::UnknownAfter(_) | Self::UnknownPlaces)
    }

    /// Whether a doubt of this part makes a doubt of the other one superfluous.
    pub fn covers(&self, other: &Self) -> bool {
        let of_places = |part: &Self| {
            matches!(part, Self::Places | Self::UnknownPlaces | Self::FinePlaces) || part.places_until().is_some()
        };
        self == other || of_places(self) && of_places(other)
    }
}

impl fmt::Display for VerdictPart {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Model => f.write_str("the model at contacts"),
            Self::Energy => f.write_str("energy and rest"),
            Self::Impacts => f.write_str("impacts"),
            Self::Meetings => f.write_str("that the run saw all contacts"),
            Self::Places | Self::UnknownPlaces => f.write_str("places"),
            Self::PlacesAfter(time) => write!(f, "places after about {}", at(*time)),
            Self::UnknownAfter(time) => write!(f, "places after {}", at(*time)),
            Self::FinePlaces => f.write_str("places to more digits"),
            Self::LastDigits => f.write_str("its last digits"),
        }
    }
}
