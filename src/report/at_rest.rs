//! Notes of the card on contacts at rest.

use bevy_ecs::prelude::*;

use super::card::name;
use jostle_engine::contacts::penalty::PenaltyState;
use jostle_engine::contacts::penalty::at_rest::{DepthAtRest, ForceBand};
use jostle_engine::tick::State;
use jostle_language::numbers::number;

/// A contact deserves a note that lies deeper than this multiple of the depth that its load asks for.
const DEEP: f64 = 1.5;

/// So many bands are told one by one.
const FEW: usize = 2;

/// How deep contacts at rest lie against their springs, and which forces statics does not determine.
pub(super) fn notes(world: &World) -> Vec<String> {
    let state = world.resource::<State>();
    let Some(own) = state.model::<PenaltyState>() else { return Vec::new() };
    let found = own.at_rest(state);
    let pair = |(a, b)| format!("`{}` and `{}`", name(world, a), name(world, b));
    let mut notes = Vec::new();
    if let Some(DepthAtRest { between, overlap, needed }) = found.deepest
        && overlap > DEEP * needed
    {
        notes.push(format!(
            "rest: {} rest {} m deep, and their spring alone would bear the load at {} m, {} times less. A contact that stops stays as \
             deep as it came, within the band of its normal law. A higher restitution or stiffness brings it up",
            pair(between),
            number(overlap),
            number(needed),
            number((10.0 * overlap / needed).round() / 10.0)
        ));
    }
    for ForceBand { between, force, springs, ends: (least, greatest) } in found.bands.iter().copied().take(FEW) {
        notes.push(format!(
            "rest: statics does not determine the normal force between {}. Any from {} to {} N balances the loads beside the present \
             friction. It is {} N, and the springs alone would give {} N",
            pair(between),
            rounded(least),
            rounded(greatest),
            rounded(force),
            rounded(springs)
        ));
    }
    if let Some(more) = found.bands.len().checked_sub(FEW).filter(|more| *more > 0) {
        notes.push(format!("rest: statics leaves {more} more normal forces between bodies at rest undetermined"));
    }
    notes
}

/// A force with five digits.
fn rounded(force: f64) -> String {
    let digits = if force == 0.0 { 0 } else { 4 - force.abs().log10().floor() as i32 };
    let scale = 10.0_f64.powi(digits);
    number((force * scale).round() / scale)
}
