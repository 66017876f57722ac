//! Anchors: points of bodies that a scene names, in the frame of the body.
//!
//! One rule holds for all of them. An anchor counts from the datum of its body. The datum is the centre of mass, or with
//! `datum: Origin` the point from which the places of atoms count. An anchor that is left out is the centre of mass.

use bevy_ecs::prelude::*;
use glam::DVec2;

use super::{Bodies, Origin};

/// The anchors that a scene gives, in the order of its models.
#[derive(Resource, Clone, Debug, Default)]
pub struct Anchors(pub Vec<Anchor>);

/// One anchor.
#[derive(Clone, Debug, PartialEq)]
pub struct Anchor {
    /// Its path in the scene, such as `joints[0].anchor_a`.
    pub path: String,
    /// Its body.
    pub body: Entity,
    /// From the centre of mass in the frame of the body, in metres.
    pub at: DVec2,
}

impl Anchor {
    /// The index of its body, and where in the world the anchor is, in metres. `None`: the body is gone.
    pub fn index(&self, bodies: &Bodies) -> Option<(usize, DVec2)> {
        let body = bodies.index(self.body)?;
        let (sin, cos) = libm::sincos(bodies.angle[body]);
        Some((body, bodies.position[body] + DVec2::new(cos, sin).rotate(self.at)))
    }
}

/// The vector in metres from a body's centre of mass to its datum, in the frame of the body.
pub fn datum(world: &World, body: Entity) -> DVec2 {
    world.get::<Origin>(body).map_or(DVec2::ZERO, |origin| origin.0)
}

/// Converts an anchor from the datum of a body to its centre of mass. The anchor is noted among those of the scene.
pub fn from_center(world: &mut World, body: Entity, path: String, given: DVec2) -> DVec2 {
    let at = given + datum(world, body);
    world.get_resource_or_init::<Anchors>().0.push(Anchor { path, body, at });
    at
}
