//! Between two ticks: positions from the cubic that has the positions and velocities of both ends (Hermite). Its
//! error is of order dt^4, below that of the integrators it serves.

use glam::DVec2;
use serde::{Deserialize, Serialize};

use crate::world::Bodies;

/// Pose and velocity of a body at a time.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct MotionSample {
    /// Time in seconds.
    pub time: f64,
    /// Centre of mass in metres.
    pub position: DVec2,
    /// Velocity in m/s.
    pub velocity: DVec2,
    /// Angle in radians.
    pub angle: f64,
    /// Angular velocity in rad/s.
    pub spin: f64,
}

impl MotionSample {
    /// The present moment of the body at `place`.
    pub fn of(bodies: &Bodies, index: usize, time: f64) -> Self {
        Self {
            time,
            position: bodies.position[index],
            velocity: bodies.velocity[index],
            angle: bodies.angle[index],
            spin: bodies.spin[index],
        }
    }
}

/// Position at `time`, in metres; at the ends exactly theirs.
pub fn position_between(before: &MotionSample, after: &MotionSample, time: f64) -> DVec2 {
    let Some(w) = weights(before, after, time) else { return after.position };
    before.position
        + (after.position - before.position) * w.change
        + before.velocity * w.slope_before
        + after.velocity * w.slope_after
}

/// Angle at `time`, in radians; at the ends exactly theirs.
pub fn angle_between(before: &MotionSample, after: &MotionSample, time: f64) -> f64 {
    let Some(w) = weights(before, after, time) else { return after.angle };
    before.angle + (after.angle - before.angle) * w.change + before.spin * w.slope_before + after.spin * w.slope_after
}

struct Weights {
    change: f64,
    slope_before: f64,
    slope_after: f64,
}

fn weights(before: &MotionSample, after: &MotionSample, time: f64) -> Option<Weights> {
    let length = after.time - before.time;
    let s = (time - before.time) / length;
    if length <= 0.0 || s >= 1.0 {
        return None;
    }
    let s = s.max(0.0);
    Some(Weights {
        change: s * s * (3.0 - 2.0 * s),
        slope_before: s * (1.0 - s) * (1.0 - s) * length,
        slope_after: -s * s * (1.0 - s) * length,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A cubic is met exactly; a quartic is missed by (t - t0)^2 (t - t1)^2 x/4!. Source: Hermite interpolation error.
    #[test]
    fn a_cubic_is_met_exactly() {
        let cubic = |t: f64| MotionSample {
            time: t,
            position: DVec2::new(t * t * t, 1.0 - t),
            velocity: DVec2::new(3.0 * t * t, -1.0),
            angle: t * t,
            spin: 2.0 * t,
        };
        let (before, after) = (cubic(0.5), cubic(0.75));
        for t in [0.5, 0.6, 0.7, 0.75] {
            let found = position_between(&before, &after, t);
            assert!((found - cubic(t).position).length() < 1e-15, "{t}: {found}");
            assert!((angle_between(&before, &after, t) - t * t).abs() < 1e-15);
        }
    }
}
