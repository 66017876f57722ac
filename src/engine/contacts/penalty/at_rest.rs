//! Contacts at rest, for the card. It tells how deep they lie against their springs. It names bodies between which statics does not
//! determine the normal force.
//!
//! The ends of the band of a force are those of a linear programme. It looks for the greatest and least sum of the normal forces
//! between two bodies. All normal forces stay within their bands, and all loads balance. Friction keeps its present forces, and joints give what
//! they have to. The engine goes along the projected gradient from bound to bound (Rosen 1960). If two independent forces are free,
//! the band may be wider still.

use bevy_ecs::entity::Entity;

use super::apply::PenaltyContacts;
use super::normal::{Mode, NormalForce};
use super::{Dashpot, Inelasticity, NormalLaw};
use crate::constraints::islands::IslandLink;
use crate::constraints::spring_network::{self, NetworkEnd, NetworkSpring, Twist};
use crate::constraints::{Row, RowKind};
use crate::contacts::CandidatePairs;
use crate::contacts::geometry::PairGeometry;
use crate::tick::State;
use crate::world::Bodies;
use glam::DVec2;

/// Bands are not looked for among more contacts at rest or rows of joints than these. The band of a heap is of no use.
const MOST: usize = 64;

/// A share of a force that counts as rounding.
const ROUNDING: f64 = 1e-6;

/// A joint bears any force: its measure is so many times the greatest normal force.
const BEARS: f64 = 1e3;

/// The contact at rest that lies deepest against its spring, by the ratio.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DepthAtRest {
    /// Both sides: bodies, or a wall and a body.
    pub between: (Entity, Entity),
    /// In metres.
    pub overlap: f64,
    /// The overlap in metres at which its spring alone bears the force.
    pub needed: f64,
}

/// A normal force between two bodies that statics does not determine.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ForceBand {
    /// Both sides: bodies, or a wall and a body.
    pub between: (Entity, Entity),
    /// The force that acts, in newtons.
    pub force: f64,
    /// The force of the springs alone at these overlaps, in newtons.
    pub springs: f64,
    /// The least and the greatest force in newtons that balance the same loads.
    pub ends: (f64, f64),
}

/// The contacts at rest, for the card.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct AtRest {
    /// The deepest one; `None` if no contact at rest bears a force.
    pub deepest: Option<DepthAtRest>,
    /// Forces that are not determined, in canonical order.
    pub bands: Vec<ForceBand>,
}

/// A contact at rest along its normal.
struct Held {
    geometry: PairGeometry,
    between: (Entity, Entity),
    row: NetworkSpring,
    force: f64,
    /// The force of the spring alone.
    spring: f64,
    band: (f64, f64),
    needed: f64,
}

/// Looks at all contacts at rest of the present state.
pub(super) fn look(contacts: &PenaltyContacts, state: &State) -> AtRest {
    let Some(pairs) = &state.pairs else { return AtRest::default() };
    let mut held = find(contacts, (&state.bodies, pairs));
    let depth = |held: &Held| held.geometry.overlap / held.needed;
    let deepest = held.iter().filter(|held| held.needed > 0.0).reduce(|a, b| if depth(b) > depth(a) { b } else { a });
    let deepest =
        deepest.map(|held| DepthAtRest { between: held.between, overlap: held.geometry.overlap, needed: held.needed });
    let mut joints: Vec<NetworkSpring> =
        state.rows().all().iter().filter_map(|row| joint(row, &state.bodies)).collect();
    if held.len() > MOST || joints.len() > MOST {
        return AtRest { deepest, bands: Vec::new() };
    }
    let count = number(held.iter_mut().map(|held| &mut held.row).chain(&mut joints));
    AtRest { deepest, bands: bands(&held, &joints, count) }
}

fn find(contacts: &PenaltyContacts, (bodies, pairs): (&Bodies, &CandidatePairs)) -> Vec<Held> {
    let of_atoms = contacts
        .atoms
        .touching()
        .map(|index| (PairGeometry::atoms(bodies, index, pairs.atoms[index]), contacts.atoms.get(index)));
    let of_surfaces = contacts
        .surfaces
        .touching()
        .map(|index| (PairGeometry::surface(bodies, index, pairs.surfaces[index]), contacts.surfaces.get(index)));
    let mut held = Vec::new();
    for (geometry, contact) in of_atoms.chain(of_surfaces).filter(|(_, contact)| contact.mode == Mode::Hold) {
        let law = contacts.laws.get(contact.law);
        let band = match contacts.settings.normal {
            NormalLaw::Inelasticity => Inelasticity::band(law, contact.overlap, contact.normal_force),
            NormalLaw::Dashpot => Dashpot::band(law, contact.overlap, contact.normal_force),
        };
        let arms = geometry.contact_arms(law.shares());
        let normal = geometry.pair.normal;
        let end = |body: Option<usize>, arm: DVec2, sign: f64| {
            let body = body.filter(|body| bodies.dynamic[*body])?;
            Some(NetworkEnd { body, row: Twist { linear: normal * sign, angular: sign * arm.perp_dot(normal) } })
        };
        let ends = [end(geometry.pair.other_body(), arms.0, -1.0), end(Some(geometry.pair.b.body), arms.1, 1.0)];
        held.push(Held {
            geometry,
            between: geometry.pair.entities(bodies),
            row: NetworkSpring { ends, stiffness: 1.0 },
            force: contact.normal_force,
            spring: law.stiffness * contact.overlap,
            band,
            needed: contact.normal_force / law.stiffness,
        });
    }
    held
}

/// Numbers the bodies of all rows, in canonical order. Returns how many they are.
fn number<'a>(rows: impl Iterator<Item = &'a mut NetworkSpring>) -> usize {
    let rows: Vec<&mut NetworkSpring> = rows.collect();
    let mut members: Vec<usize> = rows.iter().flat_map(|row| row.ends).flatten().map(|end| end.body).collect();
    members.sort_unstable();
    members.dedup();
    for end in rows.into_iter().flat_map(|row| &mut row.ends).flatten() {
        end.body = members.partition_point(|member| *member < end.body);
    }
    members.len()
}

fn bands(held: &[Held], joints: &[NetworkSpring], count: usize) -> Vec<ForceBand> {
    let mut between: Vec<(Entity, Entity)> = held.iter().map(|held| held.between).collect();
    between.sort_unstable();
    between.dedup();
    let mut found = Vec::new();
    for held_pair in held.iter().map(|held| held.between) {
        let Ok(index) = between.binary_search(&held_pair) else { continue };
        between.remove(index);
        let sum = |forces: &[f64]| {
            held.iter().zip(forces).filter(|(held, _)| held.between == held_pair).map(|(_, force)| force).sum::<f64>()
        };
        let present: Vec<f64> = held.iter().map(|held| held.force).collect();
        let [least, greatest] = [-1.0, 1.0].map(|sign| sum(&extreme((held, joints), held_pair, sign, count)));
        let springs: Vec<f64> = held.iter().map(|held| held.spring).collect();
        let (force, springs) = (sum(&present), sum(&springs));
        if greatest - least > ROUNDING * greatest.abs() {
            found.push(ForceBand { between: held_pair, force, springs, ends: (least, greatest) });
        }
    }
    found
}

/// The row of a joint, which holds bodies with any force.
fn joint(row: &Row, bodies: &Bodies) -> Option<NetworkSpring> {
    let holds = row.kind != RowKind::Acceleration && !row.gives_way();
    let end = |side: Option<crate::constraints::RowSide>| {
        let side = side.filter(|side| bodies.dynamic[side.body])?;
        Some(NetworkEnd { body: side.body, row: Twist { linear: side.direction, angular: side.lever } })
    };
    holds.then(|| NetworkSpring { ends: row.sides.map(end), stiffness: 1.0 })
}

/// The normal forces with the greatest sum between two bodies, times a sign, that is found under the present balance.
fn extreme(
    (held, joints): (&[Held], &[NetworkSpring]),
    between: (Entity, Entity),
    sign: f64,
    count: usize,
) -> Vec<f64> {
    let mut forces: Vec<f64> = held.iter().map(|held| held.force).collect();
    let greatest = held.iter().map(|held| held.band.1).fold(0.0, f64::max);
    let weight = |held: &Held| (held.band.1 + held.band.0).powi(2);
    let mut free = vec![true; held.len()];
    for _ in 0..held.len() {
        let mut rows = Vec::new();
        let mut pushed = vec![Twist::default(); count];
        for (held, _) in held.iter().zip(&free).filter(|(_, free)| **free) {
            rows.push(NetworkSpring { stiffness: weight(held), ..held.row });
            if held.between == between {
                for end in held.row.ends.iter().flatten() {
                    pushed[end.body] = pushed[end.body].plus(end.row, sign * weight(held));
                }
            }
        }
        rows.extend(joints.iter().map(|row| NetworkSpring { stiffness: (BEARS * greatest).powi(2), ..*row }));
        let mut work = usize::MAX;
        let Ok(found) = spring_network::solve(&rows, &pushed, &mut work) else { break };
        let mut step = f64::INFINITY;
        let mut first = None;
        let mut directions = vec![0.0; held.len()];
        for (index, held) in held.iter().enumerate().filter(|(index, _)| free[*index]) {
            let own = if held.between == between { sign } else { 0.0 };
            let direction = weight(held) * (own - held.row.elongation(&found));
            if direction.abs() <= ROUNDING * weight(held) {
                continue;
            }
            directions[index] = direction;
            let bound = if direction > 0.0 { held.band.1 } else { held.band.0 };
            let way = ((bound - forces[index]) / direction).max(0.0);
            if way < step {
                (step, first) = (way, Some(index));
            }
        }
        let Some(first) = first else { break };
        forces.iter_mut().zip(&directions).for_each(|(force, direction)| *force += step * direction);
        free[first] = false;
    }
    forces
}
