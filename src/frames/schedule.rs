//! The times of a film's frames.

/// The times of a film's frames, from early to late.
///
/// They are runs of evenly spaced times. The spacing is zero while a film stands still.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Schedule {
    spans: Vec<Span>,
}

/// Evenly spaced times.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Span {
    from: f64,
    step: f64,
    /// The number of the first one, counted from the one at `from`.
    first: u64,
    frames: u64,
}

impl Span {
    /// A product, so that rounding does not add up.
    fn time(&self, frame: u64) -> f64 {
        self.from + (self.first + frame) as f64 * self.step
    }
}

impl Schedule {
    /// The frames of the physics between `from` and `to` seconds. `speed` is in seconds of physics per second of film,
    /// and above zero. Their number gives the film its exact length, and is at least one.
    pub fn new(from: f64, to: f64, speed: f64, frames_per_second: f64) -> Self {
        let step = speed / frames_per_second;
        let frames = ((to - from) / step).round().max(1.0) as u64;
        Self { spans: vec![Span { from, step, first: 0, frames }] }
    }

    /// Frames at times of one's own choice, in seconds of physics, from early to late.
    pub fn at(times: impl IntoIterator<Item = f64>) -> Self {
        let span = |time| Span { from: time, step: 0.0, first: 0, frames: 1 };
        Self { spans: times.into_iter().map(span).collect() }
    }

    /// Adds frames that all show one moment, after those before it.
    #[must_use]
    pub fn standing_at(self, time: f64, frames: u64) -> Self {
        let mut spans = Vec::with_capacity(self.spans.len() + 2);
        let mut standing = Some(Span { from: time, step: 0.0, first: 0, frames });
        for span in self.spans {
            let before = leading(span.frames, |frame| span.time(frame) <= time);
            if before < span.frames
                && let Some(standing) = standing.take()
            {
                spans.push(Span { frames: before, ..span });
                spans.push(standing);
                spans.push(Span { first: span.first + before, frames: span.frames - before, ..span });
            } else {
                spans.push(span);
            }
        }
        spans.extend(standing);
        spans.retain(|span| span.frames > 0);
        Self { spans }
    }

    /// Number of frames.
    pub fn frames(&self) -> u64 {
        self.spans.iter().map(|span| span.frames).sum()
    }

    /// The times in seconds of physics.
    pub fn times(&self) -> impl Iterator<Item = f64> {
        self.spans.iter().flat_map(|span| (0..span.frames).map(|frame| span.time(frame)))
    }
}

/// The number of leading numbers below `count` that fit, by binary search. If a number does not fit, no later one does.
fn leading(count: u64, fits: impl Fn(u64) -> bool) -> u64 {
    let (mut low, mut high) = (0, count);
    while low < high {
        let middle = low + (high - low) / 2;
        if fits(middle) { low = middle + 1 } else { high = middle }
    }
    low
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_film_stands_still_where_it_is_told_to() {
        let plain = Schedule::new(1.0, 2.0, 0.5, 2.0);
        assert_eq!(plain.times().collect::<Vec<_>>(), [1.0, 1.25, 1.5, 1.75]);
        let twice = plain.standing_at(1.5, 2).standing_at(1.3, 1);
        assert_eq!(twice.times().collect::<Vec<_>>(), [1.0, 1.25, 1.3, 1.5, 1.5, 1.5, 1.75]);
        assert_eq!(twice.frames(), 7);
        let end = twice.standing_at(9.0, 1).standing_at(0.0, 1);
        assert_eq!(end.times().collect::<Vec<_>>(), [0.0, 1.0, 1.25, 1.3, 1.5, 1.5, 1.5, 1.75, 9.0]);
    }
}
