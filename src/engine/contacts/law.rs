//! Contact laws from outside the crate, and their results on the card. Overlap and critical tick are measured beside
//! such a law, so that the card misses none.

use std::marker::PhantomData;

use bevy_app::App;
use bevy_ecs::prelude::*;
use glam::DVec2;

use super::geometry::PairGeometry;
use super::{Probe, Surface, search};
use crate::tick::critical_step::{Spring, Springs};
use crate::tick::snapshot::{Memory, UnfitSnapshot, recall};
use crate::tick::{Dependence, Energies, Fastest, Holder, Model, State, SteadySpring, TimeScales};

/// Ticks from one look at how fast the touching pairs respond together to the next.
const PATIENCE: u64 = 64;

/// A pair that touches.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LawTouch {
    /// Side A.
    pub a: LawSide,
    /// The atom on side B.
    pub b: usize,
    /// Unit normal from A to B.
    pub normal: DVec2,
    /// Overlap in metres, positive.
    pub overlap: f64,
}

/// Side A of a pair.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LawSide {
    /// An atom.
    Atom(usize),
    /// The side of a hull.
    Hull(usize),
    /// A wall.
    Wall(usize),
}

/// A contact law from outside, for [`add_law`]: a model that uses [`State::pairs`].
pub trait ContactLaw: Model {
    /// Its name in scenes.
    fn law(&self) -> &'static str;

    /// Stiffness along the normal and across it, in N/m, of a pair that touches. The critical tick follows from them.
    fn pair_stiffness(&self, state: &State, pair: &LawTouch) -> (f64, f64);
}

/// Adds a contact law with the search for pairs, and the results of contacts on the card. These are the deepest
/// overlap, the elastic energy and the critical tick.
pub fn add_law<L: ContactLaw>(app: &mut App, law: L) {
    search::plugin(app);
    let name = law.law();
    let mut state = app.world_mut().resource_mut::<State>();
    state.add_model(LawWatch::<L>::default());
    state.add_contact_law(law, name);
}

/// Looks at the contacts of a law from outside, and measures their response. It makes no force.
struct LawWatch<L> {
    found: TimeScales,
    springs: Springs,
    next: u64,
    law: PhantomData<fn() -> L>,
}

impl<L> Default for LawWatch<L> {
    fn default() -> Self {
        Self { found: TimeScales::default(), springs: Springs::default(), next: 0, law: PhantomData }
    }
}

impl<L: ContactLaw> Model for LawWatch<L> {
    fn name(&self) -> &'static str {
        "contacts::LawWatch"
    }

    fn save(&self) -> Memory {
        Memory::of(&(self.found, self.next))
    }

    fn load(&mut self, bytes: &[u8]) -> Result<(), UnfitSnapshot> {
        (self.found, self.next) = recall(bytes)?;
        Ok(())
    }

    fn energies(&self, _: &State) -> Energies {
        Energies::default()
    }

    fn stiffness(&self, _: &State, _: &mut Vec<SteadySpring>) {}

    fn dependence(&self) -> Dependence {
        Dependence::Nothing
    }

    fn flies(&self) -> bool {
        true
    }

    fn looks_at_ticks(&self) -> bool {
        true
    }

    fn end_tick(&mut self, state: &mut State) {
        let touching = if state.model::<L>().is_some() { touching(state) } else { Vec::new() };
        note_deepest(state, &touching);
        if touching.is_empty() || state.clock.ticks < self.next {
            return;
        }
        self.next = state.clock.ticks + PATIENCE;
        self.measure(state, &touching);
    }

    fn time_scales(&self) -> TimeScales {
        self.found
    }
}

/// Notes the deepest overlap.
fn note_deepest(state: &mut State, touching: &[LawTouch]) {
    let time = state.clock.time();
    let State { bodies, deepest, .. } = state;
    for pair in touching {
        let entity = |atom: usize| bodies.entity[bodies.atom_body(atom)];
        let (first, smaller) = match pair.a {
            LawSide::Atom(a) => (entity(a), bodies.atom_radius[a].min(bodies.atom_radius[pair.b])),
            LawSide::Hull(hull) => {
                let packed = &bodies.hulls[hull];
                (bodies.entity[packed.body as usize], packed.half_width.min(bodies.size_of_atom(pair.b)))
            }
            LawSide::Wall(wall) => (bodies.walls[wall].entity, bodies.size_of_atom(pair.b)),
        };
        deepest.note(pair.overlap, smaller, time, || (first, entity(pair.b)));
    }
}

impl<L: ContactLaw> LawWatch<L> {
    /// Measures how fast the contacts respond together.
    fn measure(&mut self, state: &State, touching: &[LawTouch]) {
        let (Some(law), bodies, time) = (state.model::<L>(), &state.bodies, state.clock.time()) else { return };
        let side = |atom: usize| {
            let body = bodies.atom_body(atom);
            (body, bodies.atom_place(atom) - bodies.position[body])
        };
        let spring = |pair: &LawTouch| Spring {
            a: match pair.a {
                LawSide::Atom(atom) => Some(side(atom)),
                LawSide::Hull(hull) => {
                    let (shape, place, _) = bodies.meeting(hull, pair.b);
                    let body = bodies.hulls[hull].body as usize;
                    Some((body, bodies.nearest_on(body, shape, place).foot))
                }
                LawSide::Wall(_) => None,
            },
            b: side(pair.b),
            normal: pair.normal,
            stiffness: law.pair_stiffness(state, pair),
            damped: 0.0,
            turning: 0.0,
        };
        let springs: Vec<Spring> = touching.iter().map(spring).collect();
        self.springs.gather(springs, [], bodies);
        let angular_frequency = self.springs.largest().sqrt();
        if angular_frequency > self.found.fastest.map_or(0.0, |fastest| fastest.angular_frequency) {
            let body = bodies.entity[self.springs.bound().body];
            self.found.fastest = Some(Fastest { angular_frequency, body, holder: Holder::Contacts, time });
        }
    }
}

/// The pairs that touch.
fn touching(state: &State) -> Vec<LawTouch> {
    let (bodies, Some(pairs)) = (&state.bodies, &state.pairs) else { return Vec::new() };
    let touch = |a: LawSide, b: u32, PairGeometry { pair, overlap, .. }: PairGeometry| {
        (overlap > 0.0).then_some(LawTouch { a, b: b as usize, normal: pair.normal, overlap })
    };
    let atoms = pairs.atoms.iter().enumerate().filter_map(|(index, &pair)| {
        touch(LawSide::Atom(pair.a as usize), pair.b, PairGeometry::atoms(bodies, index, pair))
    });
    let surfaces = pairs.surfaces.iter().enumerate().filter_map(|(index, &pair)| {
        // Beside an end of a wall no atom is side B.
        let Probe::Atom(atom) = pair.probe(bodies) else { return None };
        let side = match pair.surface(bodies) {
            Surface::Wall(wall) => LawSide::Wall(bodies.whole_wall(wall)),
            Surface::Hull(hull) => LawSide::Hull(hull),
        };
        touch(side, atom as u32, PairGeometry::surface(bodies, index, pair))
    });
    atoms.chain(surfaces).collect()
}
