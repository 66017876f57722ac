//! The half-planes of a core that may not hold a place, by halves in the order of the normals.
//!
//! Take sides whose normals turn by less than half a turn, and any corner v of the core. Each of their normals is
//! `n = a n1 + b n2` of the first and the last one, with `a, b >= 0` and `a + b >= 1`. The line of a side lies at
//! n . c >= n . v. So if n1 . (v - p) and n2 . (v - p) exceed a margin, a place p lies below all these lines by more
//! than the margin.

use glam::DVec2;

use crate::hull::Hull;

/// So many sides are visited without a test.
const FEW: usize = 4;

/// Visits sides in ascending order until `visit` is false. It leaves out only sides below whose lines all places lie by
/// more than a positive margin in metres. It finds them in the logarithm of their number, for places far from the outline.
pub(crate) fn not_well_below(hull: &Hull, places: &[DVec2], margin: f64, visit: &mut impl FnMut(usize) -> bool) {
    walk(hull, places, margin, (0, hull.sides().len()), visit);
}

fn walk(
    hull: &Hull,
    places: &[DVec2],
    margin: f64,
    (from, to): (usize, usize),
    visit: &mut impl FnMut(usize) -> bool,
) -> bool {
    if to - from <= FEW {
        return (from..to).all(visit);
    }
    let middle = from + (to - from) / 2;
    let (first, last) = (hull.sides()[from].normal, hull.sides()[to - 1].normal);
    let corner = hull.corners()[middle];
    let is_below = |place: &DVec2| first.dot(corner - *place) > margin && last.dot(corner - *place) > margin;
    if first.perp_dot(last) > 0.0 && places.iter().all(is_below) {
        return true;
    }
    walk(hull, places, margin, (from, middle), visit) && walk(hull, places, margin, (middle, to), visit)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shape::regular;

    /// Law: a side that is left out has the place below its line by more than the margin. Work: within, near and outside a polygon
    /// of 4096 sides, the number of visits stays at some leaves.
    #[test]
    fn sides_far_above_are_left_out_and_few_are_visited() {
        let hull = &regular(4096, 1.0, 0.0).unwrap().hulls[0];
        for (step, radius) in [0.0, 0.5, 0.999, 1.0 - 1e-6, 1.0, 1.001, 3.0].into_iter().enumerate() {
            let place = DVec2::from_angle(0.7 * step as f64) * radius;
            let (mut visited, mut outside) = (Vec::new(), false);
            not_well_below(hull, &[place], 1e-13, &mut |side| {
                visited.push(side);
                outside |= hull.sides()[side].normal.dot(place - hull.corners()[side]) > 0.0;
                !outside
            });
            let above = |side: &usize| hull.sides()[*side].normal.dot(hull.corners()[*side] - place) <= 1e-13;
            if outside {
                assert!(radius >= 1.0, "{radius}");
            } else {
                let missed = (0..4096).filter(above).find(|side| !visited.contains(side));
                assert_eq!(missed, None, "{radius}");
            }
            assert!(visited.len() <= 64, "{radius}: {}", visited.len());
        }
    }
}
