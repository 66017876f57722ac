//! Bodies that do not touch each other, because a joint holds them together.

use bevy_ecs::prelude::*;
use glam::DVec2;

/// Pairs of bodies that do not touch each other, by their keys.
#[derive(Resource, Clone, Debug, Default)]
pub struct Apart(Vec<(u64, u64)>);

impl Apart {
    /// Adds a pair.
    pub fn insert(&mut self, a: u64, b: u64) {
        let pair = (a.min(b), a.max(b));
        if let Err(place) = self.0.binary_search(&pair) {
            self.0.insert(place, pair);
        }
    }

    /// All pairs, the lower key first, in order.
    pub fn pairs(&self) -> &[(u64, u64)] {
        &self.0
    }
}

/// Where the point is from which a body's anchors are counted, in the frame of the body from its centre of mass, in metres. Bodies
/// without it count from the centre of mass.
#[derive(Component, Clone, Copy, Debug, Default, PartialEq)]
pub struct Origin(pub DVec2);
