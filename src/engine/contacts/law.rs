//! Contact laws from outside the crate, and their results on the card. Overlap and critical tick are measured beside
//! such a law, so that the card misses none.

use std::any::Any;

use bevy_app::App;
use bevy_ecs::prelude::*;
use glam::DVec2;

use super::geometry::PairGeometry;
use super::{Probe, Surface, search};
use crate::tick::critical_step::{Spring, Springs};
use crate::tick::snapshot::{Memory, UnfitSnapshot, recall};
use crate::tick::touch::ContactPoint;
use crate::tick::{
    Departure, Dependence, Energies, EvaluationMode, Events, Fastest, Holder, Model, Objection, Rhythm, State,
    SteadySpring, TickAppExt, TimeScales,
};

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
pub fn add_law(app: &mut App, law: impl ContactLaw) {
    search::plugin(app);
    app.add_model(Watched { law, found: TimeScales::default(), springs: Springs::default(), next: 0 });
}

/// A law from outside, and the measured response of its contacts.
struct Watched<L> {
    law: L,
    found: TimeScales,
    springs: Springs,
    next: u64,
}

impl<L: ContactLaw> Model for Watched<L> {
    fn name(&self) -> &'static str {
        self.law.name()
    }

    fn save(&self) -> Memory {
        match self.law.save() {
            Memory::Untold => Memory::Untold,
            Memory::Nothing => Memory::of(&(None::<Vec<u8>>, self.found, self.next)),
            Memory::Bytes(bytes) => Memory::of(&(Some(bytes), self.found, self.next)),
        }
    }

    fn load(&mut self, bytes: &[u8]) -> Result<(), UnfitSnapshot> {
        let law: Option<Vec<u8>>;
        (law, self.found, self.next) = recall(bytes)?;
        law.map_or(Ok(()), |bytes| self.law.load(&bytes))
    }

    fn energies(&self, state: &State) -> Energies {
        self.law.energies(state)
    }

    fn stiffness(&self, state: &State, springs: &mut Vec<SteadySpring>) {
        self.law.stiffness(state, springs);
    }

    fn dependence(&self) -> Dependence {
        self.law.dependence()
    }

    fn contact_law(&self) -> Option<&'static str> {
        Some(self.law.law())
    }

    fn start(&mut self, world: &mut World) {
        self.law.start(world);
    }

    fn apply_forces(&mut self, state: &mut State) {
        self.law.apply_forces(state);
    }

    fn settles(&self) -> bool {
        self.law.settles()
    }

    fn settle(&mut self, state: &mut State) {
        self.law.settle(state);
    }

    fn looks_at_ticks(&self) -> bool {
        true
    }

    fn end_tick(&mut self, state: &mut State) {
        self.law.end_tick(state);
        self.watch(state);
    }

    fn finds_pairs(&self) -> bool {
        self.law.finds_pairs()
    }

    fn find_pairs(&mut self, state: &mut State) {
        self.law.find_pairs(state);
    }

    fn rhythm(&self) -> Option<Rhythm> {
        self.law.rhythm()
    }

    fn has_modes(&self) -> bool {
        self.law.has_modes()
    }

    fn begin_step(&mut self, state: &mut State) {
        self.law.begin_step(state);
    }

    fn time_scales(&self) -> TimeScales {
        self.found
    }

    fn events(&mut self) -> Option<&mut dyn Events> {
        self.law.events()
    }

    fn has_edges(&self) -> bool {
        self.law.has_edges()
    }

    fn next_edge(&self, now: f64) -> f64 {
        self.law.next_edge(now)
    }

    fn objection(&self, mode: EvaluationMode) -> Option<Objection> {
        self.law.objection(mode)
    }

    fn departures(&self, state: &State, mode: EvaluationMode) -> Vec<Departure> {
        self.law.departures(state, mode)
    }

    fn remarks(&self, state: &State) -> Vec<String> {
        self.law.remarks(state)
    }

    fn contact_points(&self, state: &State) -> Option<Vec<ContactPoint>> {
        self.law.contact_points(state)
    }

    fn inner(&self) -> Option<&dyn Any> {
        Some(&self.law)
    }

    fn inner_mut(&mut self) -> Option<&mut dyn Any> {
        Some(&mut self.law)
    }
}

impl<L: ContactLaw> Watched<L> {
    /// Notes the deepest overlap, and now and then the response of the contacts.
    fn watch(&mut self, state: &mut State) {
        let touching = touching(state);
        let (ticks, time) = (state.clock.ticks, state.clock.time());
        let State { bodies, deepest, .. } = state;
        for pair in &touching {
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
        if touching.is_empty() || ticks < self.next {
            return;
        }
        self.next = ticks + PATIENCE;
        let bodies = &state.bodies;
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
            stiffness: self.law.pair_stiffness(state, pair),
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
