//! A toothed rack: the gear of infinite radius, with straight flanks.
//!
//! With module m and pressure angle a (the basic rack of ISO 53) the pitch is pi m. Teeth are m high above the pitch
//! line and 1.25 m deep below it. Flanks stand at the angle a to the normal of the pitch line. The pitch line is y = 0,
//! teeth point along +y, and the middle of the row is at x = 0. Lengths are in metres, angles in radians.

use std::f64::consts::PI;

use glam::DVec2;

use crate::error::ShapeError;
use crate::gear::{MOST_TEETH, check_tooth};
use crate::hull::check_count;
use crate::shape::{Shape, compound, polygon, positive};

/// A rack of so many teeth. A [`crate::Gear`] of the same module and pressure angle rolls on it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rack {
    /// Number of teeth, at least 1.
    pub teeth: usize,
    /// Pitch over pi, in metres.
    pub module: f64,
    /// Angle between the flanks and the normal of the pitch line, in radians.
    pub pressure_angle: f64,
    /// Play along the pitch line, in metres; the rack gives half of it, its gear the other.
    pub backlash: f64,
    /// Thickness of the bar below the roots, in metres.
    pub back: f64,
}

impl Rack {
    /// A rack with a number of teeth and a module in metres. It has a pressure angle of 20 degrees, no backlash and a
    /// bar two modules thick.
    pub fn new(teeth: usize, module: f64) -> Self {
        Self { teeth, module, pressure_angle: PI / 9.0, backlash: 0.0, back: 2.0 * module }
    }

    /// Distance from tooth to tooth, in metres.
    pub fn pitch(&self) -> f64 {
        PI * self.module
    }

    /// Half of the width of a tooth at a height above the pitch line, both in metres.
    pub fn half_width(&self, height: f64) -> f64 {
        self.pitch() / 4.0 - self.backlash / 4.0 - height * libm::tan(self.pressure_angle)
    }

    /// The bar and the teeth as convex parts.
    ///
    /// # Errors
    /// Numbers that are NaN, infinite, out of range, or not above zero. No tooth or more than 1000. A pressure angle
    /// not between 0 and 45 degrees. A negative backlash. Flanks that meet at a tip or at a root.
    pub fn shape(&self) -> Result<Shape, ShapeError> {
        check_count("the number of teeth", self.teeth, 1, MOST_TEETH)?;
        check_tooth(self.module, self.pressure_angle, self.backlash)?;
        positive(self.back, "the thickness of the bar")?;
        let (tip, root) = (self.module, -1.25 * self.module);
        let (tip_half, root_half) = (self.half_width(tip), self.half_width(root));
        if tip_half <= 0.0 {
            return Err(ShapeError::PointedTooth { tip_width: 2.0 * tip_half });
        }
        let root_width = self.pitch() - 2.0 * root_half;
        if root_width <= 0.0 {
            return Err(ShapeError::ClosedGap { root_width });
        }
        let end = self.pitch() * self.teeth as f64 / 2.0;
        let bottom = root - self.back;
        let bar = [(-end, bottom), (end, bottom), (end, root), (-end, root)];
        let tooth = |number: usize| {
            let middle = self.pitch() * (number as f64 + 0.5) - end;
            [(-root_half, root), (root_half, root), (tip_half, tip), (-tip_half, tip)]
                .map(|(aside, height)| (middle + aside, height))
        };
        // To cut the whole outline would make slivers between all gaps and the bottom.
        let parts = std::iter::once(bar).chain((0..self.teeth).map(tooth));
        let parts: Result<Vec<Shape>, ShapeError> = parts.map(|part| polygon(&part.map(DVec2::from), 0.0)).collect();
        // The parameters give the points, so the author has nothing to correct in them.
        Ok(Shape { mended: Vec::new(), ..compound(&parts?)? })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gear::Gear;
    use crate::gear::tests::clearance;
    use crate::moments::AreaMoments;
    use crate::pose::Pose;

    /// Each tooth is one part, and only the bar reaches along the rack. So the pairs of parts that touch grow with the teeth.
    #[test]
    fn a_rack_has_a_part_for_each_tooth_and_one_bar() {
        for teeth in [1, 10, 1000] {
            let hulls = Rack::new(teeth, 0.01).shape().unwrap().hulls;
            assert_eq!(hulls.len(), teeth + 1);
            let pitch = Rack::new(teeth, 0.01).pitch();
            let wide = hulls.iter().filter(|hull| {
                let across = hull.corners().iter().map(|corner| corner.x);
                across.clone().fold(f64::MIN, f64::max) - across.fold(f64::MAX, f64::min) > pitch
            });
            assert!(wide.count() <= 1);
        }
    }

    #[test]
    fn teeth_and_bar_have_the_area_of_trapezia_and_a_rectangle() {
        let rack = Rack::new(7, 0.01);
        let bar = 7.0 * rack.pitch() * rack.back;
        // A tooth is as wide on average as in its middle.
        let teeth = 7.0 * 2.25 * 0.01 * 2.0 * rack.half_width(-0.125 * 0.01);
        let (found, length) = (AreaMoments::union_of(&rack.shape().unwrap().hulls).area, 7.0 * rack.pitch());
        assert!((found - bar - teeth).abs() < 64.0 * f64::EPSILON * length * length, "{found}");
    }

    /// Law: a gear rolls on a rack without touching, with half the backlash times cos a free on both sides. Tolerance: the
    /// gear's chords miss the involute by less than the clearance over 4, see `crate::gear`.
    #[test]
    fn a_gear_rolls_on_a_rack_with_a_constant_clearance() {
        let (module, backlash) = (0.01, 2e-4);
        let gear = Gear { backlash, chords: 12, ..Gear::new(24, module) };
        let rack = Rack { backlash, ..Rack::new(9, module) };
        let (wheel, bar) = (gear.shape().unwrap(), rack.shape().unwrap());
        let expected = backlash / 2.0 * libm::cos(gear.pressure_angle);
        for step in -20..20 {
            let angle = PI / 24.0 * f64::from(step) / 20.0;
            // A gap faces the middle tooth; the lowest point of the pitch circle moves along +x.
            let turning = Pose::new(DVec2::new(0.0, gear.pitch_radius()), angle - PI / 2.0 + PI / 24.0);
            let sliding = Pose::new(DVec2::new(gear.pitch_radius() * angle, 0.0), 0.0);
            let found = clearance(&wheel, &turning, &bar, &sliding, module);
            assert!((found - expected).abs() < expected / 4.0, "{step}: {found}, expected {expected}");
        }
    }

    #[test]
    fn impossible_racks_are_refused() {
        assert!(matches!(Rack::new(0, 0.01).shape(), Err(ShapeError::TooFew { .. })));
        assert!(matches!(Rack { back: 0.0, ..Rack::new(3, 0.01) }.shape(), Err(ShapeError::NotPositive { .. })));
        assert!(matches!(Rack { backlash: 0.02, ..Rack::new(3, 0.01) }.shape(), Err(ShapeError::PointedTooth { .. })));
        assert!(matches!(
            Rack { pressure_angle: 0.7, ..Rack::new(3, 0.01) }.shape(),
            Err(ShapeError::PointedTooth { .. })
        ));
    }
}
