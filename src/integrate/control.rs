//! How long steps are: as long as their estimated error allows (Hairer, Norsett, Wanner, *Solving Ordinary Differential
//! Equations I*, 1993, II.4).
//!
//! Errors of positions are measured by how far bodies went so far, or may go in the step, those of velocities by how fast they
//! were: so a run does not depend on what is known of it beforehand, and runs that allow different errors are alike.

use glam::DVec2;

use super::steps::{Flow, OneStep};
use crate::tick::{Reach, WorldFlow};

/// A step aims at this share of the length at which its error would be what is allowed.
const SAFETY: f64 = 0.9;
/// Steps grow and shrink by no more than these factors.
const MOST_GROWTH: f64 = 5.0;
const MOST_SHRINKING: f64 = 0.1;
/// The first step probes the rates over this share of itself.
const PROBE: f64 = 0.01;

/// A step of a swing over this angle in radians, times the root of the allowed share, is about what DOP853 is allowed.
const BEND: f64 = 6.0;
/// No first step is longer than a swing over this angle takes: a third of a contact.
const MOST_BEND: f64 = 1.0;

/// Places are rounded by a share of their distance from the origin; in a step the estimate of the error sees about this much of
/// it. Less than what that is of the motion cannot be asked:
/// stiff contacts turn it into forces, and steps would shrink for nothing.
const ROUNDING: f64 = f64::EPSILON / 64.0;

/// What error a step may have.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Allowance {
    /// Error of a step, as a share of how far and how fast bodies went so far.
    pub share: f64,
    /// The longest step in s.
    pub longest: f64,
}

/// The control of a run.
#[derive(Clone, Debug)]
pub(super) struct Control {
    allowance: Allowance,
    /// How far bodies went so far, in m, and how fast, in m/s.
    distance: f64,
    speed: f64,
    /// Positions and angles at the beginning of the run.
    origin: Vec<(DVec2, f64)>,
    /// The length to be tried next, in s; nothing after a state that does not follow from the one before.
    next: Option<f64>,
    sizes: Vec<f64>,
    /// Whether the last step was allowed more than was asked for, because of rounding.
    bounded: bool,
}

impl Control {
    pub fn new(allowance: Allowance) -> Self {
        Self { allowance, distance: 0.0, speed: 0.0, origin: Vec::new(), next: None, sizes: Vec::new(), bounded: false }
    }

    /// The motion that comes does not follow from the one before.
    pub fn forget(&mut self) {
        self.next = None;
    }

    /// The longest step that is tried.
    pub fn longest(&self) -> f64 {
        self.next.map_or(self.allowance.longest, |next| next.min(self.allowance.longest))
    }

    /// Whether rounding of places allowed the last step a larger error than was asked for.
    pub fn is_bounded(&self) -> bool {
        self.bounded
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

    /// The length of the step to be tried, from a state with these rates; no longer than `longest` seconds. The flow may be
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

    /// A first guess: rates change by a small share of themselves, as far as a short probe tells.
    fn first(
        &mut self,
        flow: &mut WorldFlow,
        order: u32,
        (time, state, rates): (f64, &[f64], &[f64]),
        longest: f64,
    ) -> f64 {
        let reach = flow.reach();
        self.measure(flow, reach, longest);
        let times = rates.iter().zip(&self.sizes).map(|(rate, size)| rate.abs() / size);
        let quickest = times.fold(0.0, f64::max);
        let probe = PROBE * if quickest * longest > 1.0 { 1.0 / quickest } else { longest };
        let probed: Vec<f64> = state.iter().zip(rates).map(|(state, rate)| state + probe * rate).collect();
        let mut after = vec![0.0; state.len()];
        flow.rates(time + probe, &probed, &mut after);
        let bends = rates.iter().zip(&after).zip(&self.sizes);
        let bend = bends.map(|((before, after), size)| (after - before).abs() / (probe * size)).fold(0.0, f64::max);
        let allowed = libm::pow(self.allowance.share, 1.0 / f64::from(order));
        let length = (BEND * allowed).min(MOST_BEND) / bend.sqrt();
        if length.is_finite() && length < longest { length } else { longest }
    }

    /// The sizes that errors of a step of `length` seconds are measured by. Returns that of places, in m.
    fn measure(&mut self, flow: &WorldFlow, reach: Reach, length: f64) -> f64 {
        let distance = self.distance.max(length * (reach.speed + 0.5 * length * reach.acceleration));
        let speed = self.speed.max(reach.speed + length * reach.acceleration);
        let distance = distance.max(f64::MIN_POSITIVE);
        flow.measures(distance, speed.max(f64::MIN_POSITIVE), &mut self.sizes);
        distance
    }

    /// The estimated error of the step that was just made, over what is allowed; nothing if the method knows no estimate.
    /// `made`: the reach at its beginning and its length in seconds.
    pub fn error(&mut self, method: &dyn OneStep, flow: &WorldFlow, made: (Reach, f64)) -> Option<f64> {
        let (reach, length) = made;
        let distance = self.measure(flow, reach, length);
        let least = ROUNDING * flow.farthest() / distance;
        self.bounded = least > self.allowance.share;
        let share = self.allowance.share.max(least);
        self.sizes.iter_mut().for_each(|size| *size *= share);
        method.error(&self.sizes)
    }

    /// After a step of `length` seconds with this error over what is allowed: how long the next one is tried.
    pub fn adapt(&mut self, length: f64, error: f64, order: u32) -> f64 {
        let factor = SAFETY * libm::pow(error, -1.0 / f64::from(order));
        // No estimate at all, as where forces are not finite, asks for the shortest.
        let factor = if factor.is_nan() { MOST_SHRINKING } else { factor.clamp(MOST_SHRINKING, MOST_GROWTH) };
        let next = length * factor;
        self.next = Some(next);
        next
    }
}
