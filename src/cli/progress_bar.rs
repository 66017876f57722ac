//! The progress of long work on standard error. A terminal shows a bar with the remaining time. Other streams get single lines.

use std::io::IsTerminal;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

use indicatif::{HumanCount, HumanDuration, ProgressBar, ProgressDrawTarget, ProgressStyle};

/// The time in seconds before the first line. Each further one comes when the work has lasted twice as long.
const FIRST: u64 = 10;

/// The times of lines in a log, so that long work does not fill it.
pub(super) struct Lines {
    begin: Instant,
    /// In seconds since the beginning.
    next: AtomicU64,
}

impl Lines {
    /// Those of work that begins now.
    pub fn begin() -> Self {
        Self { begin: Instant::now(), next: AtomicU64::new(FIRST) }
    }

    /// The time since the beginning, if a line is due.
    pub fn due(&self) -> Option<Duration> {
        self.due_after(self.begin.elapsed())
    }

    fn due_after(&self, since: Duration) -> Option<Duration> {
        let next = self.next.load(Ordering::Relaxed);
        if since.as_secs() < next {
            return None;
        }
        self.next.store(2 * since.as_secs(), Ordering::Relaxed);
        Some(since)
    }
}

/// A progress bar, or lines.
pub struct Progress {
    bar: ProgressBar,
    lines: Option<Lines>,
    unit: String,
}

impl Progress {
    /// A bar of `length` steps called `unit`. Without a terminal, lines tell of work that lasts. Hidden ones cost nothing.
    pub fn new(length: u64, unit: &str, hidden: bool) -> Self {
        let target = if hidden { ProgressDrawTarget::hidden() } else { ProgressDrawTarget::stderr_with_hz(10) };
        let bar = ProgressBar::with_draw_target(Some(length), target);
        let template = format!("{{bar:40}} {{percent:>3}} %  {{human_pos}} of {{human_len}} {unit}, {{eta}} left");
        if let Ok(style) = ProgressStyle::with_template(&template) {
            bar.set_style(style);
        }
        let lines = (!hidden && !std::io::stderr().is_terminal()).then(Lines::begin);
        Self { bar, lines, unit: unit.to_owned() }
    }

    /// Moves the bar to a place.
    pub fn at(&self, position: u64) {
        self.bar.set_position(position);
        self.tell();
    }

    /// Does something that prints, with the bar out of the way.
    pub fn aside<T>(&self, print: impl FnOnce() -> T) -> T {
        self.bar.suspend(print)
    }

    /// Moves the bar by one.
    pub fn step(&self) {
        self.bar.inc(1);
        self.tell();
    }

    fn tell(&self) {
        let Some(since) = self.lines.as_ref().and_then(Lines::due) else { return };
        eprintln!("{}", line(since, (self.bar.position(), self.bar.length().unwrap_or_default()), &self.unit));
    }
}

/// A line after a time, at a position of a length.
fn line(since: Duration, (position, length): (u64, u64), unit: &str) -> String {
    let left = since.as_secs_f64() * length.saturating_sub(position) as f64 / position.max(1) as f64;
    let left = Duration::try_from_secs_f64(left).unwrap_or(Duration::MAX);
    format!(
        "progress: {} of {} {unit} in {}, {} left",
        HumanCount(position),
        HumanCount(length),
        HumanDuration(since),
        HumanDuration(left)
    )
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_come_after_ten_seconds_and_then_ever_more_rarely() {
        let lines = Lines::begin();
        let told: Vec<u64> =
            (0..200).filter(|second| lines.due_after(Duration::from_secs(*second)).is_some()).collect();
        assert_eq!(told, [10, 20, 40, 80, 160]);
    }

    #[test]
    fn a_line_tells_how_far_work_is_and_how_long_it_will_last() {
        let told = line(Duration::from_secs(10), (25_000_000, 100_000_000), "ticks");
        assert_eq!(told, "progress: 25,000,000 of 100,000,000 ticks in 10 seconds, 30 seconds left");
    }
}
