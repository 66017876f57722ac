//! Sides and corners of a compound that lie on its outline.
//!
//! A side is inner if its boundary lies in other hulls. A corner probes if the union bends outwards there. A round
//! corner does so if a part of its arc is free. If several hulls have the same corner, their outward normals must have
//! a range of directions in common. In that range the hull of lowest index owns the corner. A sharp corner on or in
//! another hull does not probe. Boundaries nearer than a tie count as one ([`crate::moments`]).

use glam::DVec2;

use crate::boundary::Piece;
use crate::box_tree::BoxTree;
use crate::half_planes::not_well_below;
use crate::hull::{Free, Hull};
use crate::moments::{free_boundary, middle, thick, tie};
use crate::nearest::nearest;
use crate::pose::{BoundingBox, Pose};

/// Whether more than `most` pairs of hulls of one body lie so near each other that their boxes touch.
pub fn has_more_near_pairs(hulls: &[&Hull], most: usize) -> bool {
    let bounds = |hull: &&Hull| BoundingBox::of(hull, &Pose::default());
    let boxes = BoxTree::new(hulls.iter().map(bounds));
    let mut pairs = 0;
    // Places that are not finite touch nothing, not even themselves.
    hulls.iter().enumerate().any(|(own, hull)| {
        pairs += boxes.touching(&bounds(hull)).into_iter().filter(|other| *other > own).count();
        pairs > most
    })
}

/// Marks the inner sides of the hulls of one body. Marks the corners too that are not convex vertices of its outline.
pub fn mark_inner(hulls: &mut [Hull]) {
    if hulls.len() < 2 {
        return;
    }
    let (middle, tie) = (middle(hulls), tie(hulls));
    let (ranks, parts): (Vec<usize>, Vec<Hull>) = Hull::all_moved(hulls, -middle)
        .iter()
        .enumerate()
        .filter_map(|(rank, hull)| thick(hull, tie).map(|part| (rank, part)))
        .unzip();
    let size = parts.iter().map(|part| part.reach_of_core(DVec2::ZERO) + part.radius()).fold(0.0, f64::max);
    for (part, pieces) in free_boundary(&parts, tie).into_iter().enumerate() {
        let hull = &mut hulls[ranks[part]];
        let (mut side, mut corner) = (0, 0);
        for (piece, free) in pieces {
            let left = free.iter().map(|(from, to)| to - from).fold(0.0, f64::max);
            // At a touching point of curves, a tie leaves sqrt(2 tie r) free on each side. Rounding leaves less than
            // that again.
            let crumb = |radius: f64| 4.0 * libm::sqrt(2.0 * tie * radius);
            match piece {
                Piece::Straight(_) => {
                    if left <= crumb(size) {
                        hull.set_inner(side, true);
                    }
                    side += 1;
                }
                Piece::Arc(arc) => {
                    if left * arc.radius <= crumb(arc.radius) {
                        hull.set_free(corner, Free::Nowhere);
                    }
                    corner += 1;
                }
            }
        }
    }
    let normals: Vec<Hull> = ranks.iter().map(|rank| hulls[*rank].clone()).collect();
    let boxes = BoxTree::new(parts.iter().map(|hull| BoundingBox::of(hull, &Pose::default()).grown(4.0 * tie)));
    for (part, hull) in normals.iter().enumerate() {
        for corner in (0..hull.corners().len()).filter(|corner| hull.probes(*corner)) {
            hulls[ranks[part]].set_free(corner, free(&parts, &boxes, &normals, (part, corner), tie));
        }
    }
}

/// The directions in which a corner of a hull lies on the outline. Other hulls may have the same corner, or hold a
/// sharp one.
///
/// Places are those of `parts`, whose numbers are small; normals are those of the hulls themselves.
fn free(parts: &[Hull], boxes: &BoxTree, normals: &[Hull], (own, corner): (usize, usize), tie: f64) -> Free {
    let (place, radius) = (parts[own].corners()[corner], parts[own].radius());
    let cone = Cone::at(&normals[own], corner);
    let mut free = Free::Whole;
    let (mut from, mut to) = (0.0, cone.as_ref().map_or(0.0, Cone::span));
    for rank in boxes.touching(&BoundingBox { low: place, high: place }).into_iter().filter(|rank| *rank != own) {
        #[cfg(test)]
        crate::work::count();
        let other = &parts[rank];
        if is_apart(other, place, other.radius() + 4.0 * tie) {
            continue;
        }
        let gap = nearest(other, place).distance - other.radius();
        let corners = other.corners().iter();
        let alike = (other.radius() - radius).abs() <= tie;
        let same =
            corners.enumerate().find(|(_, corner)| alike && corner.distance(place) <= tie).map(|(index, _)| index);
        let Some(same) = same else {
            // A sharp corner on a side of another hull bends inwards, or not at all.
            if radius == 0.0 && gap <= tie {
                return Free::Nowhere;
            }
            continue;
        };
        if rank < own {
            return Free::Nowhere;
        }
        let (Some(cone), Some(met)) = (&cone, Cone::at(&normals[rank], same)) else { continue };
        let (start, end) = (cone.angle(met.from), cone.angle(met.from) + met.span());
        if start > from {
            (from, free) = (start, Free::Between(met.from, last(free, cone)));
        }
        if end < to {
            (to, free) = (end, Free::Between(first(free, cone), met.to));
        }
        // A tie at the end of the shortest side turns its normal by so much.
        if to - from <= 4.0 * tie / cone.shortest.min(met.shortest) {
            return Free::Nowhere;
        }
    }
    free
}

/// Whether a place lies above the line of a side by more than a distance in metres. If so, it is farther from the core.
fn is_apart(hull: &Hull, place: DVec2, distance: f64) -> bool {
    let mut is_apart = false;
    not_well_below(hull, &[place], distance, &mut |side| {
        is_apart = hull.sides()[side].normal.dot(place - hull.corners()[side]) > distance;
        !is_apart
    });
    is_apart
}

/// The first direction of a range within a cone.
fn first(free: Free, cone: &Cone) -> DVec2 {
    if let Free::Between(from, _) = free { from } else { cone.from }
}

/// The last one.
fn last(free: Free, cone: &Cone) -> DVec2 {
    if let Free::Between(_, to) = free { to } else { cone.to }
}

/// The outward normals at a corner, between the normals of the sides before and after it.
struct Cone {
    from: DVec2,
    to: DVec2,
    /// Length of the shorter of both sides, in metres.
    shortest: f64,
}

impl Cone {
    /// The cone of a corner; a disc has none.
    fn at(hull: &Hull, corner: usize) -> Option<Self> {
        let (sides, count) = (hull.sides(), hull.sides().len());
        let after = sides.get(corner)?;
        let before = &sides[(corner + count - 1) % count];
        Some(Self { from: before.normal, to: after.normal, shortest: before.length.min(after.length) })
    }

    /// The angle that it spans.
    fn span(&self) -> f64 {
        // That of a capsule is half a turn, with either sign.
        self.angle(self.to).abs()
    }

    /// The angle from the first normal to a direction, from -pi to pi.
    fn angle(&self, direction: DVec2) -> f64 {
        libm::atan2(self.from.perp_dot(direction), self.from.dot(direction))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shape::{Shape, capsule, compound, disc, polygon, rectangle};

    fn inner(shape: &Shape) -> Vec<Vec<usize>> {
        let of = |hull: &Hull| (0..hull.sides().len()).filter(|side| hull.sides()[*side].inner).collect();
        shape.hulls.iter().map(of).collect()
    }

    fn probes(shape: &Shape) -> Vec<Vec<usize>> {
        let of = |hull: &Hull| (0..hull.corners().len()).filter(|corner| hull.probes(*corner)).collect();
        shape.hulls.iter().map(of).collect()
    }

    fn at(shape: Shape, x: f64, y: f64) -> Shape {
        shape.moved(DVec2::new(x, y))
    }

    /// Sides 0 to 3 of a rectangle: below, right, above, left. Corners 0 to 3: from below left, counter-clockwise.
    #[test]
    fn boxes_side_by_side_have_four_vertices_and_no_wall_between_them() {
        let unit = || rectangle(1.0, 1.0, 0.0).unwrap();
        let row = compound(&[at(unit(), 0.1, 0.3), at(unit(), 1.1, 0.3)]).unwrap();
        assert_eq!(inner(&row), [vec![1], vec![3]]);
        assert_eq!(probes(&row), [vec![0, 3], vec![1, 2]]);
        // Half a step higher: the sides are partly free, and the corners in the middle of sides do not probe.
        let stair = compound(&[at(unit(), 0.0, 0.0), at(unit(), 1.0, 0.5)]).unwrap();
        assert_eq!(inner(&stair), [Vec::<usize>::new(), vec![]]);
        assert_eq!(probes(&stair), [vec![0, 1, 3], vec![1, 2, 3]]);
    }

    #[test]
    fn the_same_hull_twice_counts_once() {
        for rounding in [0.0, 0.2] {
            let unit = rectangle(1.0, 1.0, rounding).unwrap();
            let twice = compound(&[unit.clone(), unit]).unwrap();
            assert_eq!(inner(&twice), [vec![], vec![0, 1, 2, 3]]);
            assert_eq!(probes(&twice), [vec![0, 1, 2, 3], vec![]]);
        }
    }

    #[test]
    fn a_disc_inside_a_box_probes_nothing_and_one_across_a_corner_hides_it() {
        let unit = || rectangle(1.0, 1.0, 0.0).unwrap();
        let inside = compound(&[disc(DVec2::ZERO, 0.5).unwrap(), unit()]).unwrap();
        assert_eq!(probes(&inside), [vec![], vec![0, 1, 2, 3]]);
        let across = compound(&[unit(), disc(DVec2::new(0.5, 0.5), 0.1).unwrap()]).unwrap();
        assert_eq!(probes(&across), [vec![0, 1, 3], vec![0]]);
    }

    #[test]
    fn a_chain_of_capsules_probes_at_its_ends_and_at_its_bend() {
        let bar = |from: (f64, f64), to: (f64, f64)| capsule(from.into(), to.into(), 0.1).unwrap();
        let straight = compound(&[bar((0.0, 0.0), (1.0, 0.0)), bar((1.0, 0.0), (2.0, 0.0))]).unwrap();
        assert_eq!(probes(&straight), [vec![0], vec![1]]);
        let bent = compound(&[bar((0.0, 0.0), (1.0, 0.0)), bar((1.0, 0.0), (1.0, 1.0))]).unwrap();
        assert_eq!(probes(&bent), [vec![0, 1], vec![1]]);
    }

    /// Law: marks by topology after a cut equal marks by geometry. If a rounded or sharp bracket is marked again, only its hollow
    /// changes. Parts of a compound may overlap, so none of their corners is known to end a side in a hollow.
    #[test]
    fn marks_of_a_cut_polygon_are_those_of_its_geometry() {
        let bracket =
            [(0.0, 0.0), (3.0, 0.2), (3.0, 1.0), (1.0, 1.0), (1.1, 2.0), (0.0, 2.0)].map(|(x, y)| DVec2::new(x, y));
        for rounding in [0.0, 0.1] {
            let cut = polygon(&bracket, rounding).unwrap();
            let mut hulls = cut.hulls.clone();
            for hull in &mut hulls {
                (0..hull.sides().len()).for_each(|side| hull.set_inner(side, false));
                (0..hull.corners().len()).for_each(|corner| hull.set_free(corner, Free::Whole));
            }
            mark_inner(&mut hulls);
            let (mut known, mut hollows) = (cut.hulls, 0);
            for hull in &mut known {
                for corner in 0..hull.corners().len() {
                    if hull.free(corner) == Free::Hollow {
                        hull.set_free(corner, Free::Nowhere);
                        hollows += 1;
                    }
                }
            }
            assert_eq!((hulls, hollows), (known, 2), "{rounding}");
        }
    }
}
