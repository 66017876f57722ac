//! Contacts that hold a body against a motor: no motion satisfies both.

use super::{Cause, Evidence, Trust, at};
use jostle_engine::contacts::penalty::PenaltyState;
use jostle_engine::contacts::penalty::contradicted::Contradicted;
use jostle_engine::tick::State;

/// Rigid friction contradicts other rows. The run goes on with some of them, so it is not the motion of the scene.
pub(super) fn held(evidence: &Evidence) -> Option<Cause> {
    let state = evidence.world.resource::<State>();
    let Contradicted { body, since } = state.model::<PenaltyState>()?.contradicted()?;
    let body = evidence.name(*state.bodies().entity.get(body)?);
    let what = format!(
        "from {} on, contacts with `tangential: Exact` hold `{body}` against joints or motors. No motion satisfies all of them, and \
         the run leaves some out",
        at(since)
    );
    let remedy = "`tangential: Spring(ratio: 0.8)`, so that contacts give".to_owned();
    Some(Cause { trust: Trust::Not, what, remedy: Some(remedy) })
}
