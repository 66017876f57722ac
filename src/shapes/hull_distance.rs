//! The distance between two rounded hulls, by separating axes and nearest corners.
//!
//! Two convex cores overlap unless some line parts them. If such a line exists, one lies along a side of one core
//! (separating axis theorem). If the cores are apart, the distance is the least one from a corner of one to the other
//! core. If they overlap, the least depth under a side is the shortest way out. The surfaces are nearer by both radii.
//! Work grows with the product of the numbers of corners. Lengths are in metres.

use glam::DVec2;

use crate::hull::Hull;
use crate::nearest::nearest;
use crate::pose::Pose;

/// How far apart two surfaces are, and in which direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Separation {
    /// Distance of the surfaces in metres; if negative, the length of the shortest move along the normal that parts them.
    pub distance: f64,
    /// Unit vector from the first hull to the second, in the world's frame.
    pub normal: DVec2,
}

/// The distance between the surfaces of two hulls in metres; negative if they overlap.
pub fn distance(a: &Hull, pose_a: &Pose, b: &Hull, pose_b: &Pose) -> f64 {
    separation(a, pose_a, b, pose_b).distance
}

/// Distance and direction between two hulls. Equal choices go to the first hull, and there to the lowest index. Two points at
/// one place part along +y of the frame of the first.
pub fn separation(a: &Hull, pose_a: &Pose, b: &Hull, pose_b: &Pose) -> Separation {
    let (b_in_a, a_in_b) = (relative(pose_a, pose_b), relative(pose_b, pose_a));
    let flipped = |(height, normal): (f64, DVec2)| (height, -b_in_a.direction_to_world(normal));
    let axis = greater(highest(a, b, &b_in_a), highest(b, a, &a_in_b).map(flipped));
    let (core, normal) = match axis {
        Some((height, normal)) if height <= 0.0 => (height, normal),
        _ => {
            let (first, second) = (least(a, b, &b_in_a), flipped(least(b, a, &a_in_b)));
            if second.0 < first.0 { second } else { first }
        }
    };
    Separation { distance: core - (a.radius() + b.radius()), normal: pose_a.direction_to_world(normal) }
}

/// The second pose, seen from the first.
fn relative(from: &Pose, to: &Pose) -> Pose {
    Pose { position: from.point_to_local(to.position), rotation: from.direction_to_local(to.rotation) }
}

fn greater(first: Option<(f64, DVec2)>, second: Option<(f64, DVec2)>) -> Option<(f64, DVec2)> {
    match (first, second) {
        (Some(first), Some(second)) => Some(if second.0 > first.0 { second } else { first }),
        (first, second) => first.or(second),
    }
}

/// The greatest height of the other core above a side, or beyond an end of a segment, and its direction. A point has
/// none.
fn highest(hull: &Hull, other: &Hull, pose: &Pose) -> Option<(f64, DVec2)> {
    let height = |corner: DVec2, normal: DVec2| {
        let above = |place: &DVec2| normal.dot(pose.point_to_world(*place) - corner);
        (other.corners().iter().map(above).fold(f64::INFINITY, f64::min), normal)
    };
    let sides = hull.corners().iter().zip(hull.sides()).map(|(corner, side)| height(*corner, side.normal));
    let along_sides = sides.fold(None, |best, side| greater(best, Some(side)));
    let [from, to] = *hull.corners() else { return along_sides };
    let along = hull.sides()[0].normal.perp();
    greater(along_sides, greater(Some(height(from, -along)), Some(height(to, along))))
}

/// The least distance of a corner of the other core from this one, and the direction.
fn least(hull: &Hull, other: &Hull, pose: &Pose) -> (f64, DVec2) {
    let places = other.corners().iter().map(|corner| nearest(hull, pose.point_to_world(*corner)));
    let least = places.reduce(|best, next| if next.distance < best.distance { next } else { best });
    least.map(|found| (found.distance, found.normal)).expect("a hull has corners")
}

#[cfg(test)]
pub(crate) mod tests {
    use proptest::prelude::*;

    use super::*;

    /// A hull of up to six corners from random numbers in 0..1.
    pub(crate) fn random_hull(numbers: &[f64], radius: f64) -> Hull {
        let mut angles: Vec<f64> = numbers.iter().map(|number| number * std::f64::consts::TAU).collect();
        angles.sort_by(f64::total_cmp);
        angles.dedup_by(|a, b| (*a - *b).abs() < 1e-3);
        let corners: Vec<DVec2> = angles.iter().map(|a| DVec2::new(libm::cos(*a), 0.4 * libm::sin(*a))).collect();
        match corners.as_slice() {
            [center] => Hull::disc(*center, radius).unwrap(),
            [from, to] => Hull::capsule(*from, *to, radius).unwrap(),
            _ => Hull::polygon(&corners, radius).unwrap().0,
        }
    }

    mod oracle {
        use parry2d_f64::math::{Pose as ParryPose, Rotation, Vector};
        use parry2d_f64::query;
        use parry2d_f64::shape::{Ball, ConvexPolygon, Segment, Shape};

        use super::{DVec2, Hull, Pose};

        fn core(hull: &Hull) -> Box<dyn Shape> {
            let points: Vec<Vector> = hull.corners().iter().map(|corner| Vector::new(corner.x, corner.y)).collect();
            match points.as_slice() {
                [_] => Box::new(Ball::new(0.0)),
                [from, to] => Box::new(Segment::new(*from, *to)),
                _ => Box::new(ConvexPolygon::from_convex_polyline(points).unwrap()),
            }
        }

        /// Distance of the surfaces if the cores are apart.
        pub fn distance(a: &Hull, pose_a: &Pose, b: &Hull, pose_b: &Pose) -> f64 {
            let pose = |hull: &Hull, pose: &Pose| {
                // A ball has its centre at its origin.
                let shift = if hull.corners().len() == 1 { hull.corners()[0] } else { DVec2::ZERO };
                let place = pose.point_to_world(shift);
                let angle = libm::atan2(pose.rotation.y, pose.rotation.x);
                ParryPose::from_parts(Vector::new(place.x, place.y), Rotation::new(angle))
            };
            let found = query::distance(&pose(a, pose_a), &*core(a), &pose(b, pose_b), &*core(b)).unwrap();
            found.distance - a.radius() - b.radius()
        }
    }

    proptest! {
        #![proptest_config(crate::cases(6, 3000))]

        /// Law: the distance is that of parry2d, and the same from both sides. Tolerance: parry2d ends its iteration
        /// when bounds differ by sqrt(10 epsilon), 5e-8 of the distance, here below 6 m. The next law is sharper. Cores
        /// that overlap have no distance there.
        #[test]
        fn the_distance_is_that_of_parry(
            first in prop::collection::vec(0.0..1.0, 1..7), second in prop::collection::vec(0.0..1.0, 1..7),
            x in -3.0..3.0, y in -3.0..3.0, angle in -7.0..7.0, turn in -7.0..7.0, radius in 0.0..0.2,
        ) {
            let (a, b) = (random_hull(&first, radius), random_hull(&second, 0.1));
            let (pose_a, pose_b) = (Pose::new(DVec2::new(x, y), angle), Pose::new(DVec2::new(0.3, -0.2), turn));
            let found = separation(&a, &pose_a, &b, &pose_b);
            let back = separation(&b, &pose_b, &a, &pose_a);
            prop_assert!((found.distance - back.distance).abs() < 64.0 * f64::EPSILON);
            if found.distance + radius + 0.1 > 1e-6 {
                let expected = oracle::distance(&a, &pose_a, &b, &pose_b);
                prop_assert!((found.distance - expected).abs() < 3e-7, "{found:?}, expected {expected}");
            } else {
                prop_assert!(oracle::distance(&a, &pose_a, &b, &pose_b) <= 1e-6 - radius - 0.1);
            }
        }

        /// Law: moved along the normal by minus the distance, the hulls just touch; no shorter move parts them.
        #[test]
        fn a_move_along_the_normal_makes_hulls_touch(
            first in prop::collection::vec(0.0..1.0, 1..7), second in prop::collection::vec(0.0..1.0, 1..7),
            x in -1.0..1.0, y in -1.0..1.0, turn in -7.0..7.0, toward in 0.0..6.3,
        ) {
            let (a, b) = (random_hull(&first, 0.05), random_hull(&second, 0.0));
            let (pose_a, pose_b) = (Pose::new(DVec2::new(x, y), turn), Pose::new(DVec2::new(0.3, -0.2), 2.0 * turn));
            let found = separation(&a, &pose_a, &b, &pose_b);
            prop_assert!((found.normal.length() - 1.0).abs() < 16.0 * f64::EPSILON);
            let moved = |by: DVec2| distance(&a, &pose_a, &b, &Pose { position: pose_b.position + by, ..pose_b });
            prop_assert!(moved(found.normal * -found.distance).abs() < 64.0 * f64::EPSILON, "{found:?}");
            let other = DVec2::new(libm::cos(toward), libm::sin(toward));
            prop_assert!(moved(other * (found.distance.abs() * 0.99)) * found.distance > 0.0, "{found:?}");
        }
    }

    #[test]
    fn segments_in_line_are_apart_and_crossed_ones_overlap() {
        let bar = Hull::capsule(-DVec2::X, DVec2::X, 0.0).unwrap();
        let at = |x: f64, rotation: DVec2| Pose { position: DVec2::new(x, 0.0), rotation };
        let apart = separation(&bar, &Pose::default(), &bar, &at(5.0, DVec2::X));
        assert_eq!(apart, Separation { distance: 3.0, normal: DVec2::X });
        assert_eq!(distance(&bar, &Pose::default(), &bar, &at(0.25, DVec2::Y)), -0.75);
        let point = Hull::disc(DVec2::ZERO, 0.5).unwrap();
        assert_eq!(distance(&point, &Pose::default(), &point, &Pose::default()), -1.0);
    }
}
