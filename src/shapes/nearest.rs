//! The nearest point on a core to a given point, and the normal there.
//!
//! Outside a convex core the side with the greatest height h_i = n_i . (p - c_i) has the nearest point. It lies within
//! the side, or at the end beyond which p lies. The direction u from the nearest point to p lies between the normals of
//! the adjacent sides. So no other normal is nearer to u, and no other side passes above that point. Inside, the
//! greatest height is minus the depth. Heights equal to the last bit go to the lowest index. Distances are in metres,
//! to the core. The caller subtracts the radius of the hull.

use glam::DVec2;

use crate::hull::{Hull, direction};

/// A corner or a side of a core.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Feature {
    /// The corner of this index.
    Corner(usize),
    /// The side that begins at the corner of this index.
    Side(usize),
    /// The side of the outline of the whole concave polygon that begins at the corner of this index.
    OutlineSide(usize),
    /// The corner of that outline of this index.
    OutlineCorner(usize),
}

impl Feature {
    /// Whether it is straight: its normal is the same at all its places.
    pub fn is_side(self) -> bool {
        matches!(self, Self::Side(_) | Self::OutlineSide(_))
    }
}

/// How far a point is from a core, and in which direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nearest {
    /// Distance in metres, negative inside the core.
    pub distance: f64,
    /// Unit normal, outwards at the nearest place.
    pub normal: DVec2,
    /// The feature that holds the nearest point.
    pub feature: Feature,
}

impl Hull {
    /// Whether the nearest place lies on the outline of the hull's shape. Otherwise a contact there belongs to another part.
    #[inline]
    pub fn owns(&self, near: &Nearest) -> bool {
        match near.feature {
            Feature::Side(side) => !self.sides()[side].inner,
            Feature::Corner(corner) => self.free(corner).holds(near.normal),
            Feature::OutlineSide(_) | Feature::OutlineCorner(_) => true,
        }
    }
}

/// The nearest place of the core to a point in the hull's frame, in metres.
///
/// Inside a part of a concave polygon the whole outline of the polygon counts. Inside another core only sides on the
/// outline count, by the height under their line. So no normal points through a cut. If all sides are inner, all count.
/// Outside, an inner feature may be the nearest, which [`Hull::owns`] shows. At the centre of a disc, where all
/// directions are equal, the normal points along +y.
pub fn nearest(hull: &Hull, point: DVec2) -> Nearest {
    match *hull.corners() {
        [_] => distance_to(hull, Feature::Corner(0), point),
        [from, to] => nearest_on_segment(hull, from, to, point),
        _ => nearest_on_polygon(hull, point),
    }
}

/// Whether a point in the hull's frame may be nearer to the core than a `distance` in metres. It is true for all nearer
/// points, and for few others near corners. It takes less time than the distance.
#[inline]
pub fn may_be_nearer(hull: &Hull, point: DVec2, distance: f64) -> bool {
    if hull.corners().len() < 3 {
        return nearest(hull, point).distance < distance;
    }
    hull.sides().iter().zip(hull.corners()).all(|(side, corner)| side.normal.dot(point - *corner) < distance)
}

/// Signed distance and normal of one feature, whether or not it is the nearest. The feature is the whole line of a
/// side, or the corner alone. The point is in the hull's frame. An integrator that freezes the feature in a step sees a
/// smooth function.
///
/// # Panics
/// If the hull has no such feature.
#[inline]
pub fn distance_to(hull: &Hull, feature: Feature, point: DVec2) -> Nearest {
    match feature {
        Feature::Side(index) => {
            let normal = hull.sides()[index].normal;
            Nearest { distance: normal.dot(point - hull.corners()[index]), normal, feature }
        }
        Feature::OutlineSide(index) => {
            let (from, to) = outline_side(hull, index);
            let normal = -direction(to - from).0.perp();
            Nearest { distance: normal.dot(point - from), normal, feature }
        }
        Feature::OutlineCorner(index) => {
            // The view from within: the distance is negative and the normal points to the corner.
            let (inwards, distance) = direction(point - hull.outline()[index]);
            Nearest { distance: -distance, normal: -inwards, feature }
        }
        Feature::Corner(index) => {
            let away = point - hull.corners()[index];
            let distance = away.length();
            let normal = if distance > 0.0 {
                away / distance
            } else {
                hull.sides().get(index).map_or(DVec2::Y, |side| side.normal)
            };
            Nearest { distance, normal, feature }
        }
    }
}

fn nearest_on_segment(hull: &Hull, from: DVec2, to: DVec2, point: DVec2) -> Nearest {
    let side = hull.sides()[0];
    let along = side.normal.perp();
    if (point - from).dot(along) < 0.0 {
        return distance_to(hull, Feature::Corner(0), point);
    }
    if (point - to).dot(along) > 0.0 {
        return distance_to(hull, Feature::Corner(1), point);
    }
    // Measured from one and the same end, so that both sides agree to the last bit.
    let height = side.normal.dot(point - from);
    if height >= 0.0 {
        Nearest { distance: height, normal: side.normal, feature: Feature::Side(0) }
    } else {
        Nearest { distance: -height, normal: -side.normal, feature: Feature::Side(1) }
    }
}

fn nearest_on_polygon(hull: &Hull, point: DVec2) -> Nearest {
    let (corners, sides) = (hull.corners(), hull.sides());
    let heights = || {
        let both = sides.iter().zip(corners).enumerate();
        both.map(|(index, (side, corner))| (index, side, side.normal.dot(point - *corner)))
    };
    let (index, distance) = highest(heights().map(|(index, _, height)| (index, height)));
    if distance <= 0.0 {
        if !hull.outline().is_empty() {
            return nearest_on_outline(hull, point);
        }
        let outer = highest(heights().filter(|(_, side, _)| !side.inner).map(|(index, _, height)| (index, height)));
        let (index, distance) = if outer.1 > f64::NEG_INFINITY { outer } else { (index, distance) };
        return Nearest { distance, normal: sides[index].normal, feature: Feature::Side(index) };
    }
    let side = sides[index];
    let along = side.normal.perp();
    let next = if index + 1 == corners.len() { 0 } else { index + 1 };
    if (point - corners[index]).dot(along) < 0.0 {
        distance_to(hull, Feature::Corner(index), point)
    } else if (point - corners[next]).dot(along) > 0.0 {
        distance_to(hull, Feature::Corner(next), point)
    } else {
        Nearest { distance, normal: side.normal, feature: Feature::Side(index) }
    }
}

/// The first of the highest, with its height; index 0 and minus infinity for an empty list.
#[inline(always)]
fn highest(among: impl Iterator<Item = (usize, f64)>) -> (usize, f64) {
    among.fold((0, f64::NEG_INFINITY), |best, found| if found.1 > best.1 { found } else { best })
}

/// Both ends of a side of the outline of the whole polygon.
fn outline_side(hull: &Hull, index: usize) -> (DVec2, DVec2) {
    let outline = hull.outline();
    (outline[index], outline[(index + 1) % outline.len()])
}

/// The nearest place of the outline of the whole polygon to a point inside it.
fn nearest_on_outline(hull: &Hull, point: DVec2) -> Nearest {
    let mut best = (f64::INFINITY, Feature::OutlineSide(0));
    for index in 0..hull.outline().len() {
        let (from, to) = outline_side(hull, index);
        let (along, length) = direction(to - from);
        let way = (point - from).dot(along);
        // The end of a side is the beginning of the next one.
        let (square, feature) = if way < 0.0 {
            (point.distance_squared(from), Feature::OutlineCorner(index))
        } else if way <= length {
            (along.perp_dot(point - from).powi(2), Feature::OutlineSide(index))
        } else {
            continue;
        };
        if square < best.0 {
            best = (square, feature);
        }
    }
    // On a corner itself no direction leads to it.
    match best {
        (0.0, Feature::OutlineCorner(index)) => distance_to(hull, Feature::OutlineSide(index), point),
        (_, feature) => distance_to(hull, feature, point),
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// Strictly convex corners on an ellipse, turned by an angle.
    fn hull(angles: &[f64], height: f64, turn: f64) -> Option<Hull> {
        let mut angles = angles.to_vec();
        angles.sort_by(f64::total_cmp);
        let turned = DVec2::new(libm::cos(turn), libm::sin(turn));
        let corners: Vec<DVec2> =
            angles.iter().map(|a| turned.rotate(DVec2::new(libm::cos(*a), height * libm::sin(*a)))).collect();
        match corners.len() {
            1 => Hull::disc(corners[0], 0.0).ok(),
            2 => Hull::capsule(corners[0], corners[1], 0.0).ok(),
            _ => Hull::polygon(&corners, 0.0).ok().map(|(hull, _)| hull),
        }
    }

    /// The distance by definition: to all sides as segments; negative if the point lies under all of them.
    fn by_definition(hull: &Hull, point: DVec2) -> f64 {
        let least = (0..hull.sides().len().max(1))
            .map(|side| {
                let (from, to) =
                    if hull.sides().is_empty() { (hull.corners()[0], hull.corners()[0]) } else { hull.ends(side) };
                let span = to - from;
                let share = (point - from).dot(span) / span.length_squared().max(f64::MIN_POSITIVE);
                point.distance(from + span * share.clamp(0.0, 1.0))
            })
            .fold(f64::INFINITY, f64::min);
        let inside = hull.corners().len() > 2
            && (0..hull.sides().len()).all(|side| distance_to(hull, Feature::Side(side), point).distance <= 0.0);
        if inside { -least } else { least }
    }

    proptest! {
        #![proptest_config(crate::cases(1, 2000))]

        /// Law: the distance is the least one to all places of the outline, signed. Source: definition. Tolerance:
        /// products of numbers near 4 round. At flat angles the rounding of a normal acts over the distance.
        #[test]
        fn the_distance_is_the_least_to_all_sides(
            angles in prop::collection::vec(0.0..std::f64::consts::TAU, 1..9),
            height in 0.01..1.0, turn in 0.0..6.0, x in -3.0..3.0, y in -3.0..3.0,
        ) {
            let Some(hull) = hull(&angles, height, turn) else { return Ok(()) };
            let point = DVec2::new(x, y);
            let found = nearest(&hull, point);
            prop_assert!((found.distance - by_definition(&hull, point)).abs() < 64.0 * f64::EPSILON, "{hull:?} {found:?}");
            prop_assert!((found.normal.length() - 1.0).abs() < 4.0 * f64::EPSILON);
            // A step along the normal is the steepest way out.
            let step = 1e-4;
            let farther = nearest(&hull, point + found.normal * step);
            prop_assert!(farther.distance >= found.distance - 64.0 * f64::EPSILON);
            prop_assert!(found.distance < 0.0 || (farther.distance - found.distance - step).abs() < 1e-14);
        }

        /// Law: outside, distance and normal have no jumps. Distance changes by no more than the path. The normal turns
        /// by no more than twice the path over the distance, because the point may come nearer.
        #[test]
        fn distance_and_normal_are_continuous_outside(
            angles in prop::collection::vec(0.0..std::f64::consts::TAU, 1..9),
            height in 0.01..1.0, x in -3.0..3.0, y in -3.0..3.0, toward in 0.0..6.0,
        ) {
            let Some(hull) = hull(&angles, height, 0.3) else { return Ok(()) };
            let (point, step) = (DVec2::new(x, y), 1e-6);
            let (here, there) = (nearest(&hull, point), nearest(&hull, point + step * DVec2::new(libm::cos(toward), libm::sin(toward))));
            prop_assert!((here.distance - there.distance).abs() <= step + 64.0 * f64::EPSILON);
            if here.distance > 2.0 * step {
                prop_assert!((here.normal - there.normal).length() <= 2.0 * step / here.distance + 1e-9);
            }
        }

        /// Law: the quick check of a point omits no near point, and no point within a core. Tolerance: rounding of
        /// both.
        #[test]
        fn what_is_near_may_be_near(
            angles in prop::collection::vec(0.0..std::f64::consts::TAU, 1..9),
            x in -3.0..3.0, y in -3.0..3.0, distance in 0.0..2.0,
        ) {
            let Some(hull) = hull(&angles, 0.7, 0.3) else { return Ok(()) };
            let (point, rounding) = (DVec2::new(x, y), 64.0 * f64::EPSILON);
            let found = nearest(&hull, point);
            let may_be = may_be_nearer(&hull, point, distance);
            prop_assert!(may_be || found.distance > distance - rounding);
            // Over a side it is exact.
            prop_assert!(!may_be || !found.feature.is_side() || found.distance < distance + rounding);
        }

        /// Law: the frozen distance of the nearest feature is the distance itself.
        #[test]
        fn the_frozen_feature_gives_the_same_distance(
            angles in prop::collection::vec(0.0..std::f64::consts::TAU, 1..9), x in -3.0..3.0, y in -3.0..3.0,
        ) {
            let Some(hull) = hull(&angles, 0.7, 0.0) else { return Ok(()) };
            let found = nearest(&hull, DVec2::new(x, y));
            let frozen = distance_to(&hull, found.feature, DVec2::new(x, y));
            prop_assert_eq!(found.feature, frozen.feature);
            prop_assert!((found.distance - frozen.distance).abs() < 16.0 * f64::EPSILON);
            prop_assert!((found.normal - frozen.normal).length() < 4.0 * f64::EPSILON);
        }
    }

    fn square() -> Hull {
        let corners = [(0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0)].map(|(x, y)| DVec2::new(x, y));
        Hull::polygon(&corners, 0.0).unwrap().0
    }

    #[test]
    fn ties_go_to_the_lowest_index() {
        assert_eq!(nearest(&square(), DVec2::ONE).feature, Feature::Side(0));
        assert_eq!(nearest(&square(), DVec2::splat(2.0)).feature, Feature::Side(1));
        let disc = Hull::disc(DVec2::ONE, 1.0).unwrap();
        assert_eq!(
            nearest(&disc, DVec2::ONE),
            Nearest { distance: 0.0, normal: DVec2::Y, feature: Feature::Corner(0) }
        );
        let segment = Hull::capsule(DVec2::ZERO, DVec2::X, 1.0).unwrap();
        assert_eq!(nearest(&segment, DVec2::X).feature, Feature::Side(0));
    }

    /// A point close under a cut is pushed out through the nearest side of the outline.
    #[test]
    fn no_normal_inside_points_through_a_cut() {
        let mut cut = square();
        cut.set_inner(1, true);
        let found = nearest(&cut, DVec2::new(1.9, 1.5));
        assert_eq!((found.feature, found.distance), (Feature::Side(2), -0.5));
        // Beyond the cut the side is still the nearest, and it is marked as inner.
        let beyond = nearest(&cut, DVec2::new(2.25, 1.5));
        assert_eq!((beyond.feature, beyond.distance), (Feature::Side(1), 0.25));
        assert!(!cut.owns(&beyond) && cut.owns(&nearest(&cut, DVec2::new(2.25, 2.5))));
    }
}
