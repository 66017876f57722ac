//! Spur gears with involute teeth.
//!
//! With z teeth of module m and pressure angle a (ISO 53, ISO 21771):
//!
//! * pitch radius r = z m / 2, base radius r cos a, tip radius r + m, root radius r - 1.25 m;
//! * the flank at radius q has the pressure angle p: cos p = base / q and inv p = tan p - p;
//! * half of a tooth spans the angle s / 2r + inv a - inv p there. Its thickness is s = pi m / 2 - backlash / 2.
//!
//! Below the base circle flanks are radial. Flanks are chords of the involute, and their corners lie on it. Between
//! them the tooth is thinner, by an error that falls with the square of their number. Gears with fewer teeth than
//! [`Gear::least_without_undercut`] are not undercut, and may jam with gears of many teeth. Lengths are in metres,
//! angles in radians.

use std::f64::consts::{FRAC_PI_4, PI, TAU};

use glam::DVec2;

use crate::error::ShapeError;
use crate::hull::{Free, Hull, check_count, check_number};
use crate::shape::{Shape, positive};

/// A spur gear about the origin; one tooth points along +x.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gear {
    /// Number of teeth, at least 3.
    pub teeth: usize,
    /// Pitch diameter over number of teeth, in metres.
    pub module: f64,
    /// Angle between the line of action and the common tangent of the pitch circles, in radians.
    pub pressure_angle: f64,
    /// Play between two such gears along the pitch circle, in metres; each gear gives half of it.
    pub backlash: f64,
    /// Number of chords of each flank above the base circle. Over a chord the tangent of the pressure angle grows from
    /// u to u + d. The chord misses the involute by about u d^2 / 8 base radii.
    pub chords: usize,
}

/// The largest numbers of teeth and chords. Each tooth is a part with twice as many corners as a flank has chords.
pub(crate) const MOST_TEETH: usize = 1000;
const MOST_CHORDS: usize = 64;

impl Gear {
    /// A gear with a number of teeth and a module in metres. It has a pressure angle of 20 degrees, no backlash and 8
    /// chords.
    pub fn new(teeth: usize, module: f64) -> Self {
        Self { teeth, module, pressure_angle: PI / 9.0, backlash: 0.0, chords: 8 }
    }

    /// Radius in metres at which two gears roll on each other.
    pub fn pitch_radius(&self) -> f64 {
        self.teeth as f64 * self.module / 2.0
    }

    /// Radius of the circle from which the involutes unwind, in metres.
    pub fn base_radius(&self) -> f64 {
        self.pitch_radius() * libm::cos(self.pressure_angle)
    }

    /// Radius of the tips, in metres.
    pub fn tip_radius(&self) -> f64 {
        self.pitch_radius() + self.module
    }

    /// Radius of the roots, in metres.
    pub fn root_radius(&self) -> f64 {
        self.pitch_radius() - 1.25 * self.module
    }

    /// The least number of teeth whose flanks meet a rack only above the base circle. It is 2 / sin^2 of the pressure
    /// angle.
    pub fn least_without_undercut(pressure_angle: f64) -> f64 {
        2.0 / libm::sin(pressure_angle).powi(2)
    }

    /// Half of the angle that a tooth spans at a radius in metres, in radians. Below the base circle it does not change.
    pub fn half_angle(&self, radius: f64) -> f64 {
        let involute = |roll: f64| roll - libm::atan(roll);
        let thickness = PI * self.module / 2.0 - self.backlash / 2.0;
        thickness / (2.0 * self.pitch_radius()) + involute(libm::tan(self.pressure_angle)) - involute(self.roll(radius))
    }

    /// Tangent of the pressure angle at a radius in metres.
    fn roll(&self, radius: f64) -> f64 {
        let base = self.base_radius();
        libm::sqrt(((radius - base) * (radius + base)).max(0.0)) / base
    }

    /// The body and the teeth as convex parts.
    ///
    /// # Errors
    /// Numbers that are NaN, infinite, out of range, or not above zero. Fewer than three teeth or more than 1000. No
    /// chord or more than 64. A pressure angle not between 0 and 45 degrees. A negative backlash. Flanks that meet at a
    /// tip or at a root.
    pub fn shape(&self) -> Result<Shape, ShapeError> {
        check_count("the number of teeth", self.teeth, 3, MOST_TEETH)?;
        check_count("the number of chords", self.chords, 1, MOST_CHORDS)?;
        check_tooth(self.module, self.pressure_angle, self.backlash)?;
        let tip_width = 2.0 * self.tip_radius() * self.half_angle(self.tip_radius());
        if tip_width <= 0.0 {
            return Err(ShapeError::PointedTooth { tip_width });
        }
        let pitch = TAU / self.teeth as f64;
        let root_width = self.root_radius() * (pitch - 2.0 * self.half_angle(self.root_radius()));
        if root_width <= 0.0 {
            return Err(ShapeError::ClosedGap { root_width });
        }
        let flank = self.flank();
        let mut hulls = vec![self.body(flank[0])];
        for tooth in 0..self.teeth {
            hulls.push(self.tooth(&flank, pitch * tooth as f64)?);
        }
        Ok(Shape { hulls, mended: Vec::new(), lost_area: 0.0 })
    }

    /// Radius and half angle of the corners of a flank, from its root to its tip.
    fn flank(&self) -> Vec<(f64, f64)> {
        let (root, base) = (self.root_radius(), self.base_radius());
        let (from, to) = (self.roll(root), self.roll(self.tip_radius()));
        // Even steps of the roll angle.
        let radius = |chord: usize| {
            let roll = from + (to - from) * chord as f64 / self.chords as f64;
            base * libm::sqrt(1.0 + roll * roll)
        };
        let mut radii: Vec<f64> = (0..=self.chords).map(radius).collect();
        if root < base {
            radii.insert(0, root);
        } else {
            radii[0] = root;
        }
        radii.into_iter().map(|radius| (radius, self.half_angle(radius))).collect()
    }

    /// The polygon through the roots of all flanks. A side under a tooth is a cut.
    fn body(&self, (radius, half): (f64, f64)) -> Hull {
        let pitch = TAU / self.teeth as f64;
        let corner = |index: usize| {
            let tooth = pitch * (index / 2) as f64;
            polar(radius, if index.is_multiple_of(2) { tooth - half } else { tooth + half })
        };
        let mut body = Hull::of_corners((0..2 * self.teeth).map(corner).collect(), 0.0);
        for index in 0..2 * self.teeth {
            body.set_inner(index, index.is_multiple_of(2));
            body.set_free(index, Free::Nowhere);
        }
        body
    }

    /// The tooth at an angle. Its last side is the cut; the corners at both ends of that do not probe.
    fn tooth(&self, flank: &[(f64, f64)], angle: f64) -> Result<Hull, ShapeError> {
        let right = flank.iter().map(|(radius, half)| polar(*radius, angle - half));
        let left = flank.iter().rev().map(|(radius, half)| polar(*radius, angle + half));
        let (mut hull, _) = Hull::polygon(&right.chain(left).collect::<Vec<DVec2>>(), 0.0)?;
        let last = hull.corners().len() - 1;
        hull.set_inner(last, true);
        hull.set_free(last, Free::Nowhere);
        hull.set_free(0, Free::Nowhere);
        Ok(hull)
    }
}

/// # Errors
/// The reason why a tooth of this module, pressure angle and backlash is impossible.
pub(crate) fn check_tooth(module: f64, pressure_angle: f64, backlash: f64) -> Result<(), ShapeError> {
    positive(module, "the module")?;
    check_number(pressure_angle, "the pressure angle")?;
    if pressure_angle <= 0.0 || pressure_angle >= FRAC_PI_4 {
        let quantity = "the pressure angle";
        return Err(ShapeError::AngleOutOfRange { quantity, found: pressure_angle, above: 0.0, below: FRAC_PI_4 });
    }
    check_number(backlash, "the backlash")?;
    if backlash < 0.0 {
        return Err(ShapeError::Negative { quantity: "the backlash", found: backlash });
    }
    Ok(())
}

fn polar(radius: f64, angle: f64) -> DVec2 {
    let (sin, cos) = libm::sincos(angle);
    DVec2::new(cos, sin) * radius
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::hull_distance::distance;
    use crate::moments::AreaMoments;
    use crate::pose::{BoundingBox, Pose};

    /// The least distance between two shapes, or `within` if it is larger.
    pub(crate) fn clearance(a: &Shape, pose_a: &Pose, b: &Shape, pose_b: &Pose, within: f64) -> f64 {
        let mut least = within;
        for one in &a.hulls {
            let bounds = BoundingBox::of(one, pose_a).grown(within);
            for other in b.hulls.iter().filter(|other| bounds.touches(&BoundingBox::of(other, pose_b))) {
                least = least.min(distance(one, pose_a, other, pose_b));
            }
        }
        least
    }

    /// The greatest distance between a chord and its involute. It lies at half the roll angle, the farthest point of
    /// the curve.
    fn chord_error(gear: &Gear) -> f64 {
        let flank = gear.flank();
        let middles = flank.windows(2).filter(|ends| ends[0].0 >= gear.base_radius()).map(|ends| {
            let roll = (gear.roll(ends[0].0) + gear.roll(ends[1].0)) / 2.0;
            let radius = gear.base_radius() * (1.0 + roll * roll).sqrt();
            let [from, to] = [ends[0], ends[1]].map(|(radius, half)| polar(radius, half));
            (to - from).normalize().perp_dot(polar(radius, gear.half_angle(radius)) - from).abs()
        });
        middles.fold(0.0, f64::max)
    }

    /// Law: a string unwound from the base circle is as long as the arc that it left. Its end runs through the flank
    /// points.
    #[test]
    fn the_flank_is_the_path_of_an_unwound_string() {
        let gear = Gear::new(24, 0.005);
        let base = gear.base_radius();
        for (radius, half) in gear.flank().into_iter().filter(|(radius, _)| *radius > base) {
            let string = (radius * radius - base * base).sqrt();
            // The string touches the base circle at the pressure angle away from the point.
            let touch = -half + libm::acos(base / radius);
            let from = -gear.half_angle(base);
            assert!((base * (touch - from) - string).abs() < 16.0 * f64::EPSILON * gear.tip_radius(), "{radius}");
        }
    }

    /// Law: at the pitch circle teeth and gaps are equally wide, pi m / 2, less half the backlash.
    #[test]
    fn teeth_and_gaps_are_equal_at_the_pitch_circle() {
        let gear = Gear { backlash: 1e-4, ..Gear::new(31, 0.002) };
        let width = 2.0 * gear.pitch_radius() * gear.half_angle(gear.pitch_radius());
        assert!((width - (PI * 0.001 - 0.5e-4)).abs() < 4.0 * f64::EPSILON * gear.pitch_radius());
    }

    /// Law: cuts match. The parts fill the outline once, their corners lie between root and tip.
    #[test]
    fn body_and_teeth_fill_the_outline_once() {
        for teeth in [3, 9, 24, 60] {
            let gear = Gear::new(teeth, 0.01);
            let shape = gear.shape().unwrap();
            assert_eq!(shape.hulls.len(), teeth + 1);
            let sum = shape.hulls.iter().map(AreaMoments::of).reduce(|a, b| a.with(&b)).unwrap();
            let union = AreaMoments::union_of(&shape.hulls);
            // Each cut may leave a gap of a tie.
            let (size, ties) = (gear.tip_radius(), 64.0 * f64::EPSILON * teeth as f64);
            assert!((sum.area - union.area).abs() < ties * size * size, "{teeth}");
            assert!((sum.second_moment - union.second_moment).abs() < ties * size.powi(4));
            assert!(union.centre.length() * union.area < ties * size.powi(3));
            let radii = shape.hulls.iter().flat_map(Hull::corners).map(|corner| corner.length());
            let (low, high) = radii.fold((f64::MAX, 0.0), |(low, high), r| (f64::min(low, r), f64::max(high, r)));
            let rounding = 4.0 * f64::EPSILON * size;
            assert!((low - gear.root_radius()).abs() < rounding && (high - size).abs() < rounding);
            let outer = shape.hulls.iter().flat_map(Hull::sides).filter(|side| !side.inner).count();
            let corners_of_outline = teeth * 2 * gear.flank().len();
            assert_eq!(outer, corners_of_outline);
        }
    }

    /// Law: two gears at the distance (z + y) m / 2 run at all angles without touching. The free gap on both sides of a
    /// tooth is half the backlash times cos a. Tolerance: flanks are chords on both sides.
    #[test]
    fn two_gears_mesh_with_a_constant_clearance() {
        let (module, backlash) = (0.01, 2e-4);
        let [first, second] = [24, 31].map(|teeth| Gear { backlash, chords: 24, ..Gear::new(teeth, module) });
        let (a, b) = (first.shape().unwrap(), second.shape().unwrap());
        let apart = first.pitch_radius() + second.pitch_radius();
        let expected = backlash / 2.0 * libm::cos(first.pressure_angle);
        let tolerance = chord_error(&first) + chord_error(&second);
        assert!(tolerance < expected / 4.0, "{tolerance} {expected}");
        for step in 0..40 {
            // One pitch, in steps.
            let angle = TAU / 24.0 * f64::from(step) / 40.0;
            // A gap of the second faces a tooth of the first.
            let other = PI + PI / 31.0 - angle * 24.0 / 31.0;
            let pose_b = Pose::new(DVec2::new(apart, 0.0), other);
            let found = clearance(&a, &Pose::new(DVec2::ZERO, angle), &b, &pose_b, module);
            assert!(
                (found - expected).abs() < tolerance + 1e-12,
                "{step}: {found}, expected {expected} +- {tolerance}"
            );
        }
    }

    #[test]
    fn impossible_gears_are_refused() {
        assert!(matches!(Gear::new(2, 0.01).shape(), Err(ShapeError::TooFew { found: 2, .. })));
        assert!(matches!(Gear::new(20, 0.0).shape(), Err(ShapeError::NotPositive { .. })));
        let steep = Gear { pressure_angle: 0.6, ..Gear::new(10, 0.01) };
        assert!(matches!(steep.shape(), Err(ShapeError::PointedTooth { .. })), "{:?}", steep.shape());
        assert!(matches!(Gear { pressure_angle: 0.8, ..steep }.shape(), Err(ShapeError::AngleOutOfRange { .. })));
        assert!((Gear::least_without_undercut(PI / 9.0) - 17.097).abs() < 1e-3);
    }
}
