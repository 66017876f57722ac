//! The rounded convex hull: the convex hull of 1 to N corners, grown by a radius. It is the one geometry of all shapes.
//!
//! The *core* is the convex hull of the corners c_i. With radius r the hull is the set of points at most r from the
//! core. One corner makes a disc. Two make a capsule, a segment with two sides, back and forth. More make a rounded
//! polygon. Side i runs from corner i to the next corner. Corners run counter-clockwise, so that the outside lies right
//! of each side. Lengths are in metres.

use std::collections::BTreeMap;
use std::sync::Arc;

use glam::DVec2;
use serde::{Deserialize, Serialize};

use crate::error::{Mended, ShapeError};
use crate::orientation::orientation;

/// Coordinates lie below this, in metres: their fourth power, which second moments of area need, stays finite.
pub(crate) const LARGEST: f64 = 1e75;

/// Sides are longer than this, in metres: the fourth power of their length stays a normal number.
pub(crate) const LEAST: f64 = 1e-75;

/// One side of a core.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct HullSide {
    /// Unit normal, outwards.
    pub normal: DVec2,
    /// Length in metres.
    pub length: f64,
    /// Whether the side is a cut between two parts of one shape, or lies inside their union.
    pub inner: bool,
}

/// The outward directions in which a corner lies on the outline of its shape. No other part of the shape does so there.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Free {
    /// All directions between the normals of its sides.
    Whole,
    /// Counter-clockwise from the first unit normal to the second.
    Between(DVec2, DVec2),
    /// All of them, as the end of a side. The outline bends inwards there, and continues at another part. Such a corner
    /// by itself touches nothing. A body that rolls out of the hollow leaves the side at its end, without a jump of the
    /// force.
    Hollow,
    /// No direction: the corner lies inside, or belongs to another part.
    Nowhere,
}

impl Free {
    /// Whether an outward direction belongs to the corner, given that no side of its hull is nearer.
    #[inline]
    pub fn holds(&self, direction: DVec2) -> bool {
        match self {
            Self::Whole | Self::Hollow => true,
            Self::Between(from, to) => from.perp_dot(direction) >= 0.0 && direction.perp_dot(*to) >= 0.0,
            Self::Nowhere => false,
        }
    }
}

/// The convex hull of its corners, grown by a radius.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Hull {
    corners: Vec<DVec2>,
    sides: Vec<HullSide>,
    free: Vec<Free>,
    /// The parts of one polygon share it.
    outline: Arc<[DVec2]>,
    radius: f64,
}

/// Outlines made of others. Parts of one polygon share their outline before, and so they do afterwards.
#[derive(Default)]
pub(crate) struct SharedOutlines {
    /// That of a hull, and the one made of it.
    last: Option<[Arc<[DVec2]>; 2]>,
}

impl SharedOutlines {
    /// The outline that `make` makes of that of a hull. `make` is called once for neighbours in a list that share theirs.
    pub(crate) fn of(&mut self, hull: &Hull, make: impl FnOnce(&[DVec2]) -> Vec<DVec2>) -> Arc<[DVec2]> {
        match &self.last {
            Some([from, to]) if Arc::ptr_eq(from, &hull.outline) => to.clone(),
            _ => {
                let to: Arc<[DVec2]> = make(&hull.outline).into();
                self.last = Some([hull.outline.clone(), to.clone()]);
                to
            }
        }
    }
}

impl Hull {
    /// A disc. `center` and `radius` are in metres; a radius of zero makes a point.
    ///
    /// # Errors
    /// Numbers that are NaN, infinite or out of range; a radius below zero.
    pub fn disc(center: DVec2, radius: f64) -> Result<Self, ShapeError> {
        check_points(&[center], "a coordinate of the center")?;
        check_radius(radius)?;
        Ok(Self::of_corners(vec![center], radius))
    }

    /// All points at most `radius` from the segment between two points, in metres. A radius of zero makes a segment.
    ///
    /// # Errors
    /// Numbers that are NaN, infinite or out of range; a radius below zero; coinciding ends.
    pub fn capsule(from: DVec2, to: DVec2, radius: f64) -> Result<Self, ShapeError> {
        check_points(&[from, to], "a coordinate of an end")?;
        check_radius(radius)?;
        check_sides(&[from, to])?;
        Ok(Self::of_corners(vec![from, to], radius))
    }

    /// A convex polygon grown by `radius`, both in metres, and the corrections. A clockwise order is reversed, and
    /// points exactly on a straight side are left out.
    ///
    /// # Errors
    /// Numbers that are NaN, infinite or out of range. A radius below zero. Fewer than three points. Two coinciding
    /// neighbours. An area of zero. An outline that bends inwards or runs round more than once.
    pub fn polygon(points: &[DVec2], radius: f64) -> Result<(Self, Vec<Mended>), ShapeError> {
        check_points(points, "a coordinate of a point")?;
        check_radius(radius)?;
        let (kept, mut mended) = without_straight(points)?;
        let turns: Vec<f64> = around(&kept).map(|[a, b, c]| orientation(points[a], points[b], points[c])).collect();
        // The polygon has the sign of most corners. In a convex outline all corners have it.
        let left = turns.iter().filter(|turn| **turn > 0.0).count();
        let clockwise = 2 * left < turns.len();
        if let Some(bad) = turns.iter().position(|turn| (*turn < 0.0) != clockwise) {
            return Err(ShapeError::NotConvex { point: kept[bad] });
        }
        // An outline that bends one way only has one lowest point for each time that it runs round.
        let lowest = around(&kept).filter(|&[a, b, c]| {
            let key = |index: usize| (points[index].y, points[index].x);
            key(b) < key(a) && key(b) < key(c)
        });
        if let Some([_, second, _]) = lowest.skip(1).last() {
            return Err(ShapeError::NotConvex { point: second });
        }
        let mut corners: Vec<DVec2> = kept.iter().map(|index| points[*index]).collect();
        if clockwise {
            corners.reverse();
            mended.insert(0, Mended::Turned);
        }
        Ok((Self::of_corners(corners, radius), mended))
    }

    /// A hull of corners that are known to be strictly convex and counter-clockwise.
    pub(crate) fn of_corners(corners: Vec<DVec2>, radius: f64) -> Self {
        let count = corners.len();
        let sides = match count {
            1 => Vec::new(),
            _ => (0..count)
                .map(|index| {
                    let (along, length) = direction(corners[(index + 1) % count] - corners[index]);
                    HullSide { normal: -along.perp(), length, inner: false }
                })
                .collect(),
        };
        Self { sides, free: vec![Free::Whole; count], outline: Arc::default(), corners, radius }
    }

    /// The corners of the core, counter-clockwise, in metres.
    #[inline]
    pub fn corners(&self) -> &[DVec2] {
        &self.corners
    }

    /// The sides of the core: none of a disc, two of a capsule, else one for each corner. Side i begins at corner i.
    #[inline]
    pub fn sides(&self) -> &[HullSide] {
        &self.sides
    }

    /// By how much the core is grown, in metres.
    #[inline]
    pub fn radius(&self) -> f64 {
        self.radius
    }

    /// The core of the concave polygon of which the hull is a part, counter-clockwise, in metres. Empty for other
    /// hulls.
    #[inline]
    pub fn outline(&self) -> &[DVec2] {
        &self.outline
    }

    /// The same, as the parts of one polygon share it.
    pub(crate) fn shared_outline(&self) -> Arc<[DVec2]> {
        self.outline.clone()
    }

    /// Says of which concave polygon the hull is a part.
    pub(crate) fn set_outline(&mut self, outline: Arc<[DVec2]>) {
        self.outline = outline;
    }

    /// The same corners, sides and outline, at other places, in metres.
    pub(crate) fn with_corners(&self, corners: Vec<DVec2>, outline: Arc<[DVec2]>, radius: f64) -> Self {
        let mut moved = Self { free: self.free.clone(), outline, ..Self::of_corners(corners, radius) };
        moved.sides.iter_mut().zip(&self.sides).for_each(|(side, old)| side.inner = old.inner);
        moved
    }

    /// Both ends of a side, in metres.
    pub fn ends(&self, side: usize) -> (DVec2, DVec2) {
        (self.corners[side], self.corners[(side + 1) % self.corners.len()])
    }

    /// Whether a corner is a convex vertex of the outline of its shape. If so, contacts check it against other shapes.
    /// If several parts of a shape share the vertex, one of them owns it.
    #[inline]
    pub fn probes(&self, corner: usize) -> bool {
        !matches!(self.free[corner], Free::Nowhere | Free::Hollow)
    }

    /// The directions in which a corner lies on the outline of its shape.
    #[inline]
    pub fn free(&self, corner: usize) -> Free {
        self.free[corner]
    }

    /// Says whether a side is a cut, or lies inside the union of the parts.
    pub fn set_inner(&mut self, side: usize, inner: bool) {
        self.sides[side].inner = inner;
    }

    /// Says in which directions a corner is the outline of its shape.
    pub fn set_free(&mut self, corner: usize, free: Free) {
        self.free[corner] = free;
    }

    /// The same hull, moved by so many metres.
    #[must_use]
    pub fn moved(&self, by: DVec2) -> Self {
        self.moved_beside(by, &mut SharedOutlines::default())
    }

    /// Hulls moved by so many metres, in their order.
    pub fn all_moved(hulls: &[Self], by: DVec2) -> Vec<Self> {
        let mut shared = SharedOutlines::default();
        hulls.iter().map(|hull| hull.moved_beside(by, &mut shared)).collect()
    }

    fn moved_beside(&self, by: DVec2, shared: &mut SharedOutlines) -> Self {
        let outline = shared.of(self, |outline| outline.iter().map(|corner| *corner + by).collect());
        let mut moved = Self { outline, ..self.clone() };
        moved.corners.iter_mut().for_each(|corner| *corner += by);
        moved
    }

    /// The same hull, turned about the origin by an angle in radians, counter-clockwise.
    #[must_use]
    pub fn turned(&self, angle: f64) -> Self {
        self.turned_beside(angle, &mut SharedOutlines::default())
    }

    /// Hulls turned about the origin by an angle in radians, counter-clockwise, in their order.
    pub fn all_turned(hulls: &[Self], angle: f64) -> Vec<Self> {
        let mut shared = SharedOutlines::default();
        hulls.iter().map(|hull| hull.turned_beside(angle, &mut shared)).collect()
    }

    fn turned_beside(&self, angle: f64, shared: &mut SharedOutlines) -> Self {
        let (sin, cos) = libm::sincos(angle);
        let turn = |direction: DVec2| DVec2::new(cos, sin).rotate(direction);
        let outline = shared.of(self, |outline| outline.iter().map(|corner| turn(*corner)).collect());
        let mut turned = Self { outline, ..self.clone() };
        turned.corners.iter_mut().for_each(|corner| *corner = turn(*corner));
        turned.sides.iter_mut().for_each(|side| side.normal = turn(side.normal));
        for free in &mut turned.free {
            if let Free::Between(from, to) = *free {
                *free = Free::Between(turn(from), turn(to));
            }
        }
        turned
    }

    /// Half of the least width of the hull in metres; for a disc or a capsule its radius. For a part of a concave
    /// polygon it is half the polygon's thickness behind the sides of the part. If the part has no side of the outline,
    /// all sides count.
    pub fn half_width(&self) -> f64 {
        self.half_width_by(&mut Thicknesses::default())
    }

    /// The half widths of hulls, in their order. Parts of one polygon share the thicknesses of its outline.
    pub fn half_widths(hulls: &[Self]) -> Vec<f64> {
        let mut known = Thicknesses::default();
        hulls.iter().map(|hull| hull.half_width_by(&mut known)).collect()
    }

    fn half_width_by(&self, known: &mut Thicknesses) -> f64 {
        known.begin(&self.outline);
        let least = |widths: &mut dyn Iterator<Item = f64>| widths.fold(f64::INFINITY, f64::min);
        let outer = self.corners.iter().zip(&self.sides).filter(|(_, side)| !side.inner);
        let own: Vec<usize> = outer.filter_map(|(corner, _)| known.places.get(&bits(*corner)).copied()).collect();
        let across = |side: &HullSide| {
            let heights = self.corners.iter().map(|corner| side.normal.dot(*corner));
            let (low, high) = heights
                .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), height| (low.min(height), high.max(height)));
            high - low
        };
        let width = match (self.outline.is_empty(), self.corners.len()) {
            (true, 1 | 2) => 0.0,
            (true, _) => least(&mut self.sides.iter().map(across)),
            _ if !own.is_empty() => least(&mut own.into_iter().map(|index| known.of(self, index))),
            _ => match known.least {
                Some(least) => least,
                None => *known.least.insert(least(&mut (0..self.outline.len()).map(|index| self.thickness(index)))),
            },
        };
        0.5 * width + self.radius
    }

    /// The thickness of the whole concave polygon's core behind the middle of a side of its outline, in metres.
    pub fn thickness(&self, side: usize) -> f64 {
        #[cfg(test)]
        crate::work::count();
        let (outline, count) = (&self.outline, self.outline.len());
        let ends = |index: usize| (outline[index % count], outline[(index + 1) % count]);
        let (from, to) = ends(side);
        let (middle, inwards) = ((from + to) / 2.0, direction(to - from).0.perp());
        let hit = |index: usize| {
            let (a, b) = ends(index);
            let [left, right] = [a, b].map(|end| inwards.perp_dot(end - middle));
            let height = inwards.dot(a - middle) + (inwards.dot(b - a)) * (left / (left - right));
            ((left < 0.0) != (right < 0.0) && height > 0.0).then_some(height)
        };
        (side + 1..side + count).filter_map(hit).fold(f64::INFINITY, f64::min)
    }

    /// The distance of the farthest corner from a place, in metres. The radius does not count.
    pub fn reach_of_core(&self, from: DVec2) -> f64 {
        self.corners.iter().map(|corner| corner.distance(from)).fold(0.0, f64::max)
    }
}

/// The bits of a place, by which it is found.
pub(crate) fn bits(point: DVec2) -> [u64; 2] {
    [point.x.to_bits(), point.y.to_bits()]
}

/// The thicknesses of an outline that were asked for.
#[derive(Default)]
struct Thicknesses {
    outline: Vec<DVec2>,
    /// The index of each of its points.
    places: BTreeMap<[u64; 2], usize>,
    of_side: Vec<Option<f64>>,
    /// The least one of all.
    least: Option<f64>,
}

impl Thicknesses {
    /// Begins anew with another outline.
    fn begin(&mut self, outline: &[DVec2]) {
        if self.outline != outline {
            let places = outline.iter().enumerate().map(|(index, point)| (bits(*point), index)).collect();
            *self = Self { outline: outline.to_vec(), places, of_side: vec![None; outline.len()], least: None };
        }
    }

    fn of(&mut self, hull: &Hull, side: usize) -> f64 {
        *self.of_side[side].get_or_insert_with(|| hull.thickness(side))
    }
}

/// Unit vector and length. The square of a length within the admitted range is a normal number.
pub(crate) fn direction(vector: DVec2) -> (DVec2, f64) {
    let length = vector.length();
    (vector / length, length)
}

/// Each index of a ring with the one before and the one after it.
pub(crate) fn around(ring: &[usize]) -> impl Iterator<Item = [usize; 3]> {
    let count = ring.len();
    (0..count).map(move |at| [ring[(at + count - 1) % count], ring[at], ring[(at + 1) % count]])
}

/// The indices of points that are corners, and the others, which lie exactly on straight sides.
///
/// # Errors
/// Too few points, neighbours at one place, a side that runs back over its neighbour, all points on one line.
pub(crate) fn without_straight(points: &[DVec2]) -> Result<(Vec<usize>, Vec<Mended>), ShapeError> {
    let count = points.len();
    if count < 3 {
        return Err(ShapeError::TooFewPoints { found: count });
    }
    check_sides(points)?;
    let all: Vec<usize> = (0..count).collect();
    if all.iter().all(|index| orientation(points[0], points[1], points[*index]) == 0.0) {
        return Err(ShapeError::ZeroArea);
    }
    let (mut kept, mut mended) = (Vec::new(), Vec::new());
    for [a, b, c] in around(&all) {
        if orientation(points[a], points[b], points[c]) != 0.0 {
            kept.push(b);
        } else if (points[b] - points[a]).dot(points[c] - points[b]) < 0.0 {
            return Err(ShapeError::SelfCrossing { first: a, second: b, at: points[b] });
        } else {
            mended.push(Mended::Straight { point: b });
        }
    }
    Ok((kept, mended))
}

/// # Errors
/// An error for the first number that is NaN, infinite or too large.
pub(crate) fn check_points(points: &[DVec2], quantity: &'static str) -> Result<(), ShapeError> {
    points.iter().flat_map(|point| point.to_array()).try_for_each(|number| check_number(number, quantity))
}

/// # Errors
/// An error for a number that is NaN, infinite or too large.
pub(crate) fn check_number(number: f64, quantity: &'static str) -> Result<(), ShapeError> {
    if !number.is_finite() {
        return Err(ShapeError::NotFinite { quantity });
    }
    if number.abs() > LARGEST {
        return Err(ShapeError::OutOfRange { quantity, found: number });
    }
    Ok(())
}

/// # Errors
/// A number of sides or teeth that is too small or too large.
pub(crate) fn check_count(quantity: &'static str, found: usize, least: usize, most: usize) -> Result<(), ShapeError> {
    if found < least {
        return Err(ShapeError::TooFew { quantity, found, least });
    }
    if found > most {
        return Err(ShapeError::TooMany { quantity, found, most });
    }
    Ok(())
}

/// # Errors
/// An error for a radius that is NaN, infinite, below zero, or out of range.
pub(crate) fn check_radius(radius: f64) -> Result<(), ShapeError> {
    check_number(radius, "the radius")?;
    if radius < 0.0 {
        return Err(ShapeError::Negative { quantity: "the radius", found: radius });
    }
    if radius > 0.0 && radius < LEAST {
        return Err(ShapeError::OutOfRange { quantity: "the radius", found: radius });
    }
    Ok(())
}

/// # Errors
/// Neighbours in the ring that are at one place, or so near that powers of their distance underflow.
fn check_sides(points: &[DVec2]) -> Result<(), ShapeError> {
    let count = points.len();
    for index in 0..count {
        let next = (index + 1) % count;
        if points[index] == points[next] {
            return Err(ShapeError::EqualPoints { first: index.min(next), second: index.max(next) });
        }
        let length = direction(points[next] - points[index]).1;
        if length < LEAST {
            return Err(ShapeError::OutOfRange { quantity: "the length of a side", found: length });
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn points(list: &[(f64, f64)]) -> Vec<DVec2> {
        list.iter().map(|(x, y)| DVec2::new(*x, *y)).collect()
    }

    #[test]
    fn normals_of_a_square_point_outwards_whatever_its_order() {
        let mut corners = points(&[(0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0)]);
        for clockwise in [false, true] {
            if clockwise {
                corners.reverse();
            }
            let (hull, mended) = Hull::polygon(&corners, 0.1).unwrap();
            assert_eq!(mended.contains(&Mended::Turned), clockwise);
            for (index, side) in hull.sides().iter().enumerate() {
                assert_eq!(side.length, 2.0);
                assert_eq!(side.normal.dot(DVec2::ONE - hull.corners()[index]), -1.0, "{index}");
            }
        }
    }

    #[test]
    fn points_exactly_on_a_side_are_left_out_and_said() {
        let (hull, mended) = Hull::polygon(&points(&[(0.0, 0.0), (1.0, 0.0), (3.0, 0.0), (0.0, 3.0)]), 0.0).unwrap();
        assert_eq!(hull.corners().len(), 3);
        assert_eq!(mended, [Mended::Straight { point: 1 }]);
        // One unit in the last place outwards is a corner, however flat.
        let flat = points(&[(0.0, 0.0), (1.0, -1e-300), (3.0, 0.0), (0.0, 3.0)]);
        assert_eq!(Hull::polygon(&flat, 0.0).unwrap().0.corners().len(), 4);
    }

    /// Behind the side of a spike lies its other side. Its depth there is the tangent of the angle, 3/4, times half the
    /// side. Tolerance: a few operations round.
    #[test]
    fn a_spike_is_as_thick_as_its_other_side_is_near() {
        let star = points(&[
            (0.2, 0.0),
            (0.05, 0.05),
            (0.0, 0.2),
            (-0.05, 0.05),
            (-0.2, 0.0),
            (-0.05, -0.05),
            (0.0, -0.2),
            (0.05, -0.05),
        ]);
        let half_side = 0.5 * 0.025_f64.sqrt();
        for hull in crate::convex_parts::hulls(&star, 0.0) {
            (0..star.len()).for_each(|side| assert!((hull.thickness(side) - 0.75 * half_side).abs() < 1e-15));
        }
    }

    #[test]
    fn a_capsule_has_two_sides_back_and_forth() {
        let hull = Hull::capsule(DVec2::ZERO, DVec2::new(4.0, 0.0), 0.0).unwrap();
        assert_eq!(hull.sides()[0].normal, -DVec2::Y);
        assert_eq!(hull.sides()[1].normal, DVec2::Y);
        assert_eq!(hull.ends(1), (DVec2::new(4.0, 0.0), DVec2::ZERO));
        assert_eq!(hull.reach_of_core(DVec2::X), 3.0);
    }

    #[test]
    fn each_error_names_what_is_wrong() {
        let polygon = |list: &[(f64, f64)]| Hull::polygon(&points(list), 0.0).unwrap_err();
        assert_eq!(polygon(&[(0.0, 0.0), (1.0, 0.0)]), ShapeError::TooFewPoints { found: 2 });
        assert_eq!(polygon(&[(0.0, 0.0), (1.0, 1.0), (2.0, 2.0)]), ShapeError::ZeroArea);
        let equal = polygon(&[(0.0, 0.0), (1.0, 0.0), (1.0, 0.0), (0.0, 1.0)]);
        assert_eq!(equal, ShapeError::EqualPoints { first: 1, second: 2 });
        let spike = polygon(&[(0.0, 0.0), (2.0, 0.0), (1.0, 0.0), (0.0, 1.0)]);
        assert_eq!(spike, ShapeError::SelfCrossing { first: 0, second: 1, at: DVec2::new(2.0, 0.0) });
        let dart = polygon(&[(0.0, 0.0), (1.0, 0.0), (0.2, 0.2), (0.0, 1.0)]);
        assert_eq!(dart, ShapeError::NotConvex { point: 2 });
        // A pentagram bends one way at all points and still is not convex.
        let star: Vec<(f64, f64)> = [0, 2, 4, 1, 3]
            .map(|k: i32| f64::from(k) * 0.4 * std::f64::consts::PI)
            .map(|angle| (libm::cos(angle), libm::sin(angle)))
            .to_vec();
        assert!(matches!(polygon(&star), ShapeError::NotConvex { .. }));
        assert!(matches!(Hull::disc(DVec2::NAN, 1.0), Err(ShapeError::NotFinite { .. })));
        assert!(matches!(Hull::disc(DVec2::ZERO, -1.0), Err(ShapeError::Negative { .. })));
        assert!(matches!(Hull::disc(DVec2::X * 1e80, 1.0), Err(ShapeError::OutOfRange { .. })));
        assert!(matches!(Hull::capsule(DVec2::X, DVec2::X, 1.0), Err(ShapeError::EqualPoints { .. })));
    }

    #[test]
    fn tiny_and_huge_hulls_have_unit_normals() {
        for size in [2e-75, 1.0, 1e74] {
            let corners = points(&[(0.0, 0.0), (size, 0.0), (0.0, size)]);
            let (hull, _) = Hull::polygon(&corners, 0.0).unwrap();
            // A square root and a division round, and so do the squares.
            assert!(hull.sides().iter().all(|side| (side.normal.length() - 1.0).abs() < 4.0 * f64::EPSILON), "{size}");
        }
    }
}
