//! The error of a body that bounced to rest in one of several ways. All runs have it, and two of them may agree by chance. So it
//! counts whatever their difference is.

use jostle_engine::Simulation;
use jostle_engine::contacts::penalty::PenaltyState;
use jostle_engine::contacts::penalty::wedged::Wedged;
use jostle_engine::simulation::accuracy::trajectory::Trajectory;
use jostle_engine::tick::State;
use jostle_language::numbers::{number, rough};

use super::EstimatedError;
use crate::card::name;

/// Adds it to an estimate that is smaller.
pub(super) fn add(simulation: &Simulation, run: &Trajectory, found: &mut EstimatedError) {
    let wedged = simulation.resource::<State>().model::<PenaltyState>().and_then(PenaltyState::wedged);
    let Some(Wedged { body, since, gives }) = wedged else { return };
    let body = name(simulation.unpublished_world(), body);
    let why = || format!("`{body}` came to rest on contacts that face several ways. The last bounces decide how");
    if found.raise((gives, 0.0), run.sizes().0, why) {
        found.notes.push(format!(
            "rest: `{body}` came to rest at t = {} s on contacts that face several ways. The last bounces decide how springs and friction \
             share its loads. So places are known to {} m, the sum of its overlaps. A higher stiffness makes it smaller",
            number(since),
            rough(gives)
        ));
    }
}
