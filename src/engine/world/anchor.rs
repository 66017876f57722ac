//! Anchors: points of bodies that a scene names, in the frame of the body.
//!
//! One rule holds for all of them. An anchor counts from the datum of its body. The datum is the centre of mass, or with
//! `datum: Origin` the point from which the places of atoms count. An anchor that is left out is the centre of mass.

use bevy_ecs::prelude::*;
use glam::DVec2;

use super::{Bodies, Origin};

/// The anchors of a scene, in the order of its models.
#[derive(Resource, Clone, Debug, Default)]
pub struct Anchors(pub Vec<Anchor>);

/// The number of roundings, each of half the last digit, in the place of an anchor.
const ROUNDINGS: f64 = 4.0;

/// One anchor.
#[derive(Clone, Debug, PartialEq)]
pub struct Anchor {
    /// Its path in the scene, such as `joints[0].anchor_a`.
    pub path: String,
    /// Its body; `None`: the world.
    pub body: Option<Entity>,
    /// From the centre of mass in the frame of the body, or in the world, in metres.
    pub at: DVec2,
    /// Whether the scene gives it. Otherwise it follows from a default.
    pub given: bool,
}

impl Anchor {
    /// Its place in the world, in metres. `None`: the body is gone.
    pub fn position(&self, bodies: &Bodies) -> Option<DVec2> {
        let Some(body) = self.body else { return Some(self.at) };
        let body = bodies.index(body)?;
        let (sin, cos) = libm::sincos(bodies.angle[body]);
        Some(bodies.position[body] + DVec2::new(cos, sin).rotate(self.at))
    }

    /// The size in metres that a coordinate of that place may have by rounding alone. Sine, cosine, products
    /// and sums round numbers as large as the place of the body and the anchor.
    pub fn rounding(&self, bodies: &Bodies) -> f64 {
        let body = self.body.and_then(|body| bodies.index(body));
        let center = body.map_or(DVec2::ZERO, |body| bodies.position[body]);
        ROUNDINGS * f64::EPSILON * (center.abs().max_element() + self.at.length())
    }
}

/// The vector in metres from a body's centre of mass to its datum, in the frame of the body.
pub fn datum(world: &World, body: Entity) -> DVec2 {
    world.get::<Origin>(body).map_or(DVec2::ZERO, |origin| origin.0)
}

/// Converts an anchor from the datum of a body to its centre of mass. The anchor is noted among those of the scene.
pub fn from_center(world: &mut World, body: Entity, path: String, given: DVec2) -> DVec2 {
    let at = given + datum(world, body);
    world.get_resource_or_init::<Anchors>().0.push(Anchor { path, body: Some(body), at, given: true });
    at
}

/// Notes an anchor that follows from a default: from the centre of mass of a body, or in the world.
pub fn note_default(world: &mut World, body: Option<Entity>, path: String, at: DVec2) {
    world.get_resource_or_init::<Anchors>().0.push(Anchor { path, body, at, given: false });
}
