//! The effects of an overlap on motion: hard bodies would move otherwise. Each effect follows from the deepest overlap `d`, and the
//! scene decides which of them it can have.
//!
//! * A disc of radius `r` rolls on the point of contact, which lies `d` deeper than its rim. So it rolls as a disc of radius `r - d`.
//!   Of two discs, each gives way by its share of `d`.
//! * A bounce turns at the deepest point. Gravity works down to there, and the restitution `e` holds for that whole fall:
//!   `h' + d = e^2 (h + d)`. So the body rises less by `(1 - e^2) d`. Its spring takes the time `pi sqrt(m/k)`.
//! * Centres of equal discs in a packing are `2 r - d` apart instead of `2 r`. Their number in an area grows by the square.

use bevy_ecs::prelude::*;

use super::{Evidence, FEW, at};
use jostle_engine::contacts::Overlap;
use jostle_engine::contacts::penalty::{inelasticity_of, restitution_of};
use jostle_engine::tick::{State, index_of};
use jostle_engine::world::{Bodies, Materials};
use jostle_language::numbers::{number, percent};
use std::f64::consts::PI;

/// From this share of a radius on, the verdict names the effects of an overlap. People measure such effects without effort.
const NAMED: f64 = 0.05;

/// One side of the deepest overlap.
struct Side {
    /// Its body; `None`: a wall, which is infinitely stiff.
    body: Option<usize>,
    material: usize,
    /// Stiffness in N/m.
    stiffness: f64,
}

impl Side {
    fn of(world: &World, entity: Entity) -> Option<Self> {
        let bodies = world.resource::<State>().bodies();
        if let Some(body) = index_of(world, entity) {
            let atoms = || bodies.atoms_of(body);
            let stiffness = atoms().map(|atom| bodies.atom_stiffness(atom)).fold(f64::INFINITY, f64::min);
            let material = bodies.atom_material(atoms().next()?).index();
            return Some(Self { body: Some(body), material, stiffness });
        }
        let wall = bodies.walls.iter().find(|wall| wall.entity == entity)?;
        Some(Self { body: None, material: wall.material.index(), stiffness: f64::INFINITY })
    }

    fn give(&self) -> f64 {
        1.0 / self.stiffness
    }

    /// The radius in m of a body that rolls: a disc that moves by forces.
    fn wheel(&self, bodies: &Bodies) -> Option<f64> {
        let body = self.body.filter(|body| bodies.dynamic[*body])?;
        let mut atoms = bodies.atoms_of(body);
        let atom = atoms.next().filter(|_| atoms.next().is_none())?;
        let round = !bodies.is_corner(atom) && bodies.atom_offset(atom).length() < 1e-9 * bodies.atom_radius[atom];
        round.then_some(bodies.atom_radius[atom])
    }

    fn inverse_mass(&self, bodies: &Bodies) -> f64 {
        self.body.map_or(0.0, |body| bodies.inverse_mass(body))
    }
}

/// The sentence on an overlap that the verdict does not doubt, and names.
pub(super) fn remark(evidence: &Evidence) -> Option<String> {
    let deepest = evidence.world.resource::<State>().deepest_overlap().in_share;
    let between = deepest.between.filter(|_| deepest.share > NAMED)?;
    let (a, b) = (evidence.name(between.0), evidence.name(between.1));
    let (by, when) = (share(deepest.share), at(deepest.time));
    Some(format!("`{a}` and `{b}` overlap by {by} of a radius at {when}: {}.", effects(evidence, &deepest)))
}

/// The effects of an overlap, in a clause.
pub(super) fn effects(evidence: &Evidence, deepest: &Overlap) -> String {
    known(evidence, deepest).unwrap_or_else(|| lie_deep(deepest))
}

fn lie_deep(deepest: &Overlap) -> String {
    format!("they lie up to {} m deeper than hard bodies", number(deepest.overlap))
}

fn known(evidence: &Evidence, deepest: &Overlap) -> Option<String> {
    let world = evidence.world;
    let (state, materials) = (world.resource::<State>(), world.get_resource::<Materials>()?);
    let bodies = state.bodies();
    let (a, b) = deepest.between?;
    let sides = [Side::of(world, a)?, Side::of(world, b)?];
    let pair = materials.pair(sides[0].material, sides[1].material);
    let give = sides[0].give() + sides[1].give();
    let mut effects = Vec::new();
    let shorter = sides.iter().filter_map(|side| Some(deepest.overlap * side.give() / give / side.wheel(bodies)?));
    if let Some(shorter) = shorter.reduce(f64::max).filter(|_| pair.friction_static > 0.0) {
        effects.push(format!("a wheel rolls up to {} less far in a turn", share(shorter)));
    }
    let lost = (inelasticity_of(pair.rebounds[0]) + inelasticity_of(pair.rebounds[1])) / 2.0;
    let restitution = restitution_of(lost);
    if restitution > 0.0 {
        let inverse_mass = sides[0].inverse_mass(bodies) + sides[1].inverse_mass(bodies);
        let lasts = PI * (give / inverse_mass).sqrt();
        let lower = (1.0 - restitution * restitution) * deepest.overlap;
        let weighs = state.gravity().length() > 0.0 && lower > 0.0;
        let lower = if weighs { format!(" and comes back up to {} m lower", number(lower)) } else { String::new() };
        effects.push(format!("a bounce takes about {} s{lower}", number(two_digits(lasts))));
    }
    if (0..bodies.len()).filter(|body| bodies.dynamic[*body] && bodies.collides[*body]).count() > FEW {
        let nearer = 1.0 - deepest.share / 2.0;
        effects.push(format!("a packing is up to {} denser", share(1.0 / (nearer * nearer) - 1.0)));
    }
    match &effects[..] {
        [] => None,
        [one] => Some(one.clone()),
        [first @ .., last] => Some(format!("{}, and {last}", first.join(", "))),
    }
}

/// A share in words, of two digits and more.
pub(super) fn share(share: f64) -> String {
    if share >= 0.1 { percent(share) } else { format!("{} %", number(two_digits(share * 100.0))) }
}

fn two_digits(value: f64) -> f64 {
    format!("{value:.1e}").parse().unwrap_or(value)
}
