//! Contacts: who may touch whom ([`search`]), and what follows from it: one contact law per scene.

pub mod events;
mod law;
pub mod penalty;
pub mod points;
pub mod search;

use bevy_app::App;
use bevy_ecs::prelude::*;
use glam::DVec2;

use crate::scene::{Arity, Outline, SceneAppExt};
use crate::world::{Bodies, Body, Wall, atom};

pub use events::{ContactEvents, ContactEventsAppExt};
pub use law::{ContactLaw, Law, Touching, add_law};
pub use search::{AtomPair, CandidatePairs, FindPairs, WallPair};

/// The deepest overlap so far, as a share of the smaller radius.
#[derive(Resource, Clone, Copy, Debug, Default, PartialEq)]
pub struct DeepestOverlap {
    /// Overlap in metres.
    pub overlap: f64,
    /// The same as a share of the smaller of the two radii.
    pub share: f64,
    /// The two bodies or the body and the wall.
    pub between: Option<(Entity, Entity)>,
    /// When, in seconds.
    pub time: f64,
}

impl DeepestOverlap {
    /// Takes note of an overlap.
    #[inline]
    pub fn note(&mut self, overlap: f64, smaller_radius: f64, time: f64, between: impl FnOnce() -> (Entity, Entity)) {
        if overlap > self.share * smaller_radius {
            *self = Self { overlap, share: overlap / smaller_radius, between: Some(between()), time };
        }
    }
}

/// Force that a wall or body receives through contacts; contact laws fill it when a sensor asks for it.
#[derive(Resource, Clone, Debug, Default)]
pub struct ContactForces {
    /// Force on each body in newtons, in canonical order.
    pub on_body: Vec<DVec2>,
    /// Force on each wall in newtons, in canonical order.
    pub on_wall: Vec<DVec2>,
    /// What contacts give that are not evaluated because their bodies are asleep: on bodies, and on walls. Sums begin with it.
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

const MEANING: &str = "\
How things push each other that touch. Without this section `Penalty` with its defaults, if there is something to touch; with \
`contacts: None` everything passes through everything.";

/// Registers the contact laws of this folder.
pub fn plugin(app: &mut App) {
    app.register_entry_section("contacts", Arity::OneOrNone, "contacts: Penalty(tangential: Spring(ratio: 0.8))");
    app.describe_section("contacts", MEANING);
    penalty::plugin(app);
    app.reserve_entry("contacts", "Rigid");
}

/// A scene without the section gets penalty contacts with their defaults when there is something to touch.
pub fn install_default(outline: &Outline, app: &mut App) {
    if outline.has_section("contacts") {
        return;
    }
    let world = app.world_mut();
    let colliding = world.query::<&Body>().iter(world).filter(|body| body.collides).count();
    let walls = world.query::<&Wall>().iter(world).count();
    if atom::count_atoms(world) > 0 && (colliding > 1 || (colliding > 0 && walls > 0)) {
        penalty::install(penalty::Penalty::default(), app);
    }
}
