//! Places that are not exact, as the estimated error tells: chaos, events that ticks do not see, or a tick too long for the
//! motion itself. And what is said where nothing is wrong.

use super::{Card, Cause, Evidence, Trust, at, energy, of_the_way, places, places_of};
use crate::estimate::EstimatedError;
use jostle_engine::simulation::error::ErrorEstimate;
use jostle_engine::tick::State;
use jostle_language::numbers::{number, percent};

/// Share of how far bodies go by which places may be wrong without a cause.
const INEXACT: f64 = 1e-2;
/// Share of the energy that may be missing without a word.
const MISSING: f64 = 1e-3;

/// The tolerance that was asked for is not reached.
pub(super) fn tolerance_not_reached(evidence: &Evidence) -> Option<Cause> {
    let missed = evidence.card.missed.clone().filter(|_| !evidence.card.stands)?;
    // Where the runs that are compared say nothing, no digit is known.
    let known = evidence.card.error.is_none_or(|error| error.position.discretisation.is_some());
    let part = if known { "Do not trust its last digits" } else { "Do not trust its places" };
    Some(Cause { trust: Trust::Partly(part.to_owned()), what: missed, remedy: None })
}

/// Where and when a finer run first went another way, in words.
pub(super) fn began(evidence: &Evidence) -> Option<String> {
    let estimated = evidence.world.get_resource::<EstimatedError>()?;
    let (body, time) = estimated.began.as_ref()?;
    Some(format!(
        "a run with finer steps is elsewhere by a hundredth of the motion from {} on, `{body}` first",
        at(*time)
    ))
}

/// Any error grows until nothing is left of places.
pub(super) fn chaos(evidence: &Evidence) -> Option<Cause> {
    let estimated = evidence.world.get_resource::<EstimatedError>()?;
    let horizon = evidence.card.error.filter(|_| evidence.card.by_ticks())?.horizon?;
    // Where energy is lost or gained the tick makes bodies go elsewhere, chaos or not.
    if evidence.card.energy_error() > INEXACT {
        return None;
    }
    let body = estimated.began.as_ref().map_or_else(|| "places".to_owned(), |(body, _)| format!("`{body}` first"));
    let what = format!(
        "chaos makes errors grow exponentially, and finer runs go elsewhere from then on, {body}. What a finer tick \
         gains grows as the logarithm of its cost; statistics last, and {}",
        energy::accounted(evidence)
    );
    estimated.chaotic.then(|| Cause { trust: until(horizon), what, remedy: None })
}

fn until(horizon: f64) -> Trust {
    Trust::Partly(format!("Trust places until about {}", at(horizon)))
}

/// The tick is too long for contacts whose beginnings it does not see, or for the motion.
pub(super) fn inexact(evidence: &Evidence) -> Option<Cause> {
    let (world, card) = (evidence.world, evidence.card);
    let estimated = world.get_resource::<EstimatedError>()?;
    let (share, error) = (estimated.share?, card.error.filter(|_| card.by_ticks())?);
    if share <= INEXACT {
        return None;
    }
    let unseen =
        world.resource::<State>().contact_law().is_some() && !card.located && card.largest_overlap.meters > 0.0;
    let why = if unseen {
        format!("contacts begin and end inside ticks, which {} sees at their ends only", card.method)
    } else {
        format!("the tick of {} s is too long for the motion", number(card.tick))
    };
    let why = match (began(evidence), error.horizon) {
        (Some(began), _) => format!("{why}: {began}"),
        (None, _) => why,
    };
    let trust = match (error.horizon, places(card)) {
        (Some(horizon), _) => until(horizon),
        (None, Some(places)) => Trust::Partly(format!("Trust {places} ({})", of_the_way(share))),
        (None, None) => Trust::Roughly,
    };
    let tolerance = evidence.or_tolerance();
    // Beyond a horizon nothing says how errors fall.
    let order = if unseen { 1.0 } else { 2.0 };
    let tick = if error.horizon.is_some() { card.tick / 10.0 } else { card.tick_for(share, INEXACT / 10.0, order) };
    let whether = if error.horizon.is_some() { " to see whether that moves on" } else { "" };
    Some(Cause { trust, what: why, remedy: Some(format!("`--tick {}`{whether}{tolerance}", number(tick))) })
}

/// What is said where nothing is wrong.
pub(super) fn good(evidence: &Evidence) -> String {
    let card = evidence.card;
    if card.stands {
        return format!("Trust it: nothing moves; {}.", energy::accounted(evidence));
    }
    if let Some(known) = card.error.as_ref().filter(|_| !card.by_ticks()) {
        return of_a_tolerance(known, card);
    }
    let energy = energy::accounted(evidence);
    match (places(card), evidence.known_until()) {
        (Some(places), Some(until)) => {
            let advice =
                if card.energy_error() > MISSING { evidence.advice("; ", " would improve it") } else { String::new() };
            format!(
                "Trust its beginning: {places} until {}, as far as it was run again with finer steps. Nothing is known of the \
                 rest; `--estimate` runs it all again; {energy}{advice}.",
                at(until)
            )
        }
        (Some(places), None) if card.energy_error() > MISSING => {
            let advice = evidence.advice("; ", " would improve it");
            format!("Trust it to about {} of energy: {places}{advice}.", percent(card.energy_error()))
        }
        (Some(places), None) => {
            let share = evidence.world.get_resource::<EstimatedError>().and_then(|estimated| estimated.share);
            let share = share.filter(|share| *share > 0.0);
            let share = share.map_or_else(String::new, |share| format!(" ({})", of_the_way(share)));
            format!("Trust it: {places}{share}, as runs with finer steps tell; {energy}.")
        }
        (None, _) => format!(
            "How wrong places are is not known: {energy}, which says nothing of a light body among heavy ones. Use `--estimate`."
        ),
    }
}

/// What is said of a run whose steps were chosen for its error.
fn of_a_tolerance(error: &ErrorEstimate, card: &Card) -> String {
    let Some(places) = places_of(error) else {
        return "Do not trust its places: runs of it differ by more than can be told.".to_owned();
    };
    let until = error.horizon.filter(|horizon| *horizon < card.time);
    let until = until.map_or_else(String::new, |horizon| format!(" until about {}", at(horizon)));
    if card.has_tolerance() {
        return format!("Trust it{until}: {places}, as several runs of it tell.");
    }
    format!(
        "Trust it{until}: {places} at most. A run that allows a hundred times the error differs by that; where motion is smooth this \
         one is nearer to the truth by as much."
    )
}
