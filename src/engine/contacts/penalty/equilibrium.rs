//! The start in equilibrium. Bodies that touch and do not move begin where the springs of their contacts bear their loads.
//!
//! Bodies that are put onto each other with sides that just touch bear nothing yet. They would drop onto their springs,
//! and rebound. Before the first tick the engine looks for places in which the springs bear all loads
//! (`equilibrium_search.rs`). It moves the bodies there. No body moves in these cases:
//!
//! * A contact of the island slides, turns, approaches or parts at the start.
//! * The springs bear the loads as bodies stand, within the band of the normal law.
//! * Sides overlap by another depth than their load asks for: the scene gives their springs that energy.
//! * The search does not come to an end within its bound. The card says so.
//!
//! Bodies that nothing holds in some direction slide, roll or tip at once. Their springs bear what the acceleration leaves.
//!
//! The places depend on the scene alone. So all methods and ticks begin in the same state.

use bevy_ecs::prelude::*;

use super::apply::{sides_at_surface, sides_of_atoms};
use super::begun::{Begun, Named};
use super::equilibrium_joint::JointRow;
use super::equilibrium_part::{Candidate, touch_gap};
use super::equilibrium_search::{Outcome, Search};
use super::normal::NormalForce;
use super::pair_law::{LawTable, PairSide};
use super::penalty_model::PenaltyState;
use super::rolling::RollingContacts;
use super::{Penalty, Start};
use crate::contacts::geometry::PairGeometry;
use crate::contacts::{CandidatePairs, search};
use crate::tick::{Notes, State};
use crate::world::{Bodies, Materials, Name, Position, Rotation};
use jostle_language::numbers::number;

/// Two sides touch at the start if the gap between them is at most this share of the smaller size. That is a radius or half a width.
/// The gap is a sum of four numbers of about that size. Numbers of six digits are known to 5e-6 of themselves.
const TOUCHES: f64 = 2e-5;

/// Moves the bodies that touch at the start into their equilibrium, and says by how much.
pub(super) fn begin<N: NormalForce>(world: &mut World) {
    let mut state = std::mem::take(&mut *world.resource_mut::<State>());
    let found = find::<N>(&mut state);
    *world.resource_mut::<State>() = state;
    let Some(Found { moved, begun, some_move, unsolved }) = found else { return };
    let name = |world: &World, body: usize| {
        let entity = world.resource::<State>().bodies.entity[body];
        world.get::<Name>(entity).map_or_else(|| "(unnamed)".to_owned(), Name::to_string)
    };
    let mut notes = Vec::new();
    let farthest = moved.iter().copied().reduce(|most, next| if next.1 > most.1 { next } else { most });
    if let Some((body, way)) = farthest {
        let (name, way) = (name(world, body), number(way));
        let moved_bodies = match moved.len() {
            1 => format!("`{name}` by {way} m"),
            many => format!("{many} bodies, `{name}` the farthest by {way} m"),
        };
        let begin = if some_move { ", or slide and roll at once" } else { "" };
        notes.push(format!(
            "start: bodies that touch begin in equilibrium{begin}. The engine moved {moved_bodies}, so that the springs of contacts bear the loads. \
             `contacts: Penalty(start: AsPlaced)` leaves bodies as they stand"
        ));
    }
    if let Some((body, count)) = unsolved {
        notes.push(format!(
            "start: the search for an equilibrium of `{}` and the {} bodies around it reached its bound. They begin as they stand",
            name(world, body),
            count - 1
        ));
    }
    for (body, _) in moved {
        let bodies = &world.resource::<State>().bodies;
        let place = (Position(bodies.position[body]), Rotation(bodies.angle[body]));
        let entity = bodies.entity[body];
        world.entity_mut(entity).insert(place);
    }
    world.resource_mut::<Notes>().0.extend(notes);
    if !begun.is_empty()
        && let Some(own) = world.resource_mut::<State>().model_mut::<PenaltyState>()
    {
        own.contacts.begun = begun;
    }
}

/// The result for a scene.
struct Found {
    /// Bodies that have moved, in canonical order, and the way of their farthest points in metres.
    moved: Vec<(usize, f64)>,
    begun: Vec<Begun>,
    /// Whether bodies that have moved accelerate at once.
    some_move: bool,
    /// A body of the largest island without a result, and the number of bodies there.
    unsolved: Option<(usize, usize)>,
}

fn find<N: NormalForce>(state: &mut State) -> Option<Found> {
    let own = state.model::<PenaltyState>()?;
    let (settings, materials) = (*own.settings(), own.contacts.materials.clone());
    let rolling = own.rolling.as_ref().map(|rolling| RollingContacts::new(rolling.friction, rolling.ratio));
    if settings.start == Start::AsPlaced || state.force_systems > 0 {
        return None;
    }
    state.bodies.prescribe(0.0, 0.0);
    let mut loads = Vec::new();
    state.loads_at_start(&mut loads);
    let bodies = &mut state.bodies;
    let loaded = |body: usize| loads[body].linear != glam::DVec2::ZERO || loads[body].angular != 0.0;
    if !(0..bodies.len()).any(|body| bodies.dynamic[body] && bodies.collides[body] && loaded(body)) {
        return None;
    }
    let (pairs, reach) = search::look(bodies)?;
    let mut near = Near { pairs: &pairs, settings, materials, rolling, laws: LawTable::default() };
    let mut search = Search::new(reach, N::SET_VALUED);
    near.each::<N>(
        &state.bodies,
        |_| true,
        |candidate| {
            if candidate.touches() {
                search.add(&candidate);
            }
        },
    );
    if !search.some_touch() {
        return None;
    }
    let rows = JointRow::all(&state.joint_rows_at_start());
    search.gather(&state.bodies, rows);
    if !search.is_needed() {
        return Some(Found { moved: Vec::new(), begun: search.jointed().to_vec(), some_move: false, unsolved: None });
    }
    let members: Vec<bool> = (0..state.bodies.len()).map(|body| search.has(body)).collect();
    near.each::<N>(
        &state.bodies,
        |body| members[body],
        |candidate| {
            if !candidate.touches() {
                search.add_near(&candidate);
            }
        },
    );
    let start: Vec<_> = state.bodies.position.iter().copied().zip(state.bodies.angle.iter().copied()).collect();
    search.run(state, &pairs, &mut loads);
    let (mut begun, mut some_move, mut unsolved) = (search.jointed().to_vec(), false, None::<(usize, usize)>);
    for island in search.islands() {
        match island.outcome {
            Outcome::Found => {
                some_move |= island.moves();
                begun.extend(island.begun());
            }
            Outcome::Bound if unsolved.is_none_or(|(_, most)| island.members().len() > most) => {
                unsolved = island.members().first().map(|first| (*first, island.members().len()));
            }
            _ => begun.extend(island.as_placed(N::SET_VALUED)),
        }
    }
    let bodies = &state.bodies;
    let moved = (0..bodies.len()).filter_map(|body| {
        let (position, angle) = start[body];
        let way = bodies.position[body].distance(position) + (bodies.angle[body] - angle).abs() * bodies.extent(body);
        (way > 0.0).then_some((body, way))
    });
    Some(Found { moved: moved.collect(), begun, some_move, unsolved })
}

/// Candidate pairs with their laws.
struct Near<'a> {
    pairs: &'a CandidatePairs,
    settings: Penalty,
    materials: Materials,
    rolling: Option<RollingContacts>,
    laws: LawTable,
}

impl Near<'_> {
    /// Gives all pairs with a body that is wanted.
    fn each<N: NormalForce>(
        &mut self,
        bodies: &Bodies,
        wanted: impl Fn(usize) -> bool,
        mut take: impl FnMut(Candidate),
    ) {
        let Self { pairs, settings, materials, rolling, laws } = self;
        let mut give = |named: Named, geometry: &PairGeometry, (a, b): (PairSide, PairSide), size: f64| {
            let index = laws.index::<N>(a, b, materials, settings);
            let law = *laws.get(index);
            let rolls =
                rolling.as_ref().and_then(|rolling| rolling.law(&law, geometry.pair.other_end(), &geometry.pair.b));
            let touch = touch_gap(geometry, TOUCHES * size, bodies);
            take(Candidate { named, geometry, law, rolls, touch });
        };
        for (index, &pair) in pairs.atoms.iter().enumerate() {
            let [a, b] = [pair.a, pair.b].map(|atom| atom as usize);
            if [a, b].into_iter().any(|atom| wanted(bodies.atom_body(atom))) {
                let size = bodies.atom_radius[a].min(bodies.atom_radius[b]);
                let geometry = PairGeometry::atoms(bodies, index, pair);
                give(Named::Atoms(pair), &geometry, sides_of_atoms(bodies, pair), size);
            }
        }
        for (index, &pair) in pairs.surfaces.iter().enumerate() {
            let (a, b) = pair.bodies(bodies);
            if wanted(b) || a.is_some_and(&wanted) {
                let geometry = PairGeometry::surface(bodies, index, pair);
                give(Named::Surface(pair.names()), &geometry, sides_at_surface(bodies, pair), pair.size(bodies));
            }
        }
    }
}
