//! `--pace`: a run at the speed of the wall clock, for programs that watch it live.

use std::time::{Duration, Instant};

use super::say::{count, number, say};

/// Keeps a run from being ahead of the clock, and counts how often it was behind.
#[derive(Debug, Default)]
pub(super) struct WallClock {
    /// When the first step was ready.
    start: Option<Instant>,
    steps: u64,
    late: u64,
    worst: Duration,
}

impl WallClock {
    /// A step is ready that is due so many seconds after the first: waits until then. One that is late makes the next
    /// ones no later.
    pub fn wait(&mut self, due: f64) {
        let now = Instant::now();
        let start = *self.start.get_or_insert(now);
        self.steps += 1;
        // A moment beyond all clocks is awaited until the user ends it.
        let due = Duration::try_from_secs_f64(due.max(0.0)).unwrap_or(Duration::MAX);
        match due.checked_sub(now - start) {
            Some(early) => std::thread::sleep(early),
            None => {
                self.late += 1;
                self.worst = self.worst.max(now - start - due);
            }
        }
    }

    /// Reports the result.
    pub fn report(&self, one: &str, many: &str) {
        let steps = count(self.steps as usize, one, many);
        let late = match self.late {
            0 => "none was late".to_owned(),
            late => {
                let worst = (self.worst.as_secs_f64() * 1e3).ceil() / 1e3;
                format!("{late} of them late, by {} s at most", number(worst))
            }
        };
        say(&format!("--pace: {steps} at the speed of the clock, {late}"));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn early_steps_wait_and_late_ones_are_counted() {
        let mut clock = WallClock::default();
        let start = Instant::now();
        clock.wait(0.0);
        clock.wait(0.03);
        assert!(start.elapsed() >= Duration::from_millis(30));
        assert_eq!((clock.steps, clock.late), (2, 0));
        clock.wait(0.01);
        assert_eq!((clock.steps, clock.late), (3, 1));
        assert!(clock.worst >= Duration::from_millis(20), "{:?}", clock.worst);
    }
}
