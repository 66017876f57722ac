//! Inexact places, by the estimated error. Its causes are chaos, events that ticks do not see, and a tick that is too long for
//! the motion. If there is no estimate, the error of places is not known.

use super::{Cause, Evidence, Trust, VerdictPart, at, of_the_way};
use crate::estimate::EstimatedError;
use jostle_engine::tick::State;
use jostle_language::numbers::{number, rough};

/// A smaller error of places, as a share of how far bodies go, is no cause for doubt.
const INEXACT: f64 = 1e-2;

/// The same for the distance to runs of the other kind, if the user allows no error. It is below the third digit of places, which
/// films and tables show.
const CONTRADICTS: f64 = 1e-4;

/// The run does not reach the tolerance that its user asked for.
pub(super) fn tolerance_not_reached(evidence: &Evidence) -> Option<Cause> {
    let missed = evidence.card.missed.clone().or_else(|| EstimatedError::beyond_tolerance(evidence.world));
    let missed = missed.filter(|_| !evidence.card.stands)?;
    let part = match evidence.card.error {
        // If the comparison of runs gives no error, no digit is known.
        Some(error) if error.position.discretisation.is_none() => VerdictPart::Places,
        Some(error) => error.horizon.map_or(VerdictPart::LastDigits, VerdictPart::PlacesAfter),
        None => VerdictPart::LastDigits,
    };
    Some(Cause { trust: Trust::ButNot(part), what: missed, remedy: None })
}

/// The scene goes wrong with finer steps. So the steps of this run are too coarse for it, also if its bodies come to
/// rest.
pub(super) fn finer_run_failed(evidence: &Evidence) -> Option<Cause> {
    let failure = evidence.world.get_resource::<EstimatedError>()?.failed.as_ref()?;
    let what = format!("a run with finer steps goes wrong: {failure}");
    Some(Cause { trust: Trust::Not, what, remedy: evidence.finer() })
}

/// The body and the time at which a finer run first goes another way, in words.
pub(super) fn began(evidence: &Evidence) -> Option<String> {
    let estimated = evidence.world.get_resource::<EstimatedError>()?;
    let (body, time) = estimated.began.as_ref()?;
    Some(format!("`{body}` first differs from a run with finer steps, by a hundredth of the motion at {}", at(*time)))
}

/// Chaos: any error grows until places have no correct digit.
pub(super) fn chaos(evidence: &Evidence) -> Option<Cause> {
    let estimated = evidence.world.get_resource::<EstimatedError>()?;
    let horizon = evidence.card.error.filter(|_| !evidence.card.has_trials())?.horizon?;
    // If energy is missing, the tick makes bodies go elsewhere even without chaos.
    if evidence.card.energy_error() > INEXACT {
        return None;
    }
    let first = estimated.began.as_ref().map_or_else(String::new, |(body, _)| format!(", `{body}` first"));
    let what = format!(
        "chaos makes errors grow exponentially. From then on finer runs go elsewhere{first}. That time grows only as the \
         logarithm of the cost of a run"
    );
    estimated.chaotic.then_some(Cause { trust: Trust::ButNot(VerdictPart::PlacesAfter(horizon)), what, remedy: None })
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
        format!("contacts begin, end, stick and slip inside ticks. {} sees that only at the ends", card.method)
    } else {
        format!("the tick of {} s is too long for the motion", number(card.tick))
    };
    let why = match (began(evidence), error.horizon) {
        (Some(began), _) => format!("{why}. {began}"),
        (None, _) => why,
    };
    let until = error.horizon;
    let part = until.map_or(VerdictPart::FinePlaces, VerdictPart::PlacesAfter);
    let why = if error.horizon.is_some() { why } else { format!("{why}. The error is {}", of_the_way(share)) };
    let tolerance = evidence.or_tolerance();
    // Beyond a horizon the order at which errors fall is not known.
    let order = if unseen { 1.0 } else { 2.0 };
    let tick = if error.horizon.is_some() { card.tick / 10.0 } else { card.tick_for(share, INEXACT / 10.0, order) };
    let whether = if error.horizon.is_some() { " to see whether that time grows" } else { "" };
    Some(Cause {
        trust: Trust::ButNot(part),
        what: why,
        remedy: Some(format!("`--tick {}`{whether}{tolerance}", number(tick))),
    })
}

/// Runs of the other kind contradict the run: at most one of both is right. The stated error counts their distance. So one that is
/// small enough for the user is no cause for doubt, as far as they were compared.
pub(super) fn contradicted(evidence: &Evidence) -> Option<Cause> {
    let elsewhere = evidence.world.get_resource::<EstimatedError>()?.elsewhere?;
    let small = elsewhere.share <= evidence.card.tolerance().unwrap_or(CONTRADICTS);
    let goes = format!(
        "velocity Verlet with a tick of {} s goes elsewhere from {} on, by up to {} m",
        number(elsewhere.tick),
        at(elsewhere.since),
        rough(elsewhere.distance)
    );
    let (part, what, remedy) = match (small, elsewhere.until) {
        (true, None) => return None,
        (true, Some(until)) => {
            let remedy = "`--estimate`, which compares the whole run".to_owned();
            (VerdictPart::UnknownAfter(until), format!("{goes} so far, and was not run on"), Some(remedy))
        }
        (false, _) => {
            let remedy = Some(finer_to_compare(evidence));
            (VerdictPart::Places, format!("{goes}. At most one of these two runs is right"), remedy)
        }
    };
    Some(Cause { trust: Trust::ButNot(part), what, remedy })
}

/// Bodies rest that go elsewhere in a finer run.
pub(super) fn restless(evidence: &Evidence) -> Option<Cause> {
    let distance = evidence.world.get_resource::<EstimatedError>()?.restless?;
    let touched = evidence.world.resource::<State>().deepest_overlap().in_share.between.is_some();
    let why = if touched {
        "Forces of contacts may hold them or not, and statics does not determine these forces"
    } else {
        "No contact holds them, so ticks may miss what moves them"
    };
    let what = format!(
        "bodies rest that go up to {} m in a run with finer steps. {why}. At most one of these two runs is right",
        rough(distance)
    );
    Some(Cause { trust: Trust::Not, what, remedy: Some(finer_to_compare(evidence)) })
}

/// Finer runs to compare this one with.
fn finer_to_compare(evidence: &Evidence) -> String {
    let card = evidence.card;
    let option = match card.tolerance() {
        Some(tolerance) => format!("`--tolerance {}`", number(tolerance / 10.0)),
        None if card.by_ticks() => format!("`--tick {}`{}", number(card.tick / 4.0), evidence.or_tolerance()),
        // `Reference` has no finer steps, and its ticks are frames.
        None => "`--tolerance 1e-8`".to_owned(),
    };
    // Finer steps of one method agree with each other, where both methods draw the springs of contacts in another order.
    let touched = evidence.world.resource::<State>().deepest_overlap().in_share.between.is_some();
    let harder =
        if touched { ". If they part again, a greater `stiffness` of materials brings both nearer" } else { "" };
    format!("{option}, and places on which both runs agree{harder}")
}

/// Stiffer contacts lead elsewhere.
pub(super) fn soft_contacts(evidence: &Evidence) -> Option<Cause> {
    let until = evidence.world.get_resource::<EstimatedError>()?.model_until?;
    if evidence.card.error?.horizon? < until {
        return None;
    }
    let what = "contacts four times as stiff lead elsewhere from then on".to_owned();
    Some(Cause { trust: Trust::ButNot(VerdictPart::PlacesAfter(until)), what, remedy: None })
}

/// Only the beginning of the run was repeated with finer steps.
pub(super) fn not_run_again(evidence: &Evidence) -> Option<Cause> {
    let until = evidence.known_until().filter(|_| !evidence.card.stands)?;
    let what = "their error is not known. Runs with finer steps cover only the time before".to_owned();
    Some(Cause {
        trust: Trust::ButNot(VerdictPart::UnknownAfter(until)),
        what,
        remedy: Some("`--estimate`, which repeats the whole run".to_owned()),
    })
}

/// No estimate gives the error of places, or it gives the error only until a time.
pub(super) fn unknown(evidence: &Evidence) -> Option<Cause> {
    let card = evidence.card;
    if card.stands {
        return None;
    }
    let known = card.error.as_ref().filter(|error| error.position.sum().is_some());
    let cause = |part: VerdictPart, what: &str, remedy: Option<&str>| {
        Some(Cause { trust: Trust::ButNot(part), what: what.to_owned(), remedy: remedy.map(str::to_owned) })
    };
    match known.map(|error| error.horizon.filter(|horizon| *horizon < card.time)) {
        Some(Some(horizon)) if card.has_trials() => {
            cause(VerdictPart::PlacesAfter(horizon), "runs with other tolerances go elsewhere from then on", None)
        }
        Some(_) => None,
        None if !card.has_trials() => {
            let what = "their error is not known. Energy says nothing of a light body among heavy ones";
            cause(VerdictPart::UnknownPlaces, what, Some("`--estimate`"))
        }
        None => cause(VerdictPart::Places, "runs with other tolerances differ too much to give an error", None),
    }
}
