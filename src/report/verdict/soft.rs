//! Contacts that give way more than bodies are large.

use super::{Cause, Evidence, Trust};
use crate::numbers::{number, percent};
use crate::tick::{State, place_of};

/// A body so many times as heavy as what it presses on asks for springs that are as many times as stiff.
const HEAVY: f64 = 100.0;

/// Overlaps that hardly change what a scene means, as a share of a radius.
const HARDLY: f64 = 0.1;

/// Something was pressed in by more than a radius. Where that is an impact, overlaps fall with the root of the stiffness, `d = v
/// sqrt(m/k)`, and so do critical ticks.
pub(super) fn deep(evidence: &Evidence) -> Option<Cause> {
    let (world, card) = (evidence.world, evidence.card);
    let overlap = &card.largest_overlap;
    if overlap.share_of_radius <= 1.0 {
        return None;
    }
    let by = overlap.share_of_radius * 100.0;
    let deepest = world.resource::<State>().deepest.between?;
    let bodies = &world.resource::<State>().bodies;
    let mass = |entity| {
        let slot = place_of(world, entity)?;
        bodies.dynamic.get(slot).is_some_and(|dynamic| *dynamic).then(|| 1.0 / bodies.inverse_mass(slot))
    };
    let (a, b) = (evidence.name(deepest.0), evidence.name(deepest.1));
    let masses = mass(deepest.0).zip(mass(deepest.1));
    let heavy =
        masses.map(|(first, second)| if first > second { (first / second, &a, &b) } else { (second / first, &b, &a) });
    let heavy = heavy.filter(|(ratio, ..)| *ratio > HEAVY);
    let what = match heavy {
        Some((ratio, heavier, lighter)) => format!(
            "`{heavier}` has {ratio:.0} times the mass of `{lighter}` and is pressed into it by {by:.0} % of a radius at {}",
            super::at(overlap.time)
        ),
        None => format!("bodies overlap by {by:.0} % of a radius, `{a}` and `{b}` at {}", super::at(overlap.time)),
    };
    let error = card.energy_error();
    let softer = overlap.share_of_radius / HARDLY;
    let times = number(rounded_up(softer * softer));
    let tick = number(card.tick_for(softer, 1.0, 1.0));
    let with = if card.by_ticks() { format!(", with --tick {tick}") } else { String::new() };
    let remedy = format!(
        "a `stiffness` some {times} times as high{with}: the overlap of such an impact is about a tenth of a radius then"
    );
    let what = if card.by_ticks() && error > 0.0 {
        format!("{what}; energy is accounted for to {}", percent(error))
    } else {
        what
    };
    Some(Cause { trust: Trust::NotTheModel, what, remedy: Some(remedy) })
}

/// One digit, not less than it was.
fn rounded_up(value: f64) -> f64 {
    let digit = libm::exp10(value.log10().floor());
    (value / digit).ceil() * digit
}
