//! Detection of dead points of loops. At a dead point bars lie in one line, and rows of joints depend on each other for
//! a moment.
//!
//! There a pivot of the factors vanishes with the square of the distance. So its root `s` is linear in time and changes
//! sign. The steps only give the absolute value of `s`. If `s` grows again by its extrapolated amount below zero, the
//! loop has passed a dead point. A smooth minimum above zero does not look like that, unless one step passes it.

use serde::{Deserialize, Serialize};

/// The allowed distance of `s` from the line through the two steps before, as a share. A quarter leaves room for its
/// curvature.
const STRAIGHT: f64 = 0.25;
/// A loop is near a dead point where `s` is below this share of its largest value.
const NEAR: f64 = 0.05;

/// The dead points of a run so far.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct DeadPoints {
    /// Time in seconds and `s` of the last two steps, the later one last.
    before: [Option<(f64, f64)>; 2],
    largest: f64,
    /// The number of dead points that the run has passed.
    pub passed: u64,
    /// When the first one was passed, in seconds.
    pub first: Option<f64>,
}

impl DeadPoints {
    /// Takes the end of a step at `time` seconds. `pivot` is the least pivot, as a share of its number before
    /// elimination.
    pub fn look(&mut self, time: f64, pivot: f64) {
        let s = pivot.max(0.0).sqrt();
        // A step that was thrown away is looked at again.
        while self.before[1].is_some_and(|(last, _)| last >= time) {
            self.before = [None, self.before[0]];
        }
        if let [Some((t0, s0)), Some((t1, s1))] = self.before {
            let ahead = s1 + (s1 - s0) / (t1 - t0) * (time - t1);
            if ahead < 0.0 && (s + ahead).abs() <= STRAIGHT * s {
                self.passed += 1;
                self.first.get_or_insert(t1 + (time - t1) * s1 / (s1 + s));
            }
        }
        self.before = [self.before[1], Some((time, s))];
        self.largest = self.largest.max(s);
    }

    /// Whether the last step ended near a dead point.
    pub fn is_near(&self) -> bool {
        self.before[1].is_some_and(|(_, s)| s < NEAR * self.largest)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Steps of 0.01 s from 0 to 1 s.
    fn after(root: impl Fn(f64) -> f64) -> DeadPoints {
        let mut points = DeadPoints::default();
        (0..=100).map(|step| f64::from(step) * 0.01).for_each(|time| points.look(time, root(time).powi(2)));
        points
    }

    /// Law: a root that changes sign is seen once, at its zero, whether that lies between steps or on one. Tolerance: curvature moves the
    /// line by less than a step.
    #[test]
    fn a_change_of_sign_is_seen_where_it_is() {
        for zero in [0.3456, 0.35, 0.5000001] {
            let points = after(|time| libm::sin(time - zero));
            assert_eq!(points.passed, 1, "{zero}");
            assert!((points.first.unwrap() - zero).abs() < 0.01, "{points:?}");
        }
    }

    #[test]
    fn a_minimum_above_zero_is_none() {
        assert_eq!(after(|time| 0.05_f64.hypot(time - 0.5)).passed, 0);
        assert_eq!(after(|_| 1e-4).passed, 0);
        assert!(!after(|_| 1e-4).is_near());
    }
}
