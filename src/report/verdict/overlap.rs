//! Contacts whose overlap is a large part of a radius.

use bevy_ecs::prelude::*;

use super::{Cause, Evidence, Trust, VerdictPart, softness};
use jostle_engine::tick::{State, index_of};
use jostle_language::numbers::number;

/// Above this ratio of masses a heavy body on a light one needs springs that are stiffer by the ratio.
const HEAVY: f64 = 100.0;

/// Contacts are resolved if the critical tick is at least this many ticks.
const TICKS: f64 = 20.0;

/// An overlap, as a share of a radius, that is too much for hard bodies. Results differ from theirs by about as much. A reader of
/// trusted places takes such a share for an error.
const DEEP: f64 = 0.1;

/// An overlap, as a share of a radius, that the verdict does not mention.
const HARDLY: f64 = 0.05;

/// A contact was pressed in by much of a radius. In an impact the overlap `d = v sqrt(m/k)` falls with the root of the stiffness
/// `k`, and so does the critical tick.
pub(super) fn deep(evidence: &Evidence) -> Option<Cause> {
    let (world, card) = (evidence.world, evidence.card);
    let overlap = world.resource::<State>().deepest_overlap().in_share;
    if overlap.share <= DEEP {
        return None;
    }
    let by = softness::share(overlap.share);
    let deepest = overlap.between?;
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
            "`{heavier}` has {ratio:.0} times the mass of `{lighter}`. They overlap by {by} of a radius at {}",
            super::at(overlap.time)
        ),
        None => format!("bodies overlap by {by} of a radius, `{a}` and `{b}` at {}", super::at(overlap.time)),
    };
    let what = format!("{what}. {}", crate::capital(&softness::effects(evidence, &overlap)));
    let radius = overlap.overlap / overlap.share;
    let softer = overlap.share / HARDLY;
    // A body that runs through another was too fast for its spring. The fastest body sets the stiffness: `m v^2 = k d^2`.
    let speed = card.largest_travel_share * bodies.smallest_radius / card.tick;
    let stiffness = stiffness(world, deepest);
    let inverse_mass = |entity| index_of(world, entity).map_or(0.0, |slot| bodies.inverse_mass(slot));
    let inverse = inverse_mass(deepest.0) + inverse_mass(deepest.1);
    let run_through = speed * speed / (inverse * stiffness * (HARDLY * radius) * (HARDLY * radius));
    let many = if run_through.is_finite() { run_through.max(softer * softer) } else { softer * softer };
    let times = number(rounded_up(many));
    // If the tick is too coarse for the present contacts, the advice makes up for that too.
    let coarse = card.critical_tick.map_or(1.0, |critical| (card.tick / critical * TICKS).max(1.0));
    let tick = number(card.tick_for(many.sqrt() * coarse, 1.0, 1.0));
    let with = if card.by_ticks() { format!(", with --tick {tick}") } else { String::new() };
    let remedy =
        format!("a `stiffness` some {times} times as high{with}: overlaps are then about a twentieth of a radius");
    Some(Cause { trust: Trust::ButNot(VerdictPart::Model), what, remedy: Some(remedy) })
}

/// Stiffness in N/m of the softest atom of two sides; infinite if neither side has an atom.
fn stiffness(world: &World, (a, b): (Entity, Entity)) -> f64 {
    let bodies = world.resource::<State>().bodies();
    let atoms = [a, b].into_iter().filter_map(|entity| index_of(world, entity)).flat_map(|slot| bodies.atoms_of(slot));
    atoms.map(|atom| bodies.atom_stiffness(atom)).fold(f64::INFINITY, f64::min)
}

/// The least number of one digit that is not below the value.
fn rounded_up(value: f64) -> f64 {
    let digit = libm::exp10(value.log10().floor());
    (value / digit).ceil() * digit
}
