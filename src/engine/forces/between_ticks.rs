//! Notes for the card on forces that begin, end or have a kink between two ticks.

use crate::scene::Outline;
use crate::tick::{Clock, EvaluationMode, State};
use jostle_language::numbers::number;

/// The remedy.
pub(super) const REMEDY: &str = "`events: Located` or `method: RungeKutta4`, whose steps end there";

/// The clock of a run that has only made whole ticks; `None` if steps end between ticks.
pub(super) fn clock_of_whole_ticks(state: &State, mode: EvaluationMode) -> Option<Clock> {
    (mode == EvaluationMode::Following).then(|| state.clock()).filter(|clock| clock.ticks > 0)
}

/// The places in the scene of all entries of a name, in the order of the file, such as `forces[0]`.
pub(super) fn paths(name: &str, outline: &Outline) -> Vec<String> {
    outline.entries("forces").iter().filter(|entry| entry.name == name).map(|entry| entry.path.clone()).collect()
}

/// Whether a time in seconds lies between two ticks, by more than rounding of times.
pub(super) fn is_between(clock: &Clock, time: f64) -> bool {
    let ticks = time / clock.dt;
    (ticks - ticks.round()).abs() > 1e-9 * ticks.abs().max(1.0)
}

/// A share in words.
pub(super) fn percent(share: f64) -> String {
    format!("{} %", number((share * 1000.0).round() / 10.0))
}
