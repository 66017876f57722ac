//! Ticks that are too long: for stable springs, a periodic force, a brief contact or the travel of a body.

use std::f64::consts::TAU;

use super::{Cause, Evidence, Trust, VerdictPart, at};
use crate::Remedy;
use crate::advice::rounded_down;
use crate::estimate::EstimatedError;
use crate::warnings::only_rests;
use jostle_engine::tick::{FEWEST_TICKS_OF_CONTACT, Holder, State, far_travel};
use jostle_language::numbers::number;

/// The tick is above the critical one: springs gain energy at each tick.
pub(super) fn unstable(evidence: &Evidence) -> Option<Cause> {
    let (world, card) = (evidence.world, evidence.card);
    let critical = card.critical_tick.filter(|critical| card.by_ticks() && *critical < card.tick)?;
    if EstimatedError::is_small(world) {
        return None;
    }
    let fastest = world.resource::<State>().time_scales().fastest;
    let holder = fastest.map_or(Holder::Contacts, |fastest| fastest.holder);
    // If no bodies have touched, contacts have spoilt nothing.
    if holder == Holder::Contacts && card.largest_overlap.meters == 0.0 && critical > 0.0 {
        return None;
    }
    let seen = fastest
        .map_or_else(String::new, |fastest| format!(" for `{}` at {}", evidence.name(fastest.body), at(fastest.time)));
    let most = if critical > 0.0 {
        format!("The longest stable one was {} s", number(critical))
    } else {
        "This method had no stable one".to_owned()
    };
    let what = format!("the tick of {} s is longer than the {holder} can bear. {most}{seen}", number(card.tick));
    Some(Cause { trust: Trust::Not, what, remedy: evidence.finer() })
}

/// With fewer ticks to a period a run does not follow an oscillation. With two or fewer it sees a slower one or none (aliasing).
/// A run with half the tick may see the same.
const FEWEST_A_PERIOD: f64 = 5.0;
/// With this many ticks to a period a run follows an oscillation well.
const GOOD_A_PERIOD: f64 = 80.0;

/// A force oscillates in time faster than the ticks can sample.
pub(super) fn unseen_swing(evidence: &Evidence) -> Option<Cause> {
    let (world, card) = (evidence.world, evidence.card);
    let rhythms = world.resource::<State>().models().filter_map(|model| model.rhythm());
    let fastest = rhythms.max_by(|a, b| a.angular_frequency.total_cmp(&b.angular_frequency))?;
    let period = TAU / fastest.angular_frequency;
    let ticks = period / card.tick;
    let what = format!("`{}` swings with {ticks:.1} ticks a period, which are too few to follow it", fastest.path);
    let remedy = Some(Remedy::Tick(rounded_down(period / GOOD_A_PERIOD)).or_finer());
    (card.by_ticks() && ticks < FEWEST_A_PERIOD).then_some(Cause { trust: Trust::Not, what, remedy })
}

/// A prescribed motion turns or stops more often than the ticks can sample. Steps that locate events end at the points of paths.
pub(super) fn unseen_path(evidence: &Evidence) -> Option<Cause> {
    let (world, card) = (evidence.world, evidence.card);
    let bodies = world.resource::<State>().bodies();
    let (body, swing) = bodies.prescribed.fastest_swing().filter(|_| card.by_ticks() && !card.located)?;
    let (ticks, name) = (swing / card.tick, evidence.name(bodies.entity[body]));
    let what =
        format!("the path of `{name}` goes from stop to stop in {ticks:.1} ticks, which are too few to follow it");
    let remedy = Some(Remedy::Tick(rounded_down(2.0 * swing / GOOD_A_PERIOD)).or_finer());
    (2.0 * ticks < FEWEST_A_PERIOD).then_some(Cause { trust: Trust::Not, what, remedy })
}

/// Contacts begin and end within few ticks.
pub(super) fn brief_contact(evidence: &Evidence) -> Option<Cause> {
    let (world, card) = (evidence.world, evidence.card);
    let ticks = card.shortest_contact.filter(|_| card.by_ticks())? / card.tick;
    let brief = world.resource::<State>().time_scales().briefest;
    if EstimatedError::is_small(world) || brief.is_none() && card.located {
        return None;
    }
    if brief.is_none() && far_travel_unseen(evidence).is_some() {
        return None;
    }
    if only_rests(world) {
        return None;
    }
    let whose = brief.map_or_else(
        || "the stiffest contact".to_owned(),
        |brief| {
            let (a, b) = (evidence.name(brief.between.0), evidence.name(brief.between.1));
            format!("the contact of `{a}` and `{b}` at {}", at(brief.time))
        },
    );
    let what = format!("{whose} lasts only {ticks:.1} ticks");
    (ticks < FEWEST_TICKS_OF_CONTACT).then(|| Cause {
        trust: Trust::ButNot(VerdictPart::Impacts),
        what,
        remedy: evidence.finer(),
    })
}

/// A body moves farther in a tick than the smallest radius.
pub(super) fn far_travel_unseen(evidence: &Evidence) -> Option<Cause> {
    let (world, card) = (evidence.world, evidence.card);
    let share = card.largest_travel_share;
    let who = far_travel(world.resource())
        .map_or_else(|| "a body".to_owned(), |far| format!("`{}` at {}", evidence.name(far.body), at(far.time)));
    let what = format!("{who} travelled {share:.1} radii in one tick and may have missed a contact");
    let unseen = world.resource::<State>().contact_law().is_some() && !card.located;
    (share > 1.0 && unseen).then(|| Cause {
        trust: Trust::ButNot(VerdictPart::Meetings),
        what,
        remedy: evidence.finer(),
    })
}
