//! The moving frame of an island that a belt or platform carries.
//!
//! A contact stands if its relative velocity is zero. The difference of two large velocities carries their rounding, and the
//! solver would correct forces for that without end. Seen from the belt or platform a body that rides on it stands as on a floor.

use glam::DVec2;

use super::Mover;

/// Motion of the frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MovingFrame {
    /// A point of it, in metres.
    pub origin: DVec2,
    /// Velocity of that point in m/s.
    pub velocity: DVec2,
    /// Spin in rad/s.
    pub spin: f64,
}

impl MovingFrame {
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
