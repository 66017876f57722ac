//! Rounding of sharp corners: the sides move inwards by a radius, and the hull is grown by it.
//!
//! The sides keep their lines and only lose their ends: each corner becomes an arc that touches both sides. Lengths are
//! in metres.

use glam::DVec2;
use serde::{Deserialize, Serialize};

use crate::hull::{Hull, direction};

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
        if self.radius() > 0.0 || self.corners().len() < 3 {
            return None;
        }
        let whole = Ring::of_outline(self).unwrap_or_else(|| Ring::of_hull(self));
        let radius = whole.largest(radius);
        let inset = whole.inset(radius);
        let place = |corner: &DVec2| inset[whole.corners.iter().position(|other| other == corner)?];
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
        let outline = if self.outline().is_empty() { Vec::new() } else { inset.into_iter().collect::<Option<_>>()? };
        Some(Rounded { hull: self.with_corners(corners, outline, radius), spread })
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

    #[test]
    fn what_is_round_already_stays() {
        let disc = Hull::disc(DVec2::ZERO, 0.0).unwrap();
        let round = Hull::polygon(&[DVec2::ZERO, DVec2::X, DVec2::Y], 0.1).unwrap().0;
        assert!(disc.rounded(0.1).is_none() && round.rounded(0.1).is_none());
    }
}
