//! Running without drawing, with a progress bar that moves.

use std::time::{Duration, Instant};

use super::progress::Progress;
use crate::simulation::Simulation;
use crate::tick::Failure;

/// How often the bar is moved, at most.
const BEAT: Duration = Duration::from_millis(50);

/// Runs to a tick in batches that last about a beat: a fixed share of an enormous run would keep the bar still.
pub(super) fn run_to(simulation: &mut Simulation, tick: u64, progress: &Progress) -> Result<(), Failure> {
    let mut batch = 1;
    while simulation.clock().ticks < tick {
        let start = Instant::now();
        let next = simulation.clock().ticks.saturating_add(batch);
        simulation.run_to_tick(next.min(tick))?;
        progress.at(simulation.clock().ticks);
        if start.elapsed() < BEAT / 2 {
            batch = batch.saturating_mul(2);
        } else if start.elapsed() > BEAT {
            batch = (batch / 2).max(1);
        }
    }
    Ok(())
}
