//! Attractions that grow without bound as bodies approach each other.

use super::energy::UNACCOUNTED;
use super::{Cause, Evidence, Trust};
use jostle_engine::forces::attraction::nearest;
use jostle_engine::tick::State;
use jostle_language::numbers::number;

/// An orbit that turns by more than this angle in radians within a tick is one that no method follows.
const LOST: f64 = 1.0;

const REMEDY: &str = "`softening:` for the attraction, a length below which it stops growing";

/// Two bodies that attract each other came so near that a tick steps over the steepest part of the attraction.
pub(super) fn attraction(evidence: &Evidence) -> Option<Cause> {
    let card = evidence.card;
    let near = attracted(evidence)?;
    // A share that is NaN counts as too large.
    let missing = card.energy_error().is_nan() || card.energy_error() > UNACCOUNTED;
    let lost = missing && card.by_ticks() && near.1 * card.tick > LOST;
    let what = format!("{} than ticks of {} s can follow", near.0, number(card.tick));
    lost.then(|| Cause { trust: Trust::Not, what, remedy: Some(REMEDY.to_owned()) })
}

/// The reason for which steps became ever shorter, and a remedy.
pub(super) fn of_endless_steps(evidence: &Evidence) -> String {
    match attracted(evidence) {
        Some((near, _)) => format!("{near} than steps can follow: use {REMEDY}"),
        None => {
            "a force grows beyond all bounds as bodies come near, or at that time. Bound it, or give the scene a tick"
                .to_owned()
        }
    }
}

/// Names two bodies that fell towards each other. Also gives the angular frequency in 1/s of a circular orbit at their distance.
fn attracted(evidence: &Evidence) -> Option<(String, f64)> {
    let nearest = nearest(evidence.world.resource())?;
    let bodies = evidence.world.resource::<State>().bodies();
    let name = |body: usize| evidence.name(bodies.entity[body]);
    let (a, b) = (name(nearest.between.0), name(nearest.between.1));
    Some((
        format!("`{a}` and `{b}` fall upon each other, and their attraction grows faster"),
        nearest.squared_rate.sqrt(),
    ))
}
