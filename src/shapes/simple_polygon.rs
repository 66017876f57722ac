//! The outline of a simple polygon: its points are checked, put counter-clockwise, and moved inwards.
//!
//! If the outline moves inwards by r, each side stays parallel. The corner between the normals m and n moves to c - r
//! (m + n) / (1 + m . n), the mitre. At a convex corner the disc that rolls inside loses area: r^2 (tan(b/2) - b/2) for
//! a turn b. All signs are exact. Lengths are in metres.

use glam::DVec2;

use crate::box_tree::BoxTree;
use crate::error::{Mended, ShapeError};
use crate::hull::{around, check_points, direction, without_straight};
use crate::orientation::orientation;
use crate::pose::BoundingBox;

/// The corners of a simple polygon, counter-clockwise and without straight ones, and the corrections.
///
/// # Errors
/// Numbers that are NaN, infinite or out of range. Too few points. Coinciding points. No area. Sides that cross or
/// touch.
pub(crate) fn simple(points: &[DVec2]) -> Result<(Vec<DVec2>, Vec<Mended>), ShapeError> {
    check_points(points, "a coordinate of a point")?;
    if points.len() < 3 {
        return Err(ShapeError::TooFewPoints { found: points.len() });
    }
    distinct(points)?;
    let (kept, mut mended) = without_straight(points)?;
    if let Some(crossing) = crossing(points, &kept) {
        return Err(crossing);
    }
    let mut corners: Vec<DVec2> = kept.iter().map(|index| points[*index]).collect();
    if !is_counter_clockwise(&corners) {
        corners.reverse();
        mended.insert(0, Mended::Turned);
    }
    Ok((corners, mended))
}

/// # Errors
/// The two points at one place, of those the ones with the lowest indices.
fn distinct(points: &[DVec2]) -> Result<(), ShapeError> {
    let mut order: Vec<usize> = (0..points.len()).collect();
    // Minus zero is zero.
    let key = |index: usize| points[index] + DVec2::ZERO;
    order.sort_by(|a, b| key(*a).x.total_cmp(&key(*b).x).then(key(*a).y.total_cmp(&key(*b).y)).then(a.cmp(b)));
    let equal = order.windows(2).filter(|pair| points[pair[0]] == points[pair[1]]).map(|pair| (pair[0], pair[1])).min();
    equal.map_or(Ok(()), |(first, second)| Err(ShapeError::EqualPoints { first, second }))
}

/// The first two sides of a ring, not neighbours, that have a place in common.
fn crossing(points: &[DVec2], ring: &[usize]) -> Option<ShapeError> {
    let count = ring.len();
    let ends = |side: usize| (points[ring[side]], points[ring[(side + 1) % count]]);
    let bounds = |(from, to): (DVec2, DVec2)| BoundingBox { low: from.min(to), high: from.max(to) };
    let boxes = BoxTree::new((0..count).map(|side| bounds(ends(side))));
    for first in 0..count {
        let (a, b) = ends(first);
        let low = a.min(b);
        let last = if first == 0 { count - 1 } else { count };
        let others = boxes.touching(&bounds((a, b))).into_iter().filter(|second| (first + 2..last).contains(second));
        for second in others {
            #[cfg(test)]
            crate::work::count();
            let (c, d) = ends(second);
            let heights = [orientation(c, d, a), orientation(c, d, b), orientation(a, b, c), orientation(a, b, d)];
            let same_side = |one: f64, other: f64| (one > 0.0 && other > 0.0) || (one < 0.0 && other < 0.0);
            if same_side(heights[0], heights[1]) || same_side(heights[2], heights[3]) {
                continue;
            }
            // Sides along one line meet where their boxes do.
            let on_line = heights[0] == heights[1];
            let at = if on_line { low.max(c.min(d)) } else { a + (b - a) * (heights[0] / (heights[0] - heights[1])) };
            return Some(ShapeError::SelfCrossing { first: ring[first], second: ring[second], at });
        }
    }
    None
}

/// The order of a simple polygon without straight corners is that of its turn at the lowest corner.
fn is_counter_clockwise(corners: &[DVec2]) -> bool {
    let all: Vec<usize> = (0..corners.len()).collect();
    let lowest = around(&all).min_by(|a, b| {
        let key = |ring: &[usize; 3]| corners[ring[1]] + DVec2::ZERO;
        key(a).y.total_cmp(&key(b).y).then(key(a).x.total_cmp(&key(b).x))
    });
    lowest.is_some_and(|[a, b, c]| orientation(corners[a], corners[b], corners[c]) > 0.0)
}

/// Whether the corner bends outwards, for each corner of a counter-clockwise outline.
pub(crate) fn convex_corners(corners: &[DVec2]) -> Vec<bool> {
    let all: Vec<usize> = (0..corners.len()).collect();
    around(&all).map(|[a, b, c]| orientation(corners[a], corners[b], corners[c]) > 0.0).collect()
}

/// Unit vectors along the sides that end and begin at each corner.
fn sides_at(corners: &[DVec2]) -> Vec<[DVec2; 2]> {
    let all: Vec<usize> = (0..corners.len()).collect();
    let along = |from: usize, to: usize| direction(corners[to] - corners[from]).0;
    around(&all).map(|[a, b, c]| [along(a, b), along(b, c)]).collect()
}

/// The outline moved inwards, if all sides keep their direction and no sides meet.
fn moved_inwards(corners: &[DVec2], sides: &[[DVec2; 2]], by: f64) -> Option<Vec<DVec2>> {
    let mitre = |(corner, [before, after]): (&DVec2, &[DVec2; 2])| {
        *corner + (before.perp() + after.perp()) * (by / (1.0 + before.dot(*after)))
    };
    let moved: Vec<DVec2> = corners.iter().zip(sides).map(mitre).collect();
    let count = moved.len();
    let forward = (0..count).all(|index| (moved[(index + 1) % count] - moved[index]).dot(sides[index][1]) > 0.0);
    let (kept, _) = forward.then(|| without_straight(&moved).ok()).flatten()?;
    (distinct(&moved).is_ok() && crossing(&moved, &kept).is_none() && is_counter_clockwise(&moved)).then_some(moved)
}

/// The outline moved inwards by a rounding in metres.
///
/// # Errors
/// [`ShapeError::RoundingTooLarge`] with the greatest rounding at which no side vanishes and no two sides meet.
pub(crate) fn inset(corners: &[DVec2], rounding: f64) -> Result<Vec<DVec2>, ShapeError> {
    if rounding == 0.0 {
        return Ok(corners.to_vec());
    }
    let sides = sides_at(corners);
    if let Some(moved) = moved_inwards(corners, &sides, rounding) {
        return Ok(moved);
    }
    // Bisection until no `f64` lies between the greatest possible and the least impossible one.
    let (mut greatest, mut too_large) = (0.0, rounding);
    loop {
        let middle = greatest + (too_large - greatest) / 2.0;
        if middle <= greatest || middle >= too_large {
            return Err(ShapeError::RoundingTooLarge { found: rounding, greatest });
        }
        match moved_inwards(corners, &sides, middle) {
            Some(_) => greatest = middle,
            None => too_large = middle,
        }
    }
}

/// The area that rounding takes off the convex corners, in m2.
pub(crate) fn lost_area(corners: &[DVec2], rounding: f64) -> f64 {
    let loss = |[before, after]: &[DVec2; 2]| {
        let (across, along) = (before.perp_dot(*after), before.dot(*after));
        if across <= 0.0 { 0.0 } else { across / (1.0 + along) - libm::atan2(across, along) / 2.0 }
    };
    rounding * rounding * sides_at(corners).iter().map(loss).sum::<f64>()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn points(list: &[(f64, f64)]) -> Vec<DVec2> {
        list.iter().map(|(x, y)| DVec2::new(*x, *y)).collect()
    }

    #[test]
    fn a_clockwise_outline_is_turned_round_and_said() {
        let clockwise = points(&[(0.0, 0.0), (0.0, 1.0), (0.2, 0.3), (1.0, 0.0)]);
        let (corners, mended) = simple(&clockwise).unwrap();
        assert_eq!(mended, [Mended::Turned]);
        assert_eq!(convex_corners(&corners), [true, false, true, true]);
    }

    #[test]
    fn sides_that_meet_are_named_with_the_place() {
        let bow = simple(&points(&[(0.0, 0.0), (2.0, 2.0), (2.0, 0.0), (0.0, 2.0)]));
        assert_eq!(bow, Err(ShapeError::SelfCrossing { first: 0, second: 2, at: DVec2::ONE }));
        // A corner that touches a side; indices count straight points too.
        let touch = simple(&points(&[(0.0, 0.0), (1.0, 0.0), (4.0, 0.0), (4.0, 2.0), (2.0, 0.0), (0.0, 2.0)]));
        assert_eq!(touch, Err(ShapeError::SelfCrossing { first: 0, second: 3, at: DVec2::new(2.0, 0.0) }));
        let twice = simple(&points(&[(0.0, 0.0), (2.0, 0.0), (1.0, 1.0), (2.0, 2.0), (0.0, 2.0), (1.0, 1.0)]));
        assert_eq!(twice, Err(ShapeError::EqualPoints { first: 2, second: 5 }));
        // One side runs along another and past both its ends.
        let along = simple(&points(&[(0.0, 0.0), (4.0, 0.0), (4.0, 2.0), (5.0, 0.0), (-1.0, 0.0), (-2.0, 1.0)]));
        assert_eq!(along, Err(ShapeError::SelfCrossing { first: 0, second: 3, at: DVec2::ZERO }));
    }

    /// Law: the greatest rounding of a triangle is the radius of its inscribed circle. That of a bar is half its width.
    /// A neck allows half its width.
    #[test]
    fn the_greatest_rounding_is_told() {
        let triangle = points(&[(0.0, 0.0), (4.0, 0.0), (0.0, 3.0)]);
        let bar = points(&[(0.0, 0.0), (9.0, 0.0), (9.0, 2.0), (0.0, 2.0)]);
        // Two boxes of 2 x 2 with a neck of width 0.5 between them.
        let bone = points(&[
            (0.0, 0.0),
            (2.0, 0.0),
            (2.0, 0.75),
            (4.0, 0.75),
            (4.0, 0.0),
            (6.0, 0.0),
            (6.0, 2.0),
            (4.0, 2.0),
            (4.0, 1.25),
            (2.0, 1.25),
            (2.0, 2.0),
            (0.0, 2.0),
        ]);
        for (corners, radius) in [(triangle, 1.0), (bar, 1.0), (bone, 0.25)] {
            let Err(ShapeError::RoundingTooLarge { greatest, .. }) = inset(&corners, 1.5) else {
                panic!("{corners:?}")
            };
            assert!((greatest - radius).abs() < 16.0 * f64::EPSILON, "{greatest}");
            assert!(inset(&corners, greatest).is_ok());
        }
    }

    #[test]
    fn a_rounded_square_loses_four_minus_pi() {
        let square = points(&[(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]);
        let expected = (4.0 - std::f64::consts::PI) * 0.01;
        assert!((lost_area(&square, 0.1) - expected).abs() < 8.0 * f64::EPSILON * expected);
    }
}
