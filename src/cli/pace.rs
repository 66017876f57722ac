//! Runs without drawing, with a moving progress bar, as fast as possible or at the speed of the clock.

use std::time::{Duration, Instant};

use super::interrupt;
use super::progress_bar::Progress;
use super::wall_clock::WallClock;
use crate::simulation::Simulation;
use crate::tick::Failure;

/// Why a run ended before its end.
pub(super) enum Ended {
    /// It failed.
    Wrong(Failure),
    /// Ctrl-C.
    Interrupted,
}

impl Ended {
    /// The end that a failure is.
    pub fn of(failure: Failure) -> Self {
        interrupt::unless_asked(failure).map_or(Self::Interrupted, Self::Wrong)
    }
}

/// The shortest time between two updates of the bar.
const BEAT: Duration = Duration::from_millis(50);

/// Seconds of physics after which a run at the speed of the clock waits for it.
const STEP: f64 = 0.01;

/// Runs with a bar, and if asked for no faster than the clock.
pub(super) struct Runner {
    pub progress: Progress,
    /// `--pace`.
    pub wall_clock: Option<WallClock>,
}

impl Runner {
    /// Runs to a tick in batches of about a beat. Batches of a fixed share would stop the bar in enormous runs.
    pub fn run_to(&mut self, simulation: &mut Simulation, tick: u64) -> Result<(), Ended> {
        let step = ((STEP / simulation.clock().dt).round() as u64).max(1);
        let mut batch = if self.wall_clock.is_some() { step } else { 1 };
        while simulation.clock().ticks < tick {
            if interrupt::asked() {
                return Err(Ended::Interrupted);
            }
            if let Some(clock) = &mut self.wall_clock {
                clock.wait(simulation.clock().time());
            }
            let start = Instant::now();
            let next = simulation.clock().ticks.saturating_add(batch);
            let ran = simulation.run_to_tick(next.min(tick));
            ran.map_err(Ended::of)?;
            self.progress.at(simulation.clock().ticks);
            if self.wall_clock.is_some() {
                continue;
            }
            if start.elapsed() < BEAT / 2 {
                batch = batch.saturating_mul(2);
            } else if start.elapsed() > BEAT {
                batch = (batch / 2).max(1);
            }
        }
        // The last state is due too.
        if let Some(clock) = self.wall_clock.as_mut().filter(|_| tick == simulation.ticks()) {
            clock.wait(simulation.clock().time());
        }
        Ok(())
    }
}
