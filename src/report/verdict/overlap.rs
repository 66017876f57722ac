//! Contacts that give way more than bodies are large.

use bevy_ecs::prelude::*;

use super::{Cause, Evidence, Part, Trust};
use jostle_engine::tick::{State, index_of};
use jostle_language::numbers::number;

/// A body so many times as heavy as what it presses on asks for springs that are as many times as stiff.
const HEAVY: f64 = 100.0;

/// Critical ticks that a tick has to be shorter than, so that contacts are resolved.
const TICKS: f64 = 20.0;

/// An overlap, as a share of a radius, from which on bodies visibly are not where their surfaces meet.
const DEEP: f64 = 0.5;

/// Overlaps that hardly change what a scene means, as a share of a radius.
const HARDLY: f64 = 0.1;

/// Something was pressed in by much of a radius. Where that is an impact, overlaps fall with the root of the stiffness, `d = v
/// sqrt(m/k)`, and so do critical ticks.
pub(super) fn deep(evidence: &Evidence) -> Option<Cause> {
    let (world, card) = (evidence.world, evidence.card);
    let overlap = &card.largest_overlap_share;
    if overlap.share_of_radius <= DEEP {
        return None;
    }
    let by = overlap.share_of_radius * 100.0;
    let deepest = world.resource::<State>().deepest_overlap().in_share.between?;
    let bodies = world.resource::<State>().bodies();
    let mass = |entity| {
        let slot = index_of(world, entity)?;
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
    let radius = overlap.meters / overlap.share_of_radius;
    let softer = overlap.share_of_radius / HARDLY;
    // What runs through another was not stopped by its spring: `m v^2 = k d^2` for the fastest that was seen.
    let speed = card.largest_travel_share * bodies.smallest_radius / card.tick;
    let stiffness = stiffness(world, deepest);
    let inverse_mass = |entity| index_of(world, entity).map_or(0.0, |slot| bodies.inverse_mass(slot));
    let inverse = inverse_mass(deepest.0) + inverse_mass(deepest.1);
    let run_through = speed * speed / (inverse * stiffness * (HARDLY * radius) * (HARDLY * radius));
    let many = if run_through.is_finite() { run_through.max(softer * softer) } else { softer * softer };
    let times = number(rounded_up(many));
    // Contacts have to take some ticks already.
    let coarse = card.critical_tick.map_or(1.0, |critical| (card.tick / critical * TICKS).max(1.0));
    let tick = number(card.tick_for(many.sqrt() * coarse, 1.0, 1.0));
    let with = if card.by_ticks() { format!(", with --tick {tick}") } else { String::new() };
    let remedy = format!(
        "a `stiffness` some {times} times as high{with}: the overlap of such an impact is about a tenth of a radius then"
    );
    Some(Cause { trust: Trust::ButNot(Part::Model), what, remedy: Some(remedy) })
}

/// Stiffness in N/m of the softest atom of two sides; infinite where neither has one.
fn stiffness(world: &World, (a, b): (Entity, Entity)) -> f64 {
    let bodies = world.resource::<State>().bodies();
    let atoms = [a, b].into_iter().filter_map(|entity| index_of(world, entity)).flat_map(|slot| bodies.atoms_of(slot));
    atoms.map(|atom| bodies.atom_stiffness(atom)).fold(f64::INFINITY, f64::min)
}

/// One digit, not less than it was.
fn rounded_up(value: f64) -> f64 {
    let digit = libm::exp10(value.log10().floor());
    (value / digit).ceil() * digit
}
