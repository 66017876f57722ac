//! Forces that act otherwise than the scene asks, as their models report departures.

use super::{Cause, Evidence, Trust};
use jostle_engine::integrate::ChosenMethod;
use jostle_engine::tick::{Departure, EvaluationMode, State};

/// A departure by this share of the force that the scene asks for changes where bodies go.
const MUCH: f64 = 0.01;

/// A force loses or gains impulse. With half the tick it may lose as much, so the estimate of the error does not see it.
pub(super) fn otherwise(evidence: &Evidence) -> Option<Cause> {
    let mode = evidence.world.get_resource::<ChosenMethod>().map_or_else(EvaluationMode::default, |method| method.mode);
    let state = evidence.world.resource::<State>();
    let all = state.models().flat_map(|model| model.departures(state, mode));
    let Departure { what, remedy, share } = all.max_by(|a, b| a.share.total_cmp(&b.share))?;
    (share >= MUCH).then(|| Cause { trust: Trust::Not, what, remedy: Some(remedy.to_owned()) })
}
