//! The reports of contact laws on the current state. They are the deepest overlap, and on request the touching pairs
//! with points and forces.

use bevy_ecs::prelude::*;
use glam::DVec2;

use crate::world::Bodies;
use serde::{Deserialize, Serialize};

/// An overlap: how deep, whose and when.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Overlap {
    /// In metres.
    pub overlap: f64,
    /// The same as a share of the smaller of the two radii.
    pub share: f64,
    /// The two bodies or the body and the wall.
    pub between: Option<(Entity, Entity)>,
    /// The time in seconds.
    pub time: f64,
}

/// The deepest overlaps so far. If bodies have different sizes, a small one may be pressed in by more of its radius. A
/// large one may be pressed in by more metres.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct DeepestOverlap {
    /// The deepest in metres.
    pub in_meters: Overlap,
    /// The deepest as a share of the smaller radius.
    pub in_share: Overlap,
}

impl DeepestOverlap {
    /// Takes note of an overlap.
    #[inline]
    pub fn note(&mut self, overlap: f64, smaller_radius: f64, time: f64, between: impl FnOnce() -> (Entity, Entity)) {
        if overlap > self.in_meters.overlap || overlap > self.in_share.share * smaller_radius {
            self.merge(&Self::of(Overlap { overlap, share: overlap / smaller_radius, between: Some(between()), time }));
        }
    }

    /// One overlap alone.
    pub fn of(overlap: Overlap) -> Self {
        Self { in_meters: overlap, in_share: overlap }
    }

    /// Takes over deeper overlaps.
    pub fn merge(&mut self, other: &Self) {
        if other.in_meters.overlap > self.in_meters.overlap {
            self.in_meters = other.in_meters;
        }
        if other.in_share.share > self.in_share.share {
            self.in_share = other.in_share;
        }
    }
}

/// The force that a wall or body receives through contacts. Contact laws fill it in if a sensor asks for it.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct ContactForces {
    /// Force on each body in newtons, in canonical order.
    pub on_body: Vec<DVec2>,
    /// Force on each wall in newtons, in canonical order.
    pub on_wall: Vec<DVec2>,
    /// The forces of contacts that are not evaluated because their bodies sleep: on bodies, and on walls. Sums begin
    /// with them.
    pub asleep: Option<(Vec<DVec2>, Vec<DVec2>)>,
}

impl ContactForces {
    /// Begins a new sum for each body and wall.
    pub fn clear(&mut self, bodies: &Bodies) {
        if let Some((on_body, on_wall)) = self.asleep.as_ref().filter(|_| !bodies.asleep.is_empty()) {
            self.on_body.clone_from(on_body);
            self.on_wall.clone_from(on_wall);
            return;
        }
        self.on_body.clear();
        self.on_body.resize(bodies.len(), DVec2::ZERO);
        self.on_wall.clear();
        self.on_wall.resize(bodies.walls.len(), DVec2::ZERO);
    }
}

/// The touching pairs of the current state. Contact laws fill them in at each evaluation, if the resource exists.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct Touches {
    /// Indices of bodies; if the flag is set, the second is that of a wall. After the tick they are sorted and without
    /// duplicates.
    pub(crate) pairs: Vec<(bool, u32, u32)>,
    /// Those that began to touch at located events since the last tick, once for each time.
    pub(crate) begun: Vec<(bool, u32, u32)>,
    /// Whether a law has ever begun a list.
    pub(crate) told: bool,
}

impl Touches {
    /// Begins a new list.
    pub fn clear(&mut self) {
        self.pairs.clear();
        self.told = true;
    }

    /// Two bodies touch, given by their places.
    pub fn bodies(&mut self, a: usize, b: usize) {
        self.pairs.push((false, a.min(b) as u32, a.max(b) as u32));
    }

    /// A body touches a wall, given by their places.
    pub fn wall(&mut self, body: usize, wall: u32) {
        self.pairs.push((true, body as u32, wall));
    }

    /// The pairs that touch at the start begin to touch, also those that part before the first tick ends.
    pub(crate) fn begin_all(&mut self) {
        if self.begun.is_empty() {
            self.begun.clone_from(&self.pairs);
            self.begun.sort_unstable();
            self.begun.dedup();
        }
    }

    /// Two bodies began to touch at an event inside a tick, given by their places.
    pub fn bodies_begin(&mut self, a: usize, b: usize) {
        self.begun.push((false, a.min(b) as u32, a.max(b) as u32));
    }

    /// A body and a wall did, given by their places.
    pub fn wall_begins(&mut self, body: usize, wall: u32) {
        self.begun.push((true, body as u32, wall));
    }
}

/// Whom a body touches, by its place in canonical order.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Other {
    /// Another body, which precedes it.
    Body(usize),
    /// A wall.
    Wall(usize),
}

/// One atom that touches another body's atom or a wall.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactPoint {
    /// The body that receives the force, by its place in canonical order.
    pub body: usize,
    /// Whom it touches; the opposite force acts there.
    pub other: Other,
    /// The point of action of the force, in metres.
    pub point: DVec2,
    /// The force on `body` in newtons.
    pub force: DVec2,
    /// The unit vector along which contacts press `body`; friction is across it.
    pub normal: DVec2,
}
