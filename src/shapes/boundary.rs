//! The boundary of a rounded hull as segments and arcs, and the integrals along it that give moments of area.
//!
//! Gauss's theorem turns areas into integrals along a path. The *fan* of a path is the area between it and the origin.
//! With w = p x dp a fan has
//!
//! * area = 1/2 of the integral of w,
//! * first moments = 1/3 of the integral of p w,
//! * polar second moment = 1/4 of the integral of |p|^2 w,
//!
//! and the fans of a closed path sum up to the area within. On an arc p = c + r u, so that w = (r c . u + r^2) dt. All
//! integrals follow from those of 1, u and u u^T. Lengths are in metres.

use std::f64::consts::{PI, TAU};

use glam::DVec2;

use crate::hull::Hull;
use crate::pose::BoundingBox;

/// A side, moved outwards by the radius.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Straight {
    /// The beginning of the side of the core, in metres.
    pub corner: DVec2,
    /// Unit normal outwards.
    pub normal: DVec2,
    /// By how much the side is moved, in metres.
    pub radius: f64,
    /// In metres.
    pub length: f64,
}

impl Straight {
    /// The beginning of the moved side, in metres.
    pub fn origin(&self) -> DVec2 {
        self.corner + self.normal * self.radius
    }

    /// Unit vector along the side.
    pub fn along(&self) -> DVec2 {
        self.normal.perp()
    }
}

/// An arc about a corner, counter-clockwise.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Arc {
    /// In metres.
    pub center: DVec2,
    /// In metres.
    pub radius: f64,
    /// Unit vector from the center to the beginning of the arc.
    pub start: DVec2,
    /// In radians, at most a full turn.
    pub angle: f64,
}

/// A piece of a boundary. Its places are counted along a segment in metres, along an arc in radians.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Piece {
    Straight(Straight),
    Arc(Arc),
}

impl Piece {
    /// The end of the piece: its length in metres or its angle in radians.
    pub fn extent(&self) -> f64 {
        match self {
            Self::Straight(side) => side.length,
            Self::Arc(arc) => arc.angle,
        }
    }

    /// Places, of which none of the piece is farther from the line between them than the radius in metres.
    pub fn frame(&self) -> ([DVec2; 2], f64) {
        match self {
            Self::Straight(side) => ([side.origin(), side.origin() + side.along() * side.length], 0.0),
            Self::Arc(arc) => ([arc.center; 2], arc.radius),
        }
    }

    /// A box that holds the piece.
    pub fn bounds(&self) -> BoundingBox {
        let ([from, to], radius) = self.frame();
        BoundingBox { low: from.min(to), high: from.max(to) }.grown(radius)
    }

    /// The moments of the fan between the origin and a part of the piece.
    pub fn fan(&self, from: f64, to: f64) -> Fan {
        match self {
            Self::Straight(side) => {
                let at = |place: f64| side.origin() + side.along() * place;
                Fan::of_segment(at(from), at(to))
            }
            Self::Arc(arc) => {
                let at = |angle: f64| {
                    let (sin, cos) = libm::sincos(angle);
                    DVec2::new(cos, sin).rotate(arc.start)
                };
                Fan::of_arc(arc.center, arc.radius, [at(from), at(to)], to - from)
            }
        }
    }
}

/// Area in m2, first moments in m3 and polar second moment in m4, about the origin.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Fan {
    pub area: f64,
    pub first: DVec2,
    pub polar: f64,
}

impl std::ops::AddAssign for Fan {
    fn add_assign(&mut self, other: Self) {
        self.area += other.area;
        self.first += other.first;
        self.polar += other.polar;
    }
}

impl Fan {
    fn of_segment(from: DVec2, to: DVec2) -> Self {
        let twice = from.perp_dot(to);
        Self {
            area: twice / 2.0,
            first: (from + to) * (twice / 6.0),
            polar: twice * (from.length_squared() + from.dot(to) + to.length_squared()) / 12.0,
        }
    }

    fn of_arc(c: DVec2, r: f64, [from, to]: [DVec2; 2], angle: f64) -> Self {
        // The integral of u, and that of u u^T, a symmetric matrix, times c.
        let one = -(to - from).perp();
        let difference = (to.x * to.y - from.x * from.y) / 2.0;
        let (xx, yy) = (angle / 2.0 + difference, angle / 2.0 - difference);
        let xy = (to.y - from.y) * (to.y + from.y) / 2.0;
        let two = DVec2::new(xx * c.x + xy * c.y, xy * c.x + yy * c.y);
        let area = r * c.dot(one) + r * r * angle;
        Self {
            area: area / 2.0,
            first: (c * area + (two + one * r) * (r * r)) / 3.0,
            polar: ((c.length_squared() + r * r) * area + 2.0 * r * r * (c.dot(two) + r * c.dot(one))) / 4.0,
        }
    }
}

/// The pieces of the boundary: the sides, and the arcs at the corners if the radius is not zero.
pub(crate) fn pieces(hull: &Hull) -> Vec<Piece> {
    let (corners, sides, radius) = (hull.corners(), hull.sides(), hull.radius());
    let mut pieces = Vec::with_capacity(2 * corners.len());
    for (index, (&corner, side)) in corners.iter().zip(sides).enumerate() {
        if radius > 0.0 {
            let before = sides[(index + sides.len() - 1) % sides.len()].normal;
            let angle = turn(before, side.normal);
            pieces.push(Piece::Arc(Arc { center: corner, radius, start: before, angle }));
        }
        pieces.push(Piece::Straight(Straight { corner, normal: side.normal, radius, length: side.length }));
    }
    if sides.is_empty() {
        pieces.push(Piece::Arc(Arc { center: corners[0], radius, start: DVec2::X, angle: TAU }));
    }
    pieces
}

/// The angle from one normal of a convex outline to the next, from 0 to pi.
fn turn(from: DVec2, to: DVec2) -> f64 {
    let (across, along) = (from.perp_dot(to), from.dot(to));
    // Rounding may give the wrong sign to the exact half turn of a capsule, or to a turn near zero.
    match across > 0.0 {
        true => libm::atan2(across, along),
        false if along < 0.0 => PI,
        false => 0.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Law: the fan of an arc is that of many short segments. Tolerance: the chords of n segments err by angle^3 / 12 /
    /// n^2 times sizes near 4.
    #[test]
    fn the_fan_of_an_arc_is_that_of_its_chords() {
        let arc = Piece::Arc(Arc { center: DVec2::new(1.0, -2.0), radius: 0.7, start: DVec2::Y, angle: 2.5 });
        let (from, to, count) = (0.3, 2.4, 20_000);
        let mut sum = Fan::default();
        for index in 0..count {
            let at = |index: i32| {
                let angle = from + (to - from) * f64::from(index) / f64::from(count) + std::f64::consts::FRAC_PI_2;
                DVec2::new(1.0, -2.0) + 0.7 * DVec2::new(libm::cos(angle), libm::sin(angle))
            };
            sum += Fan::of_segment(at(index), at(index + 1));
        }
        let (fan, tolerance) = (arc.fan(from, to), 4.0 / f64::from(count).powi(2));
        assert!((fan.area - sum.area).abs() < tolerance, "{fan:?} {sum:?}");
        assert!((fan.first - sum.first).length() < tolerance, "{fan:?} {sum:?}");
        assert!((fan.polar - sum.polar).abs() < tolerance, "{fan:?} {sum:?}");
    }

    #[test]
    fn the_arcs_of_a_hull_make_a_full_turn() {
        let corners = [(0.0, 0.0), (3.0, 0.1), (2.0, 2.0)].map(|(x, y)| DVec2::new(x, y));
        for hull in [Hull::polygon(&corners, 0.3).unwrap().0, Hull::capsule(corners[0], corners[1], 0.3).unwrap()] {
            let turned: f64 =
                pieces(&hull).iter().filter(|piece| matches!(piece, Piece::Arc(_))).map(Piece::extent).sum();
            assert!((turned - TAU).abs() < 8.0 * f64::EPSILON);
        }
    }
}
