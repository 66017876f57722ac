//! Causes in the scene itself: bodies that overlap at the start, and drag that is too strong for the tick.

use super::energy::UNACCOUNTED;
use super::{Cause, Evidence, Trust, VerdictPart};
use crate::Remedy;
use bevy_ecs::prelude::*;
use jostle_engine::contacts::search::{OverlapAtStart, TurnedWalls};
use jostle_engine::forces::resists;
use jostle_engine::tick::State;
use jostle_language::numbers::{number, percent};

/// At the start springs may hold this share of the energy that changed form. Bodies that lie on the ground compress theirs.
const COMPRESSED: f64 = 0.1;
/// Drag that took a smaller share of that energy has not reversed any velocity.
const TAKEN: f64 = 0.3;

/// Contacts that saw less than this share of an overlap at the start do not see the overlap. A corner inside a side lies as deep as
/// the two bodies overlap.
const SEEN: f64 = 0.5;

/// Bodies overlap at the start, and springs that no motion has compressed drive them apart. Or no contact sees them: bars that cross
/// have no corner inside each other.
pub(super) fn overlaps_at_the_start(evidence: &Evidence) -> Option<Cause> {
    let (world, card) = (evidence.world, evidence.card);
    let overlap = world.get_resource::<OverlapAtStart>()?;
    let begin = world.resource::<State>().ledger().start?;
    let share = begin.elastic / card.energy_scale.max(begin.elastic);
    let (a, b) = (evidence.name(overlap.between.0), evidence.name(overlap.between.1));
    let unseen = world.resource::<State>().deepest_overlap().in_share.share < SEEN * overlap.share;
    let what = if unseen {
        let by = percent(overlap.share);
        format!(
            "`{a}` and `{b}` overlap at the start by {by} of the smaller radius, and no contact parts them. Neither has a corner in the \
             other"
        )
    } else {
        format!(
            "`{a}` and `{b}` overlap at the start by {} of the smaller radius. Contacts hold {} J from the start on, {} of the energy \
         that changed form",
            percent(overlap.share),
            number(begin.elastic),
            percent(share)
        )
    };
    let turned = world.get_resource::<TurnedWalls>().and_then(|walls| {
        let before = |entity: &Entity| walls.0.contains(entity);
        [overlap.between.0, overlap.between.1].into_iter().find(before)
    });
    let remedy = turned.map_or_else(
        || "other places, smaller bodies, or `collides: false`".to_owned(),
        |wall| format!("the points of `{}` in the other order, because all bodies are behind it", evidence.name(wall)),
    );
    let remedy = Some(remedy);
    (unseen || share > COMPRESSED).then_some(Cause { trust: Trust::ButNot(VerdictPart::Model), what, remedy })
}

/// Drag or a damper takes more than the whole velocity in a step. An explicit method then reverses the velocity and makes it
/// larger.
pub(super) fn drag(evidence: &Evidence) -> Option<Cause> {
    let card = evidence.card;
    let drag = card.energy.drag + card.energy.accounts.values().sum::<f64>();
    let taken = drag / card.energy_scale;
    // A run that went wrong makes all accounts NaN, also those that nothing in the scene uses.
    let there = drag.is_finite() || !card.energy.accounts.is_empty() || resists(evidence.world.resource());
    let mad = there && drag != 0.0 && (!taken.is_finite() || taken > TAKEN && card.energy_error() > UNACCOUNTED);
    let what = "drag takes more than the whole velocity of a body in a tick, and reverses it".to_owned();
    // The reversed velocities set how far bodies travelled, so the travel does not tell which tick would do.
    let finer = Remedy::Tick(card.tick_for(1.0, 0.1, 1.0));
    mad.then(|| Cause { trust: Trust::Not, what, remedy: Some(finer.or_finer()) })
}
