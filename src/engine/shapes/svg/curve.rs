//! Flattening of curves: the curves of a drawing, and the chords that approximate them.
//!
//! Let a chord span a share `h` of a curve `p(s)`, `0 <= s <= 1`. It is nowhere farther from the curve than `h^2/8
//! max|p''|` (remainder of linear interpolation). So `sqrt(max|p''|/(8 tolerance))` chords are enough. For a Bezier
//! curve of degree `d`, `|p''|` is at most `d (d - 1)` times the largest second difference of its points. The source is
//! Farin, Curves and Surfaces for CAGD, section 5.3. Lengths are in units of the drawing.

use std::f64::consts::{PI, TAU};

use glam::{DMat2, DVec2};

/// A map of the plane: turned, stretched and sheared by a matrix, then moved.
#[derive(Clone, Copy, Debug)]
pub(super) struct Affine {
    pub matrix: DMat2,
    pub shift: DVec2,
}

impl Affine {
    pub const IDENTITY: Self = Self { matrix: DMat2::IDENTITY, shift: DVec2::ZERO };

    pub fn of(self, at: DVec2) -> DVec2 {
        self.matrix * at + self.shift
    }

    /// First `inner`, then this one.
    pub fn after(self, inner: Self) -> Self {
        Self { matrix: self.matrix * inner.matrix, shift: self.of(inner.shift) }
    }
}

/// One curve, from one end to the other.
#[derive(Clone, Debug)]
pub(super) enum Curve {
    /// A Bezier curve by its points: two of a line, up to four.
    Bezier(Vec<DVec2>),
    /// An arc of an ellipse: centre, two conjugate half axes, the parameter at its beginning and its growth, in rad.
    Arc { center: DVec2, axes: DMat2, from: f64, turn: f64, end: DVec2 },
}

impl Curve {
    pub fn line(from: DVec2, to: DVec2) -> Self {
        Self::Bezier(vec![from, to])
    }

    /// The arc between two points on an ellipse with two half axes. The first axis is turned by `tilt` rad; `large` and
    /// `sweep` are the flags of a drawing. An ellipse that is too small grows (SVG 1.1, appendix F.6).
    pub fn arc(from: DVec2, to: DVec2, radii: DVec2, tilt: f64, (large, sweep): (bool, bool)) -> Self {
        let radii = radii.abs();
        if radii.x == 0.0 || radii.y == 0.0 || from == to {
            return Self::line(from, to);
        }
        let (sin, cos) = libm::sincos(tilt);
        let axes = DMat2::from_cols(DVec2::new(cos, sin) * radii.x, DVec2::new(-sin, cos) * radii.y);
        let back = axes.inverse();
        // In the frame in which the ellipse is a circle of radius 1.
        let half = back * ((to - from) / 2.0);
        let grown = half.length().max(1.0);
        let (axes, half) = (axes * grown, half / grown);
        let away = (1.0 - half.length_squared()).max(0.0).sqrt() / half.length();
        let side = if large == sweep { -away } else { away };
        let center = half + half.perp() * side;
        let angle = |at: DVec2| libm::atan2(at.y, at.x);
        let (start, end) = (angle(-center), angle(2.0 * half - center));
        let turn = match (end - start, sweep) {
            (turn, true) if turn < 0.0 => turn + TAU,
            (turn, false) if turn > 0.0 => turn - TAU,
            (turn, _) => turn,
        };
        Self::Arc { center: from + axes * center, axes, from: start, turn, end: to }
    }

    /// Its end.
    pub fn end(&self) -> DVec2 {
        match self {
            Self::Bezier(points) => points.last().copied().unwrap_or_default(),
            Self::Arc { end, .. } => *end,
        }
    }

    /// The place after a share of the way.
    fn at(&self, share: f64) -> DVec2 {
        match self {
            Self::Bezier(points) => {
                let mut points = points.clone();
                while points.len() > 1 {
                    points = points.windows(2).map(|two| two[0] * (1.0 - share) + two[1] * share).collect();
                }
                points.first().copied().unwrap_or_default()
            }
            Self::Arc { center, axes, from, turn, .. } => {
                let (sin, cos) = libm::sincos(from + turn * share);
                *center + *axes * DVec2::new(cos, sin)
            }
        }
    }

    /// A bound of the second derivative by the share of the way.
    fn bend(&self) -> f64 {
        match self {
            Self::Bezier(points) => {
                let degree = points.len() as f64 - 1.0;
                let second = |three: &[DVec2]| (three[0] - 2.0 * three[1] + three[2]).length();
                degree * (degree - 1.0) * points.windows(3).map(second).fold(0.0, f64::max)
            }
            Self::Arc { axes, turn, .. } => {
                // The longer half axis, from the greater eigenvalue of the squares.
                let (a, b, c) =
                    (axes.x_axis.length_squared(), axes.x_axis.dot(axes.y_axis), axes.y_axis.length_squared());
                let longest = (0.5 * (a + c + ((a - c) * (a - c) + 4.0 * b * b).sqrt())).sqrt();
                turn * turn * longest
            }
        }
    }

    /// The number of chords that stay within a tolerance of it. Each chord of an arc turns by at most a third of a
    /// round.
    pub fn chords(&self, tolerance: f64) -> usize {
        let least = if let Self::Arc { turn, .. } = self { (turn.abs() * 1.5 / PI).ceil().max(1.0) } else { 1.0 };
        // Rounding of a straight curve's points is no bend.
        (self.bend() / (8.0 * tolerance)).sqrt().ceil().max(least) as usize
    }

    /// The ends of `chords` chords, without the beginning of the curve.
    pub fn ends(&self, chords: usize) -> impl Iterator<Item = DVec2> {
        let between = (1..chords).map(move |chord| self.at(chord as f64 / chords as f64));
        between.chain(std::iter::once(self.end()))
    }

    /// The same in another frame.
    pub fn mapped(&self, map: Affine) -> Self {
        match self {
            Self::Bezier(points) => Self::Bezier(points.iter().map(|point| map.of(*point)).collect()),
            Self::Arc { center, axes, from, turn, end } => Self::Arc {
                center: map.of(*center),
                axes: map.matrix * *axes,
                from: *from,
                turn: *turn,
                end: map.of(*end),
            },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn farthest(curve: &Curve, from: DVec2, chords: usize) -> f64 {
        let mut corners = vec![from];
        corners.extend(curve.ends(chords));
        let from_chord = |at: DVec2, two: &[DVec2]| {
            let along = two[1] - two[0];
            let share = ((at - two[0]).dot(along) / along.length_squared()).clamp(0.0, 1.0);
            at.distance(two[0] + along * share)
        };
        let from_chords = |at: DVec2| corners.windows(2).map(|two| from_chord(at, two)).fold(f64::INFINITY, f64::min);
        (0..=1000).map(|step| from_chords(curve.at(f64::from(step) / 1000.0))).fold(0.0, f64::max)
    }

    /// Law: chords stay within the tolerance. For one arc and half a chord more than needed the bound is sharp to 0.15
    /// of it.
    #[test]
    fn chords_stay_within_the_tolerance() {
        let start = DVec2::new(-1.0, 0.5);
        let curves = [
            Curve::Bezier(vec![start, DVec2::new(3.0, 4.0), DVec2::new(-2.0, -5.0), DVec2::new(2.0, 1.0)]),
            Curve::Bezier(vec![start, DVec2::new(0.0, 2.0), DVec2::new(2.0, 1.0)]),
            Curve::arc(start, DVec2::new(2.0, 1.0), DVec2::new(2.0, 1.0), 0.4, (true, false)),
            Curve::arc(start, DVec2::new(-1.0, -0.5), DVec2::new(0.5, 0.5), 0.0, (false, true)),
        ];
        for curve in curves {
            for tolerance in [0.1, 1e-3, 1e-5] {
                let found = farthest(&curve, start, curve.chords(tolerance));
                assert!(found <= tolerance, "{curve:?}: {found} of {tolerance}");
            }
        }
        let round = Curve::arc(DVec2::X, -DVec2::X, DVec2::ONE, 0.0, (false, true));
        let found = farthest(&round, DVec2::X, round.chords(1e-4));
        assert!(found > 0.85e-4, "{found}");
    }

    /// Law: an arc begins and ends at the given points and lies on its ellipse. Its flags give its direction and
    /// length. Tolerance: roundings of numbers near 1.
    #[test]
    fn arcs_follow_their_flags() {
        let (from, to) = (DVec2::X, DVec2::Y);
        for (flags, middle) in [
            ((false, true), DVec2::ONE / 2.0_f64.sqrt()),
            ((true, false), -DVec2::ONE / 2.0_f64.sqrt()),
            ((false, false), DVec2::ONE - DVec2::ONE / 2.0_f64.sqrt()),
            ((true, true), DVec2::ONE + DVec2::ONE / 2.0_f64.sqrt()),
        ] {
            let arc = Curve::arc(from, to, DVec2::ONE, 0.3, flags);
            assert!(arc.at(0.0).distance(from) < 1e-15 && arc.at(1.0).distance(to) < 1e-15, "{arc:?}");
            assert!(arc.at(0.5).distance(middle) < 1e-15, "{flags:?}: {}", arc.at(0.5));
        }
        let grown = Curve::arc(DVec2::ZERO, DVec2::new(4.0, 0.0), DVec2::new(1.0, 0.5), 0.0, (false, true));
        assert!(grown.at(0.5).distance(DVec2::new(2.0, -1.0)) < 1e-15, "{}", grown.at(0.5));
    }
}
