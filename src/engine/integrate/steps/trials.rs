//! Runs of one-step methods on the motions of `problems.rs`, for tests of their order and cost.

use std::f64::consts::TAU;

use super::problems::{Counted, KEPLER, MOTIONS, ProblemMotion};
use super::{OneStep, Start};

/// A run with equal steps. Changes are added with compensation (Kahan 1965), so that rounding does not grow with their
/// number.
pub(super) struct TrialRun {
    pub(super) flow: Counted,
    pub(super) time: f64,
    pub(super) state: Vec<f64>,
    lost: Vec<f64>,
    lost_time: f64,
    rates: Vec<f64>,
    change: Vec<f64>,
}

impl TrialRun {
    /// At the beginning of a motion.
    pub(super) fn of(motion: ProblemMotion) -> Self {
        Self::at(motion, 0.0)
    }

    /// At some time of a motion.
    pub(super) fn at(motion: ProblemMotion, time: f64) -> Self {
        Self::from(motion, time, (motion.exact)(time))
    }

    /// From another time and state.
    pub(super) fn from(motion: ProblemMotion, time: f64, state: Vec<f64>) -> Self {
        let zero = vec![0.0; state.len()];
        let flow = Counted { motion, evaluations: 0 };
        Self { flow, time, state, lost: zero.clone(), lost_time: 0.0, rates: zero.clone(), change: zero }
    }

    /// One step. The rates at its beginning are taken here and not counted.
    pub(super) fn step(&mut self, method: &mut dyn OneStep, length: f64) {
        (self.flow.motion.rates)(self.time, &self.state, &mut self.rates);
        let start = Start { time: self.time, state: &self.state, rates: &self.rates };
        method.step(&mut self.flow, start, length, &mut self.change);
        for ((state, lost), change) in self.state.iter_mut().zip(&mut self.lost).zip(&self.change) {
            add(state, lost, *change);
        }
        add(&mut self.time, &mut self.lost_time, length);
    }

    /// Largest difference of a number of the state from the exact motion.
    pub(super) fn error(&self) -> f64 {
        distance(&self.state, &(self.flow.motion.exact)(self.time))
    }
}

/// Adds with compensation.
fn add(sum: &mut f64, lost: &mut f64, change: f64) {
    let change = change + *lost;
    let next = *sum + change;
    *lost = change - (next - *sum);
    *sum = next;
}

/// Largest difference of two numbers at the same place.
pub(super) fn distance(left: &[f64], right: &[f64]) -> f64 {
    left.iter().zip(right).fold(0.0, |most, (left, right)| (left - right).abs().max(most))
}

/// Slope of a straight line through points, by least squares.
pub(super) fn slope(points: &[(f64, f64)]) -> f64 {
    let count = points.len() as f64;
    let (x, y) = points.iter().fold((0.0, 0.0), |(x, y), point| (x + point.0 / count, y + point.1 / count));
    let (mut above, mut below) = (0.0, 0.0);
    for point in points {
        above += (point.0 - x) * (point.1 - y);
        below += (point.0 - x) * (point.0 - x);
    }
    above / below
}

/// Measured order of a method on a motion, from six step lengths. It is the slope of the error's logarithm over that of
/// the length. The error is the root mean square over all steps. The first run takes `fineness` times the steps of a
/// method of order 4. The `ratio` is the factor of steps from then on.
fn measured_order(method: &mut dyn OneStep, motion: ProblemMotion, fineness: f64, ratio: f64) -> f64 {
    let points: Vec<_> = (0..6)
        .map(|number| {
            let steps = (motion.steps * fineness * libm::pow(ratio, f64::from(number))).round();
            let length = motion.duration / steps;
            let mut run = TrialRun::of(motion);
            let mut squares = 0.0;
            for _ in 0..steps as usize {
                run.step(method, length);
                squares += run.error() * run.error();
            }
            (libm::log(length), 0.5 * libm::log(squares / steps))
        })
        .collect();
    slope(&points)
}

/// Demands the order of a method on all motions, to a quarter.
pub(super) fn demand_order(method: &mut dyn OneStep, order: u32, fineness: f64, ratio: f64) {
    for motion in MOTIONS {
        let measured = measured_order(method, motion, fineness, ratio);
        let off = (measured - f64::from(order)).abs();
        assert!(off <= 0.25, "{}: order {measured:.3} instead of {order}", motion.name);
    }
}

/// Demands that energy swings equally far in the first and last hundred of 10 000 periods of 2 pi. The tolerance is a
/// tenth, because the phases at which a hundred periods are sampled differ by less. Even a drift that is invisible in
/// the first hundred would make the last swing a hundred times as far.
pub(super) fn demand_bounded_energy(method: &mut dyn OneStep, motion: ProblemMotion, steps_per_period: f64) {
    let length = TAU / steps_per_period;
    let mut run = TrialRun::of(motion);
    let beginning = (motion.energy)(&run.state);
    let hundred = (100.0 * steps_per_period) as usize;
    let (mut first, mut last) = (0.0_f64, 0.0_f64);
    for number in 0..100 * hundred {
        run.step(method, length);
        let off = ((motion.energy)(&run.state) - beginning).abs();
        if number < hundred {
            first = first.max(off);
        } else if number >= 99 * hundred {
            last = last.max(off);
        }
    }
    assert!(first > 0.0 && last <= 1.1 * first, "{}: energy is off by {first:e}, later {last:e}", motion.name);
}

/// Demands that energy on an ellipse of eccentricity 0.9 (truth file P07) has no trend in 10 000 orbits. Energies are
/// averaged over a hundred orbits at a time. The gain of their regression line over the whole must be within four times
/// its statistical error. A gain below a thousandth of the swing in an orbit is accepted too.
pub(super) fn demand_no_trend(method: &mut dyn OneStep, steps_per_orbit: u32) {
    let length = TAU / f64::from(steps_per_orbit);
    let mut run = TrialRun::from(KEPLER, 0.0, vec![0.1, 0.0, 0.0, 19.0_f64.sqrt()]);
    let (mut lowest, mut highest, mut means) = (f64::INFINITY, f64::NEG_INFINITY, Vec::new());
    for block in 0..100 {
        let mut sum = 0.0;
        for _ in 0..100 * steps_per_orbit {
            run.step(method, length);
            let energy = (KEPLER.energy)(&run.state);
            (lowest, highest) = (lowest.min(energy), highest.max(energy));
            sum += energy;
        }
        means.push((f64::from(block), sum / f64::from(100 * steps_per_orbit)));
    }
    let count = means.len() as f64;
    let (rise, mean) = (slope(&means), means.iter().map(|(_, mean)| mean).sum::<f64>() / count);
    let middle = 0.5 * (count - 1.0);
    let spread: f64 = means.iter().map(|(block, _)| (block - middle).powi(2)).sum();
    let scatter: f64 = means.iter().map(|(block, value)| (value - mean - rise * (block - middle)).powi(2)).sum();
    let uncertainty = (scatter / (count - 2.0) / spread).sqrt() * count;
    let (gain, swing) = (rise * count, highest - lowest);
    assert!(
        gain.abs() <= (4.0 * uncertainty).max(1e-3 * swing),
        "energy gains {gain:e} +- {uncertainty:e} of {swing:e}"
    );
}

/// Demands that the same number of steps backwards returns to the start. Tolerance: eight roundings for each step,
/// times the measured condition number of the way back. That number is the growth of a small displacement.
pub(super) fn demand_reversible(method: &mut dyn OneStep, fineness: f64) {
    for motion in MOTIONS {
        let steps = (motion.steps * fineness).round();
        let length = motion.duration / steps;
        let mut run = TrialRun::of(motion);
        for _ in 0..steps as usize {
            run.step(method, length);
        }
        let displacement = 1e-6;
        let mut displaced =
            TrialRun::from(motion, run.time, run.state.iter().map(|number| number + displacement).collect());
        for _ in 0..steps as usize {
            run.step(method, -length);
            displaced.step(method, -length);
        }
        let condition = (distance(&displaced.state, &run.state) / displacement).max(1.0);
        let off = distance(&run.state, &(motion.exact)(0.0));
        let allowed = 16.0 * steps * f64::EPSILON * condition;
        assert!(off <= allowed, "{}: {off:e} off after the way back, {allowed:e} would be rounding", motion.name);
    }
}
