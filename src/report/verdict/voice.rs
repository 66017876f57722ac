//! The wording of a verdict that trusts at least a part of a run. Trusted parts come first, then doubted parts, then the remedy.
//! A doubted part is never among the trusted ones.

use super::{Cause, Evidence, Trust, VerdictPart, at, energy, of_the_way, places};
use crate::estimate::EstimatedError;
use jostle_engine::tick::{State, stands};
use jostle_language::numbers::{percent, rough};

/// More doubts than a reader keeps in mind.
const MOST: usize = 3;

/// The verdict with these doubts, the gravest first. Without doubts it is praise.
pub(super) fn told(evidence: &Evidence, doubts: &[(VerdictPart, Cause)]) -> String {
    if doubts.is_empty() {
        return praise(evidence);
    }
    let trusted = trusted(evidence, doubts);
    let trusted = match &trusted[..] {
        [] => String::new(),
        [one] => format!("Trust {one}. "),
        [first @ .., last] => format!("Trust {} and {last}. ", first.join(", ")),
    };
    let doubted: Vec<String> =
        doubts.iter().take(MOST).map(|(part, cause)| format!("{part}: {}", cause.what)).collect();
    let mut help: Vec<&str> = doubts.iter().filter_map(|(_, cause)| cause.remedy.as_deref()).collect();
    // One step at a time: the remedy of the gravest doubt, and a better estimate.
    help.truncate(1);
    let unknown = doubts.iter().filter(|(part, _)| part.is_unknown()).filter_map(|(_, cause)| cause.remedy.as_deref());
    let first = help.first().copied();
    help.extend(unknown.filter(|remedy| Some(*remedy) != first));
    let help = if help.is_empty() { String::new() } else { format!(" Use {}.", help.join("; ")) };
    format!("{trusted}Do not trust {}.{help}", doubted.join("; nor "))
}

fn trusted(evidence: &Evidence, doubts: &[(VerdictPart, Cause)]) -> Vec<String> {
    let (card, state) = (evidence.card, evidence.world.resource::<State>());
    let doubted = |part: &VerdictPart| doubts.iter().any(|(other, _)| other == part);
    let mut trusted = Vec::new();
    let until = doubts.iter().filter_map(|(part, _)| part.places_until()).reduce(f64::min);
    if !doubted(&VerdictPart::Energy) {
        trusted.push(match card.energy_error() {
            0.0 => "energy (all of it is accounted for)".to_owned(),
            error => format!("energy (accounted for to {})", percent(error)),
        });
        let bodies = state.bodies();
        let moved = (0..bodies.len()).filter(|body| bodies.dynamic[*body]);
        let (count, resting) =
            moved.fold((0, 0), |(count, resting), body| (count + 1, resting + usize::from(bodies.is_asleep(body))));
        if until.is_some() && count > 1 && !doubted(&VerdictPart::Meetings) {
            trusted.push("statistics".to_owned());
        }
        match resting {
            0 => (),
            all if all == count => trusted.push("the state of rest of all bodies".to_owned()),
            some => trusted.push(format!("the state of rest of {some} of {count} bodies")),
        }
    }
    if stands(state) || doubted(&VerdictPart::Places) || doubted(&VerdictPart::UnknownPlaces) {
        return trusted;
    }
    // The error on the card holds until the same time.
    let known = card.error.and_then(|error| error.position.sum());
    match until {
        Some(until) if until <= 0.0 => (),
        Some(until) => {
            let to = known.map_or_else(String::new, |position| format!(" (to about {} m)", rough(position)));
            trusted.push(format!("places until about {}{to}", at(until)));
        }
        None => trusted.extend(places(card)),
    }
    trusted
}

/// The verdict of a run without doubts.
fn praise(evidence: &Evidence) -> String {
    let (card, energy) = (evidence.card, energy::accounted(evidence));
    if card.stands {
        return format!("Trust it: nothing moves; {energy}.");
    }
    let places = places(card).unwrap_or_default();
    if !card.by_ticks() {
        if card.has_tolerance() {
            return format!("Trust it: {places}, as several runs of it tell.");
        }
        return format!(
            "Trust it: {places} at most. A run that allows a hundred times the error differs by that. If the motion is \
             smooth, this one is nearer to the truth by as much."
        );
    }
    let share = evidence.world.get_resource::<EstimatedError>().and_then(|estimated| estimated.share);
    let share = share.filter(|share| *share > 0.0);
    let share = share.map_or_else(String::new, |share| format!(" ({})", of_the_way(share)));
    let advice = if card.energy_error() > energy::MISSING {
        evidence.advice("; ", " would improve that")
    } else {
        String::new()
    };
    format!("Trust it: {places}{share}, as runs with finer steps tell; {energy}{advice}.")
}

/// The doubts among causes, or as the error the first cause that leaves nothing to trust.
pub(super) fn doubts(causes: Vec<Cause>) -> Result<Vec<(VerdictPart, Cause)>, Cause> {
    let mut doubts: Vec<(VerdictPart, Cause)> = Vec::new();
    for cause in causes {
        match cause.trust.clone() {
            Trust::Not => return Err(cause),
            // The first doubt of a part explains later doubts of it.
            Trust::ButNot(part) if doubts.iter().any(|(other, _)| other.covers(&part)) => (),
            Trust::ButNot(part) => doubts.push((part, cause)),
        }
    }
    Ok(doubts)
}
