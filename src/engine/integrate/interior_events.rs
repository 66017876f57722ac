//! Events inside a step whose ends show no change of sign. Examples are two bodies that meet and pass each other, and a
//! spring force that dips below zero.
//!
//! Between two moments at which an indicator is positive it may have a minimum. If it bends downwards by at most `c`,
//! it lies above two parabolas, `g + g' t - c t^2/2` from both moments. If these meet above zero, there is no event. If
//! they meet below, the step is evaluated at that time. The gap of two discs bends downwards only by their relative
//! acceleration: on straight ways it bends upwards everywhere. The value of `c` between two moments is estimated from
//! both. It is the greater one plus the difference between them.
//!
//! The rate of an indicator may be unknown, such as that of the force of a row. Such an indicator lies above the
//! parabola `chord - c t (T - t)/2` through both moments (the error of linear interpolation). If it is below zero at
//! the later moment, it may have passed zero three times. It passed only once if the chord falls faster than such a
//! parabola turns.

use super::locate::{IndicatorSample, vanished};
use crate::tick::Indicator;

/// Looks into one step.
const MOST_LOOKS: usize = 24;

/// Moments of a step, from its beginning on.
pub(super) struct Inside {
    samples: Vec<IndicatorSample>,
    /// Length of the step in seconds.
    length: f64,
    looks: usize,
}

impl Inside {
    /// A step of `length` seconds, seen at its beginning and end.
    pub fn of(begin: &[Indicator], end: &[Indicator], length: f64) -> Self {
        let sample = |share: f64, indicators: &[Indicator]| IndicatorSample { share, indicators: indicators.to_vec() };
        Self { samples: vec![sample(0.0, begin), sample(1.0, end)], length, looks: 0 }
    }

    /// The share of the step that is to be looked at next.
    pub fn next(&mut self) -> Option<f64> {
        if self.looks >= MOST_LOOKS {
            return None;
        }
        self.looks += 1;
        Some(self.suspected()?.1)
    }

    /// The first pair of moments between which something may happen, and where.
    fn suspected(&self) -> Option<(usize, f64)> {
        let pairs = self.samples.windows(2).enumerate();
        pairs.filter_map(|(index, pair)| Some((index, suspect(&pair[0], &pair[1], self.length)?))).next()
    }

    /// Takes the indicators of a moment. If one of them is below zero, all later moments are discarded.
    pub fn see(&mut self, sample: IndicatorSample) {
        let index = self.samples.partition_point(|known| known.share < sample.share);
        if sample
            .indicators
            .iter()
            .zip(&self.samples[0].indicators)
            .any(|(now, begin)| vanished(now) && begin.value > 0.0)
        {
            self.samples.truncate(index);
        }
        self.samples.insert(index, sample);
    }

    /// The last two moments, which enclose the first event if there is one. After too many evaluations the step ends at
    /// the first interval in which an event remains possible.
    pub fn last_two(mut self) -> (IndicatorSample, IndicatorSample) {
        if self.looks >= MOST_LOOKS
            && let Some((index, _)) = self.suspected()
        {
            self.samples.truncate(index + 2);
        }
        let high = self.samples.pop().expect("there are two at least");
        let low = self.samples.pop().expect("there are two at least");
        (low, high)
    }
}

/// The share at which the bounds of an indicator from both sides meet below zero: the earliest of all indicators.
fn suspect(from: &IndicatorSample, to: &IndicatorSample, length: f64) -> Option<f64> {
    let way = to.share - from.share;
    let meet = |(a, b): (&Indicator, &Indicator)| {
        let bend = (a.bend.max(b.bend) + (a.bend - b.bend).abs()) * length * length;
        let known = !(a.slope.is_nan() || b.slope.is_nan());
        if !known && a.value > 0.0 && b.value < 0.0 {
            // If the rate may change its sign, there may be more than one passage.
            let turns = a.value - b.value < 0.5 * bend * way * way;
            return turns.then_some(from.share + 0.5 * way);
        }
        if !(a.value >= 0.0 && b.value >= 0.0 && a.value + b.value > 0.0) {
            return None;
        }
        let (after, least) = match known {
            true => between_rates([a, b], bend, (way, length)),
            false => below_chord([a.value, b.value], bend, way),
        };
        let inside = after > 0.0 && after < way && least < 0.0;
        inside.then_some(from.share + after).filter(|share| *share > from.share && *share < to.share)
    };
    from.indicators.iter().zip(&to.indicators).filter_map(meet).reduce(f64::min)
}

/// The meeting point of the two parabolas that begin at both ends of a piece. It is given as a share of the step after
/// its beginning, and as a height.
fn between_rates([a, b]: [&Indicator; 2], bend: f64, (way, length): (f64, f64)) -> (f64, f64) {
    let (first, second) = (a.slope * length, b.slope * length);
    let after = (b.value - a.value - second * way - 0.5 * bend * way * way) / (first - second - bend * way);
    (after, a.value + (first - 0.5 * bend * after) * after)
}

/// The lowest point that a value of unknown rate may reach on a piece: `g >= chord - c t (way - t)/2`.
fn below_chord([a, b]: [f64; 2], bend: f64, way: f64) -> (f64, f64) {
    let rise = (b - a) / way;
    let after = 0.5 * way - rise / bend;
    (after, a + (rise - 0.5 * bend * (way - after)) * after)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn look(indicators: impl Fn(f64) -> Vec<Indicator>) -> (IndicatorSample, IndicatorSample, usize) {
        look_within(1.0, indicators)
    }

    fn look_within(
        length: f64,
        indicators: impl Fn(f64) -> Vec<Indicator>,
    ) -> (IndicatorSample, IndicatorSample, usize) {
        let mut inside = Inside::of(&indicators(0.0), &indicators(length), length);
        let mut looks = 0;
        while let Some(share) = inside.next() {
            looks += 1;
            inside.see(IndicatorSample { share, indicators: indicators(share * length) });
        }
        let (low, high) = inside.last_two();
        (low, high, looks)
    }

    /// The gap of two discs of radius `r` that pass at a distance `d`.
    fn gap(t: f64, r: f64, d: f64) -> Indicator {
        let (x, speed) = (10.0 * (t - 0.3), 10.0);
        let distance = x.hypot(d);
        Indicator { value: distance - 2.0 * r, slope: x * speed / distance, ..Indicator::default() }
    }

    /// The gap between a disc on a circle of radius 1 and a peg at 2 rad on the circle. The disc circles once in 6.3 seconds. The
    /// disc starts at the angle `begin`. The gap bends downwards everywhere except at the peg.
    fn gap_on_a_circle(t: f64, begin: f64) -> Indicator {
        let half = 0.5 * (t + begin - 2.0);
        Indicator {
            value: 2.0 * libm::sin(half).abs() - 0.02,
            slope: libm::cos(half) * half.signum(),
            bend: 1.0,
            ..Indicator::default()
        }
    }

    #[test]
    fn a_peg_on_a_curved_way_is_seen() {
        for (begin, length) in [(0.0, 5.0), (1.5, 3.0), (-1.2, 5.5), (1.99 - std::f64::consts::PI, 5.0)] {
            let (_, high, looks) = look_within(length, |t| vec![gap_on_a_circle(t, begin)]);
            let angle = begin + length * high.share;
            assert!((angle - 2.0).abs() < 0.02 && high.indicators[0].value < 0.0, "{begin}: {angle} {looks}");
        }
    }

    /// A parabola over the ground is its own bound.
    #[test]
    fn a_throw_that_does_not_come_down_is_not_looked_at() {
        let height = |t: f64| Indicator {
            value: 0.1 + 3.0 * t - 2.0 * t * t,
            slope: 3.0 - 4.0 * t,
            bend: 4.0,
            ..Indicator::default()
        };
        let (_, high, looks) = look(|t| vec![height(t)]);
        assert!(high.share == 1.0 && looks == 0, "{looks}");
    }

    /// A way along a surface, so near that two dozen evaluations cannot distinguish it from touching.
    #[test]
    fn a_step_ends_where_it_stays_open_whether_bodies_meet() {
        let (_, high, looks) = look(|_| vec![Indicator { value: 1e-6, slope: 0.0, bend: 1.0, ..Indicator::default() }]);
        assert!(high.share > 0.0 && high.share < 1.0 && looks == MOST_LOOKS, "{high:?} {looks}");
    }

    /// A force that swings, and passes its bound for a hundredth of the step.
    #[test]
    fn a_peak_of_unknown_rate_is_seen() {
        for (begin, length) in [(0.0, 3.0), (0.4, 2.5), (1.5, 6.0)] {
            let omega = std::f64::consts::FRAC_PI_2;
            let room = |t: f64| Indicator {
                value: 1.0 - 1.0001 * libm::sin(omega * (begin + t)),
                slope: f64::NAN,
                bend: 2.0 * omega * omega,
                ..Indicator::default()
            };
            let (_, high, looks) = look_within(length, |t| vec![room(t)]);
            let time = begin + length * high.share;
            assert!((time - time.round()).abs() < 0.01 && high.indicators[0].value < 0.0, "{begin}: {time} {looks}");
        }
    }

    /// A force that swings beyond its bounds several times. The first passage counts, although the step ends within the
    /// last one.
    #[test]
    fn the_first_of_several_passages_of_unknown_rate_counts() {
        let room =
            |t: f64| Indicator { value: 1.0 - 1.5 * libm::sin(t), slope: f64::NAN, bend: 2.0, ..Indicator::default() };
        let length = 2.5 * std::f64::consts::PI;
        let (low, high, _) = look_within(length, |t| vec![room(t)]);
        let first = libm::asin(1.0 / 1.5);
        assert!(low.share * length < first && (first..1.6).contains(&(high.share * length)), "{low:?} {high:?}");
    }

    #[test]
    fn a_meeting_much_shorter_than_the_step_is_seen() {
        let (low, high, looks) = look(|t| vec![gap(t, 0.05, 0.02)]);
        assert!(low.share < 0.3 && high.share < 0.4 && high.indicators[0].value < 0.0 && looks < 8, "{high:?} {looks}");
    }

    #[test]
    fn a_near_miss_is_looked_at_and_let_go() {
        let (low, high, looks) = look(|t| vec![gap(t, 0.05, 0.11)]);
        assert!(high.share == 1.0 && high.indicators[0].value > 0.0 && low.share > 0.0 && looks < 16, "{looks}");
    }

    #[test]
    fn the_first_of_two_meetings_counts() {
        let (_, high, _) = look(|t| vec![gap(t + 0.0, 0.05, 0.0), gap(t + 0.2, 0.05, 0.0)]);
        assert!(high.share < 0.15 && high.indicators[1].value < 0.0, "{high:?}");
    }

    #[test]
    fn what_only_rises_or_falls_is_not_looked_at() {
        let (_, _, looks) = look(|t| vec![Indicator { value: 1.0 - 0.5 * t, slope: -0.5, ..Indicator::default() }]);
        assert_eq!(looks, 0);
    }
}
