//! The growth of the difference of two runs.

use jostle_engine::simulation::accuracy::trajectory::Trajectory;

/// If runs differ by more than this share of the motion, their positions are meaningless.
const USELESS: f64 = 0.1;
/// Differences of smooth motion grow with no higher power of time, for long: faster is exponential growth.
const HIGHEST_POWER: f64 = 3.0;
/// Differences below this share of the motion are rounding, and show no order.
const ROUNDING: f64 = 1e-13;

/// Time in s, difference of places in m and of velocities in m/s at each moment.
pub(super) struct Seen(Vec<(f64, f64, f64)>);

impl Seen {
    pub fn between(run: &Trajectory, other: &Trajectory) -> Self {
        Self(run.errors(other).collect())
    }
}

/// How far two runs part.
#[derive(Clone, Debug)]
pub(super) struct Growth {
    seen: Vec<(f64, f64, f64)>,
    /// The distance that bodies go, in m.
    motion: f64,
    /// Greatest difference of places until the horizon, in m.
    pub distance: f64,
    /// Root of the mean square over time of the greatest difference of velocities until the horizon, in m/s.
    pub speed: f64,
    /// The last moment in s at which the positions of both runs are meaningful. `None` if they always are.
    pub horizon: Option<f64>,
}

impl Growth {
    /// The results of two runs whose bodies go as far as `motion` metres.
    pub fn of(seen: Seen, motion: f64) -> Self {
        let Seen(seen) = seen;
        // NaN is useless too.
        let lost = seen.iter().position(|(_, far, _)| !(*far <= USELESS * motion || motion == 0.0));
        let horizon = lost.map(|index| index.checked_sub(1).map_or(0.0, |before| seen[before].0));
        let told = &seen[..lost.unwrap_or(seen.len())];
        let distance = told.iter().fold(0.0_f64, |most, (_, far, _)| most.max(*far));
        Self { motion, distance, speed: mean(told), horizon, seen }
    }

    /// The difference of positions as a share of the ways of bodies. One if positions are meaningless.
    pub fn share(&self) -> Option<f64> {
        let share = if self.motion > 0.0 { self.distance / self.motion } else { 0.0 };
        Some(if self.horizon.is_some() { 1.0 } else { share })
    }

    /// The power with which differences fall with the tick, from two runs and a pair twice as fine. `None` if the
    /// differences are rounding, or do not fall.
    pub fn order_against(&self, finer: &Self) -> Option<f64> {
        let order = libm::log2(self.distance / finer.distance);
        let told = finer.distance > ROUNDING * self.motion && self.horizon.is_none();
        (told && order.is_finite() && order > 0.0).then_some(order)
    }

    /// Whether positions are lost because differences grew exponentially. They grew more in the later half of their
    /// visible time than by any power.
    pub fn is_exponential(&self) -> bool {
        let Some(end) = self.horizon else { return false };
        let seen = |(_, far, _): &&(f64, f64, f64)| *far > ROUNDING * self.motion;
        let Some(&(begin, ..)) = self.seen.iter().find(seen) else { return false };
        self.until(end) > libm::exp2(HIGHEST_POWER) * self.until(0.5 * (begin + end))
    }

    /// The greatest difference of places until a time in s, in m.
    fn until(&self, time: f64) -> f64 {
        let before = self.seen.iter().filter(|(at, ..)| *at <= time);
        before.fold(0.0_f64, |most, (_, far, _)| most.max(*far))
    }
}

/// Root of the mean square over time, by the rule of trapezoids.
fn mean(seen: &[(f64, f64, f64)]) -> f64 {
    let area = |pair: &[(f64, f64, f64)]| (pair[1].0 - pair[0].0) * 0.5 * (pair[0].2.powi(2) + pair[1].2.powi(2));
    match seen {
        [.., last] if last.0 > seen[0].0 => (seen.windows(2).map(area).sum::<f64>() / (last.0 - seen[0].0)).sqrt(),
        _ => seen.iter().fold(0.0, |most, (.., fast)| most.max(*fast)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grown(law: impl Fn(f64) -> f64, until: u32) -> Growth {
        let seen = (0..=until).map(|time| (f64::from(time), law(f64::from(time)), 2.0 * law(f64::from(time))));
        Growth::of(Seen(seen.collect()), 1.0)
    }

    /// Only the last moment of agreement counts, and not later, larger differences.
    #[test]
    fn a_horizon_that_was_seen_ends_what_is_told() {
        let growth = grown(|time| 0.01 * time, 50);
        assert_eq!(growth.horizon, Some(10.0));
        assert!(growth.distance <= 0.1 && growth.distance > 0.099);
        assert_eq!(growth.share(), Some(1.0));
        // `2 c t` has the mean square `4 c^2 T^2/3`; the rule of trapezoids adds a part in 2 T^2.
        let exact = 2.0 * 0.1 / 3.0_f64.sqrt();
        assert!((growth.speed / exact - 1.0).abs() < 1.0 / 200.0, "{}", growth.speed);
    }

    #[test]
    fn the_order_is_that_of_the_differences() {
        let (coarse, fine) = (grown(|time| 4e-6 * time, 16), grown(|time| 1e-6 * time, 16));
        assert_eq!(coarse.order_against(&fine), Some(2.0));
        assert_eq!(fine.order_against(&coarse), None);
        let rounding = grown(|_| 1e-15, 16);
        assert_eq!(fine.order_against(&rounding), None);
    }
}
