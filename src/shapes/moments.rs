//! Exact area, centre and second moment of a rounded hull, and of the union of several.
//!
//! The boundary of a union consists of the stretches of its parts' boundaries that lie in no other part. The fans over
//! them sum up ([`crate::boundary`]). Sums are taken about the middle of the shape, so that a far origin costs no
//! digits. With a density the second moment becomes the moment of inertia. Area is in m2, centre in m, second moment in
//! m4.

use glam::DVec2;

use crate::boundary::{Fan, Piece, pieces};
use crate::box_tree::BoxTree;
use crate::clipping::{Ranked, STEEP, Spans, add_covered, free};
use crate::hull::Hull;
use crate::pose::{BoundingBox, Pose};

/// Area, centre and polar second moment of a shape.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct AreaMoments {
    /// In m2.
    pub area: f64,
    /// Centre of the area, in m.
    pub centre: DVec2,
    /// Polar second moment about the centre, in m4.
    pub second_moment: f64,
}

impl AreaMoments {
    /// The moments of one hull with its radius. A hull without area has its centre in the middle of its bounds.
    pub fn of(hull: &Hull) -> Self {
        let middle = middle(std::slice::from_ref(hull));
        let mut sum = Fan::default();
        for piece in pieces(&hull.moved(-middle)) {
            sum += piece.fan(0.0, piece.extent());
        }
        Self::about(middle, sum)
    }

    /// The moments of the union of the hulls, in which overlaps count once.
    ///
    /// Boundaries nearer to each other than 64 units in the last place of the greatest coordinate count as one. If such
    /// boundaries meet at an angle below 1/64, each meeting may change the area. The change is at most that distance
    /// times the size of the shape.
    pub fn union_of(hulls: &[Hull]) -> Self {
        if let [hull] = hulls {
            return Self::of(hull);
        }
        if hulls.is_empty() {
            return Self::default();
        }
        let (middle, tie) = (middle(hulls), tie(hulls));
        let parts: Vec<Hull> = Hull::all_moved(hulls, -middle).iter().filter_map(|hull| thick(hull, tie)).collect();
        let mut sum = Fan::default();
        for (piece, spans) in free_boundary(&parts, tie).iter().flatten() {
            spans.iter().for_each(|(from, to)| sum += piece.fan(*from, *to));
        }
        Self::about(middle, sum)
    }

    fn about(middle: DVec2, Fan { area, first, polar }: Fan) -> Self {
        if area <= 0.0 {
            return Self { centre: middle, ..Self::default() };
        }
        let centre = first / area;
        // p^2 dA about the middle, minus that of the whole area in its centre.
        Self { area, centre: middle + centre, second_moment: polar - area * centre.length_squared() }
    }

    /// The moments of both together, if they have no area in common.
    #[must_use]
    pub fn with(&self, other: &Self) -> Self {
        let area = self.area + other.area;
        if area <= 0.0 {
            return *self;
        }
        let share = other.area / area;
        let apart = other.centre - self.centre;
        let second_moment = self.second_moment + other.second_moment + self.area * share * apart.length_squared();
        Self { area, centre: self.centre + apart * share, second_moment }
    }
}

/// By how much boundaries that count as one may differ, in metres.
///
/// A boundary point comes from a coordinate, a unit normal times the radius, and a product along a side. Each rounds by
/// at most a unit in the last place of the greatest coordinate. Points that a scene computed carry a few more. 64 units
/// hold all of them, and change areas by no more than rounding itself does.
pub(crate) fn tie(hulls: &[Hull]) -> f64 {
    let bounds = bounds(hulls);
    64.0 * f64::EPSILON * bounds.low.abs().max(bounds.high.abs()).max_element()
}

/// The pieces of each hull's boundary with their stretches outside all others.
pub(crate) fn free_boundary(parts: &[Hull], tie: f64) -> Vec<Vec<(Piece, Spans)>> {
    let boxes = BoxTree::new(parts.iter().map(|hull| BoundingBox::of(hull, &Pose::default()).grown(tie)));
    let of_part = |own: usize| {
        let free_of = |piece: Piece| {
            let (mut covered, mut seen) = (Spans::new(), 1);
            // Beyond a corner of two lines that are flat to the piece, a tie reaches this far.
            let near = boxes.touching(&piece.bounds().grown(tie / STEEP));
            for rank in near.into_iter().filter(|rank| *rank != own) {
                add_covered(&piece, own, Ranked { hull: &parts[rank], rank }, tie, &mut covered);
                // Of many hulls above each other, few look at all others. To look at twice as many stretches each time costs as much as
                // to sort them once.
                if covered.len() >= seen {
                    if free(&piece, covered.clone()).is_empty() {
                        break;
                    }
                    seen = 2 * covered.len();
                }
            }
            (piece, free(&piece, covered))
        };
        pieces(&parts[own]).into_iter().map(free_of).collect()
    };
    (0..parts.len()).map(of_part).collect()
}

/// The hull, without its radius if the radius is lost among ties. `None` if the hull itself is thinner than a few ties.
pub(crate) fn thick(hull: &Hull, tie: f64) -> Option<Hull> {
    if hull.radius() > 4.0 * tie {
        return Some(hull.clone());
    }
    let width = |side: usize| {
        let (normal, corner) = (hull.sides()[side].normal, hull.corners()[side]);
        hull.corners().iter().map(|other| normal.dot(corner - *other)).fold(0.0, f64::max)
    };
    let thinnest = (0..hull.sides().len()).map(width).fold(f64::INFINITY, f64::min);
    (hull.corners().len() > 2 && thinnest > 4.0 * tie).then(|| Hull::of_corners(hull.corners().to_vec(), 0.0))
}

fn bounds(hulls: &[Hull]) -> BoundingBox {
    let boxes = hulls.iter().map(|hull| BoundingBox::of(hull, &Pose::default()));
    boxes.reduce(|a, b| a.with(&b)).expect("at least one hull")
}

pub(crate) fn middle(hulls: &[Hull]) -> DVec2 {
    let BoundingBox { low, high } = bounds(hulls);
    low / 2.0 + high / 2.0
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use proptest::prelude::*;

    use super::*;
    use crate::nearest::nearest;

    fn rectangle(low: (f64, f64), high: (f64, f64), radius: f64) -> Hull {
        let corners = [low, (high.0, low.1), high, (low.0, high.1)].map(|(x, y)| DVec2::new(x, y));
        Hull::polygon(&corners, radius).unwrap().0
    }

    fn disc(x: f64, y: f64, radius: f64) -> Hull {
        Hull::disc(DVec2::new(x, y), radius).unwrap()
    }

    /// `size`: of the shape, in metres. Tolerance: a few hundred sums of terms that each round once.
    fn assert_same(found: AreaMoments, expected: AreaMoments, size: f64) {
        let rounding = 256.0 * f64::EPSILON;
        assert!((found.area - expected.area).abs() < rounding * size.powi(2), "{found:?}, expected {expected:?}");
        let lever = (found.centre - expected.centre).length() * expected.area;
        assert!(lever < rounding * size.powi(3), "{found:?}, expected {expected:?}");
        let second = (found.second_moment - expected.second_moment).abs();
        assert!(second < rounding * size.powi(4), "{found:?}, expected {expected:?}");
    }

    #[test]
    fn a_disc_has_half_its_area_times_its_squared_radius() {
        let (centre, radius) = (DVec2::new(3.0, -2.0), 0.7_f64);
        let area = PI * radius * radius;
        let expected = AreaMoments { area, centre, second_moment: area * radius * radius / 2.0 };
        assert_same(AreaMoments::of(&disc(3.0, -2.0, radius)), expected, 2.0);
    }

    /// Closed form: rectangle, two strips each way, four quarter discs.
    #[test]
    fn a_rounded_rectangle_is_the_sum_of_its_parts() {
        let (w, h, r) = (3.0, 2.0, 0.5);
        let found = AreaMoments::of(&rectangle((1.0, 1.0), (1.0 + w, 1.0 + h), r));
        let area = w * h + 2.0 * r * (w + h) + PI * r * r;
        // The quarters make one disc, drawn apart by (w, h) / 2. The centre of each lies 4 r / 3 pi from its corner.
        let shift = 4.0 * r / (3.0 * PI);
        let quarters = PI * r.powi(4) / 2.0 + PI * r * r * ((w * w + h * h) / 4.0 + shift * (w + h));
        let strip = |a: f64, b: f64| a * r * (a * a + r * r) / 12.0 + a * r * ((b + r) / 2.0).powi(2);
        let second_moment = w * h * (w * w + h * h) / 12.0 + 2.0 * strip(w, h) + 2.0 * strip(h, w) + quarters;
        assert_same(found, AreaMoments { area, centre: DVec2::new(1.0 + w / 2.0, 1.0 + h / 2.0), second_moment }, 4.0);
    }

    #[test]
    fn a_capsule_is_a_rectangle_and_a_disc_drawn_apart() {
        let (l, r) = (2.0, 0.25);
        let found = AreaMoments::of(&Hull::capsule(DVec2::ZERO, DVec2::new(0.0, l), r).unwrap());
        let area = 2.0 * r * l + PI * r * r;
        let ends = PI * r.powi(4) / 2.0 + PI * r * r * l * l / 4.0 + PI * r * r * l * 4.0 * r / (3.0 * PI);
        let second_moment = 2.0 * r * l * (4.0 * r * r + l * l) / 12.0 + ends;
        assert_same(found, AreaMoments { area, centre: DVec2::new(0.0, l / 2.0), second_moment }, 2.5);
    }

    /// Law: the lens of two unit discs at distance 1 has the area 2 pi / 3 - sqrt(3) / 2.
    #[test]
    fn two_discs_have_their_lens_once() {
        let found = AreaMoments::union_of(&[disc(0.0, 0.0, 1.0), disc(1.0, 0.0, 1.0)]);
        let lens = 2.0 * PI / 3.0 - 3.0_f64.sqrt() / 2.0;
        assert!((found.area - (2.0 * PI - lens)).abs() < 64.0 * f64::EPSILON);
        assert!((found.centre - DVec2::new(0.5, 0.0)).length() < 64.0 * f64::EPSILON);
    }

    /// Ties: sides in common, whole and in part, flush sides, the same hull again, one inside that touches. Each union is
    /// known as one hull.
    #[test]
    fn hulls_that_touch_or_coincide_are_counted_once() {
        for radius in [0.0, 0.25] {
            let part = |from: f64, to: f64| rectangle((from, -0.3), (to, 0.7), radius);
            let whole = AreaMoments::of(&part(0.1, 0.9));
            for parts in [
                vec![part(0.1, 0.1 + 0.2), part(0.3, 0.9)],
                vec![part(0.3, 0.9), part(0.1, 0.1 + 0.2)],
                vec![part(0.1, 0.9), part(0.1, 0.9)],
                vec![part(0.1, 0.9), part(0.1, 0.9), part(0.1, 0.9)],
                vec![part(0.1, 0.6), part(0.4, 0.9), part(0.3, 0.7)],
                vec![part(0.1, 0.9), part(0.2, 0.5)],
                vec![part(0.2, 0.5), part(0.1, 0.9)],
                vec![rectangle((0.1, -0.3), (0.9, 0.2), radius), rectangle((0.1, 0.2), (0.9, 0.7), radius)],
                vec![part(0.1, 0.9), Hull::capsule(DVec2::new(0.1, -0.3), DVec2::new(0.9, -0.3), radius).unwrap()],
                vec![Hull::capsule(DVec2::new(0.1, -0.3), DVec2::new(0.9, -0.3), radius).unwrap(), part(0.1, 0.9)],
                vec![part(0.1, 0.9), disc(0.1, 0.7, radius), disc(0.5, -0.3, radius)],
                vec![disc(0.1, 0.7, radius), disc(0.5, -0.3, radius), part(0.1, 0.9)],
            ] {
                assert_same(AreaMoments::union_of(&parts), whole, 1.5);
            }
        }
    }

    /// Ties of curves: capsules that share an end, at all angles. Discs that touch from outside and from inside. A disc
    /// in the end of a capsule. The expected values are sums and closed forms.
    #[test]
    fn curves_that_touch_are_counted_once() {
        let (r, l) = (0.3, 2.0);
        for degrees in [5, 30, 45, 60, 90, 120, 150, 175, 180] {
            let angle = f64::from(degrees).to_radians();
            let arm = |angle: f64| {
                let end = DVec2::new(libm::cos(angle), libm::sin(angle)) * l;
                Hull::capsule(DVec2::new(0.1, 0.2), DVec2::new(0.1, 0.2) + end, r).unwrap()
            };
            // On the inside of the bend both strips cover a kite, if they are long enough. On the outside a sector is
            // added.
            let cotangent = libm::cos(angle / 2.0) / libm::sin(angle / 2.0);
            if r * cotangent > l {
                continue;
            }
            let expected = 4.0 * r * l + PI * r * r + r * r * (PI - angle) / 2.0 - r * r * cotangent;
            let found = AreaMoments::union_of(&[arm(0.3), arm(0.3 + angle)]).area;
            assert!((found - expected).abs() < 256.0 * f64::EPSILON, "{degrees}: {found} {expected}");
        }
        let apart = [disc(0.1, 0.0, 0.2), disc(0.1 + 0.5, 0.0, 0.3)];
        let both = AreaMoments::of(&apart[0]).with(&AreaMoments::of(&apart[1]));
        assert_same(AreaMoments::union_of(&apart), both, 1.0);
        let inside = [disc(0.3, 0.0, 0.1), disc(0.2, 0.0, 0.2), disc(0.2, 0.0, 0.2)];
        assert_same(AreaMoments::union_of(&inside), AreaMoments::of(&inside[1]), 0.4);
    }

    /// Law: nearly parallel sides that cross are cut at one place. Two slim triangles on a common base, turned by `tilt`:
    /// the union is the box plus two triangles.
    #[test]
    fn nearly_parallel_sides_are_cut_at_one_place() {
        for exponent in 3..16 {
            let tilt = 10.0_f64.powi(-exponent);
            let corners = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0 + tilt), (0.0, 1.0 - tilt)].map(|(x, y)| DVec2::new(x, y));
            let tilted = Hull::polygon(&corners, 0.0).unwrap().0;
            let found = AreaMoments::union_of(&[rectangle((0.0, 0.0), (1.0, 1.0), 0.0), tilted]).area;
            assert!((found - 1.0 - tilt / 4.0).abs() < 128.0 * f64::EPSILON, "{tilt}: {}", found - 1.0);
        }
    }

    fn random(numbers: &[f64]) -> Vec<Hull> {
        let hull = |n: &[f64]| {
            let at = |k: usize| DVec2::new(n[2 * k], n[2 * k + 1]);
            match (n[8] * 3.0) as usize {
                0 => Hull::disc(at(0), 0.3 * n[9] + 0.01).unwrap(),
                1 => Hull::capsule(at(0), at(1), 0.2 * n[9] + 0.01).unwrap(),
                _ => {
                    let points = [at(0), at(1), at(2)];
                    let radius = if n[9] < 0.5 { 0.0 } else { 0.2 * n[9] };
                    Hull::polygon(&points, radius).map_or(Hull::disc(at(0), 0.1).unwrap(), |(hull, _)| hull)
                }
            }
        };
        numbers.chunks(10).map(hull).collect()
    }

    proptest! {
        #![proptest_config(crate::cases(3, 60))]

        /// Law: the area equals the count of a grid of points. Tolerance: only cells on the boundary count wrongly. A
        /// boundary of length L has at most 4 L / cell of them. About their square root remains after cancellation, and
        /// the test takes five times that.
        #[test]
        fn a_union_has_the_area_that_a_grid_counts(numbers in prop::collection::vec(0.0..1.0, 40)) {
            let hulls = random(&numbers);
            let found = AreaMoments::union_of(&hulls);
            let (cells, low, width) = (500, -0.5, 2.0);
            let cell = width / f64::from(cells);
            let (mut area, mut first, mut polar) = (0.0, DVec2::ZERO, 0.0);
            for index in 0..cells * cells {
                let at = DVec2::new(f64::from(index % cells) + 0.5, f64::from(index / cells) + 0.5) * cell + low;
                if hulls.iter().any(|hull| nearest(hull, at).distance <= hull.radius()) {
                    area += cell * cell;
                    first += at * cell * cell;
                    polar += (at - found.centre).length_squared() * cell * cell;
                }
            }
            let tolerance = 5.0 * (4.0 * 12.0 / cell).sqrt() * cell * cell;
            prop_assert!((found.area - area).abs() < tolerance, "{} {area}", found.area);
            prop_assert!((found.centre * found.area - first).length() < 1.5 * tolerance);
            prop_assert!((found.second_moment - polar).abs() < tolerance, "{} {polar}", found.second_moment);
        }
    }

    proptest! {
        #![proptest_config(crate::cases(4, 2000))]

        /// Law: the union depends neither on the order of its parts, nor on repeated parts, nor on its origin.
        #[test]
        fn a_union_knows_no_order_and_no_repetition(numbers in prop::collection::vec(0.0..1.0, 40), x in -2.0..2.0) {
            let hulls = random(&numbers);
            let found = AreaMoments::union_of(&hulls);
            let mut twice = hulls.clone();
            twice.extend(hulls.iter().rev().cloned());
            assert_same(AreaMoments::union_of(&twice), found, 2.0);
            let reversed: Vec<Hull> = hulls.iter().rev().map(|hull| hull.moved(DVec2::splat(x))).collect();
            let mut back = AreaMoments::union_of(&reversed);
            back.centre -= DVec2::splat(x);
            assert_same(back, found, 4.0);
        }
    }
}
