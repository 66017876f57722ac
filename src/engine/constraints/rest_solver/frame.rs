//! The frame in which an island that is carried looks for rest: that of what carries it.
//!
//! Whether a contact stands is a matter of relative velocities. Taken as differences of large ones they would carry the
//! rounding of those, and forces over a short tick would be corrected for it without end; seen from a belt or a platform
//! a body that rides on it stands as it would on the floor.

use glam::DVec2;

use super::Mover;

/// Motion of the frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// A point of it, in metres.
    pub origin: DVec2,
    /// Velocity of that point in m/s.
    pub velocity: DVec2,
    /// Spin in rad/s.
    pub spin: f64,
}

impl Frame {
    fn at(&self, position: DVec2) -> DVec2 {
        self.velocity + (position - self.origin).perp() * self.spin
    }

    /// Sees a mover at `position` from the frame.
    pub fn enter(&self, mover: &mut Mover, position: DVec2) {
        mover.velocity -= self.at(position);
        mover.spin -= self.spin;
    }

    /// Sees it from the world again.
    pub fn leave(&self, mover: &mut Mover, position: DVec2) {
        mover.velocity += self.at(position);
        mover.spin += self.spin;
    }
}
