//! The time of impact of two moving hulls, by conservative advancement (Mirtich 1996).
//!
//! The normal n of the current separation is fixed. Along it the gap between corners i and j of the two cores is a
//! known function of time. The surfaces cannot touch before the least of these gaps is zero. The arms from the origins
//! are u and w, the spins p and q, and the relative velocity v. Then the gap after a time s is at least each of
//!
//! * g + s (n . v + q n . w' - p n . u') - s^2 (p^2 |u| + q^2 |w|) / 2, with ' a quarter turn. This is Taylor's formula
//!   with a bound on the second derivative;
//! * g + s n . v - s (|p| |u| + |q| |w|): the speeds of the corners;
//! * g + s n . v - 2 (|u| + |w|): no corner is farther away than the far side of its circle.
//!
//! Time advances until all three have been zero for some pair, and the separation is computed again. The first bound
//! makes the steps those of Newton. No step leads past a contact. Times are in s, lengths in m, spins in rad/s.

use glam::DVec2;

use crate::hull::Hull;
use crate::hull_distance::separation;
use crate::pose::Pose;

/// A motion with constant velocity and spin. The hull turns about the origin of its frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RigidMotion {
    /// The pose of the hull at time zero.
    pub start: Pose,
    /// Velocity of the origin of its frame, in m/s.
    pub velocity: DVec2,
    /// In rad/s, counter-clockwise.
    pub spin: f64,
}

impl RigidMotion {
    /// The pose at a time in seconds.
    pub fn at(&self, time: f64) -> Pose {
        Pose { position: self.start.position + self.velocity * time, rotation: self.rotation(time) }
    }

    fn rotation(&self, time: f64) -> DVec2 {
        let (sin, cos) = libm::sincos(self.spin * time);
        DVec2::new(cos, sin).rotate(self.start.rotation)
    }
}

/// The first time in `0..=within`, in seconds, at which the surfaces touch. Zero if they touch at the start, `None` if
/// they do not touch in that time.
///
/// Surfaces count as touching below 1e-12 of the size of the hulls, or below the rounding of their path. A near miss by
/// less counts as a contact.
pub fn time_of_impact(a: &Hull, motion_a: &RigidMotion, b: &Hull, motion_b: &RigidMotion, within: f64) -> Option<f64> {
    let start = motion_b.start.position - motion_a.start.position;
    let velocity = motion_b.velocity - motion_a.velocity;
    let size = [a, b].iter().map(|hull| hull.reach_of_core(DVec2::ZERO) + hull.radius()).sum::<f64>();
    // A position rounds when the path is added and when the arm is turned. It rounds twice when both are taken to
    // another frame.
    let rounding = 4.0 * f64::EPSILON * (start.length() + velocity.length() * within + size);
    let touching = f64::max(1e-12 * size, rounding);
    let mut time = 0.0;
    loop {
        let pose_a = Pose { position: DVec2::ZERO, rotation: motion_a.rotation(time) };
        let pose_b = Pose { position: start + velocity * time, rotation: motion_b.rotation(time) };
        let apart = separation(a, &pose_a, b, &pose_b);
        if apart.distance <= touching {
            return Some(time);
        }
        let first = Course { hull: a, pose: pose_a, spin: motion_a.spin };
        let second = Course { hull: b, pose: pose_b, spin: motion_b.spin };
        let next = time + free_time(&first, &second, velocity, apart.normal, apart.distance);
        if next > within {
            return None;
        }
        if next == time {
            // No representable time lies between this one and the contact.
            return Some(time);
        }
        time = next;
    }
}

/// A hull at a moment.
struct Course<'a> {
    hull: &'a Hull,
    pose: Pose,
    spin: f64,
}

/// How a corner moves along a normal because its hull turns.
#[derive(Clone, Copy)]
struct Arm {
    /// Place along the normal, from the origin of the first hull, in m.
    place: f64,
    /// Rate of the place, in m/s.
    rate: f64,
    /// Distance from the origin of its hull, in m.
    length: f64,
    /// Spin in rad/s, without sign.
    spin: f64,
}

impl Course<'_> {
    fn arms(&self, normal: DVec2) -> impl Iterator<Item = Arm> {
        let (pose, spin) = (self.pose, self.spin);
        self.hull.corners().iter().map(move |corner| {
            let arm = pose.direction_to_world(*corner);
            Arm {
                place: normal.dot(pose.position + arm),
                rate: spin * normal.dot(arm.perp()),
                length: arm.length(),
                spin: spin.abs(),
            }
        })
    }
}

/// A time in seconds during which no pair of corners closes its gap along the normal.
fn free_time(a: &Course, b: &Course, velocity: DVec2, normal: DVec2, distance: f64) -> f64 {
    let radii = a.hull.radius() + b.hull.radius();
    let parting = velocity.dot(normal);
    let mut least = f64::INFINITY;
    for u in a.arms(normal) {
        for w in b.arms(normal) {
            // No gap is less than the distance, although rounding may make it so.
            let gap = f64::max(w.place - u.place - radii, distance);
            let rate = parting + w.rate - u.rate;
            let bend = u.spin * u.spin * u.length + w.spin * w.spin * w.length;
            let speed = u.spin * u.length + w.spin * w.length;
            let by_bend = until_zero(gap, rate, bend);
            let by_speed = until_zero(gap, parting - speed, 0.0);
            let by_circles = until_zero(gap - 2.0 * (u.length + w.length), parting, 0.0);
            least = least.min(by_bend.max(by_speed).max(by_circles));
        }
    }
    least
}

/// When `gap + rate s - bend s^2 / 2` is zero; never if it grows, at once if it is below zero at the start.
fn until_zero(gap: f64, rate: f64, bend: f64) -> f64 {
    if gap <= 0.0 {
        return 0.0;
    }
    let root = libm::sqrt(rate * rate + 2.0 * bend * gap);
    if rate < 0.0 {
        2.0 * gap / (root - rate)
    } else if bend > 0.0 {
        (rate + root) / bend
    } else {
        f64::INFINITY
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::hull_distance::distance;
    use crate::hull_distance::tests::random_hull;

    fn motion(position: DVec2, angle: f64, velocity: DVec2, spin: f64) -> RigidMotion {
        RigidMotion { start: Pose::new(position, angle), velocity, spin }
    }

    /// Checks the definition: apart at all sampled times before, touching at the time found.
    fn check(a: &Hull, motion_a: &RigidMotion, b: &Hull, motion_b: &RigidMotion, within: f64) -> Option<f64> {
        let found = time_of_impact(a, motion_a, b, motion_b, within);
        let gap = |time: f64| distance(a, &motion_a.at(time), b, &motion_b.at(time));
        let end = found.unwrap_or(within);
        let samples = 2000;
        for sample in 0..samples {
            let time = end * f64::from(sample) / f64::from(samples);
            assert!(gap(time) > 0.0 || end == 0.0, "they touch at {time} already, found {found:?}");
        }
        if let Some(time) = found.filter(|time| *time > 0.0) {
            // Sizes, paths and gaps below 10 m round; 1e-12 of sizes below 3 m counts as touching.
            assert!(gap(time) < 3e-12 + 40.0 * f64::EPSILON, "{} apart at {time}", gap(time));
        }
        found
    }

    #[test]
    fn two_discs_meet_when_their_gap_is_gone() {
        let disc = Hull::disc(DVec2::ZERO, 0.5).unwrap();
        let left = motion(DVec2::ZERO, 0.0, DVec2::new(2.0, 0.0), 7.0);
        let right = motion(DVec2::new(5.0, 0.0), 0.0, DVec2::new(-2.0, 0.0), -7.0);
        let found = time_of_impact(&disc, &left, &disc, &right, 2.0).unwrap();
        assert!((found - 1.0).abs() < 1e-12, "{found}");
        assert_eq!(time_of_impact(&disc, &left, &disc, &right, 0.9), None);
        let aside = RigidMotion { start: Pose::new(DVec2::new(5.0, 1.001), 0.0), ..right };
        assert_eq!(time_of_impact(&disc, &left, &disc, &aside, 10.0), None);
        assert_eq!(time_of_impact(&disc, &left, &disc, &left, 1.0), Some(0.0));
    }

    /// Closed form: a rod of half length 1 turns at 1 rad/s. Its end meets a wall at height h when sin t = h.
    #[test]
    fn a_turning_rod_meets_a_wall_at_the_arc_sine() {
        let rod = Hull::capsule(-DVec2::X, DVec2::X, 0.0).unwrap();
        let wall = Hull::capsule(DVec2::new(-3.0, 0.0), DVec2::new(3.0, 0.0), 0.0).unwrap();
        for height in [0.1, 0.5, 0.9, 0.999] {
            let turning = motion(DVec2::ZERO, 0.0, DVec2::ZERO, 1.0);
            let standing = motion(DVec2::new(0.0, height), 0.0, DVec2::ZERO, 0.0);
            let found = time_of_impact(&rod, &turning, &wall, &standing, 3.0).unwrap();
            // A gap of 4e-12 closes at the rate cos t.
            let expected = libm::asin(height);
            let early = expected - found;
            assert!((-1e-14..5e-12 / libm::cos(expected)).contains(&early), "{height}: {early}");
        }
        let above = motion(DVec2::new(0.0, 1.0 + 1e-9), 0.0, DVec2::ZERO, 0.0);
        assert_eq!(time_of_impact(&rod, &motion(DVec2::ZERO, 0.0, DVec2::ZERO, 1.0), &wall, &above, 9.0), None);
    }

    proptest! {
        #![proptest_config(crate::cases(7, 1000))]

        /// Law: no bullet passes a wall of 1 mm. Its spin is at most 1e4 rad/s and its speed at most 1 km/s. Each
        /// starts in front of the wall, and its free flight would end behind it.
        #[test]
        fn no_bullet_passes_a_thin_wall(
            corners in prop::collection::vec(0.0..1.0, 1..7), radius in 0.0..0.5, size in 0.001..0.02,
            speed in 10.0..1000.0, slope in -0.5..0.5, spin in -1e4..1e4, angle in -4.0..4.0,
        ) {
            let unit = random_hull(&corners, radius);
            let shrunk: Vec<DVec2> = unit.corners().iter().map(|corner| *corner * size).collect();
            let bullet = Hull::of_corners(shrunk, radius * size);
            let wall = Hull::capsule(DVec2::new(0.0, -2.0), DVec2::new(0.0, 2.0), 0.0005).unwrap();
            let start = DVec2::new(-0.04, 0.0);
            let flying = motion(start, angle, DVec2::new(speed, speed * slope), spin);
            let standing = motion(DVec2::ZERO, 0.0, DVec2::ZERO, 0.0);
            prop_assert!(check(&bullet, &flying, &wall, &standing, 0.1 / speed).is_some());
        }

        /// Law: two hulls in any motion are apart before the time found, and touch then.
        #[test]
        fn the_first_contact_is_found(
            first in prop::collection::vec(0.0..1.0, 1..7), second in prop::collection::vec(0.0..1.0, 1..7),
            x in 1.5..4.0, vx in -9.0..1.0, vy in -3.0..3.0, spin in -30.0..30.0, other in -30.0..30.0, radius in 0.0..0.2,
        ) {
            let (a, b) = (random_hull(&first, radius), random_hull(&second, 0.0));
            check(&a, &motion(DVec2::ZERO, 0.0, DVec2::ZERO, spin), &b, &motion(DVec2::new(x, 0.3), 1.0, DVec2::new(vx, vy), other), 1.0);
        }
    }
}
