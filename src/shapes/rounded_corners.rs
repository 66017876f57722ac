//! Rounding of sharp corners: the sides move inwards by a radius, and the hull is grown by it.
//!
//! The sides keep their lines and only lose their ends: each corner becomes an arc that touches both sides. Lengths are
//! in metres.

use std::collections::BTreeMap;
use std::sync::Arc;

use glam::DVec2;
use serde::{Deserialize, Serialize};

use crate::hull::{Hull, bits, direction};

/// The least share of its length that a side keeps.
const KEPT: f64 = 0.5;

/// A hull with its corners rounded off. Corners and sides have the same indices as those of the sharp hull.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Rounded {
    /// It lies within the sharp hull.
    pub hull: Hull,
    /// No place of an arc is farther in metres from its sharp corner.
    pub spread: f64,
}

impl Hull {
    /// The hull with sharp corners rounded off by a radius in metres. The radius is smaller if a side would lose more
    /// than half of its length. Cuts between parts stay in place.
    ///
    /// `None` if it is round, or has fewer than three corners. Also `None` if a corner of the outline begins at a cut
    /// for which no outline is known.
    pub fn rounded(&self, radius: f64) -> Option<Rounded> {
        Self::all_rounded(std::slice::from_ref(self), radius).pop()?
    }

    /// The same of each hull, in their order. The parts of a polygon share its new outline.
    pub fn all_rounded(hulls: &[Self], radius: f64) -> Vec<Option<Rounded>> {
        let mut last = None::<Inset>;
        hulls.iter().map(|hull| hull.rounded_beside(radius, &mut last)).collect()
    }

    fn rounded_beside(&self, radius: f64, last: &mut Option<Inset>) -> Option<Rounded> {
        if self.radius() > 0.0 || self.corners().len() < 3 {
            return None;
        }
        let known = last.take().filter(|inset| inset.is_of(self));
        let inset = last.insert(known.unwrap_or_else(|| Inset::of(self, radius)));
        let radius = inset.radius;
        let place = |corner: &DVec2| inset.corners.get(&bits(*corner)).copied()?;
        let corners: Vec<DVec2> = self.corners().iter().map(place).collect::<Option<_>>()?;
        let is_cut = |corner: usize| {
            let before = (corner + corners.len() - 1) % corners.len();
            self.sides()[corner].inner || self.sides()[before].inner
        };
        if self.outline().is_empty() && (0..corners.len()).any(|corner| is_cut(corner) && self.probes(corner)) {
            return None;
        }
        let way = |corner: usize| (corners[corner], corners[(corner + 1) % corners.len()]);
        let turns = |corner: usize| {
            let ((a, b), (_, c)) = (way(corner), way((corner + 1) % corners.len()));
            (b - a).perp_dot(c - b) > 0.0
        };
        if !(0..corners.len()).all(turns) {
            return None;
        }
        let moved = self.corners().iter().zip(&corners).map(|(sharp, round)| sharp.distance(*round));
        let spread = moved.fold(0.0, f64::max) + radius;
        let outline = inset.outline.clone()?;
        Some(Rounded { hull: self.with_corners(corners, outline, radius), spread })
    }
}

/// An outline whose sides have moved inwards.
struct Inset {
    /// The outline before; empty if it is that of one hull.
    before: Arc<[DVec2]>,
    /// By how much they have moved, in metres.
    radius: f64,
    /// The new place of each corner before. `None`: its sides are parallel.
    corners: BTreeMap<[u64; 2], Option<DVec2>>,
    /// The new outline of the concave polygon, empty if there is none. `None` if a corner has no place.
    outline: Option<Arc<[DVec2]>>,
}

impl Inset {
    /// Of the outline of which the hull is a part, or of the hull.
    fn of(hull: &Hull, radius: f64) -> Self {
        let part_of = Ring::of_outline(hull);
        let is_part = part_of.is_some();
        let whole = part_of.unwrap_or_else(|| Ring::of_hull(hull));
        let radius = whole.largest(radius);
        let inset = whole.inset(radius);
        let outline = if is_part { inset.iter().copied().collect() } else { Some(Arc::default()) };
        let corners = whole.corners.iter().map(|corner| bits(*corner)).zip(inset).collect();
        Self { before: hull.shared_outline(), radius, corners, outline }
    }

    fn is_of(&self, hull: &Hull) -> bool {
        !self.before.is_empty() && Arc::ptr_eq(&self.before, &hull.shared_outline())
    }
}

/// The corners of an outline, counter-clockwise, with its sides.
struct Ring {
    corners: Vec<DVec2>,
    /// Unit normals outwards, and by which share of the radius each side moves inwards.
    sides: Vec<(DVec2, f64)>,
}

impl Ring {
    /// The outline of the concave polygon of which the hull is a part, if there is one.
    fn of_outline(hull: &Hull) -> Option<Self> {
        let corners = hull.outline().to_vec();
        let next = |index: usize| corners[(index + 1) % corners.len()];
        let normal = |index: usize| (-direction(next(index) - corners[index]).0.perp(), 1.0);
        let sides = (0..corners.len()).map(normal).collect();
        (!corners.is_empty()).then_some(Self { sides, corners })
    }

    fn of_hull(hull: &Hull) -> Self {
        let sides = hull.sides().iter().map(|side| (side.normal, if side.inner { 0.0 } else { 1.0 })).collect();
        Self { corners: hull.corners().to_vec(), sides }
    }

    fn before(&self, corner: usize) -> usize {
        (corner + self.corners.len() - 1) % self.corners.len()
    }

    /// The shift of a corner for each metre of the radius, up to the crossing of the moved sides. `None` if those are
    /// parallel.
    fn shift(&self, corner: usize) -> Option<DVec2> {
        let ((first, by_first), (second, by_second)) = (self.sides[self.before(corner)], self.sides[corner]);
        let sine = first.perp_dot(second);
        let shift = (second.perp() * by_first - first.perp() * by_second) / sine;
        shift.is_finite().then_some(shift)
    }

    /// The radius, or as much of it as leaves each side its share of its length.
    fn largest(&self, radius: f64) -> f64 {
        let count = self.corners.len();
        (0..count).fold(radius, |least, side| {
            let next = (side + 1) % count;
            let (Some(from), Some(to)) = (self.shift(side), self.shift(next)) else { return least };
            let (along, length) = direction(self.corners[next] - self.corners[side]);
            let lost = (from - to).dot(along);
            if lost > 0.0 { least.min((1.0 - KEPT) * length / lost) } else { least }
        })
    }

    fn inset(&self, radius: f64) -> Vec<Option<DVec2>> {
        (0..self.corners.len()).map(|corner| Some(self.corners[corner] + self.shift(corner)? * radius)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::nearest;

    fn polygon(points: &[(f64, f64)]) -> Hull {
        let points: Vec<DVec2> = points.iter().map(|(x, y)| DVec2::new(*x, *y)).collect();
        Hull::polygon(&points, 0.0).unwrap().0
    }

    /// The lines of the sides stay. So the middle of each side is equally far from the round hull and the sharp one.
    /// Tolerance: rounding.
    #[test]
    fn sides_stay_and_corners_come_nearer() {
        for hull in
            [polygon(&[(0.0, 0.0), (2.0, 0.0), (2.0, 1.0), (0.0, 1.0)]), polygon(&[(0.0, 0.0), (3.0, 0.0), (0.4, 1.0)])]
        {
            let Rounded { hull: round, spread } = hull.rounded(0.02).unwrap();
            assert_eq!(round.radius(), 0.02);
            for side in 0..hull.sides().len() {
                let (from, to) = hull.ends(side);
                let out = (from + to) / 2.0 + hull.sides()[side].normal * 0.3;
                let found = nearest(&round, out);
                assert!((found.distance - round.radius() - 0.3).abs() < 1e-15, "side {side}: {found:?}");
                let corner = nearest(&round, from).distance - round.radius();
                assert!(corner > 0.0 && corner <= spread, "corner {side}: {corner} of {spread}");
            }
        }
    }

    #[test]
    fn a_short_side_keeps_half_of_its_length() {
        let hull = polygon(&[(0.0, 0.0), (1.0, 0.0), (1.0, 0.99), (0.99, 1.0), (0.0, 1.0)]);
        let round = hull.rounded(0.1).unwrap().hull;
        let lengths = round.sides().iter().zip(hull.sides()).map(|(round, sharp)| round.length / sharp.length);
        let least = lengths.fold(f64::INFINITY, f64::min);
        assert!((least - KEPT).abs() < 1e-12 && round.radius() < 0.1, "{least} {}", round.radius());
    }

    /// One outline for each part would take memory that grows with the square of the corners.
    #[test]
    fn parts_of_a_polygon_share_one_outline_wherever_they_go() {
        let points: Vec<DVec2> = (0..12)
            .map(|index| DVec2::from_angle(f64::from(index) * 0.5) * if index % 2 == 0 { 1.0 } else { 0.5 })
            .collect();
        let parts = crate::convex_parts::hulls(&points, 0.0);
        let moved = Hull::all_moved(&parts, DVec2::new(0.3, -0.1));
        let turned = Hull::all_turned(&moved, 0.7);
        let rounded = Hull::all_rounded(&turned, 0.01).into_iter().map(|rounded| rounded.unwrap().hull).collect();
        for hulls in [parts.clone(), moved.clone(), turned.clone(), rounded] {
            assert!(hulls.len() > 2 && hulls.iter().all(|hull| hull.outline().len() == points.len()));
            let first = hulls[0].shared_outline();
            assert!(hulls.iter().all(|hull| Arc::ptr_eq(&first, &hull.shared_outline())));
        }
        for ((before, moved), turned) in parts.iter().zip(&moved).zip(&turned) {
            assert_eq!(*moved, before.moved(DVec2::new(0.3, -0.1)));
            assert_eq!(*turned, moved.turned(0.7));
            assert_eq!(turned.rounded(0.01), Hull::all_rounded(std::slice::from_ref(turned), 0.01)[0]);
        }
    }

    #[test]
    fn what_is_round_already_stays() {
        let disc = Hull::disc(DVec2::ZERO, 0.0).unwrap();
        let round = Hull::polygon(&[DVec2::ZERO, DVec2::X, DVec2::Y], 0.1).unwrap().0;
        assert!(disc.rounded(0.1).is_none() && round.rounded(0.1).is_none());
    }
}
