//! Shapes by their parameters, each converted into rounded convex hulls.
//!
//! Measures are those of the outside. Rounding goes inwards: the core is smaller by the rounding, and the hull grows by
//! it again. So corners become round, and the sides stay in place. Lengths are in metres.

use glam::DVec2;

use crate::compound::mark_inner;
use crate::convex_parts::hulls;
use crate::error::{Mended, ShapeError};
use crate::hull::{Hull, LEAST, check_count, check_number, check_radius};
use crate::simple_polygon::{inset, lost_area, simple};

/// A shape as rounded convex hulls.
#[derive(Clone, Debug, PartialEq)]
pub struct Shape {
    /// The convex parts; they may overlap.
    pub hulls: Vec<Hull>,
    /// The corrections of the given points.
    pub mended: Vec<Mended>,
    /// Area that rounding took off the corners, in m2.
    pub lost_area: f64,
}

impl Shape {
    pub(crate) fn of(hull: Hull) -> Self {
        Self { hulls: vec![hull], mended: Vec::new(), lost_area: 0.0 }
    }

    /// The same shape, moved by so many metres.
    #[must_use]
    pub fn moved(&self, by: DVec2) -> Self {
        Self { hulls: Hull::all_moved(&self.hulls, by), ..self.clone() }
    }

    /// The same shape, turned about the origin by an angle in radians, counter-clockwise.
    #[must_use]
    pub fn turned(&self, angle: f64) -> Self {
        Self { hulls: Hull::all_turned(&self.hulls, angle), ..self.clone() }
    }
}

/// A disc with center and radius in metres.
///
/// # Errors
/// Numbers that are NaN, infinite or out of range; a radius that is not above zero.
pub fn disc(center: DVec2, radius: f64) -> Result<Shape, ShapeError> {
    positive(radius, "the radius")?;
    Hull::disc(center, radius).map(Shape::of)
}

/// A bar with round ends about the segment between two points, in metres.
///
/// # Errors
/// Numbers that are NaN, infinite or out of range. A radius that is not above zero. Coinciding ends.
pub fn capsule(from: DVec2, to: DVec2, radius: f64) -> Result<Shape, ShapeError> {
    positive(radius, "the radius")?;
    Hull::capsule(from, to, radius).map(Shape::of)
}

/// A rectangle about the origin, with its outside measures and the radius of its corners in metres. With the greatest rounding
/// it is a capsule, or a disc.
///
/// # Errors
/// Numbers that are NaN, infinite or out of range. A width or height that is not above zero. A rounding below zero or
/// above half of the smaller measure.
pub fn rectangle(width: f64, height: f64, rounding: f64) -> Result<Shape, ShapeError> {
    positive(width, "the width")?;
    positive(height, "the height")?;
    check_rounding(rounding, width.min(height) / 2.0)?;
    let half = DVec2::new(width / 2.0 - rounding, height / 2.0 - rounding);
    let hull = match (half.x > 0.0, half.y > 0.0) {
        (true, true) => {
            let corners = [-half, DVec2::new(half.x, -half.y), half, DVec2::new(-half.x, half.y)];
            Hull::polygon(&corners, rounding)?.0
        }
        (false, false) => Hull::disc(DVec2::ZERO, rounding)?,
        _ => Hull::capsule(-half, half, rounding)?,
    };
    let lost_area = (4.0 - std::f64::consts::PI) * rounding * rounding;
    Ok(Shape { lost_area, ..Shape::of(hull) })
}

/// Sides of a regular polygon at most: more would be a disc that costs much.
const MOST_SIDES: usize = 10_000;

/// A regular polygon about the origin, with one corner at +x. `radius` is that of the circle through the corners before these
/// are rounded, in metres.
///
/// # Errors
/// Numbers that are NaN, infinite or out of range. Fewer than three sides or more than 10 000. A radius that is not
/// above zero. A rounding below zero or above the radius of the inscribed circle.
pub fn regular(sides: usize, radius: f64, rounding: f64) -> Result<Shape, ShapeError> {
    check_count("the number of sides", sides, 3, MOST_SIDES)?;
    positive(radius, "the radius")?;
    let half = std::f64::consts::PI / sides as f64;
    let (sin, cos) = libm::sincos(half);
    check_rounding(rounding, radius * cos)?;
    let core = radius - rounding / cos;
    let lost_area = rounding * rounding * sides as f64 * (sin / cos - half);
    if core <= 0.0 {
        return Ok(Shape { lost_area, ..disc(DVec2::ZERO, rounding)? });
    }
    let corner = |index: usize| {
        let (sin, cos) = libm::sincos(2.0 * half * index as f64);
        DVec2::new(cos, sin) * core
    };
    let corners: Vec<DVec2> = (0..sides).map(corner).collect();
    Ok(Shape { lost_area, ..Shape::of(Hull::polygon(&corners, rounding)?.0) })
}

/// Corners of a polygon of a scene at most. The cuts and contacts of more would take seconds.
pub const MOST_CORNERS: usize = 1000;

/// A simple polygon, convex or not, with the radius of its convex corners, in metres. Corners that bend inwards stay sharp. A
/// concave one is cut into convex parts.
///
/// # Errors
/// Numbers that are NaN, infinite or out of range. Fewer than three points. Coinciding points. No area. Sides that
/// cross or touch. A rounding below zero, or so large that sides vanish or meet.
pub fn polygon(points: &[DVec2], rounding: f64) -> Result<Shape, ShapeError> {
    let (corners, mut mended) = simple(points)?;
    check_rounding(rounding, f64::INFINITY)?;
    // Rounding of numbers may make an almost straight corner exactly straight.
    let (core, _) = simple(&inset(&corners, rounding)?)?;
    let hulls = hulls(&core, rounding);
    if hulls.len() > 1 {
        mended.push(Mended::Cut { parts: hulls.len() });
    }
    Ok(Shape { hulls, mended, lost_area: lost_area(&corners, rounding) })
}

/// Several shapes as one. They may overlap and touch; sides inside their union become inner.
///
/// # Errors
/// A list without shapes.
pub fn compound(parts: &[Shape]) -> Result<Shape, ShapeError> {
    if parts.is_empty() {
        return Err(ShapeError::Empty);
    }
    let mut hulls: Vec<Hull> = parts.iter().flat_map(|part| part.hulls.iter().cloned()).collect();
    mark_inner(&mut hulls);
    let mended = parts.iter().flat_map(|part| part.mended.iter().copied()).collect();
    Ok(Shape { hulls, mended, lost_area: parts.iter().map(|part| part.lost_area).sum() })
}

/// # Errors
/// An error for a number that is NaN, infinite, not above zero, or out of range.
pub(crate) fn positive(number: f64, quantity: &'static str) -> Result<(), ShapeError> {
    check_number(number, quantity)?;
    if number <= 0.0 {
        return Err(ShapeError::NotPositive { quantity, found: number });
    }
    if number < LEAST {
        return Err(ShapeError::OutOfRange { quantity, found: number });
    }
    Ok(())
}

/// # Errors
/// An error for a rounding that is NaN, infinite, below zero, or above the greatest possible.
fn check_rounding(rounding: f64, greatest: f64) -> Result<(), ShapeError> {
    if rounding < 0.0 {
        return Err(ShapeError::Negative { quantity: "the rounding", found: rounding });
    }
    check_radius(rounding)?;
    if rounding > greatest {
        return Err(ShapeError::RoundingTooLarge { found: rounding, greatest });
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gear::Gear;
    use crate::moments::AreaMoments;
    use crate::pose::{BoundingBox, Pose};
    use crate::work;

    /// Law: area = that of the sharp shape, minus the loss by rounding. Tolerance: a few dozen terms below `size`^2
    /// round.
    fn assert_area(shape: &Shape, sharp: f64, size: f64) {
        let found = AreaMoments::union_of(&shape.hulls).area;
        assert!((found + shape.lost_area - sharp).abs() < 64.0 * f64::EPSILON * size * size, "{found} {shape:?}");
    }

    #[test]
    fn a_rectangle_has_its_outside_measures_whatever_its_rounding() {
        for rounding in [0.0, 0.1, 0.25, 0.5] {
            let shape = rectangle(3.0, 1.0, rounding).unwrap();
            let bounds = BoundingBox::of(&shape.hulls[0], &Pose::default());
            assert_eq!(bounds, BoundingBox { low: DVec2::new(-1.5, -0.5), high: DVec2::new(1.5, 0.5) });
            assert_area(&shape, 3.0, 3.0);
        }
        assert_eq!(rectangle(1.0, 3.0, 0.5).unwrap().hulls[0].corners().len(), 2);
        assert_eq!(rectangle(1.0, 1.0, 0.5).unwrap().hulls[0].corners().len(), 1);
        assert_eq!(rectangle(3.0, 1.0, 0.6), Err(ShapeError::RoundingTooLarge { found: 0.6, greatest: 0.5 }));
        assert!(matches!(rectangle(0.0, 1.0, 0.0), Err(ShapeError::NotPositive { quantity: "the width", .. })));
        assert!(matches!(rectangle(1.0, -1.0, 0.0), Err(ShapeError::NotPositive { quantity: "the height", .. })));
        assert!(matches!(rectangle(1.0, 1.0, -0.1), Err(ShapeError::Negative { .. })));
        assert!(matches!(rectangle(f64::NAN, 1.0, 0.0), Err(ShapeError::NotFinite { .. })));
    }

    #[test]
    fn a_regular_polygon_keeps_its_sides_when_rounded() {
        for sides in [3, 4, 5, 6, 17] {
            let half = std::f64::consts::PI / sides as f64;
            let (sharp, inscribed) = (sides as f64 * 2.0 * libm::sin(2.0 * half), 2.0 * libm::cos(half));
            for share in [0.0, 0.1, 0.5, 1.0] {
                let shape = regular(sides, 2.0, inscribed * share).unwrap();
                assert_area(&shape, sharp, 4.0);
            }
            assert!(matches!(regular(sides, 2.0, inscribed * 1.01), Err(ShapeError::RoundingTooLarge { .. })));
        }
        assert!(matches!(regular(2, 1.0, 0.0), Err(ShapeError::TooFew { found: 2, .. })));
    }

    /// Convex corners are rounded. The reflex corner stays sharp, because the rounded parts meet there on both sides.
    #[test]
    fn a_concave_polygon_is_cut_and_said() {
        let bracket =
            [(0.0, 0.0), (3.0, 0.0), (3.0, 1.0), (1.0, 1.0), (1.0, 2.0), (0.0, 2.0)].map(|(x, y)| DVec2::new(x, y));
        for rounding in [0.0, 0.1, 0.4] {
            let shape = polygon(&bracket, rounding).unwrap();
            assert_eq!(shape.mended, [Mended::Cut { parts: 2 }]);
            assert_area(&shape, 4.0, 3.0);
            assert!((shape.lost_area - 5.0 * rounding * rounding * (1.0 - std::f64::consts::FRAC_PI_4)).abs() < 1e-15);
        }
        let Err(ShapeError::RoundingTooLarge { greatest, .. }) = polygon(&bracket, 0.6) else { panic!() };
        assert!((greatest - 0.5).abs() < 4.0 * f64::EPSILON);
    }

    /// Law: the work of a shape with its moments and marks grows as `n log n` if its parts are small. From 250
    /// corners on, four times as many take 4.8 times as long. A look at all pairs takes sixteen times. Parts of a star or a comb
    /// are long slivers whose boxes meet. Their pairs are many, and the bound on corners holds: for each pair of corners, some looks.
    #[test]
    fn the_work_of_a_shape_grows_little_more_than_its_corners() {
        let turned = |angle: f64, radius: f64| DVec2::from_angle(angle) * radius;
        let step = |count: usize| std::f64::consts::TAU / count as f64;
        let star = |count: usize| -> Vec<DVec2> {
            (0..count).map(|at| turned(step(count) * at as f64, if at % 2 == 0 { 1.0 } else { 0.9 })).collect()
        };
        let comb = |count: usize| -> Vec<DVec2> {
            let teeth = (1..count - 2).map(|at| DVec2::new((count - at) as f64, 1.0 + (at % 2) as f64));
            [DVec2::ZERO, DVec2::new(count as f64, 0.0)].into_iter().chain(teeth).chain([DVec2::Y]).collect()
        };
        let spiral = |count: usize| -> Vec<DVec2> {
            let half = count / 2;
            let arm = |at: usize, radius: f64| turned(0.2 * at as f64, radius + 0.01 * at as f64);
            let (out, back) = ((0..half).map(|at| arm(at, 1.0)), (0..half).rev().map(|at| arm(at, 0.8)));
            out.chain(back).rev().collect()
        };
        let whole = |shape: Shape| {
            let mut hulls = shape.hulls;
            mark_inner(&mut hulls);
            (AreaMoments::union_of(&hulls), Hull::half_widths(&hulls))
        };
        type Outline<'a> = &'a dyn Fn(usize) -> Vec<DVec2>;
        let outlines: [(&str, Outline); 3] = [("star", &star), ("comb", &comb), ("spiral", &spiral)];
        let mut works: Vec<(&str, [u64; 2])> = Vec::new();
        for (name, outline) in outlines {
            works.push((name, [250, 1000].map(|count| work::of(|| whole(polygon(&outline(count), 0.0).unwrap())))));
        }
        works.push(("gear", [100, 400].map(|teeth| work::of(|| whole(Gear::new(teeth, 0.01).shape().unwrap())))));
        for (name, [few, many]) in works {
            let bound =
                if ["star", "comb"].contains(&name) { 8 * (MOST_CORNERS * MOST_CORNERS) as u64 } else { 6 * few };
            assert!(many < bound, "{name}: {few} and {many}");
        }
    }

    /// Drawings give one outline many times. Each copy but one is covered as soon as it was compared with that one.
    #[test]
    fn the_work_of_copies_above_each_other_grows_with_their_number() {
        let round = |at: f64| capsule(DVec2::new(at, 0.0), DVec2::new(1.0 + at, 0.5), 0.2).unwrap().hulls;
        let works = [10, 40].map(|count| {
            let mut hulls: Vec<Hull> = (0..count).flat_map(|_| [round(0.0), round(0.3)].concat()).collect();
            work::of(|| (mark_inner(&mut hulls), AreaMoments::union_of(&hulls)))
        });
        assert!(works[1] < 6 * works[0], "{works:?}");
        let union = |count: usize| {
            AreaMoments::union_of(&(0..count).flat_map(|_| [round(0.0), round(0.3)].concat()).collect::<Vec<_>>())
        };
        assert_eq!(union(1), union(40));
    }

    #[test]
    fn a_disc_and_a_capsule_need_a_radius() {
        assert!(matches!(disc(DVec2::ZERO, 0.0), Err(ShapeError::NotPositive { .. })));
        assert!(matches!(capsule(DVec2::ZERO, DVec2::X, 0.0), Err(ShapeError::NotPositive { .. })));
        assert_eq!(compound(&[]), Err(ShapeError::Empty));
    }
}
