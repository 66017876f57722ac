//! Bodies that do not touch each other: a joint holds them together, or one ignores the group of the other.

use bevy_ecs::prelude::*;
use glam::DVec2;

/// Pairs of bodies that do not touch each other, by their keys.
#[derive(Resource, Clone, Debug, Default)]
pub struct IgnoredPairs(Vec<(u64, u64)>);

impl IgnoredPairs {
    /// Adds a pair.
    pub fn insert(&mut self, a: u64, b: u64) {
        let pair = (a.min(b), a.max(b));
        if let Err(index) = self.0.binary_search(&pair) {
            self.0.insert(index, pair);
        }
    }

    /// Adds many pairs.
    pub fn extend(&mut self, pairs: impl IntoIterator<Item = (u64, u64)>) {
        self.0.extend(pairs.into_iter().map(|(a, b)| (a.min(b), a.max(b))));
        self.0.sort_unstable();
        self.0.dedup();
    }

    /// All pairs, the lower key first, in order.
    pub fn pairs(&self) -> &[(u64, u64)] {
        &self.0
    }
}

/// The origin of a body's anchors, in the frame of the body from its centre of mass, in metres. Bodies without it count
/// from the centre of mass.
#[derive(Component, Clone, Copy, Debug, Default, PartialEq)]
pub struct Origin(pub DVec2);
