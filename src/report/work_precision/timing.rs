//! The cost of a run: the minimum of repeated timings.

use super::timed;
use jostle_engine::Simulation;

/// The number of runs, of which the fastest counts: other work of the computer only makes them slower. Short runs are repeated more often.
const RUNS: u32 = 3;
const MOST_RUNS: u32 = 9;
/// After this many seconds there are at most [`RUNS`] runs.
const PATIENCE: f64 = 0.05;

/// Seconds of the fastest run to the end. `None` if `left` seconds do not suffice for a run of `expected` seconds, or if no run
/// reaches its end.
pub(crate) fn least<E>(load: impl Fn() -> Result<Simulation, E>, left: f64, expected: f64) -> Result<Option<f64>, E> {
    let mut least: Option<f64> = None;
    let (mut spent, mut runs) = (0.0, 0);
    while (runs < RUNS || runs < MOST_RUNS && spent < PATIENCE) && left - spent >= expected {
        let mut simulation = load()?;
        let (time, ended) = timed(|| simulation.run_to_end());
        let time = time.as_secs_f64();
        (spent, runs) = (spent + time, runs + 1);
        if ended.is_ok() {
            least = Some(least.map_or(time, |least| least.min(time)));
        }
    }
    Ok(least)
}
