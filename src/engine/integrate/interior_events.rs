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
//!
//! If no bound `c` is known, it is fitted. With rates, the cubic through both moments gives it (Hermite), less an
//! estimate of the error of that cubic. Without rates, the values at the stages of the step give it by second
//! differences. Stages are less exact than the step, so they only suggest moments at which the step is evaluated.

use super::locate::{IndicatorSample, cubic, is_open, vanished};
use crate::constraints::DEPENDENT;
use crate::tick::Indicator;

/// Looks into one step.
const MOST_LOOKS: usize = 24;

/// A fitted bound below zero by less than this share of the values at both ends is no event. Otherwise a value that
/// begins at zero would be looked at again and again.
const SIGNIFICANT: f64 = 1e-3;

/// The estimated error of a fitted cubic counts this many times.
const WARY: f64 = 4.0;

/// A rate that may turn by less than this share more than it did lets an indicator return by little.
const SPARE: f64 = 0.1;

/// Points at which a fitted cubic is examined.
const PARTS: usize = 16;

/// Stages nearer to each other than this share of a step tell one value.
const APART: f64 = 1.0 / 12.0;

/// Second differences count this many times. Stages are not exact. A contact at its bound leaves the rest to another one. The force of
/// that bends up to twice as much from then on. Differences across that moment show half of that.
const STAGES: f64 = 4.0;

/// The values of all indicators at a stage of a step.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct StageValues {
    /// Share of the step, 0 to 1.
    pub share: f64,
    /// A value for each indicator of unknown rate.
    pub values: Vec<f64>,
}

/// Moments of a step, from its beginning on.
pub(super) struct Inside {
    samples: Vec<IndicatorSample>,
    /// Stages in ascending order, if some rates are unknown.
    stages: Vec<StageValues>,
    /// Length of the step in seconds.
    length: f64,
    looks: usize,
}

impl Inside {
    /// A step of `length` seconds, seen at its beginning and end, and at its stages in any order.
    pub fn of(begin: &[Indicator], end: &[Indicator], mut stages: Vec<StageValues>, length: f64) -> Self {
        let sample = |share: f64, indicators: &[Indicator]| IndicatorSample { share, indicators: indicators.to_vec() };
        // Lists of candidate pairs that were renewed within the step have other indicators.
        stages.retain(|stage| stage.values.len() == begin.len());
        stages.sort_by(|a, b| a.share.total_cmp(&b.share));
        let mut last = 0.0;
        stages.retain(|stage| {
            let tells = stage.share - last >= APART && stage.share < 1.0;
            last = if tells { stage.share } else { last };
            tells
        });
        Self { samples: vec![sample(0.0, begin), sample(1.0, end)], stages, length, looks: 0 }
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
        let of = |pair: &[IndicatorSample]| {
            let bounded = suspect(&pair[0], &pair[1], self.length);
            bounded.into_iter().chain(self.suspect_by_stages(&pair[0], &pair[1])).reduce(f64::min)
        };
        pairs.filter_map(|(index, pair)| Some((index, of(pair)?))).next()
    }

    /// The share between two moments at which stages and looks suggest that an indicator of unknown rate is below zero.
    fn suspect_by_stages(&self, from: &IndicatorSample, to: &IndicatorSample) -> Option<f64> {
        let of = |index: usize| {
            let begin = &from.indicators[index];
            let course = (begin.is_sampled() && begin.value > 0.0).then(|| self.course(index))?;
            // At the later look others may last.
            let place = |share: f64| course.partition_point(|point| point.0 < share).min(course.len() - 1);
            let (first, last) = (place(from.share), place(to.share));
            if first < last { dip(&course, (first, last)) } else { None }
        };
        (0..from.indicators.len())
            .filter_map(of)
            .filter(|share| *share > from.share && *share < to.share)
            .reduce(f64::min)
    }

    /// All that is known of an indicator in this step, as shares and values. A look is exact, so it replaces the stages near it.
    fn course(&self, index: usize) -> Vec<(f64, f64)> {
        let looks = self.samples.iter().filter(|look| look.indicators[index].is_sampled());
        let looks = looks.map(|look| (look.share, look.indicators[index].value));
        let apart = |share: f64| self.samples.iter().all(|look| (look.share - share).abs() >= 0.5 * APART);
        let stages = self.stages.iter().filter(|stage| apart(stage.share) && !stage.values[index].is_nan());
        let mut course: Vec<_> = looks.chain(stages.map(|stage| (stage.share, stage.values[index]))).collect();
        course.sort_by(|a, b| a.0.total_cmp(&b.0));
        course
    }

    /// Takes the indicators of a moment. If one of them is below zero, all later moments are discarded.
    pub fn see(&mut self, sample: IndicatorSample) {
        let index = self.samples.partition_point(|known| known.share < sample.share);
        if sample
            .indicators
            .iter()
            .zip(&self.samples[0].indicators)
            .any(|(now, begin)| vanished(now) && is_open(begin, self.length))
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
        let known = !(a.slope.is_nan() || b.slope.is_nan());
        let seconds = way * length;
        let open = is_open(a, seconds);
        let a = &Indicator { value: if open { a.value.max(0.0) } else { a.value }, ..*a };
        let bend = match (a.bend.within(seconds), b.bend.within(seconds)) {
            (Some(first), Some(second)) => (first.max(second) + (first - second).abs()) * length * length,
            // Steps resolve the swings of springs: their indicators lie above the tangents at both ends.
            _ if known && (a.swings > 0.0 || b.swings > 0.0) => 0.0,
            _ => return fitted(a, b, seconds).filter(|_| known).map(|at| from.share + at * way),
        };
        if open && (vanished(b) || !known && b.value < 0.0) {
            let several =
                if known { returns([a, b], bend, (way, length)) } else { a.value - b.value < 0.5 * bend * way * way };
            return several.then_some(from.share + 0.5 * way);
        }
        if !(a.value >= 0.0 && b.value >= 0.0 && a.value + b.value > 0.0) {
            return None;
        }
        let (after, least) = match known {
            true => between_rates([a, b], bend, (way, length)),
            false => below_chord([a.value, b.value], bend, way),
        };
        let inside = after > 0.0 && after < way && least < -a.rounding.max(b.rounding);
        inside.then_some(from.share + after).filter(|share| *share > from.share && *share < to.share)
    };
    from.indicators.iter().zip(&to.indicators).filter_map(meet).reduce(f64::min)
}

/// Whether an indicator that ends below zero may have passed zero there and back before. Its rate has to turn for that, by
/// at least the rates at both ends together. Steps resolve the swings of springs, so these do not return.
fn returns([a, b]: [&Indicator; 2], bend: f64, (way, length): (f64, f64)) -> bool {
    let turned = (a.slope.abs() + b.slope.abs()) * length;
    a.swings == 0.0 && b.swings == 0.0 && turned < (1.0 - SPARE) * bend * way
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

/// The share of a piece of `length` seconds at which a fitted cubic, less its error, is below zero. If the piece ends
/// below zero, only a cubic that comes back counts.
///
/// The fourth derivative bounds the error, `t^2 (T - t)^2/24` times it. In a swing the ratio of two successive
/// derivatives is the angular frequency. So the third and the second derivative give the fourth.
fn fitted(a: &Indicator, b: &Indicator, length: f64) -> Option<f64> {
    let (first, second, way) = (a.slope * length, b.slope * length, b.value - a.value);
    let bends = [6.0 * way - 4.0 * first - 2.0 * second, -6.0 * way + 2.0 * first + 4.0 * second];
    let bend = bends[0].abs().max(bends[1].abs());
    // A cubic is below its chord by at most an eighth of its greatest second derivative. Its error is at most a sixth.
    let far = a.value < 0.0 || a.value.min(b.value) > bend / 3.0;
    if far || bend == 0.0 || !bend.is_finite() {
        return None;
    }
    let error = WARY * (bends[1] - bends[0]).powi(2) / bend / 24.0;
    let rounding = a.rounding.max(b.rounding);
    let height = |share: f64| cubic(a, b, length, share) + rounding;
    let mut shares = (1..PARTS).map(|part| part as f64 / PARTS as f64);
    if vanished(b) {
        if a.value == 0.0 {
            return None;
        }
        let passed = shares.find(|share| height(*share) < 0.0)?;
        return shares.any(|share| height(share) > rounding).then_some(passed);
    }
    let least = |share: f64| height(share) - error * (share * (1.0 - share)).powi(2);
    let lowest = shares.min_by(|a, b| least(*a).total_cmp(&least(*b)))?;
    (least(lowest) < -SIGNIFICANT * a.value.max(b.value)).then_some(lowest)
}

/// The first share at which a course of shares and values is below zero, or bends below it. It is looked at from the point `first`
/// to the point `last`. A course that stays below zero up to there has passed zero once. Its points beyond tell how it bends.
fn dip(course: &[(f64, f64)], (first, last): (usize, usize)) -> Option<f64> {
    let below = |(_, value): &&(f64, f64)| *value < 0.0;
    let (inner, end) = (&course[first + 1..last], course[last]);
    if let Some(first) = inner.iter().position(|point| point.1 < 0.0) {
        let comes_back = end.1 >= 0.0 || !inner[first..].iter().all(|point| below(&point));
        return comes_back.then_some(inner[first].0);
    }
    // A course is below its chord by at most an eighth of its bend. A dip less deep than the error of forces is none.
    let deepest = 8.0 * DEPENDENT * course.iter().map(|point| point.1.abs()).fold(0.0, f64::max);
    let bend = |at: usize| {
        let [(a, first), (b, middle), (c, last)] = [course[at - 1], course[at], course[at + 1]];
        2.0 * ((last - middle) / (c - b) - (middle - first) / (b - a)) / (c - a)
    };
    let lowest = |index: usize| {
        let [(from, a), (to, b)] = [course[index], course[index + 1]];
        if b < 0.0 {
            return None;
        }
        let near = index.max(1)..=(index + 1).min(course.len() - 2);
        let most = STAGES * near.map(bend).fold(0.0, f64::max);
        let way = to - from;
        let (after, least) = below_chord([a, b], most, way);
        let inside = most * way * way > deepest && after > 0.0 && after < way && least < 0.0;
        inside.then_some(from + after)
    };
    (first..last).find_map(lowest)
}

#[cfg(test)]
mod tests {
    use super::super::locate::Bracket;
    use super::*;
    use crate::tick::Bend;

    fn look(indicators: impl Fn(f64) -> Vec<Indicator>) -> (IndicatorSample, IndicatorSample, usize) {
        look_within(1.0, indicators)
    }

    fn look_within(
        length: f64,
        indicators: impl Fn(f64) -> Vec<Indicator>,
    ) -> (IndicatorSample, IndicatorSample, usize) {
        let mut inside = Inside::of(&indicators(0.0), &indicators(length), Vec::new(), length);
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
        Indicator::new(distance - 2.0 * r, x * speed / distance, Bend::AtMost(0.0))
    }

    /// The gap between a disc on a circle of radius 1 and a peg at 2 rad on the circle. The disc circles once in 6.3 seconds. The
    /// disc starts at the angle `begin`. The gap bends downwards everywhere except at the peg.
    fn gap_on_a_circle(t: f64, begin: f64) -> Indicator {
        let half = 0.5 * (t + begin - 2.0);
        let value = 2.0 * libm::sin(half).abs() - 0.02;
        Indicator::new(value, libm::cos(half) * half.signum(), Bend::AtMost(1.0))
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
        let height = |t: f64| Indicator::new(0.1 + 3.0 * t - 2.0 * t * t, 3.0 - 4.0 * t, Bend::AtMost(4.0));
        let (_, high, looks) = look(|t| vec![height(t)]);
        assert!(high.share == 1.0 && looks == 0, "{looks}");
    }

    /// An event leaves a gap at zero, and rounding puts it below. The gap opens, closes inside the step, and is open at its end.
    #[test]
    fn a_gap_that_begins_a_rounding_below_zero_closes_again_inside_a_step() {
        for below in [0.0, 7e-18, 1e-12] {
            let gap = |t: f64| {
                let (value, slope) = (t * (t - 0.1) * (t - 0.6) - below, (3.0 * t - 1.4) * t + 0.06);
                vec![Indicator::new(value, slope, Bend::AtMost(1.4))]
            };
            let (low, high, looks) = look(gap);
            assert!(low.share < 0.1 && (0.1..0.6).contains(&high.share), "{below}: {low:?} {high:?} {looks}");
            let mut bracket = Bracket::between(&gap(0.0), low, high, 1.0).expect("it closes");
            while let Some(share) = bracket.next() {
                bracket.narrow(IndicatorSample { share, indicators: gap(share) });
            }
            let (share, fired) = (bracket.share(), bracket.fired(&gap(bracket.share())));
            assert!((share - 0.1).abs() < 1e-10 && fired == [0], "{below}: {share} {fired:?}");
        }
    }

    /// Sides that just touch and approach part again inside the step.
    #[test]
    fn a_gap_that_begins_at_zero_and_closes_is_seen_at_once() {
        for below in [0.0, 7e-18] {
            let gap = |t: f64| vec![Indicator::new(t * (t - 0.3) - below, 2.0 * t - 0.3, Bend::AtMost(0.0))];
            let (low, high, looks) = look(gap);
            let mut bracket = Bracket::between(&gap(0.0), low, high, 1.0).expect("it closes");
            while let Some(share) = bracket.next() {
                bracket.narrow(IndicatorSample { share, indicators: gap(share) });
            }
            let (share, fired) = (bracket.share(), bracket.fired(&gap(bracket.share())));
            assert!(share < 1e-6 && fired == [0] && looks < 3, "{below}: {share} {fired:?} {looks}");
        }
    }

    /// A way along a surface, so near that two dozen evaluations cannot distinguish it from touching.
    #[test]
    fn a_step_ends_where_it_stays_open_whether_bodies_meet() {
        let (_, high, looks) = look(|_| vec![Indicator::new(1e-6, 0.0, Bend::AtMost(1.0))]);
        assert!(high.share > 0.0 && high.share < 1.0 && looks == MOST_LOOKS, "{high:?} {looks}");
    }

    /// A force that swings, and passes its bound for a hundredth of the step.
    #[test]
    fn a_peak_of_unknown_rate_is_seen() {
        for (begin, length) in [(0.0, 3.0), (0.4, 2.5), (1.5, 6.0)] {
            let omega = std::f64::consts::FRAC_PI_2;
            let room = |t: f64| {
                let value = 1.0 - 1.0001 * libm::sin(omega * (begin + t));
                Indicator::of_value(value, Bend::AtMost(2.0 * omega * omega))
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
        let room = |t: f64| Indicator::of_value(1.0 - 1.5 * libm::sin(t), Bend::AtMost(2.0));
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
        let (_, _, looks) = look(|t| vec![Indicator::new(1.0 - 0.5 * t, -0.5, Bend::AtMost(0.0))]);
        assert_eq!(looks, 0);
    }

    /// A corner of a turning box passes below the floor early in a step, and again at its end. The first passage counts.
    #[test]
    fn a_step_that_ends_below_zero_may_have_passed_before() {
        let height = |t: f64| {
            let value = 1.0 + 0.9 * libm::cos(12.0 * t + 1.0) - 5.0 * t * t - 0.6;
            let slope = -0.9 * 12.0 * libm::sin(12.0 * t + 1.0) - 10.0 * t;
            Indicator::new(value, slope, Bend::AtMost(0.9 * 144.0 + 10.0))
        };
        let (low, high, looks) = look_within(0.5, |t| vec![height(t)]);
        // The first root of the height.
        let (mut before, mut after) = (0.0, 0.2);
        while after - before > 1e-12 {
            let middle = 0.5 * (before + after);
            if height(middle).value > 0.0 { before = middle } else { after = middle }
        }
        let first = before / 0.5;
        assert!(low.share <= first && high.share >= first && high.share < 0.5, "{} {} {looks}", low.share, high.share);
    }

    /// Looks at a room of unknown rate, whose stages are those of the pair of orders 8, 5 and 3.
    fn look_by_stages(from: f64, length: f64, room: impl Fn(f64) -> f64) -> (f64, f64, usize) {
        let room_at = |t: f64| Indicator::of_value(room(t), Bend::Fitted);
        let shares = [0.05, 0.08, 0.12, 0.25, 0.28, 0.31, 0.33, 0.6, 0.65, 0.86];
        let stages = shares.map(|share| StageValues { share, values: vec![room(from + share * length)] });
        let mut inside = Inside::of(&[room_at(from)], &[room_at(from + length)], stages.to_vec(), length);
        let mut looks = 0;
        while let Some(share) = inside.next() {
            looks += 1;
            inside.see(IndicatorSample { share, indicators: vec![room_at(from + share * length)] });
        }
        let (low, high) = inside.last_two();
        (low.indicators[0].value, high.indicators[0].value, looks)
    }

    /// A force of unknown rate that dips below zero between two stages of a step.
    #[test]
    fn stages_tell_of_a_dip_of_unknown_rate() {
        let (low, high, _) = look_by_stages(1.6, 3.0, |t| 1.0 + 1.2 * libm::cos(t));
        assert!(low > 0.0 && high < 0.0, "{low:?} {high:?}");
    }

    /// A load exceeds its bound by a share of 1e-8 to 1e-2 at its peak, or it does not quite. The peak is anywhere in the step.
    #[test]
    fn a_load_that_exceeds_its_bound_briefly_is_seen() {
        let mut most = 0;
        for number in 0..2000 {
            let beyond = libm::exp10(-2.0 - 6.0 * libm::fmod(0.618_034 * f64::from(number), 1.0));
            let (peak, length) = (libm::fmod(0.754_878 * f64::from(number), 1.0), 1.0);
            let load = |t: f64| libm::sin(t - peak + 0.5 * std::f64::consts::PI);
            let half = libm::acos(1.0 / (1.0 + beyond));
            if half >= peak || peak + half >= length {
                continue;
            }
            let (low, high, looks) = look_by_stages(0.0, length, |t| 1.0 - (1.0 + beyond) * load(t));
            assert!(low > 0.0 && high < 0.0, "{beyond:e} at {peak}: {low:e} {high:e} after {looks} looks");
            let (low, high, away) = look_by_stages(0.0, length, |t| 1.0 - (1.0 - beyond) * load(t));
            assert!(low > 0.0 && high > 0.0, "{beyond:e} below at {peak}: {low:e} {high:e}");
            most = most.max(looks).max(away);
        }
        assert!(most < MOST_LOOKS, "{most} looks into a step");
    }
}
