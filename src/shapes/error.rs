//! The reasons why a shape cannot be made, and the corrections in one that can.

use std::fmt;

use glam::DVec2;

/// A correction of the points in a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mended {
    /// The points ran clockwise, and were reversed.
    Turned,
    /// The point of this index lay exactly on the line through its neighbours, and was left out.
    Straight {
        /// Index of the point as given.
        point: usize,
    },
    /// The shape is concave and was cut into so many convex parts.
    Cut {
        /// Number of convex parts.
        parts: usize,
    },
}

impl fmt::Display for Mended {
    fn fmt(&self, text: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Turned => write!(text, "the points ran clockwise, and the engine reversed their order"),
            Self::Straight { point } => {
                write!(text, "point {point} lies on the line through its neighbours, and the engine left it out")
            }
            Self::Cut { parts } => {
                write!(text, "the shape is concave, and the engine cut it into {parts} convex parts")
            }
        }
    }
}

/// Why a shape cannot be made. Indices count the points, or the sides that begin there, from zero.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ShapeError {
    /// A polygon has at least three points.
    TooFewPoints {
        /// Number of points given.
        found: usize,
    },
    /// Two points are at one place.
    EqualPoints {
        /// Index of one point.
        first: usize,
        /// Index of the other point.
        second: usize,
    },
    /// All points lie on one line.
    ZeroArea,
    /// Two sides cross or touch.
    SelfCrossing {
        /// Index of one side.
        first: usize,
        /// Index of the other side.
        second: usize,
        /// Their meeting point, in metres.
        at: DVec2,
    },
    /// The outline bends inwards at a point, although it has to be convex.
    NotConvex {
        /// Index of the point.
        point: usize,
    },
    /// A number is infinite or not a number.
    NotFinite {
        /// Name of the quantity.
        quantity: &'static str,
    },
    /// A number is too large or too small for its fourth power, which moments of area need.
    OutOfRange {
        /// Name of the quantity.
        quantity: &'static str,
        /// Its value in metres.
        found: f64,
    },
    /// A number that must be above zero is not.
    NotPositive {
        /// Name of the quantity.
        quantity: &'static str,
        /// Its value.
        found: f64,
    },
    /// A length that may be zero is below zero.
    Negative {
        /// Name of the quantity.
        quantity: &'static str,
        /// Its value in metres.
        found: f64,
    },
    /// The rounding is larger than the shape allows.
    RoundingTooLarge {
        /// The rounding asked for, in metres.
        found: f64,
        /// The greatest one possible, in metres.
        greatest: f64,
    },
    /// A regular polygon, gear or rack has too few sides or teeth.
    TooFew {
        /// Name of the quantity.
        quantity: &'static str,
        /// Number given.
        found: usize,
        /// Least number possible.
        least: usize,
    },
    /// A regular polygon, gear or rack has too many sides or teeth.
    TooMany {
        /// Name of the quantity.
        quantity: &'static str,
        /// Number given.
        found: usize,
        /// Greatest number possible.
        most: usize,
    },
    /// An angle lies outside its range.
    AngleOutOfRange {
        /// Name of the quantity.
        quantity: &'static str,
        /// The angle given, in radians.
        found: f64,
        /// The least angle, in radians, itself not possible.
        above: f64,
        /// The greatest angle, in radians, itself not possible.
        below: f64,
    },
    /// Both flanks of a tooth meet before its tip.
    PointedTooth {
        /// Width of the tooth at its tip circle or tip line, in metres; negative if the flanks have crossed.
        tip_width: f64,
    },
    /// Two teeth meet at their roots.
    ClosedGap {
        /// Width of the gap at the root circle, in metres, zero or below.
        root_width: f64,
    },
    /// A compound has no parts.
    Empty,
}

/// A number as messages show it: with an exponent if it had dozens of digits without.
struct Short(f64);

impl fmt::Display for Short {
    fn fmt(&self, text: &mut fmt::Formatter) -> fmt::Result {
        let plain = self.0 == 0.0 || (1e-4..1e9).contains(&self.0.abs());
        if plain { write!(text, "{}", self.0) } else { write!(text, "{:e}", self.0) }
    }
}

impl fmt::Display for ShapeError {
    fn fmt(&self, text: &mut fmt::Formatter) -> fmt::Result {
        match *self {
            Self::TooFewPoints { found } => write!(text, "a polygon has at least 3 points, found {found}"),
            Self::EqualPoints { first, second } => write!(text, "points {first} and {second} are at one place"),
            Self::ZeroArea => write!(text, "all points lie on one line: the area is zero"),
            Self::SelfCrossing { first, second, at } => {
                write!(text, "sides {first} and {second} meet at ({}, {})", Short(at.x), Short(at.y))
            }
            Self::NotConvex { point } => write!(text, "the outline bends inwards at point {point}"),
            Self::NotFinite { quantity } => write!(text, "{quantity} is NaN or infinite"),
            Self::OutOfRange { quantity, found } => {
                write!(text, "{quantity} is {} m: sizes lie between 1e-75 m and 1e75 m", Short(found))
            }
            Self::NotPositive { quantity, found } => {
                write!(text, "{quantity} must be above zero, found {}", Short(found))
            }
            Self::Negative { quantity, found } => {
                write!(text, "{quantity} must not be below zero, found {}", Short(found))
            }
            Self::RoundingTooLarge { found, greatest } => {
                write!(text, "a rounding of {} m is too large: at most {} m", Short(found), Short(greatest))
            }
            Self::TooFew { quantity, found, least } => write!(text, "{quantity}: at least {least}, found {found}"),
            Self::TooMany { quantity, found, most } => write!(text, "{quantity}: at most {most}, found {found}"),
            Self::AngleOutOfRange { quantity, found, above, below } => {
                let [found, above, below] = [found, above, below].map(f64::to_degrees);
                write!(text, "{quantity} must lie between {above} deg and {below} deg, found {} deg", Short(found))
            }
            Self::PointedTooth { tip_width } => {
                write!(text, "the teeth are pointed: {} m wide at their tips", Short(tip_width))
            }
            Self::ClosedGap { root_width } => {
                write!(text, "the teeth meet at their roots: gaps of {} m", Short(root_width))
            }
            Self::Empty => write!(text, "a compound has at least one part"),
        }
    }
}

impl std::error::Error for ShapeError {}
