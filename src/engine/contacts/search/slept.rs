//! Bodies that slept all the time since a look, and so stand where they stood.

use jostle_simd::BLOCK;
use serde::{Deserialize, Serialize};

use crate::world::Bodies;

/// The bodies asleep at a look. Such a body sleeps on until [`Bodies::rousings`] counts: to move a body by hand wakes all.
#[derive(Debug, Default, Serialize, Deserialize)]
pub(super) struct Slept {
    generation: u64,
    rousings: u64,
    /// Whether some slept at all.
    some: bool,
    /// The blocks of bodies in which some did not.
    awake: Vec<u32>,
}

impl Slept {
    /// Whether the blocks are those of these bodies.
    pub fn fits(&self, bodies: &Bodies) -> bool {
        let blocks = bodies.len().div_ceil(BLOCK);
        self.awake.is_sorted_by(|a, b| a < b) && self.awake.iter().all(|block| (*block as usize) < blocks)
    }

    /// Notes the bodies that sleep now.
    pub fn note(&mut self, bodies: &Bodies) {
        (self.generation, self.rousings, self.some) = (bodies.generation, bodies.rousings, !bodies.asleep.is_empty());
        self.awake.clone_from(&bodies.awake);
    }

    /// Whether the bodies asleep at the look sleep on.
    pub fn on(&self, bodies: &Bodies) -> bool {
        self.some && (self.generation, self.rousings) == (bodies.generation, bodies.rousings)
    }

    /// Whether some of them woke.
    pub fn roused(&self, bodies: &Bodies) -> bool {
        self.some && !self.on(bodies)
    }

    /// Whether no body can have moved since the look.
    pub fn all_on(&self, bodies: &Bodies) -> bool {
        self.awake.is_empty() && self.on(bodies)
    }

    /// The bodies that may have moved since the look, in order.
    pub fn others(&self, bodies: &Bodies) -> impl Iterator<Item = usize> + use<'_> {
        let (on, count) = (self.on(bodies), bodies.len());
        let blocks = if on { &*self.awake } else { &[] };
        let block = move |&block: &u32| BLOCK * block as usize..count.min(BLOCK * block as usize + BLOCK);
        (!on).then_some(0..count).into_iter().chain(blocks.iter().map(block)).flatten()
    }
}

/// Whether a pair sleeps: neither body moves, and at least one of them is asleep. `None` is a wall.
pub(super) fn pair_sleeps((a, b): (Option<usize>, usize), bodies: &Bodies) -> bool {
    let stands = |body: usize| !bodies.moves[body] || bodies.is_asleep(body);
    let sleeps = bodies.is_asleep(b) || a.is_some_and(|a| bodies.is_asleep(a));
    sleeps && stands(b) && a.is_none_or(stands)
}
