//! Atoms that pass through walls with ends: the run ends, with both names.
//!
//! Such a wall is open on both sides, so an atom whose centre has passed the middle line would be pushed out on the other side. Soft
//! contacts let that happen, and ticks in which a small atom goes farther than it is wide. A film would not show it.

use bevy_ecs::world::World;
use glam::DVec2;
use serde::{Deserialize, Serialize};

use crate::tick::snapshot::{Memory, Unfit, recall};
use crate::tick::{Dependence, Energies, Model, State, SteadySpring, Wrong};
use crate::world::Bodies;

/// Where atoms were at the beginning of the present step, in m.
#[derive(Default, Serialize, Deserialize)]
struct Crossings {
    before: Vec<DVec2>,
}

/// Watches for atoms that pass through walls, if the scene has walls with ends.
pub(super) fn watch(world: &mut World) {
    let mut state = world.resource_mut::<State>();
    if state.bodies().walls.iter().any(|wall| wall.ends.is_some()) {
        state.add_model(Crossings::default());
    }
}

/// Moves nothing.
impl Model for Crossings {
    fn save(&self) -> Memory {
        Memory::of(self)
    }

    fn load(&mut self, bytes: &[u8]) -> Result<(), Unfit> {
        *self = recall(bytes)?;
        Ok(())
    }

    fn dependence(&self) -> Dependence {
        Dependence::Nothing
    }

    fn energies(&self, _: &State) -> Energies {
        Energies::default()
    }

    fn stiffness(&self, _: &State, _: &mut Vec<SteadySpring>) {}

    fn has_modes(&self) -> bool {
        true
    }

    /// Between ticks others may have put bodies elsewhere.
    fn begin_step(&mut self, state: &mut State) {
        if state.span.begin > state.clock.time() {
            self.look(state);
        }
        let bodies = &state.bodies;
        self.before.clear();
        self.before.extend((0..bodies.atom_count()).map(|atom| bodies.atom_place(atom)));
    }

    fn looks_at_ticks(&self) -> bool {
        true
    }

    fn end_tick(&mut self, state: &mut State) {
        self.look(state);
    }
}

impl Crossings {
    fn look(&self, state: &mut State) {
        if let Some((body, wall)) = self.first(&state.bodies) {
            state.end_run(body, Wrong::Crossed(state.bodies.walls[wall].entity));
        }
    }

    /// The first body with an atom that has crossed a wall since, and the index of the wall.
    fn first(&self, bodies: &Bodies) -> Option<(usize, usize)> {
        let moves = |body: &usize| bodies.dynamic[*body] && bodies.collides[*body];
        let atoms =
            (0..bodies.len()).filter(moves).flat_map(|body| bodies.atoms_of(body).map(move |atom| (body, atom)));
        for (body, atom) in atoms {
            let (Some(&before), now) = (self.before.get(atom), bodies.atom_place(atom)) else { continue };
            if let Some(wall) = bodies.walls.iter().position(|wall| wall.is_crossed(before, now)) {
                return Some((body, wall));
            }
        }
        None
    }
}
