//! The pose of a hull, and its bounding box.
//!
//! A pose maps a point p of the hull's frame to x + R p, with R = [cos, -sin; sin, cos]. Cosine and sine are computed
//! from the angle each time, so that R stays a rotation. Lengths are in metres, angles in radians.

use glam::DVec2;

use crate::hull::Hull;

/// Position and orientation of a hull's frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// The position of the origin of the hull's frame, in metres.
    pub position: DVec2,
    /// Cosine and sine of the angle, counter-clockwise.
    pub rotation: DVec2,
}

impl Default for Pose {
    fn default() -> Self {
        Self { position: DVec2::ZERO, rotation: DVec2::X }
    }
}

impl Pose {
    /// The pose at a position in metres, turned by an angle in radians.
    pub fn new(position: DVec2, angle: f64) -> Self {
        let (sin, cos) = libm::sincos(angle);
        Self { position, rotation: DVec2::new(cos, sin) }
    }

    /// A direction of the hull's frame, seen from the world.
    #[inline]
    pub fn direction_to_world(&self, direction: DVec2) -> DVec2 {
        self.rotation.rotate(direction)
    }

    /// A direction of the world, seen from the hull's frame.
    #[inline]
    pub fn direction_to_local(&self, direction: DVec2) -> DVec2 {
        DVec2::new(self.rotation.dot(direction), self.rotation.perp_dot(direction))
    }

    /// A place of the hull's frame, seen from the world, in metres.
    #[inline]
    pub fn point_to_world(&self, point: DVec2) -> DVec2 {
        self.position + self.direction_to_world(point)
    }

    /// A place of the world, seen from the hull's frame, in metres.
    #[inline]
    pub fn point_to_local(&self, point: DVec2) -> DVec2 {
        self.direction_to_local(point - self.position)
    }
}

/// A box with sides along x and y, in metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoundingBox {
    /// Least x and least y.
    pub low: DVec2,
    /// Greatest x and greatest y.
    pub high: DVec2,
}

impl BoundingBox {
    /// The least box that holds a hull with its radius, under a pose.
    pub fn of(hull: &Hull, pose: &Pose) -> Self {
        let empty = Self { low: DVec2::INFINITY, high: DVec2::NEG_INFINITY };
        let core = hull.corners().iter().fold(empty, |bounds, corner| {
            let place = pose.point_to_world(*corner);
            Self { low: bounds.low.min(place), high: bounds.high.max(place) }
        });
        core.grown(hull.radius())
    }

    /// The box with so many metres more on each side.
    #[must_use]
    pub fn grown(&self, by: f64) -> Self {
        Self { low: self.low - by, high: self.high + by }
    }

    /// The least box that holds both.
    #[must_use]
    pub fn with(&self, other: &Self) -> Self {
        Self { low: self.low.min(other.low), high: self.high.max(other.high) }
    }

    /// Whether two boxes have a point in common, inside or on their edges.
    pub fn touches(&self, other: &Self) -> bool {
        self.low.cmple(other.high).all() && other.low.cmple(self.high).all()
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #![proptest_config(crate::cases(2, 256))]

        /// Law: the way to the world and back is the identity. Tolerance: two rotations round numbers near 10 twice each.
        #[test]
        fn world_and_back_is_the_identity(x in -9.0..9.0, y in -9.0..9.0, angle in -7.0..7.0, px in -1.0..1.0, py in -1.0..1.0) {
            let (pose, point) = (Pose::new(DVec2::new(x, y), angle), DVec2::new(px, py));
            prop_assert!((pose.point_to_local(pose.point_to_world(point)) - point).length() < 64.0 * f64::EPSILON);
            prop_assert!((pose.direction_to_world(pose.direction_to_local(point)) - point).length() < 8.0 * f64::EPSILON);
        }
    }

    #[test]
    fn a_quarter_turn_takes_x_to_y() {
        let pose = Pose { position: DVec2::new(5.0, 0.0), rotation: DVec2::Y };
        assert_eq!(pose.point_to_world(DVec2::X), DVec2::new(5.0, 1.0));
        assert_eq!(pose.point_to_local(DVec2::new(5.0, 1.0)), DVec2::X);
    }

    #[test]
    fn bounds_hold_the_radius_and_follow_the_pose() {
        let hull = Hull::capsule(DVec2::ZERO, DVec2::new(2.0, 0.0), 0.5).unwrap();
        let flat = BoundingBox::of(&hull, &Pose::default());
        assert_eq!(flat, BoundingBox { low: DVec2::new(-0.5, -0.5), high: DVec2::new(2.5, 0.5) });
        let upright = BoundingBox::of(&hull, &Pose { position: DVec2::X, rotation: DVec2::Y });
        assert_eq!(upright, BoundingBox { low: DVec2::new(0.5, -0.5), high: DVec2::new(1.5, 2.5) });
        assert!(
            flat.touches(&upright)
                && !flat.touches(&BoundingBox::of(&hull.moved(DVec2::new(3.1, 0.0)), &Pose::default()))
        );
        assert_eq!(flat.with(&upright).high, DVec2::splat(2.5));
    }
}
