//! Ray casting: the first point at which a ray meets a hull.
//!
//! The outline of a hull consists of its sides, moved outwards by the radius, and of arcs about its corners. Lengths
//! are in metres.

use glam::DVec2;

use crate::hull::Hull;
use crate::nearest::nearest;

/// The distance in metres from a point, along a unit direction, to the first hit on the hull. It is zero inside the
/// hull, and `None` if the ray misses. Point and direction are in the hull's frame.
pub fn ray(hull: &Hull, from: DVec2, direction: DVec2) -> Option<f64> {
    if nearest(hull, from).distance <= hull.radius() {
        return Some(0.0);
    }
    let on_side = |index: usize| {
        let (start, end) = hull.ends(index);
        let normal = hull.sides()[index].normal;
        let way = (hull.radius() - normal.dot(from - start)) / normal.dot(direction);
        let along = (from + direction * way - start).dot(end - start);
        (way >= 0.0 && (0.0..=start.distance_squared(end)).contains(&along)).then_some(way)
    };
    let on_corner = |corner: &DVec2| ray_to_disc(*corner - from, direction, hull.radius());
    let sides = (0..hull.sides().len()).filter_map(on_side);
    sides.chain(hull.corners().iter().filter_map(on_corner)).min_by(f64::total_cmp)
}

/// The same for a disc about a place that is seen from the ray's beginning, which lies outside.
fn ray_to_disc(center: DVec2, direction: DVec2, radius: f64) -> Option<f64> {
    let (along, across) = (center.dot(direction), center.perp_dot(direction));
    let half_chord = (radius - across) * (radius + across);
    (along >= 0.0 && half_chord >= 0.0).then(|| along - half_chord.sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cases;
    use proptest::prelude::*;

    #[test]
    fn a_ray_meets_sides_arcs_and_nothing() {
        let square = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(|(x, y)| DVec2::new(x, y));
        let hull = Hull::polygon(&square, 0.5).unwrap().0;
        assert_eq!(ray(&hull, DVec2::new(-4.0, 0.3), DVec2::X), Some(2.5));
        assert_eq!(ray(&hull, DVec2::new(-4.0, 0.3), DVec2::NEG_X), None);
        assert_eq!(ray(&hull, DVec2::new(-4.0, 1.6), DVec2::X), None);
        assert_eq!(ray(&hull, DVec2::new(0.0, 0.9), DVec2::X), Some(0.0));
        let on_arc = ray(&hull, DVec2::new(-4.0, 1.3), DVec2::X).unwrap();
        assert!((on_arc - (3.0 - 0.4)).abs() < 1e-15, "{on_arc}");
    }

    proptest! {
        #![proptest_config(cases(20, 400))]

        /// Law: the distance of a hull is zero at the point where a ray meets it, and above zero before. Tolerance:
        /// roundings of numbers near 10, divided by the sine of the angle between ray and side. In the tried cases that
        /// sine is at least 1e-3.
        #[test]
        fn the_place_of_meeting_is_on_the_surface(
            x in -3.0..3.0, y in -3.0..3.0, angle in 0.0..std::f64::consts::TAU, radius in 0.0..0.4,
        ) {
            let corners = [(-1.0, -0.5), (1.2, -0.7), (0.6, 0.9)].map(|(x, y)| DVec2::new(x, y));
            let hull = Hull::polygon(&corners, radius).unwrap().0;
            let (from, direction) = (DVec2::new(x, y), DVec2::from_angle(angle));
            let height = |way: f64| nearest(&hull, from + direction * way).distance - radius;
            let least = (0..4000).map(|step| height(step as f64 * 2.5e-3)).fold(f64::INFINITY, f64::min);
            match ray(&hull, from, direction) {
                Some(way) => {
                    prop_assert!(way == 0.0 || height(way).abs() < 1e-12, "{way} {}", height(way));
                    prop_assert!((0..40).all(|step| height(way * f64::from(step) / 40.0) > -1e-12 || way == 0.0));
                }
                None => prop_assert!(least > -1e-12, "{least}"),
            }
        }
    }
}
