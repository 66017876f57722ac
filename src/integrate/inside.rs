//! Events inside a step of which its ends show nothing: two bodies that meet and have passed each other at the end, a spring
//! force that dips below zero.
//!
//! Between two moments at which an indicator is positive, falling at the first and rising at the second, it has a minimum.
//! As long as it bends upwards it lies above its tangents, so where these meet above zero nothing happens. Where they meet
//! below, the step is looked at there. The gap of two discs on straight ways bends upwards everywhere.

use super::locate::Moment;
use crate::tick::Indicator;

/// Looks into one step.
const MOST_LOOKS: usize = 24;

/// Moments of a step, from its beginning on.
pub(super) struct Inside {
    moments: Vec<Moment>,
    /// Length of the step in seconds.
    length: f64,
    looks: usize,
}

impl Inside {
    /// A step of `length` seconds, seen at its beginning and end.
    pub fn of(begin: &[Indicator], end: &[Indicator], length: f64) -> Self {
        let moment = |share: f64, indicators: &[Indicator]| Moment { share, indicators: indicators.to_vec() };
        Self { moments: vec![moment(0.0, begin), moment(1.0, end)], length, looks: 0 }
    }

    /// The share of the step that is to be looked at next.
    pub fn next(&mut self) -> Option<f64> {
        if self.looks >= MOST_LOOKS {
            return None;
        }
        self.looks += 1;
        self.moments.windows(2).find_map(|pair| suspect(&pair[0], &pair[1], self.length))
    }

    /// Takes what was seen there. What comes after an indicator below zero is not looked at any more.
    pub fn see(&mut self, moment: Moment) {
        let place = self.moments.partition_point(|known| known.share < moment.share);
        if moment
            .indicators
            .iter()
            .zip(&self.moments[0].indicators)
            .any(|(now, begin)| now.value < 0.0 && begin.value > 0.0)
        {
            self.moments.truncate(place);
        }
        self.moments.insert(place, moment);
    }

    /// The last two moments: in between is the first event, if there is one.
    pub fn last_two(mut self) -> (Moment, Moment) {
        let high = self.moments.pop().expect("there are two at least");
        let low = self.moments.pop().expect("there are two at least");
        (low, high)
    }
}

/// The share at which tangents of an indicator meet below zero: the earliest of all indicators.
fn suspect(from: &Moment, to: &Moment, length: f64) -> Option<f64> {
    let way = to.share - from.share;
    let meet = |(a, b): (&Indicator, &Indicator)| {
        if !(a.value > 0.0 && b.value >= 0.0 && a.slope < 0.0 && b.slope > 0.0) {
            return None;
        }
        let (first, second) = (a.slope * length, b.slope * length);
        let after = (b.value - a.value - second * way) / (first - second);
        let inside = after > 0.0 && after < way && a.value + first * after < 0.0;
        inside.then_some(from.share + after).filter(|share| *share > from.share && *share < to.share)
    };
    from.indicators.iter().zip(&to.indicators).filter_map(meet).reduce(f64::min)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn look(indicators: impl Fn(f64) -> Vec<Indicator>) -> (Moment, Moment, usize) {
        let mut inside = Inside::of(&indicators(0.0), &indicators(1.0), 1.0);
        let mut looks = 0;
        while let Some(share) = inside.next() {
            looks += 1;
            inside.see(Moment { share, indicators: indicators(share) });
        }
        let (low, high) = inside.last_two();
        (low, high, looks)
    }

    /// The gap of two discs of radius `r` that pass at a distance `d`.
    fn gap(t: f64, r: f64, d: f64) -> Indicator {
        let (x, speed) = (10.0 * (t - 0.3), 10.0);
        let distance = x.hypot(d);
        Indicator { value: distance - 2.0 * r, slope: x * speed / distance }
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
        let (_, _, looks) = look(|t| vec![Indicator { value: 1.0 - 0.5 * t, slope: -0.5 }]);
        assert_eq!(looks, 0);
    }
}
