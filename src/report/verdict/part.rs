//! Parts of a run that a verdict trusts or doubts one by one.

use std::fmt;

use super::at;

/// A part of what a run tells.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Part {
    /// The numbers are those of the scene, but the scene is not what it is meant to be, as its springs give way so far.
    Model,
    /// What is gained and lost, and what lies still.
    Energy,
    /// What happens within contacts.
    Impacts,
    /// Whether each contact was seen at all.
    Meetings,
    /// Places.
    Places,
    /// Places after a time in s, as finer runs go elsewhere.
    PlacesAfter(f64),
    /// Places after a time in s, of which nothing is known.
    UnknownAfter(f64),
    /// Places of which nothing is known.
    UnknownPlaces,
    /// Places that finer runs give otherwise by a hundredth of the motion or more.
    FinePlaces,
    /// The digits that a tolerance asked for.
    LastDigits,
}

impl Part {
    /// Until when places can be trusted, in s, if not to the end.
    pub fn places_until(&self) -> Option<f64> {
        match self {
            Self::PlacesAfter(time) | Self::UnknownAfter(time) => Some(*time),
            _ => None,
        }
    }

    /// Whether nothing speaks against it: it is only not known.
    pub fn is_unknown(&self) -> bool {
        matches!(self, Self::UnknownAfter(_) | Self::UnknownPlaces)
    }

    /// Whether a doubt of this part makes a doubt of the other idle.
    pub fn covers(&self, other: &Self) -> bool {
        let of_places = |part: &Self| {
            matches!(part, Self::Places | Self::UnknownPlaces | Self::FinePlaces) || part.places_until().is_some()
        };
        self == other || of_places(self) && of_places(other)
    }
}

impl fmt::Display for Part {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Model => f.write_str("the model at contacts"),
            Self::Energy => f.write_str("energy and rest"),
            Self::Impacts => f.write_str("impacts"),
            Self::Meetings => f.write_str("that all contacts were seen"),
            Self::Places | Self::UnknownPlaces => f.write_str("places"),
            Self::PlacesAfter(time) => write!(f, "places after about {}", at(*time)),
            Self::UnknownAfter(time) => write!(f, "places after {}", at(*time)),
            Self::FinePlaces => f.write_str("places to more than that"),
            Self::LastDigits => f.write_str("its last digits"),
        }
    }
}
