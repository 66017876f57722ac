//! What a joint holds: one law per file.

use std::sync::Arc;

use super::ends::{Along, Pair};

/// A direction that is held, and how far it is from where it should be.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Held {
    /// The direction.
    pub along: Along,
    /// How far, in m or rad.
    pub gap: f64,
    /// The size of the numbers from which that was found.
    pub size: f64,
}

/// What is free in a joint: the angle of a hinge, the travel of a slide.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Freedom {
    /// Along which it moves.
    pub along: Along,
    /// Where it is, in rad or m.
    pub value: f64,
}

/// What a joint holds of its two ends, and what it leaves free.
pub trait Law: Send + Sync + 'static {
    /// The same law, with what it does not say taken from the ends at the start.
    fn begun(&self, pair: &Pair) -> Arc<dyn Law>;

    /// Adds what it holds: always as many, in the same order.
    fn hold(&self, pair: &Pair, held: &mut dyn FnMut(Held));

    /// Whether it cannot hold anchors that are in one place. Default: it can.
    fn needs_distance(&self) -> bool {
        false
    }

    /// Limits of what it leaves free, of the law itself, in rad or m. Default: none.
    fn limits(&self) -> Option<[f64; 2]> {
        None
    }

    /// What it leaves free, if that is one motion. Default: it is not.
    fn freedom(&self, _: &Pair) -> Option<Freedom> {
        None
    }

    /// How the channel of what it leaves free is called, and its unit. Default: `angle`, in rad.
    fn freedom_name(&self) -> (&'static str, &'static str) {
        ("angle", "rad")
    }
}
