//! The wording of a verdict that trusts at least a part of a run. Trusted parts come first, then doubted parts, then the remedy.
//! A doubted part is never among the trusted ones.

use super::{Cause, Evidence, Trust, VerdictPart, at, energy, of_the_way, places, softness};
use crate::estimate::EstimatedError;
use jostle_engine::tick::{State, stands};
use jostle_language::numbers::{percent, rough};

/// More doubts than a reader keeps in mind.
const MOST: usize = 3;

/// The verdict with these doubts, the gravest first. Without doubts it is praise. It ends with the effects of soft contacts that it
/// does not doubt.
pub(super) fn told(evidence: &Evidence, doubts: &[(VerdictPart, Cause)]) -> String {
    let told = if doubts.is_empty() { praise(evidence) } else { doubted(evidence, doubts) };
    let doubts_model = doubts.iter().any(|(part, _)| *part == VerdictPart::Model);
    let soft = softness::remark(evidence).filter(|_| !doubts_model);
    [told].into_iter().chain(soft).collect::<Vec<_>>().join(" ")
}

fn doubted(evidence: &Evidence, doubts: &[(VerdictPart, Cause)]) -> String {
    let trusted = trusted(evidence, doubts);
    let trusted = match &trusted[..] {
        [] => None,
        [one] => Some(format!("Trust {one}.")),
        [first, second] => Some(format!("Trust {first} and {second}.")),
        [first @ .., last] => Some(format!("Trust {}, and {last}.", first.join(", "))),
    };
    let doubted = doubts.iter().take(MOST).map(|(part, cause)| format!("Do not trust {part}: {}.", cause.what));
    let mut help: Vec<&str> = doubts.iter().filter_map(|(_, cause)| cause.remedy.as_deref()).collect();
    // One step at a time: the remedy of the gravest doubt, and a better estimate.
    help.truncate(1);
    let unknown = doubts.iter().filter(|(part, _)| part.is_unknown()).filter_map(|(_, cause)| cause.remedy.as_deref());
    let first = help.first().copied();
    help.extend(unknown.filter(|remedy| Some(*remedy) != first));
    let help = help.iter().enumerate().map(|(number, remedy)| match number {
        0 => format!("Use {remedy}."),
        _ => format!("Also use {remedy}."),
    });
    trusted.into_iter().chain(doubted).chain(help).collect::<Vec<_>>().join(" ")
}

fn trusted(evidence: &Evidence, doubts: &[(VerdictPart, Cause)]) -> Vec<String> {
    let (card, state) = (evidence.card, evidence.world.resource::<State>());
    let doubted = |part: &VerdictPart| doubts.iter().any(|(other, _)| other == part);
    let mut trusted = Vec::new();
    let until = doubts.iter().filter_map(|(part, _)| part.places_until()).reduce(f64::min);
    if !doubted(&VerdictPart::Energy) {
        trusted.push(match card.energy_error() {
            0.0 => "energy (residual 0)".to_owned(),
            error => format!("energy (residual {})", percent(error)),
        });
        let bodies = state.bodies();
        let moved = (0..bodies.len()).filter(|body| bodies.dynamic[*body]);
        let (count, mut resting) =
            moved.fold((0, 0), |(count, resting), body| (count + 1, resting + usize::from(bodies.is_asleep(body))));
        // Of bodies that sink into each other, neither statistics nor rest means anything for hard ones.
        if doubted(&VerdictPart::Model) {
            resting = 0;
        } else if until.is_some() && count > 1 && !doubted(&VerdictPart::Meetings) {
            trusted.push("statistics".to_owned());
        }
        match resting {
            0 => (),
            all if all == count => trusted.push("that all bodies rest".to_owned()),
            1 => trusted.push(format!("that 1 of {count} bodies rests")),
            some => trusted.push(format!("that {some} of {count} bodies rest")),
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
    let (card, energy) = (evidence.card, energy::residual(evidence));
    if card.stands {
        return format!("Trust it: all bodies rest. {energy}");
    }
    let places = places(card).unwrap_or_default();
    if card.has_trials() {
        let raised = evidence.world.get_resource::<EstimatedError>().and_then(|estimated| estimated.raised.as_ref());
        if let Some(raised) = raised {
            return format!("Trust it: {places} at most. {}.", raised.why);
        }
        if card.has_tolerance() {
            return format!("Trust it: {places}, as several runs tell.");
        }
        return format!(
            "Trust it: {places} at most. A run with a hundred times the tolerance differs by so much. If the motion is \
             smooth, the error is about a hundredth of that."
        );
    }
    let share = evidence.world.get_resource::<EstimatedError>().and_then(|estimated| estimated.share);
    let share = share.filter(|share| *share > 0.0);
    let share = share.map_or_else(String::new, |share| format!(" Their error is {}.", of_the_way(share)));
    let advice = if card.energy_error() > energy::MISSING {
        card.remedy().map_or_else(String::new, |remedy| format!(" With `{remedy}` it would be smaller."))
    } else {
        String::new()
    };
    format!("Trust it: {places}, as runs with finer steps tell.{share} {energy}{advice}")
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
