//! The covered part of a piece of boundary: its stretches that lie in another hull.
//!
//! A hull is the union of its core, a strip along each side, and a disc about each corner. A segment meets a strip
//! along one stretch. An arc at height h above a line passes below it at angles with sin^2(t/2) = gap / 2r. The gap is
//! that between the line and the top of the circle. Formulas in gaps, not in cosines, keep all digits where curves
//! touch.
//!
//! **Ties.** Two boundaries may run along each other: boxes side by side, a hull given twice. Rounding must not decide
//! there. Boundaries nearer than `tie` count as one. If their normals are opposite, both are covered. If their normals
//! agree, the boundary of the hull of lower index is free, and the other is covered. Both sides of a pair reach the
//! same result, because both work from the same number. Boundaries that cross at an angle whose sine is above 1/64 have
//! no ties. Rounding is 1/64 of a tie, and moves their crossing by less than one tie.

use std::f64::consts::{PI, TAU};

use glam::DVec2;

use crate::boundary::{Arc, Piece, Straight};
use crate::half_planes::not_well_below;
use crate::hull::Hull;
use crate::pose::BoundingBox;

/// Stretches of a piece, from and to, counted as its places are.
pub(crate) type Spans = Vec<(f64, f64)>;

/// A hull by its rank among those united.
#[derive(Clone, Copy)]
pub(crate) struct Ranked<'a> {
    pub hull: &'a Hull,
    pub rank: usize,
}

/// Adds the stretches of a piece of the hull of rank `own` that lie in another hull.
pub(crate) fn add_covered(piece: &Piece, own: usize, other: Ranked, tie: f64, covered: &mut Spans) {
    let hull = other.hull;
    let line = |side: usize| {
        let (corner, side) = (hull.corners()[side], hull.sides()[side]);
        Straight { corner, normal: side.normal, radius: hull.radius(), length: side.length }
    };
    let ranks = Ranks { own, other: other.rank, tie };
    // A half-plane that holds the piece by more than ties leaves all of it over.
    let in_all = |meets: &dyn Fn(&Straight) -> Spans| {
        let mut left = vec![(0.0, piece.extent())];
        let (places, radius) = piece.frame();
        not_well_below(hull, &places, radius + 4.0 * tie, &mut |side| {
            left = meet(&left, &meets(&line(side)));
            !left.is_empty()
        });
        left
    };
    if hull.radius() == 0.0 {
        covered.extend(in_all(&|line| below(piece, line, ranks)));
        return;
    }
    if hull.corners().len() > 2 {
        covered.extend(in_all(&|line| within(piece, -line.normal, -line.normal.dot(line.corner))));
    }
    let near = piece.bounds().grown(hull.radius() + tie / STEEP);
    for line in (0..hull.sides().len()).map(line) {
        let end = line.corner + line.along() * line.length;
        if !near.touches(&BoundingBox { low: line.corner.min(end), high: line.corner.max(end) }) {
            continue;
        }
        let (along, start) = (line.along(), line.along().dot(line.corner));
        // A strip reaches into the core by a tie, so that no crack is left between them.
        let floor = within(piece, line.normal, line.normal.dot(line.corner) - tie);
        let ends = meet(&within(piece, along, start), &within(piece, -along, -start - line.length));
        covered.extend(meet(&meet(&floor, &ends), &below(piece, &line, ranks)));
    }
    let is_near = |center: &&DVec2| near.touches(&BoundingBox { low: **center, high: **center });
    for &center in hull.corners().iter().filter(is_near) {
        covered.extend(in_disc(piece, center, hull.radius(), ranks));
    }
}

/// The stretches of a piece that are left over.
pub(crate) fn free(piece: &Piece, mut covered: Spans) -> Spans {
    covered.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)));
    let (mut free, mut at) = (Vec::new(), 0.0);
    for (from, to) in covered {
        if from > at {
            free.push((at, from));
        }
        at = f64::max(at, to);
    }
    if at < piece.extent() {
        free.push((at, piece.extent()));
    }
    free
}

/// Sine of the angle between boundaries, above which they have no ties.
pub(crate) const STEEP: f64 = 1.0 / 64.0;

/// Whether curves are nearly parallel at their meeting point. `share` is the square of the sine of half the angle
/// between their normals, one of which may be reversed.
fn is_flat(share: f64) -> bool {
    share < STEEP * STEEP / 4.0
}

/// The ranks of two hulls, and by how much boundaries that count as one may differ, in metres.
#[derive(Clone, Copy)]
struct Ranks {
    own: usize,
    other: usize,
    tie: f64,
}

impl Ranks {
    /// By how much the other hull is grown in the verdict, in metres.
    fn growth(&self, flat: bool, opposite: bool) -> f64 {
        match flat {
            false => 0.0,
            true if opposite || self.other < self.own => self.tie,
            true => -self.tie,
        }
    }
}

/// The stretches that two lists have in common.
fn meet(a: &Spans, b: &Spans) -> Spans {
    let both = a.iter().flat_map(|x| b.iter().map(move |y| (x.0.max(y.0), x.1.min(y.1))));
    both.filter(|(from, to)| from < to).collect()
}

/// The stretch of `0..=extent` where `height + slope * place` is not above zero.
fn sunk(height: f64, slope: f64, extent: f64) -> Spans {
    if slope == 0.0 {
        return if height <= 0.0 { vec![(0.0, extent)] } else { Vec::new() };
    }
    let cross = -height / slope;
    if slope > 0.0 { vec![(0.0, cross.min(extent))] } else { vec![(cross.max(0.0), extent)] }
}

/// The spans of a piece with `normal . p >= level`: an edge inside another hull, which needs no ties.
fn within(piece: &Piece, normal: DVec2, level: f64) -> Spans {
    match piece {
        Piece::Straight(side) => sunk(level - normal.dot(side.origin()), -normal.dot(side.along()), side.length),
        Piece::Arc(arc) => {
            let height = normal.dot(arc.center) - level;
            window(arc, normal, half_window((arc.radius + height) / (2.0 * arc.radius)))
        }
    }
}

/// Half of the angle in which sin^2 of half the angle from an axis is less than this share.
fn half_window(share: f64) -> f64 {
    if share <= 0.0 {
        0.0
    } else if share >= 1.0 {
        PI
    } else {
        2.0 * libm::asin(libm::sqrt(share))
    }
}

/// The stretches of an arc at most an angle `half` away from an axis.
fn window(arc: &Arc, axis: DVec2, half: f64) -> Spans {
    if half >= PI {
        return vec![(0.0, arc.angle)];
    }
    let middle = libm::atan2(arc.start.perp_dot(axis), arc.start.dot(axis));
    let turns = [-TAU, 0.0, TAU].map(|turn| ((middle + turn - half).max(0.0), (middle + turn + half).min(arc.angle)));
    turns.into_iter().filter(|(from, to)| from < to).collect()
}

/// The spans of a piece below the moved side of another hull.
fn below(piece: &Piece, line: &Straight, ranks: Ranks) -> Spans {
    #[cfg(test)]
    crate::work::count();
    match piece {
        Piece::Straight(side) => segment_below(side, line, ranks),
        Piece::Arc(arc) => {
            let (gap, opposite) = reach(line, arc.center, arc.radius);
            let growth = ranks.growth(is_flat(gap / (2.0 * arc.radius)), opposite);
            let half = match opposite {
                true => half_window((gap + growth) / (2.0 * arc.radius)),
                false => PI - half_window((gap - growth) / (2.0 * arc.radius)),
            };
            window(arc, -line.normal, half)
        }
    }
}

/// The reach of a circle over a moved side, in metres: upwards, or downwards if the center is above. The second value
/// is true for downwards.
fn reach(line: &Straight, center: DVec2, radius: f64) -> (f64, bool) {
    let height = line.normal.dot(center - line.corner);
    let opposite = height - line.radius > 0.0;
    (if opposite { (line.radius + radius) - height } else { (radius - line.radius) + height }, opposite)
}

/// Both sides of a pair compute the crossing from the side of lower rank. So they cut at the same point even if they
/// are nearly parallel.
fn segment_below(side: &Straight, line: &Straight, ranks: Ranks) -> Spans {
    let opposite = side.normal.dot(line.normal) < 0.0;
    let is_low = ranks.own < ranks.other;
    let (low, high) = if is_low { (side, line) } else { (line, side) };
    let rise = high.normal.dot(low.corner - high.corner) + low.radius * high.normal.dot(low.normal) - high.radius;
    let slope = high.normal.dot(low.along());
    // Seen from the lower rank.
    let height = rise - Ranks { own: 0, other: 1, ..ranks }.growth(slope.abs() < STEEP, opposite);
    if is_low {
        return sunk(height, slope, side.length);
    }
    if slope == 0.0 {
        let covered = (height <= 0.0) == opposite;
        return if covered { vec![(0.0, side.length)] } else { Vec::new() };
    }
    let crossing = low.origin() - low.along() * (height / slope);
    let place = side.along().dot(crossing - side.origin());
    // In the view of the other side, a line falls if the first one rises.
    if slope < 0.0 { vec![(0.0, place.min(side.length))] } else { vec![(place.max(0.0), side.length)] }
}

/// The spans of a piece in a disc of another hull.
fn in_disc(piece: &Piece, center: DVec2, radius: f64, ranks: Ranks) -> Spans {
    match piece {
        Piece::Straight(side) => {
            let (raw, opposite) = reach(side, center, radius);
            let growth = ranks.growth(is_flat(raw / (2.0 * radius)), opposite);
            let (gap, grown) = (raw + growth, radius + growth);
            if gap <= 0.0 {
                return Vec::new();
            }
            let half = libm::sqrt(gap * (2.0 * grown - gap));
            let middle = side.along().dot(center - side.corner);
            let span = ((middle - half).max(0.0), (middle + half).min(side.length));
            if span.0 < span.1 { vec![span] } else { Vec::new() }
        }
        Piece::Arc(arc) => {
            let away = center - arc.center;
            let distance = away.length();
            let opposite = distance * distance > radius * radius + arc.radius * arc.radius;
            // Sides of the triangle of distance and both radii give the angle between both normals.
            let (unequal, both) = ((arc.radius - radius).abs(), arc.radius + radius);
            let room = if opposite {
                (both - distance) * (both + distance)
            } else {
                (distance - unequal) * (distance + unequal)
            };
            let growth = ranks.growth(is_flat(room / (4.0 * arc.radius * radius)), opposite);
            // The difference of the own radius and the grown other one.
            let larger = (arc.radius - radius) - growth;
            if larger + distance <= 0.0 {
                return vec![(0.0, arc.angle)];
            }
            // sin^2 and cos^2 of half the angle at the own center, in that triangle.
            let sine = (both + growth - distance) * (distance - larger);
            let cosine = (larger + distance) * (both + growth + distance);
            if sine <= 0.0 {
                return Vec::new();
            }
            window(arc, away, 2.0 * libm::atan2(libm::sqrt(sine), libm::sqrt(cosine)))
        }
    }
}
