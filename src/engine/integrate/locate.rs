//! Event location: the root of an indicator within a step (cubic interpolation, Illinois method, bisection).
//!
//! Every guess costs a step, so guesses are good. If slopes are known, the guess is the root of the cubic through both
//! ends of the bracket. Otherwise it is that of the chord (Illinois variant: Dowell and Jarratt 1971). If these fail to
//! shrink the bracket, it is halved.

use crate::tick::Indicator;

/// An indicator counts as zero below this share of its greatest value in the step. Events within about this share of
/// the step count as simultaneous.
const ZERO: f64 = 1e-12;
/// The first event is located until its indicator is below this share.
const GOAL: f64 = 1e-15;
/// Guesses; halving alone would need fifty.
const MOST_GUESSES: u32 = 80;
/// Guesses for an indicator that begins at zero and ends below it, until it is seen above zero.
const MOST_HALVINGS: u32 = 24;
/// Guesses in a row on one side of the event, after which the bracket is halved.
const MOST_ON_ONE_SIDE: i32 = 3;
/// An indicator begins at zero if its rate leads from there within this share of a step. An event leaves the indicators that begin
/// with it at zero, and rounding puts them below.
const AT_ONCE: f64 = 1e-6;

/// The indicators at a share of a step.
#[derive(Clone, Debug)]
pub struct IndicatorSample {
    /// Share of the step, 0 to 1.
    pub share: f64,
    /// Indicators there.
    pub indicators: Vec<Indicator>,
}

/// The part of a step in which the first event is.
#[derive(Debug)]
pub struct Bracket {
    /// Length of the step in seconds.
    length: f64,
    low: IndicatorSample,
    high: IndicatorSample,
    /// Greatest value of each indicator at both ends of the step.
    scale: Vec<f64>,
    /// The indicators that are not below zero at the beginning.
    open: Vec<bool>,
    /// The indicators that were below zero at a look after that.
    crossing: Vec<bool>,
    /// The share tried last.
    tried: f64,
    guesses: u32,
    /// The number of times that the lower end (positive) or the upper one (negative) was replaced in a row.
    replaced: i32,
    /// The share tried last is the event.
    met: bool,
}

impl Bracket {
    /// The bracket between two moments of a step of `length` seconds that began with the indicators `begin`. `None` if
    /// it contains no event.
    pub fn between(begin: &[Indicator], low: IndicatorSample, high: IndicatorSample, length: f64) -> Option<Self> {
        let crossing: Vec<bool> = high.indicators.iter().map(vanished).collect();
        if !crossing.contains(&true) {
            return None;
        }
        Some(Self {
            length,
            scale: begin.iter().zip(&high.indicators).map(|(a, b)| a.value.abs().max(b.value.abs())).collect(),
            open: begin.iter().map(|indicator| is_open(indicator, length)).collect(),
            tried: high.share,
            low,
            high,
            crossing,
            guesses: 0,
            replaced: 0,
            met: false,
        })
    }

    /// The share to be tried next; nothing when the event is located.
    pub fn next(&mut self) -> Option<f64> {
        if self.met || self.guesses >= MOST_GUESSES {
            return None;
        }
        self.tried = self.guess()?;
        self.guesses += 1;
        Some(self.tried)
    }

    /// Takes the indicators at the share that was tried.
    pub fn narrow(&mut self, sample: IndicatorSample) {
        let mut beyond = false;
        let (mut met, mut passed) = (false, false);
        for (index, indicator) in sample.indicators.iter().enumerate() {
            if vanished(indicator) && self.open[index] {
                self.crossing[index] = true;
            }
            if self.crossing[index] {
                beyond |= vanished(indicator);
                met |= indicator.value.abs() <= indicator.rounding.max(GOAL * self.scale[index]);
                passed |= indicator.value < -indicator.rounding.max(ZERO * self.scale[index]);
            }
        }
        self.met = met && !passed;
        if beyond {
            self.replaced = self.replaced.min(0) - 1;
            self.high = sample;
        } else {
            self.replaced = self.replaced.max(0) + 1;
            self.low = sample;
        }
    }

    /// The end of the step, as a share.
    pub fn share(&self) -> f64 {
        if self.met { self.tried } else { self.high.share }
    }

    /// The indicators that vanish together at the end of the step, whose values are given. One that is above zero and rises has its
    /// event later in the step.
    pub fn fired(&self, indicators: &[Indicator]) -> Vec<usize> {
        let zero = |index: usize| indicators[index].rounding.max(ZERO * self.scale[index]);
        let rises = |indicator: &Indicator| indicator.value > 0.0 && indicator.slope > 0.0;
        let vanishes = |index: &usize| indicators[*index].value <= zero(*index) && !rises(&indicators[*index]);
        (0..indicators.len()).filter(|&index| self.crossing[index]).filter(vanishes).collect()
    }

    /// The earliest of the guesses for all that have crossed.
    fn guess(&self) -> Option<f64> {
        let (a, b) = (self.low.share, self.high.share);
        let middle = 0.5 * (a + b);
        if middle <= a || middle >= b || b - a <= f64::EPSILON * b {
            return None;
        }
        let crossed = |index: &usize| self.crossing[*index] && vanished(&self.high.indicators[*index]);
        let guess = |index: usize| {
            let (low, high) = (&self.low.indicators[index], &self.high.indicators[index]);
            if low.value <= 0.0 || self.replaced.abs() > MOST_ON_ONE_SIDE {
                // It began at zero and has to be seen above it first; or the guesses do not shrink the bracket.
                return middle;
            }
            let share = cubic_root(low, high, (b - a) * self.length);
            a + (b - a) * share.unwrap_or_else(|| chord(low, high, self.replaced))
        };
        let earliest = (0..self.scale.len()).filter(crossed).map(guess).fold(f64::INFINITY, f64::min);
        if self.low_is_zero() && self.guesses > MOST_HALVINGS {
            return None;
        }
        Some(if earliest > a && earliest < b { earliest } else { middle })
    }

    /// Whether nothing that crossed was seen above zero yet.
    fn low_is_zero(&self) -> bool {
        !(0..self.scale.len()).any(|index| self.crossing[index] && self.low.indicators[index].value > 0.0)
    }
}

/// Whether an indicator is below zero by more than rounding.
pub fn vanished(indicator: &Indicator) -> bool {
    indicator.value < -indicator.rounding
}

/// Whether an indicator is above zero or at zero at the beginning of a step of `length` seconds. Below zero inside the step, it has
/// vanished. One that begins farther below waits for another event, and one of unknown rate does so from zero on.
pub fn is_open(begin: &Indicator, length: f64) -> bool {
    begin.value > 0.0
        || begin.value.abs() <= begin.rounding.max(AT_ONCE * length * begin.slope.abs()) && !begin.is_sampled()
}

/// Value of the cubic through both ends at `share`.
pub(super) fn cubic(begin: &Indicator, end: &Indicator, length: f64, share: f64) -> f64 {
    let rest = 1.0 - share;
    let (first, second) = (begin.slope * length, end.slope * length);
    let way = end.value - begin.value;
    begin.value + way * share * share * (3.0 - 2.0 * share) + first * share * rest * rest
        - second * share * share * rest
}

/// The root of the cubic through a value above zero and one below.
fn cubic_root(begin: &Indicator, end: &Indicator, length: f64) -> Option<f64> {
    if !(begin.slope.is_finite() && end.slope.is_finite()) {
        return None;
    }
    let (mut a, mut b) = (0.0, 1.0);
    while b - a > f64::EPSILON {
        let middle = 0.5 * (a + b);
        if middle <= a || middle >= b {
            break;
        }
        if cubic(begin, end, length, middle) > 0.0 { a = middle } else { b = middle }
    }
    Some(0.5 * (a + b))
}

/// The root of the chord. An end that stayed twice counts half (Illinois).
fn chord(low: &Indicator, high: &Indicator, replaced: i32) -> f64 {
    let (above, below) = match replaced {
        2.. => (low.value, 0.5 * high.value),
        ..=-2 => (0.5 * low.value, high.value),
        _ => (low.value, high.value),
    };
    above / (above - below)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tick::Bend;

    fn find(indicators: impl Fn(f64) -> Vec<Indicator>, length: f64) -> Option<(f64, Vec<usize>, u32)> {
        let ends = [0.0, 1.0].map(|share| IndicatorSample { share, indicators: indicators(share * length) });
        let [low, high] = ends;
        let mut bracket = Bracket::between(&low.indicators.clone(), low, high, length)?;
        while let Some(share) = bracket.next() {
            bracket.narrow(IndicatorSample { share, indicators: indicators(share * length) });
        }
        let share = bracket.share();
        let fired = bracket.fired(&indicators(share * length));
        Some((share * length, fired, bracket.guesses))
    }

    fn known(value: f64, slope: f64) -> Indicator {
        Indicator::new(value, slope, Bend::Fitted)
    }

    fn unknown(value: f64) -> Indicator {
        Indicator::of_value(value, Bend::Fitted)
    }

    #[test]
    fn a_root_is_found_to_rounding_with_and_without_slopes() {
        let (time, fired, guesses) = find(|t| vec![known(libm::cos(t), -libm::sin(t))], 2.0).expect("a root");
        assert!((time - std::f64::consts::FRAC_PI_2).abs() < 1e-14 && fired == [0] && guesses < 10, "{time} {guesses}");
        let (time, fired, guesses) = find(|t| vec![unknown(libm::cos(t))], 2.0).expect("a root");
        assert!((time - std::f64::consts::FRAC_PI_2).abs() < 1e-14 && fired == [0] && guesses < 16, "{time} {guesses}");
    }

    #[test]
    fn the_first_of_several_counts_and_simultaneous_ones_fire_together() {
        let three = |t: f64| vec![unknown(1.0 - t), unknown(0.25 - t * t), known(0.5 - t, -1.0), unknown(1.0)];
        let (time, fired, _) = find(three, 2.0).expect("a root");
        assert!((time - 0.5).abs() < 1e-14 && fired == [1, 2], "{time} {fired:?}");
    }

    /// Two contacts begin at one moment. The force of one grows from a rounding, and ends within the step. That of the other ends at once.
    #[test]
    fn one_that_rises_from_zero_does_not_fire_with_one_that_falls() {
        let two = |t: f64| vec![known(1e-13 + 3.0 * t * (0.5 - t), 1.5 - 6.0 * t), known(1e-14 - 9.0 * t, -9.0)];
        let (time, fired, _) = find(two, 1.0).expect("a root");
        assert!(time < 1e-13 && fired == [1], "{time} {fired:?}");
    }

    #[test]
    fn an_indicator_that_begins_at_zero_fires_when_it_comes_back() {
        let (time, fired, _) = find(|t| vec![unknown(t * (0.3 - t))], 1.0).expect("a root");
        assert!((time - 0.3).abs() < 1e-14 && fired == [0], "{time}");
    }
}
