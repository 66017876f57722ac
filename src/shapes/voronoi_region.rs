//! Voronoi regions: the points nearest to a corner or side of a hull, and the features beyond their borders.
//!
//! Outside the core the region of a side is a strip. The region of a corner is a wedge between the normals of its
//! sides. Each has two borders: the first is passed clockwise round the hull, the second counter-clockwise.

use glam::DVec2;

use crate::hull::{Free, Hull};
use crate::nearest::Feature;

/// The hull and the feature beyond a border, as indices.
pub type Beyond = (usize, Feature);

impl Hull {
    /// The distances of a point from the two borders of a feature's region, in metres; positive inside. Each is
    /// measured along the direction in which the point passes the border. The second numbers are their rates for a
    /// point that moves with `velocity`, in m/s. All are in the hull's frame.
    ///
    /// `None` if the feature is not a corner or side of the hull. A disc has no border, so it gives `None` too.
    pub fn borders(&self, feature: Feature, point: DVec2, velocity: DVec2) -> Option<[(f64, f64); 2]> {
        let along = |side: usize| self.sides()[side].normal.perp();
        let seen = |from: DVec2, inwards: DVec2| ((point - from).dot(inwards), velocity.dot(inwards));
        match feature {
            Feature::Side(side) if side < self.sides().len() => {
                let (from, to) = self.ends(side);
                Some([seen(from, along(side)), seen(to, -along(side))])
            }
            Feature::Corner(corner) if !self.sides().is_empty() => {
                let at = self.corners()[corner];
                let [first, second] = match self.free(corner) {
                    Free::Between(from, to) => [from.perp(), to.perp()],
                    Free::Whole | Free::Hollow | Free::Nowhere => [along(self.side_before(corner)), along(corner)],
                };
                Some([seen(at, first), seen(at, -second)])
            }
            _ => None,
        }
    }

    /// The border that a point has passed if it left the region of a feature: whether it is the second. Both borders of the
    /// end of a capsule are one line; there the half in which the point lies decides.
    pub fn passed_second(&self, feature: Feature, point: DVec2, [_, second]: [bool; 2]) -> bool {
        match (feature, self.corners()) {
            (Feature::Corner(corner), [_, _]) => self.sides()[corner].normal.dot(point - self.corners()[corner]) > 0.0,
            _ => second,
        }
    }

    /// The side that ends at a corner.
    fn side_before(&self, corner: usize) -> usize {
        corner.checked_sub(1).unwrap_or(self.sides().len() - 1)
    }
}

/// The hull and feature that a point enters when it leaves the region of a feature of `hulls[hull]`. `second` chooses
/// the border. Hulls that share a corner are parts of one shape. The outline continues at the part that owns the
/// corner. `None` beyond the end of a side in a hollow: another part is nearest there.
pub fn beyond(hulls: &[&Hull], hull: usize, feature: Feature, second: bool) -> Option<Beyond> {
    let of = hulls[hull];
    match feature {
        Feature::Side(side) => {
            let own = if second { (side + 1) % of.corners().len() } else { side };
            let at = of.corners()[own];
            if of.free(own) == Free::Hollow {
                return Some((hull, Feature::Corner(own)));
            }
            let owner = corners_at(hulls, at).find(|(part, corner)| hulls[*part].probes(*corner));
            match owner {
                Some((part, corner)) => Some((part, Feature::Corner(corner))),
                // A straight place of the outline: the side of the next part.
                None => straight(hulls, at, of.sides()[side].normal, second),
            }
        }
        Feature::Corner(corner) => {
            let at = of.corners()[corner];
            if of.free(corner) == Free::Hollow {
                let side = if second { corner } else { of.side_before(corner) };
                return (!of.sides()[side].inner).then_some((hull, Feature::Side(side)));
            }
            // The outer side of a part that begins there follows, one that ends there precedes.
            corners_at(hulls, at).find_map(|(part, corner)| {
                let side = if second { corner } else { hulls[part].side_before(corner) };
                (!hulls[part].sides()[side].inner).then_some((part, Feature::Side(side)))
            })
        }
        Feature::OutlineSide(_) | Feature::OutlineCorner(_) => None,
    }
}

/// All corners at a place, with their hulls.
fn corners_at<'a>(hulls: &'a [&Hull], at: DVec2) -> impl Iterator<Item = (usize, usize)> + 'a {
    let of = move |(part, hull): (usize, &&'a Hull)| {
        let hull = *hull;
        let corner = hull.corners().iter().position(|corner| *corner == at);
        corner.filter(|_| !hull.sides().is_empty()).map(|corner| (part, corner))
    };
    hulls.iter().enumerate().filter_map(of)
}

/// A share by which two normals of one straight side may differ.
const STRAIGHT: f64 = 1e-9;

fn straight(hulls: &[&Hull], at: DVec2, normal: DVec2, second: bool) -> Option<Beyond> {
    corners_at(hulls, at).find_map(|(part, corner)| {
        let side = if second { corner } else { hulls[part].side_before(corner) };
        let found = hulls[part].sides()[side];
        let goes_on = found.normal.dot(normal) > 0.0 && found.normal.perp_dot(normal).abs() < STRAIGHT;
        (!found.inner && goes_on).then_some((part, Feature::Side(side)))
    })
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::nearest::nearest;
    use crate::shape::{capsule, polygon, rectangle, regular};

    proptest! {
        #![proptest_config(crate::cases(11, 2000))]

        /// Law: a feature is the nearest if and only if both its borders are positive. Beyond a passed border lies the
        /// next nearest feature.
        #[test]
        fn borders_part_the_regions(turn in 0.0..std::f64::consts::TAU, step in 0.001..0.3_f64, which in 0..3_usize) {
            let shape = match which {
                0 => capsule(DVec2::new(-0.4, 0.0), DVec2::new(0.4, 0.0), 0.1),
                1 => rectangle(1.0, 0.6, 0.1),
                _ => regular(5, 0.5, 0.1),
            };
            let shape = shape.unwrap();
            let hull = &shape.hulls[0];
            let place = |turn: f64| 2.0 * DVec2::new(libm::cos(turn), libm::sin(turn));
            let (before, after) = (place(turn), place(turn + step));
            let (first, next) = (nearest(hull, before).feature, nearest(hull, after).feature);
            let velocity = after - before;
            let borders = |feature, point| hull.borders(feature, point, velocity).unwrap();
            let inside = |feature, point| borders(feature, point).map(|(way, _)| way >= 0.0);
            prop_assert_eq!(inside(first, before), [true, true]);
            if first == next {
                prop_assert_eq!(inside(first, after), [true, true]);
                return Ok(());
            }
            let passed = inside(first, after).map(|inside| !inside);
            prop_assert!(hull.passed_second(first, after, passed), "counter-clockwise the second border is passed");
            prop_assert!(borders(first, before)[1].1 < 0.0);
            let found = beyond(&[hull], 0, first, true);
            // A long step may pass two.
            if found != Some((0, next)) {
                let (_, between) = found.unwrap();
                prop_assert_eq!(beyond(&[hull], 0, between, true), Some((0, next)));
            }
            prop_assert_eq!(beyond(&[hull], 0, found.unwrap().1, false), Some((0, first)));
        }
    }

    /// Law: an L is cut into parts. Once round its outline each part leads to the next at their meeting point. At the
    /// concave corner no part follows, because a side of another part is nearest.
    #[test]
    fn parts_hand_over_along_the_outline() {
        let points = [(0.0, 0.0), (2.0, 0.0), (2.0, 1.0), (1.0, 1.0), (1.0, 2.0), (0.0, 2.0)].map(DVec2::from);
        let shape = polygon(&points, 0.0).unwrap();
        assert!(shape.hulls.len() > 1);
        let hulls: Vec<&Hull> = shape.hulls.iter().collect();
        // From the side that comes after the concave corner, counter-clockwise, to that which comes before it.
        let begin = hulls.iter().enumerate().find_map(|(part, hull)| {
            let is_it = |side: &usize| !hull.sides()[*side].inner && hull.ends(*side).0 == points[3];
            (0..hull.sides().len()).find(is_it).map(|side| (part, Feature::Side(side)))
        });
        let (mut now, mut corners, mut parts) = (begin.unwrap(), Vec::new(), vec![]);
        while let Some(next) = beyond(&hulls, now.0, now.1, true) {
            if let Feature::Corner(corner) = next.1 {
                corners.push(hulls[next.0].corners()[corner]);
            }
            parts.push(next.0);
            let back = beyond(&hulls, next.0, next.1, false);
            assert_eq!(back, Some(now));
            now = next;
        }
        assert_eq!(corners, [points[4], points[5], points[0], points[1], points[2], points[3]]);
        parts.dedup();
        assert!(parts.len() > 1, "{parts:?}");
    }
}
