//! What a run costs: the least of several that do nothing else.

use super::{Budget, Load, Way, timed};
use crate::scene::SceneErrors;

/// Runs of which the fastest counts: what else the computer does only makes them slower.
const RUNS: u32 = 3;

/// Seconds of the fastest run of a setting; nothing where the budget leaves no time for one, which takes about `expected` seconds.
pub(super) fn least(
    load: Load,
    (method, tick): (&str, f64),
    budget: &Budget,
    expected: f64,
) -> Result<Option<f64>, SceneErrors> {
    let mut least: Option<f64> = None;
    for _ in 0..RUNS {
        if budget.left() < expected {
            break;
        }
        let mut simulation = load(Way::Flags(method, tick))?;
        let (spent, ended) = timed(|| simulation.run_to_end());
        if ended.is_ok() {
            let spent = spent.as_secs_f64();
            least = Some(least.map_or(spent, |least| least.min(spent)));
        }
    }
    Ok(least)
}
