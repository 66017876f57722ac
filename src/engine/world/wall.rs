//! A wall: the half-plane behind a line, infinitely stiff, one-sided.

use bevy_ecs::prelude::*;
use glam::DVec2;

use super::body::mark_changed;
use super::material::MaterialIndex;

/// A half-plane through two points. Seen from the open side `left` is on the left.
#[derive(Component, Clone, Copy, Debug, PartialEq)]
#[component(immutable, on_insert = mark_changed, on_remove = mark_changed)]
pub struct Wall {
    /// Place in the canonical order of walls.
    pub key: u64,
    /// The left point in metres.
    pub left: DVec2,
    /// The right point in metres.
    pub right: DVec2,
    /// What it is made of.
    pub material: MaterialIndex,
    /// Velocity of its surface in m/s, along the wall: a belt. Zero: it stands.
    pub surface_velocity: DVec2,
}

impl Wall {
    /// Unit normal towards the open side: the direction from left to right, turned a quarter turn clockwise.
    ///
    /// A floor with its left point at x = 6 and its right point at x = 0 opens upward.
    pub fn normal(&self) -> DVec2 {
        let along = self.right - self.left;
        DVec2::new(along.y, -along.x).normalize()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_open_side_is_where_left_is_left() {
        let material = MaterialIndex::default();
        let wall = |left, right| Wall { key: 0, left, right, material, surface_velocity: DVec2::ZERO };
        let normal = |l: (f64, f64), r: (f64, f64)| wall(DVec2::new(l.0, l.1), DVec2::new(r.0, r.1)).normal();
        assert_eq!(normal((6.0, 0.0), (0.0, 0.0)), DVec2::Y);
        assert_eq!(normal((0.0, 6.0), (1.0, 6.0)), DVec2::NEG_Y);
        assert_eq!(normal((0.0, 0.0), (0.0, 1.0)), DVec2::X);
        assert_eq!(normal((6.0, 1.0), (6.0, 0.0)), DVec2::NEG_X);
    }
}
