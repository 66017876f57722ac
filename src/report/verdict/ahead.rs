//! What was wrong before the first tick: the scene itself.

use super::energy::UNACCOUNTED;
use super::{Cause, Evidence, Part, Trust};
use crate::Remedy;
use jostle_engine::contacts::search::OverlapAtStart;
use jostle_engine::tick::State;
use jostle_language::numbers::{number, percent};

/// Share of the energy that went round which springs may hold at the start without a word: what lies on the ground holds some.
const COMPRESSED: f64 = 0.1;
/// Drag that took less of it has not turned anything round.
const TAKEN: f64 = 0.3;

/// Bodies stand in each other at the start: springs that nobody compressed drive them apart.
pub(super) fn overlaps_at_the_start(evidence: &Evidence) -> Option<Cause> {
    let (world, card) = (evidence.world, evidence.card);
    let overlap = world.get_resource::<OverlapAtStart>()?;
    let begin = world.resource::<State>().ledger().start?;
    let share = begin.elastic / card.energy_scale.max(begin.elastic);
    let (a, b) = (evidence.name(overlap.between.0), evidence.name(overlap.between.1));
    let what = format!(
        "`{a}` and `{b}` overlap at the start by {} of the smaller radius, and contacts hold {} J there that nothing in the scene \
         put in, {} of the energy that changed form",
        percent(overlap.share),
        number(begin.elastic),
        percent(share)
    );
    let remedy = Some("other places, smaller bodies, or `collides: false`".to_owned());
    (share > COMPRESSED).then_some(Cause { trust: Trust::ButNot(Part::Model), what, remedy })
}

/// Drag or a damper that takes more than there is: a method of whole steps then turns a velocity round and makes it larger.
pub(super) fn drag(evidence: &Evidence) -> Option<Cause> {
    let card = evidence.card;
    let drag = card.energy.drag + card.energy.accounts.values().sum::<f64>();
    let taken = drag / card.energy_scale;
    let mad = drag != 0.0 && (!taken.is_finite() || taken > TAKEN && card.energy_error() > UNACCOUNTED);
    let what = "drag takes more than the whole velocity of a body in a tick, and turns it round".to_owned();
    // How far anything travelled came of that: it says nothing of the tick that would do.
    let finer = Remedy::Tick(card.tick_for(1.0, 0.1, 1.0));
    mad.then(|| Cause { trust: Trust::Not, what, remedy: Some(finer.or_finer()) })
}
