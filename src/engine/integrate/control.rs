//! Step size control by the estimated error (Hairer, Norsett, Wanner, *Solving Ordinary Differential Equations I*,
//! 1993, II.4).
//!
//! Errors of velocities are measured by the greatest speed so far. Errors of positions are measured by the greatest
//! distance so far, but at most by that of the step. The reason is a stiff contact with its small overlap: a wrong
//! position becomes a wrong velocity within the step. So a run needs no scales beforehand, and runs with different
//! allowed errors are alike.

use glam::DVec2;

use super::steps::OneStep;
use crate::tick::Flow;
use crate::tick::{Reach, StepCount, WorldFlow};
use serde::{Deserialize, Serialize};

/// A step aims at this share of the length at which its error would reach the allowance.
const SAFETY: f64 = 0.9;
/// Bounds of the ratio of a step to the one before it, for growth and for shrinking.
const MOST_GROWTH: f64 = 5.0;
const MOST_SHRINKING: f64 = 0.1;
/// The first step probes the rates over this share of itself.
const PROBE: f64 = 0.01;

/// The first step of DOP853 swings by about this angle in radians, times the root of the allowed share.
const BEND: f64 = 6.0;
/// No first step is longer than a swing over this angle takes: a third of a contact.
const MOST_BEND: f64 = 1.0;

/// The number of guesses of the first step. Each uses the sizes that bodies may reach in the step guessed before.
const PASSES: usize = 2;

/// Positions round by a share of their distance from the origin. In a step the estimate of the error sees about this
/// much of it. For velocities that is divided by the length of the step. No smaller error can be reached. Stiff
/// contacts turn the rounding into forces, and steps would shrink in vain.
const ROUNDING: f64 = f64::EPSILON / 64.0;
/// Motion over less than this share of the distance from the origin is itself little more than rounding.
const STILL: f64 = 1024.0 * f64::EPSILON;

/// The allowed error of a step.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Allowance {
    /// Error of a step, as a share of the distance and the speed of bodies so far.
    pub share: f64,
    /// The longest step in s.
    pub longest: f64,
    /// The approximate limit of steps to the end of a tick. If more are needed, the run ends with a message.
    pub most_steps: f64,
    /// The factor by which steps without a bound by their error are shorter. Those are bounded by `longest` or by the next
    /// jump of a force, or are the first. Two runs that differ in it have no such step in common.
    pub shorter: f64,
}

impl Allowance {
    /// The allowance of a run that may take `longest` seconds for a step.
    pub fn new(share: f64, longest: f64) -> Self {
        Self { share, longest, most_steps: MOST_STEPS, shorter: 1.0 }
    }

    /// The same with another share. Errors fall with the power `ORDER` of the step. So steps bounded otherwise become
    /// shorter in the same proportion.
    pub fn with_share(self, share: f64) -> Self {
        let shorter = self.shorter * libm::pow(self.share / share, 1.0 / ORDER);
        Self { share, shorter: shorter.max(1.0), ..self }
    }
}

/// The power of the step by which errors of the methods that estimate them fall.
pub const ORDER: f64 = 8.0;
/// A way to a jump that exceeds a part by less than this share is one part.
const WHOLE: f64 = 1e-6;

/// Steps that no tick needs where bodies do not fall upon each other: more take half a minute.
pub const MOST_STEPS: f64 = 1e7;

/// The control of a run.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) struct Control {
    allowance: Allowance,
    /// The greatest distance of bodies so far in m, and their greatest speed in m/s.
    distance: f64,
    speed: f64,
    /// Positions and angles at the beginning of the run.
    origin: Vec<(DVec2, f64)>,
    /// The length to be tried next, in s; nothing after a state that does not follow from the one before.
    next: Option<f64>,
    /// The unit of errors for each number of the state.
    measures: Vec<f64>,
    /// The error of velocities in m/s that the last step was allowed. Whether that is more than was asked for, because of rounding.
    allowed: f64,
    bounded: bool,
    /// The next jump of a force in s, and the longest part in s of the way to it.
    jump: f64,
    part: f64,
}

impl Control {
    /// Whether another one, from a file, gives steps the same lengths.
    pub fn paces_as(&self, saved: &Self) -> bool {
        self.allowance == saved.allowance
    }

    /// Whether its numbers are lengths, and those of so many bodies.
    pub fn fits(&self, bodies: usize) -> bool {
        let Self { distance, speed, origin, next, measures, allowed, jump, part, .. } = self;
        let positive = |number: f64| number >= 0.0;
        [*distance, *speed, *allowed, *jump, *part].into_iter().all(positive)
            && next.is_none_or(|next| next > 0.0)
            && measures.iter().all(|measure| positive(*measure))
            && origin.len() <= bodies
    }

    pub fn new(allowance: Allowance) -> Self {
        Self {
            allowance,
            distance: 0.0,
            speed: 0.0,
            origin: Vec::new(),
            next: None,
            measures: Vec::new(),
            allowed: 0.0,
            bounded: false,
            jump: f64::INFINITY,
            part: f64::INFINITY,
        }
    }

    /// The motion that comes does not follow from the one before.
    pub fn forget(&mut self) {
        self.next = None;
    }

    /// The longest step in s that is tried from `now`, if forces jump at `jump` next. The way to a jump is divided into
    /// equal parts, one for a run without finer ones beside it.
    pub fn longest(&mut self, now: f64, jump: f64) -> f64 {
        if jump != self.jump {
            let part = (jump - now) / self.allowance.shorter.ceil();
            // The times of one jump may differ by rounding. That has no parts, and a part of it would not pass time.
            (self.jump, self.part) = (jump, if now + part > now { part } else { f64::INFINITY });
        }
        let part = if jump - now > (1.0 + WHOLE) * self.part { self.part } else { f64::INFINITY };
        let longest = (self.allowance.longest / self.allowance.shorter).min(part);
        self.next.map_or(longest, |next| next.min(longest))
    }

    /// The factor by which steps are shorter that are bounded otherwise than by their error.
    pub fn shorter(&self) -> f64 {
        self.allowance.shorter
    }

    /// The most steps that may be needed to the end of a tick.
    pub fn most_steps(&self) -> f64 {
        self.allowance.most_steps
    }

    /// The error of velocities in m/s that the last step was allowed.
    pub fn velocity_error(&self) -> f64 {
        self.allowed
    }

    /// Counts the error that the last step was allowed. Rounding of places may have made it larger than was asked for.
    pub fn count(&self, count: &mut StepCount) {
        count.allowed += self.allowed;
        if self.bounded {
            count.bounded += 1;
            count.allowed_to_bounded += self.allowed;
        }
    }

    /// Looks how far and how fast bodies are.
    pub fn look(&mut self, flow: &WorldFlow) {
        if self.origin.is_empty() {
            self.origin = flow.places();
        }
        let (distance, speed) = flow.sizes_since(&self.origin);
        self.distance = self.distance.max(distance);
        self.speed = self.speed.max(speed);
    }

    /// The length of the step to be tried from a state with these rates, at most `longest` seconds. The flow may be
    /// left in another state.
    pub fn length(
        &mut self,
        flow: &mut WorldFlow,
        order: u32,
        (time, state, rates): (f64, &[f64], &[f64]),
        longest: f64,
    ) -> f64 {
        let length = match self.next {
            Some(length) => length,
            None => self.first(flow, order, (time, state, rates), longest),
        };
        length.min(longest)
    }

    /// A first guess, by which rates change by a small share of themselves. A short probe measures the change.
    fn first(
        &mut self,
        flow: &mut WorldFlow,
        order: u32,
        (time, state, rates): (f64, &[f64], &[f64]),
        longest: f64,
    ) -> f64 {
        let reach = flow.reach();
        let (distance, speed) = self.sizes(reach, longest);
        flow.measures(distance, speed, &mut self.measures);
        flow.measure_own(1.0, &mut self.measures);
        let times = rates.iter().zip(&self.measures).map(|(rate, size)| rate.abs() / size);
        let quickest = times.fold(0.0, f64::max);
        let probe = PROBE * if quickest * longest > 1.0 { 1.0 / quickest } else { longest };
        let probed: Vec<f64> = state.iter().zip(rates).map(|(state, rate)| state + probe * rate).collect();
        let mut after = vec![0.0; state.len()];
        flow.rates(time + probe, &probed, &mut after);
        // Forces on bodies at rest may only begin.
        let later = flow.reach();
        let reach =
            Reach { speed: reach.speed.max(later.speed), acceleration: reach.acceleration.max(later.acceleration) };
        if reach == Reach::default() {
            // No body moves yet, while states of models may. No size says how fast their change is: the error of the step does.
            return longest;
        }
        let allowed = libm::pow(self.allowance.share, 1.0 / f64::from(order));
        let mut length = longest;
        for _ in 0..PASSES {
            let (distance, speed) = self.sizes(reach, length);
            flow.measures(distance, speed, &mut self.measures);
            flow.measure_own(1.0, &mut self.measures);
            let bends = rates.iter().zip(&after).zip(&self.measures);
            let bend = bends.map(|((before, after), size)| (after - before).abs() / (probe * size)).fold(0.0, f64::max);
            let guess = (BEND * allowed).min(MOST_BEND / self.allowance.shorter) / bend.sqrt();
            length = if guess.is_finite() && guess < length { guess } else { length };
        }
        length
    }

    /// The distance (m) and speed (m/s) of bodies so far, or those that a step of `length` seconds may reach.
    fn sizes(&self, reach: Reach, length: f64) -> (f64, f64) {
        let distance = self.distance.max(length * (reach.speed + 0.5 * length * reach.acceleration));
        let speed = self.speed.max(reach.speed + length * reach.acceleration);
        (distance.min(length * speed).max(f64::MIN_POSITIVE), speed.max(f64::MIN_POSITIVE))
    }

    /// The estimated error of the last step, divided by the allowed one; `None` if the method has no estimate. `made`:
    /// the reach at its beginning, its length in seconds, and the change it made of the state.
    pub fn error(&mut self, method: &dyn OneStep, flow: &mut WorldFlow, made: (Reach, f64, &[f64])) -> Option<f64> {
        let (reach, length, change) = made;
        if change.iter().any(|change| !change.is_finite()) {
            // Sizes would be infinite with it, and no error is large beside them.
            return Some(f64::INFINITY);
        }
        let (distance, speed) = self.sizes(reach, length);
        // Bodies on which nothing acted at the beginning go as far as the step took them.
        let (far, fast) = flow.sizes_of(change);
        let (distance, speed) = (distance.max(far), speed.max(fast));
        let share = self.allowance.share;
        let rounding = ROUNDING * flow.farthest();
        let least = rounding.max(share * f64::MIN_POSITIVE);
        self.bounded = distance > STILL * flow.farthest() && (rounding > share * distance);
        let speeds = (share * speed).max(least / length);
        self.allowed = if self.bounded { speeds } else { share * speed };
        flow.measures((share * distance).max(least), speeds, &mut self.measures);
        flow.measure_own(share, &mut self.measures);
        method.error(&self.measures)
    }

    /// The same with an additional allowance for the rounding of each number. It uses the arguments of the last call of
    /// `error`.
    pub fn error_beside(&mut self, method: &dyn OneStep, rounding: &[f64]) -> Option<f64> {
        self.measures.iter_mut().zip(rounding).for_each(|(size, rounding)| *size += rounding);
        method.error(&self.measures)
    }

    /// The length of the next step. The last one took `length` seconds, and `error` is the ratio of its error to the
    /// allowed one.
    pub fn adapt(&mut self, length: f64, error: f64, order: u32) -> f64 {
        let factor = SAFETY * libm::pow(error, -1.0 / f64::from(order));
        // NaN or infinite forces leave no estimate, which asks for the shortest step.
        let factor = if factor.is_nan() { MOST_SHRINKING } else { factor.clamp(MOST_SHRINKING, MOST_GROWTH) };
        let next = length * factor;
        self.next = Some(next);
        next
    }
}
