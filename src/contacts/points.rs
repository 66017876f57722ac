//! Contact points: where bodies touch at the end of the last tick, and with what force. Found only when somebody asks.

use bevy_ecs::prelude::*;
use glam::DVec2;

/// Whom a body touches, by its place in canonical order.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Other {
    /// Another body, which stands before it.
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
    /// Where the force acts, in metres.
    pub point: DVec2,
    /// The force on `body` in newtons.
    pub force: DVec2,
}

/// How the present contact law tells its contacts: the law puts this into the world. A law that does not has none to
/// show.
#[derive(Resource, Clone, Copy)]
pub struct TellContacts(pub fn(&World) -> Vec<ContactPoint>);

/// All contacts in canonical order.
pub fn contact_points(world: &World) -> Vec<ContactPoint> {
    world.get_resource::<TellContacts>().map_or_else(Vec::new, |tell| (tell.0)(world))
}
