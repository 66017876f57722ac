//! Decomposition of a simple polygon into convex parts, by ear clipping and the method of Hertel and Mehlhorn.
//!
//! Ears are clipped until triangles are left, because each simple polygon has two ears (Meisters 1975). Then cuts are
//! removed if both their ends stay convex (Hertel and Mehlhorn 1983). The result has at most four times the least
//! possible number of parts. Predicates are exact, so that each part is strictly convex. Each choice takes the lowest
//! index.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use glam::DVec2;

use crate::box_tree::BoxTree;
use crate::hull::{Free, Hull, direction};
use crate::orientation::orientation;
use crate::pose::BoundingBox;
use crate::simple_polygon::convex_corners;

/// The parts as rings of indices, each strictly convex. `corners` is a simple outline, counter-clockwise, without
/// straight corners.
pub(crate) fn convex_parts(corners: &[DVec2]) -> Vec<Vec<usize>> {
    let (parts, cuts) = triangles(corners);
    let mut holders = BTreeMap::new();
    for (number, part) in parts.iter().enumerate() {
        sides_of(part).for_each(|side| {
            holders.insert(side, number);
        });
    }
    let mut parts: Vec<Option<Vec<usize>>> = parts.into_iter().map(Some).collect();
    for (from, to) in cuts {
        let [left, right] = [(from, to), (to, from)].map(|side| holders[&side]);
        let (Some(one), Some(other)) = (&parts[left], &parts[right]) else { continue };
        let merged = merged(one, other, from, to);
        let count = merged.len();
        let turns_left = |index: usize| {
            let at = merged.iter().position(|other| *other == index).expect("an end of the cut");
            let [before, after] = [merged[(at + count - 1) % count], merged[(at + 1) % count]];
            orientation(corners[before], corners[index], corners[after]) > 0.0
        };
        if turns_left(from) && turns_left(to) {
            sides_of(other).for_each(|side| {
                holders.insert(side, left);
            });
            parts[left] = Some(merged);
            parts[right] = None;
        }
    }
    parts.into_iter().flatten().collect()
}

/// The sides of a part, each from one corner to the next.
fn sides_of(part: &[usize]) -> impl Iterator<Item = (usize, usize)> {
    part.iter().copied().zip(part.iter().copied().cycle().skip(1))
}

/// Triangles, and the cuts between them.
fn triangles(corners: &[DVec2]) -> (Vec<Vec<usize>>, Vec<(usize, usize)>) {
    let (mut parts, mut cuts) = (Vec::new(), Vec::new());
    let mut ring = EarRing::new(corners);
    for _ in 3..corners.len() {
        let ear = ring.ears.pop_first().expect("a simple polygon has ears");
        let (before, after) = (ring.before[ear], ring.after[ear]);
        parts.push(vec![before, ear, after]);
        cuts.push((after, before));
        ring.clip(ear);
    }
    parts.push((0..corners.len()).filter(|corner| !ring.is_clipped[*corner]).collect());
    (parts, cuts)
}

/// The corners that are left over, and those of them that are ears.
///
/// The triangle of an ear and its neighbours has an area. It holds no other corner inside or on its edge. At the held corner
/// nearest to the tip, the outline does not bend outwards. So only such corners count. Clipping makes no corner bend inwards. So a triangle waits for one such corner at a time, and looks at each of them once.
struct EarRing<'a> {
    corners: &'a [DVec2],
    before: Vec<usize>,
    after: Vec<usize>,
    is_clipped: Vec<bool>,
    bends_out: Vec<bool>,
    ears: BTreeSet<usize>,
    /// For each corner, those that its triangle may hold and that were not looked at. The next one is the last.
    unseen: Vec<Vec<usize>>,
    /// For each corner, those whose triangles hold it. They are no ears as long as it stays their obstacle.
    waiting: Vec<Vec<usize>>,
    obstacle: Vec<Option<usize>>,
    /// The corners at which the outline does not bend outwards in the beginning.
    others: Vec<usize>,
    tree: BoxTree,
}

impl<'a> EarRing<'a> {
    fn new(corners: &'a [DVec2]) -> Self {
        let count = corners.len();
        let bends_out = convex_corners(corners);
        let others: Vec<usize> = (0..count).filter(|corner| !bends_out[*corner]).collect();
        let tree =
            BoxTree::new(others.iter().map(|corner| BoundingBox { low: corners[*corner], high: corners[*corner] }));
        let mut ring = Self {
            corners,
            before: (0..count).map(|corner| (corner + count - 1) % count).collect(),
            after: (0..count).map(|corner| (corner + 1) % count).collect(),
            is_clipped: vec![false; count],
            bends_out,
            ears: BTreeSet::new(),
            unseen: vec![Vec::new(); count],
            waiting: vec![Vec::new(); count],
            obstacle: vec![None; count],
            others,
            tree,
        };
        (0..count).for_each(|corner| ring.look_anew(corner));
        ring
    }

    fn triangle(&self, corner: usize) -> [usize; 3] {
        [self.before[corner], corner, self.after[corner]]
    }

    /// Looks whether a corner with a new neighbour is an ear.
    fn look_anew(&mut self, corner: usize) {
        self.ears.remove(&corner);
        self.obstacle[corner] = None;
        let triangle = self.triangle(corner);
        let [a, b, c] = triangle.map(|index| self.corners[index]);
        self.unseen[corner].clear();
        if self.bends_out[corner] {
            let bounds = BoundingBox { low: a.min(b).min(c), high: a.max(b).max(c) };
            let near = self.tree.touching(&bounds).into_iter().map(|place| self.others[place]);
            self.unseen[corner] = near.filter(|other| !self.bends_out[*other] && !triangle.contains(other)).collect();
            self.look_on(corner);
        }
    }

    /// Looks at the corners that were not seen, until the triangle holds one.
    fn look_on(&mut self, corner: usize) {
        let [a, b, c] = self.triangle(corner).map(|index| self.corners[index]);
        while let Some(other) = self.unseen[corner].pop() {
            #[cfg(test)]
            crate::work::count();
            let p = self.corners[other];
            let holds = orientation(a, b, p) >= 0.0 && orientation(b, c, p) >= 0.0 && orientation(c, a, p) >= 0.0;
            if holds && !self.bends_out[other] {
                self.waiting[other].push(corner);
                self.obstacle[corner] = Some(other);
                return;
            }
        }
        self.ears.insert(corner);
    }

    /// Takes an ear off.
    fn clip(&mut self, ear: usize) {
        let (before, after) = (self.before[ear], self.after[ear]);
        self.is_clipped[ear] = true;
        (self.after[before], self.before[after]) = (after, before);
        for corner in [before, after] {
            let [a, b, c] = self.triangle(corner).map(|index| self.corners[index]);
            let straightened = !self.bends_out[corner] && orientation(a, b, c) > 0.0;
            self.bends_out[corner] |= straightened;
            self.look_anew(corner);
            if straightened {
                for waiting in std::mem::take(&mut self.waiting[corner]) {
                    if self.obstacle[waiting].take_if(|obstacle| *obstacle == corner).is_some() {
                        self.look_on(waiting);
                    }
                }
            }
        }
    }
}

/// The ring of both parts without the cut, which runs from `from` to `to` in the left one.
fn merged(left: &[usize], right: &[usize], from: usize, to: usize) -> Vec<usize> {
    // From the end of the cut all round to its start.
    let open = |part: &[usize], start: usize| {
        let at = part.iter().position(|index| *index == start).expect("an end of the cut");
        part[at..].iter().chain(&part[..at]).copied().collect::<Vec<usize>>()
    };
    let (mut ring, other) = (open(left, to), open(right, from));
    ring.extend(&other[1..other.len() - 1]);
    ring
}

/// A turn in rad by which an outline may bend inwards and still is straight.
const STRAIGHT: f64 = 1e-9;

/// Whether an outline bends inwards from one outward normal to the next.
fn is_hollow((from, to): (DVec2, DVec2)) -> bool {
    from.perp_dot(to) < -STRAIGHT
}

/// The parts as hulls grown by `radius` in metres. Cuts are inner; each convex corner of the outline probes once.
pub(crate) fn hulls(corners: &[DVec2], radius: f64) -> Vec<Hull> {
    let mut to_probe = convex_corners(corners);
    let count = corners.len();
    let normal = |from: usize, to: usize| -direction(corners[to] - corners[from]).0.perp();
    let of_outline = |index: usize| {
        let [before, after] = [(index + count - 1) % count, (index + 1) % count];
        (normal(before, index), normal(index, after))
    };
    let part_to_hull = |part: Vec<usize>| {
        let mut hull = Hull::of_corners(part.iter().map(|index| corners[*index]).collect(), radius);
        for (at, &index) in part.iter().enumerate() {
            let [before, after] = [part[(at + part.len() - 1) % part.len()], part[(at + 1) % part.len()]];
            let [ends_side, begins_side] = [index == (before + 1) % count, after == (index + 1) % count];
            hull.set_inner(at, !begins_side);
            let normals @ (from, to) = of_outline(index);
            let free = match std::mem::take(&mut to_probe[index]) {
                true if ends_side && begins_side => Free::Whole,
                true => Free::Between(from, to),
                false if is_hollow(normals) && (ends_side || begins_side) => Free::Hollow,
                false => Free::Nowhere,
            };
            hull.set_free(at, free);
        }
        hull
    };
    let mut hulls: Vec<Hull> = convex_parts(corners).into_iter().map(part_to_hull).collect();
    if hulls.len() > 1 {
        let outline: Arc<[DVec2]> = corners.into();
        hulls.iter_mut().for_each(|hull| hull.set_outline(outline.clone()));
    }
    hulls
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::moments::AreaMoments;
    use crate::nearest::{Feature, nearest};
    use crate::simple_polygon::simple;

    fn shoelace(corners: &[DVec2]) -> f64 {
        (0..corners.len()).map(|at| corners[at].perp_dot(corners[(at + 1) % corners.len()])).sum::<f64>() / 2.0
    }

    /// A star-shaped outline: simple by construction.
    fn star(radii: &[f64]) -> Vec<DVec2> {
        let step = std::f64::consts::TAU / radii.len() as f64;
        let corner = |(index, radius): (usize, &f64)| {
            let (sin, cos) = libm::sincos(step * index as f64);
            DVec2::new(cos, sin) * *radius
        };
        radii.iter().enumerate().map(corner).collect()
    }

    proptest! {
        #![proptest_config(crate::cases(5, 500))]

        /// Law: parts are strictly convex, have no area in common and fill the outline. The sum of their areas and the
        /// area of their union both equal the area of the outline. Tolerance: one rounded term below one for each
        /// corner. In the union each cut that leaves a corner at a flat angle may leave a gap in the boundary. The gap
        /// is one tie, 64 units.
        #[test]
        fn convex_parts_fill_the_outline_once(radii in prop::collection::vec(0.1..1.0, 3..24), turn in 0.0..6.0) {
            let turned = DVec2::new(libm::cos(turn), libm::sin(turn));
            let points: Vec<DVec2> = star(&radii).into_iter().map(|p| turned.rotate(p)).collect();
            let (corners, _) = simple(&points).unwrap();
            let hulls = hulls(&corners, 0.0);
            for hull in &hulls {
                prop_assert!(Hull::polygon(hull.corners(), 0.0).is_ok_and(|(_, mended)| mended.is_empty()));
            }
            let (whole, tolerance) = (shoelace(&corners), corners.len() as f64 * 4.0 * f64::EPSILON);
            prop_assert!((hulls.iter().map(|hull| shoelace(hull.corners())).sum::<f64>() - whole).abs() < tolerance);
            prop_assert!((AreaMoments::union_of(&hulls).area - whole).abs() < 16.0 * tolerance);
            // Each convex corner probes once, each side of the outline belongs to one part.
            let probes = hulls.iter().map(|hull| (0..hull.corners().len()).filter(|at| hull.probes(*at)).count()).sum::<usize>();
            prop_assert_eq!(probes, convex_corners(&corners).iter().filter(|convex| **convex).count());
            let outer = hulls.iter().flat_map(Hull::sides).filter(|side| !side.inner).count();
            prop_assert_eq!(outer, corners.len());
        }

        /// Law: one part owns the nearest place of the outline, at its signed distance, whatever the cuts. Source: definition, over all
        /// sides of the outline. Tolerance: products of numbers near 1 round, and normals of short sides.
        #[test]
        fn one_part_owns_the_nearest_place(
            radii in prop::collection::vec(0.1..1.0, 3..24), x in -1.2..1.2, y in -1.2..1.2,
        ) {
            let (corners, _) = simple(&star(&radii)).unwrap();
            let point = DVec2::new(x, y);
            let side = |at: usize| (corners[at], corners[(at + 1) % corners.len()]);
            let from_side = |at: usize| {
                let (from, to) = side(at);
                let share = ((point - from).dot(to - from) / (to - from).length_squared()).clamp(0.0, 1.0);
                point.distance(from + (to - from) * share)
            };
            // A ray to the right crosses the outline an odd number of times from within.
            let crosses = |at: &usize| {
                let (from, to) = side(*at);
                (from.y > y) != (to.y > y) && (orientation(from, to, point) > 0.0) == (to.y > from.y)
            };
            let inside = (0..corners.len()).filter(crosses).count() % 2 == 1;
            let distance = (0..corners.len()).map(from_side).fold(f64::INFINITY, f64::min) * if inside { -1.0 } else { 1.0 };
            let hulls = hulls(&corners, 0.0);
            let found: Vec<_> = hulls.iter().map(|hull| (hull, nearest(hull, point))).filter(|(hull, near)| hull.owns(near)).collect();
            let there = found.iter().filter(|(_, near)| (near.distance - distance).abs() < 1e-12).count();
            prop_assert_eq!(there, 1, "{} {:?}", distance, found);
            prop_assert!(found.iter().all(|(_, near)| near.distance > distance - 1e-12));
            // Seen from an owned corner, a point lies beyond both adjacent sides of the outline. In a hollow it lies
            // beyond the end of one of them.
            for (hull, near) in found {
                let Feature::Corner(corner) = near.feature else { continue };
                let place = hull.corners()[corner];
                let at = corners.iter().position(|other| *other == place).unwrap();
                let (before, after) = (side((at + corners.len() - 1) % corners.len()), side(at));
                let beyond = [(point - place).dot(before.1 - before.0) > -1e-12, (point - place).dot(after.1 - after.0) < 1e-12];
                let least = if hull.free(corner) == Free::Hollow { 1 } else { 2 };
                prop_assert!(beyond.iter().filter(|beyond| **beyond).count() >= least);
            }
        }
    }

    #[test]
    fn a_cross_needs_three_parts_and_a_convex_outline_one() {
        let cross = [
            (1.0, 0.0),
            (2.0, 0.0),
            (2.0, 1.0),
            (3.0, 1.0),
            (3.0, 2.0),
            (2.0, 2.0),
            (2.0, 3.0),
            (1.0, 3.0),
            (1.0, 2.0),
            (0.0, 2.0),
            (0.0, 1.0),
            (1.0, 1.0),
        ];
        let corners = cross.map(|(x, y)| DVec2::new(x, y));
        // Four reflex corners: a cut serves two of them at best. Twice four cuts are the worst of the method.
        let count = convex_parts(&corners).len();
        assert!((3..=9).contains(&count), "{count}");
        assert_eq!(convex_parts(&star(&[1.0; 17])).len(), 1);
    }

    /// Corners on one line with a cut, and a comb: no triangle without area, no cut through a corner.
    #[test]
    fn corners_in_line_with_each_other_make_no_flat_part() {
        let mut comb: Vec<DVec2> = vec![DVec2::ZERO, DVec2::new(12.0, 0.0)];
        for tooth in (0..6).rev() {
            let x = f64::from(2 * tooth);
            comb.extend([(x + 2.0, 2.0), (x + 1.0, 2.0), (x + 1.0, 1.0), (x, 1.0)].map(|(x, y)| DVec2::new(x, y)));
        }
        let corners = simple(&comb).unwrap().0;
        let parts = hulls(&corners, 0.0);
        assert!(parts.iter().all(|part| Hull::polygon(part.corners(), 0.0).unwrap().1.is_empty()));
        assert_eq!(parts.iter().map(|part| shoelace(part.corners())).sum::<f64>(), 18.0);
    }
}
