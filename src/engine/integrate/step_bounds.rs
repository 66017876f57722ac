//! Bounds of a step beside its error: many atoms, loads that change while bodies rest, the rounding of times.

use super::steps::Start;
use crate::tick::{Flow, Indicator, WorldFlow};

/// In scenes of more atoms than this a step moves no body farther than `MOST_RADII` smallest radii. Each stage visits
/// all pairs that a step may bring together, and an event ends it soon.
const MANY_ATOMS: usize = 64;
const MOST_RADII: f64 = 8.0;

/// The greatest angle in rad over which a load may swing in a step that holds bodies by forces. Nothing moves under such
/// a load, so no error of the step tells of it.
const LOAD_SWING: f64 = 1.0;

/// The number of times that a step whose trial overflows is shortened, and the share that remains each time. Forces without a
/// bound at the beginning of the step keep overflowing, and the run ends with an error.
pub(super) const MOST_OVERFLOWS: u32 = 30;
pub(super) const AFTER_OVERFLOW: f64 = 0.25;

/// Whether all numbers of a state are finite.
pub(super) fn is_finite(state: &[f64]) -> bool {
    state.iter().all(|value| value.is_finite())
}

/// The longest sensible step in s in a scene of many bodies that may collide.
pub(super) fn longest_among_many(flow: &WorldFlow) -> f64 {
    let bodies = &flow.tick.state().bodies;
    if bodies.atom_count() <= MANY_ATOMS || flow.tick.bounds().is_none() {
        return f64::INFINITY;
    }
    let (reach, way) = (flow.reach(), MOST_RADII * bodies.smallest_radius);
    // The smaller root of `v t + a t^2/2 = way`, written so that nothing cancels.
    2.0 * way / (reach.speed + (reach.speed * reach.speed + 2.0 * reach.acceleration * way).sqrt())
}

/// The longest step in s from a time over which loads of forces that hold something keep their course. The forces of
/// systems of users have an unknown course: beside them a step ends with its tick.
pub(super) fn longest_under_loads(flow: &WorldFlow, indicators: &[Indicator], from: f64) -> f64 {
    if !indicators.iter().any(Indicator::is_sampled) {
        return f64::INFINITY;
    }
    let state = flow.tick.state();
    let tick = if state.has_force_systems() && flow.tick.end > from { flow.tick.end - from } else { f64::INFINITY };
    tick.min(LOAD_SWING / state.fastest_rhythm())
}

/// The effect of the rounding of times on each number of the state in a step of `length` seconds. The force of a short
/// pulse differs between two neighbouring times.
pub(super) fn rounding_of_time(flow: &mut WorldFlow, start: Start, length: f64) -> Vec<f64> {
    let until = start.time + length;
    let (mut rounding, mut before) = (vec![0.0; flow.dimension()], vec![0.0; flow.dimension()]);
    let end = flow.ends_at(f64::NAN);
    flow.rates(until, start.state, &mut rounding);
    flow.rates(until - 4.0 * f64::EPSILON * until.abs(), start.state, &mut before);
    flow.ends_at(end);
    rounding.iter_mut().zip(&before).for_each(|(rate, before)| *rate = length * (*rate - before).abs());
    let coordinates = flow.coordinates();
    for index in 0..coordinates {
        rounding[index] += length * rounding[coordinates + index];
    }
    rounding
}
