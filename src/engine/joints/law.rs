//! The laws of joints, one per file: the directions that a joint holds.

use std::sync::Arc;

use super::ends::{Along, EndPair};

/// A direction that is held, and its deviation from the required value.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Held {
    /// The direction.
    pub along: Along,
    /// The distance, in m or rad.
    pub gap: f64,
    /// The size of the numbers from which that was found.
    pub size: f64,
}

/// The free motion of a joint: the angle of a hinge, the travel of a slide.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Freedom {
    /// Along which it moves.
    pub along: Along,
    /// Its value, in rad or m.
    pub value: f64,
}

/// The held directions and the freedom of a joint with two ends.
pub trait JointLaw: Send + Sync + 'static {
    /// The same law, with its absent parameters taken from the ends at the start.
    fn begun(&self, pair: &EndPair) -> Arc<dyn JointLaw>;

    /// Adds the held directions. Their number and order never change.
    fn hold(&self, pair: &EndPair, held: &mut dyn FnMut(Held));

    /// Whether it cannot hold anchors that are in one place. Default: it can.
    fn needs_distance(&self) -> bool {
        false
    }

    /// Limits of the free motion that belong to the law itself, in rad or m. Default: none.
    fn limits(&self) -> Option<[f64; 2]> {
        None
    }

    /// The free motion, if there is exactly one. Default: there is not.
    fn freedom(&self, _: &EndPair) -> Option<Freedom> {
        None
    }

    /// The name and unit of the channel of the free motion. Default: `angle`, in rad.
    fn freedom_name(&self) -> (&'static str, &'static str) {
        ("angle", "rad")
    }
}
