//! Application of penalty contacts: every candidate pair is followed, forces act on the bodies, and losses enter the
//! ledger.

use bevy_ecs::prelude::*;
use glam::DVec2;

use super::Penalty;
use super::begun::{self, Begun};
use super::contact::Losses;
use super::contact_list::ContactList;
use super::contact_stages;
use super::contradicted::Contradicted;
use super::coulomb::Slider;
use super::critical::Watch;
use super::held::Held;
use super::kernel::{self, EvaluationTime};
use super::meetings::Meetings;
use super::normal::{Approach, NormalForce};
use super::pair_law::{LawTable, PairSide};
use super::records::Records;
use super::rest::{Rest, Sleep};
use super::rolling::RollingContacts;
use super::search_schedule::SearchSchedule;
use super::surfaces::follow_surfaces;
use super::switching::Told;
use super::wedged::Wedged;
use crate::constraints::Rows;
use crate::contacts::Touches;
use crate::contacts::geometry::{ContactEnd, PairGeometry, Shares, SideA, arms};
use crate::contacts::{AtomPair, CandidatePairs, ContactForces, DeepestOverlap, Probe, Surface, SurfacePair};
use crate::contacts::{ContactPoint, Other};
use crate::tick::pairs::NEW;
use crate::tick::{Evaluation, Ledger, Rates};
use crate::world::{Bodies, Materials};
use jostle_simd::BLOCK;
use serde::{Deserialize, Serialize};

/// History of all candidate pairs, beside the lists of [`CandidatePairs`].
#[derive(Resource, Debug, Serialize, Deserialize)]
pub struct PenaltyContacts {
    pub(super) version: u64,
    /// The generation of the bodies at which the lists were made.
    generation: u64,
    #[serde(skip)]
    pub(super) settings: Penalty,
    #[serde(skip)]
    pub(super) materials: Materials,
    pub(super) laws: LawTable,
    /// One for each pair of atoms.
    pub atoms: ContactList,
    /// One for each probe near a surface.
    pub surfaces: ContactList,
    pub(super) records: Records,
    pub(super) meetings: Meetings,
    pub(super) rest: Rest,
    pub(super) schedule: SearchSchedule,
    pub(super) sleep: Sleep,
    /// Whether bodies at rest are left out of the work until something touches them. Otherwise each evaluation includes
    /// them. It changes nothing of the motion.
    pub may_sleep: bool,
    pub(super) watch: Watch,
    pub(super) held: Held,
    pub(super) told: Told,
    /// Energy in J of the tangential springs before modes were switched.
    pub(super) held_before: Option<f64>,
    /// The tangential and the rolling spring of each contact at the beginning of an event. They are those that hold or
    /// stick, and those that slip beside a normal force that is not held.
    pub(super) before: Vec<[Option<Slider>; 2]>,
    /// Contacts of a state that did not follow from the one before, until their modes have settled.
    #[serde(skip)]
    pub(super) fresh: Vec<u32>,
    /// Contacts whose friction stopped sliding at the last event, and is held for a first try.
    pub(super) stopped: Vec<u32>,
    /// Contacts whose held force has left its bounds at the last event, until the next step.
    pub(super) released: Vec<u32>,
    /// Energy in J of the tangential springs that slip, at the beginning of the step.
    pub(super) slid: f64,
    /// Contacts that begin in equilibrium, until the first evaluation.
    pub(super) begun: Vec<Begun>,
    /// Contacts whose normal motion ended at the last event.
    #[serde(skip)]
    pub(super) turned: Vec<u32>,
    /// The body whose rigid friction contradicted other rows first.
    pub(super) contradicted: Option<Contradicted>,
    /// The estimate of the error counts it, and a run from a snapshot has none.
    #[serde(skip)]
    pub(super) wedged: Option<Wedged>,
}

impl Default for PenaltyContacts {
    fn default() -> Self {
        Self {
            version: 0,
            generation: 0,
            settings: Penalty::default(),
            materials: Materials::default(),
            laws: LawTable::default(),
            atoms: ContactList::default(),
            surfaces: ContactList::default(),
            records: Records::default(),
            meetings: Meetings::default(),
            rest: Rest::default(),
            schedule: SearchSchedule::default(),
            sleep: Sleep::Never,
            may_sleep: true,
            watch: Watch::default(),
            held: Held::default(),
            told: Told::default(),
            held_before: None,
            fresh: Vec::new(),
            before: Vec::new(),
            stopped: Vec::new(),
            released: Vec::new(),
            slid: 0.0,
            begun: Vec::new(),
            turned: Vec::new(),
            contradicted: None,
            wedged: None,
        }
    }
}

impl PenaltyContacts {
    /// Goes on from saved contacts of the same scene.
    pub(super) fn take_over(&mut self, saved: Self) {
        let Self { settings, materials, .. } = std::mem::replace(self, saved);
        (self.settings, self.materials) = (settings, materials);
    }
}

fn side_of_atom(bodies: &Bodies, atom: u32) -> PairSide {
    PairSide { stiffness: bodies.atom_stiffness(atom as usize), material: bodies.atom_material(atom as usize) }
}

/// Both sides of a pair of atoms, as laws see them.
pub(super) fn sides_of_atoms(bodies: &Bodies, pair: AtomPair) -> (PairSide, PairSide) {
    (side_of_atom(bodies, pair.a), side_of_atom(bodies, pair.b))
}

/// Both sides of a probe near a surface, as laws see them.
pub(super) fn sides_at_surface(bodies: &Bodies, pair: SurfacePair) -> (PairSide, PairSide) {
    let wall = |wall: usize| PairSide { stiffness: f64::INFINITY, material: bodies.walls[wall].material };
    let surface = match pair.surface(bodies) {
        Surface::Wall(index) => wall(index),
        Surface::Hull(hull) => side_of_atom(bodies, bodies.hulls[hull].first_atom),
    };
    match pair.probe(bodies) {
        Probe::Atom(atom) => (surface, side_of_atom(bodies, atom as u32)),
        Probe::End(index, _) => (wall(index), surface),
    }
}

/// Gives every pair of a new list its slot, with its history if it had one.
fn carry_history<N: NormalForce>(contacts: &mut PenaltyContacts, bodies: &Bodies, pairs: &CandidatePairs) {
    contacts.version = pairs.version;
    contacts.released.clear();
    let same = std::mem::replace(&mut contacts.generation, bodies.generation) == bodies.generation;
    let PenaltyContacts { laws, materials, settings, atoms, surfaces, .. } = contacts;
    atoms.carry(&pairs.atoms_before, same, |index| {
        let (a, b) = sides_of_atoms(bodies, pairs.atoms[index]);
        laws.index::<N>(a, b, materials, settings)
    });
    atoms.pairs.list(pairs.atoms.iter().map(|pair| (pair.a, pair.b)));
    // Between discs that turn about their centres no lever arm changes.
    let changes = |index: &u32| laws.get(*index).damping.depends_on_mobility();
    if N::DEPENDS_ON_VELOCITY && bodies.lone_discs && !atoms.is_empty() && changes(&atoms.get(0).law) {
        let mobility = |pair: &AtomPair| bodies.inverse_mass(pair.a as usize) + bodies.inverse_mass(pair.b as usize);
        let damping = |law: &u32, pair| N::response(laws.get(*law), mobility(pair)).1;
        atoms.damping = vec![[0.0; BLOCK]; atoms.law.len()];
        for ((damped, law), pairs) in atoms.damping.iter_mut().zip(&atoms.law).zip(pairs.atoms.chunks(BLOCK)) {
            for ((damped, law), pair) in damped.iter_mut().zip(law).zip(pairs) {
                *damped = damping(law, pair);
            }
        }
    }
    surfaces.carry(&pairs.surfaces_before, same, |index| {
        let (a, b) = sides_at_surface(bodies, pairs.surfaces[index]);
        laws.index::<N>(a, b, materials, settings)
    });
    if bodies.hulls.is_empty() {
        return;
    }
    surfaces.remembered.resize(pairs.surfaces.len());
    for (index, (&pair, &before)) in pairs.surfaces.iter().zip(&pairs.surfaces_before).enumerate() {
        if !same || before == NEW {
            surfaces.remembered.name(index, bodies, pair);
        }
    }
}

/// The approach of side B to side A. `None` is a wall.
#[inline]
pub(super) fn approach(bodies: &Bodies, a: Option<&ContactEnd>, b: &ContactEnd, normal: DVec2) -> Approach {
    let (velocity, mobility) = a.map_or((DVec2::ZERO, 0.0), |a| (a.velocity(bodies), a.mobility(bodies, normal)));
    Approach { parting: (b.velocity(bodies) - velocity).dot(normal), mobility: mobility + b.mobility(bodies, normal) }
}

/// The recipients of contact forces.
pub(super) struct Sink<'a> {
    pub bodies: &'a mut Bodies,
    pub rates: &'a mut Rates,
    pub forces: Option<&'a mut ContactForces>,
}

/// Accounts for a force on side B that the bodies have received. They serve the sensors of forces, and sides that do
/// not move by forces.
#[inline]
pub(super) fn account(
    bodies: &Bodies,
    (rates, forces): (&mut Rates, Option<&mut ContactForces>),
    (a, b): (&ContactEnd, &ContactEnd),
    (arm_a, arm_b): (DVec2, DVec2),
    force: DVec2,
) {
    if let Some(forces) = forces {
        forces.on_body[a.body] -= force;
        forces.on_body[b.body] += force;
    }
    // The force of a fixed body comes from outside. A body with prescribed motion also does work.
    let driven = |end: &ContactEnd, arm: DVec2, force: DVec2| {
        if bodies.moves[end.body] { force.dot(bodies.velocity_at(end.body, arm)) } else { 0.0 }
    };
    if !bodies.dynamic[a.body] {
        rates.outside(bodies.position[b.body] + arm_b, force, 0.0);
        rates.work += driven(a, arm_a, force);
    }
    if !bodies.dynamic[b.body] {
        rates.outside(bodies.position[a.body] + arm_a, -force, 0.0);
        rates.work += driven(b, arm_b, -force);
    }
}

impl Sink<'_> {
    /// `force` acts on side B, the opposite on side A, at the contact point.
    #[inline]
    pub fn between(
        &mut self,
        (a, b): (&ContactEnd, &ContactEnd),
        normal: DVec2,
        overlap: f64,
        shares: Shares,
        force: DVec2,
    ) {
        let (arm_a, arm_b) = arms((a, b), normal, overlap, shares);
        self.bodies.push(a.body, arm_a, -force);
        self.bodies.push(b.body, arm_b, force);
        let (arms, forces) = (arms((a, b), normal, overlap, shares), self.forces.as_deref_mut());
        account(self.bodies, (self.rates, forces), (a, b), arms, force);
    }

    /// `force` acts on an atom at its contact with the wall, `height` metres from its centre.
    #[inline]
    pub fn wall_pushes(&mut self, end: &ContactEnd, wall: u32, normal: DVec2, height: f64, force: DVec2) {
        let arm = end.arm - normal * height;
        self.bodies.push(end.body, arm, force);
        self.rates.outside(self.bodies.position[end.body] + arm, force, 0.0);
        if let Some(&belt) = self.bodies.belts.get(wall as usize) {
            self.rates.work += force.dot(belt);
        }
        if let Some(forces) = &mut self.forces {
            forces.on_body[end.body] += force;
            forces.on_wall[wall as usize] -= force;
        }
    }
}

/// The state that contacts act on.
pub(super) struct Shared<'a> {
    pub bodies: &'a mut Bodies,
    pub rates: &'a mut Rates,
    pub ledger: &'a mut Ledger,
    pub evaluation: &'a Evaluation,
    pub rows: &'a mut Rows,
}

/// The data of contacts beside it.
pub(super) struct Own<'a> {
    pub pairs: &'a CandidatePairs,
    pub contacts: &'a mut PenaltyContacts,
    pub rolling: Option<&'a mut RollingContacts>,
    pub forces: Option<&'a mut ContactForces>,
}

/// All contacts follow the state, or are evaluated as in a stage of a step.
pub(super) fn apply<N: NormalForce>(
    Shared { bodies, rates, ledger, evaluation, rows }: Shared,
    Own { pairs, contacts, mut rolling, mut forces }: Own,
    deepest: &mut DeepestOverlap,
    touches: Option<&mut Touches>,
) {
    contacts.records.take_back(bodies);
    if contacts.version != pairs.version {
        carry_history::<N>(contacts, bodies, pairs);
        if !contacts.begun.is_empty() {
            begun::take_over::<N>(contacts, rolling.as_deref_mut(), pairs, evaluation.mode);
        }
        let PenaltyContacts { records, atoms, .. } = &mut *contacts;
        records.prepare(bodies, &pairs.atoms, atoms);
        contacts.lay_asleep(bodies, pairs, forces.as_deref_mut());
        bodies.try_flights(contacts.atoms.touching_count());
    }
    if bodies.asleep.is_empty() {
        contacts.atoms.wake_all();
        contacts.surfaces.wake_all();
    }
    if let Some(forces) = &mut forces {
        forces.clear(bodies);
    }
    let mut losses = Losses::default();
    let mut sink = Sink { bodies, rates, forces };
    if evaluation.mode.is_staged() {
        if let Some(rolling) = &mut rolling {
            rolling.carry(pairs);
        }
        contact_stages::evaluate::<N>(contacts, rolling, pairs, evaluation.mode, (&mut sink, rows));
        if let Some(touches) = touches {
            note_touches(contacts, sink.bodies, pairs, touches);
        }
        return;
    }
    let (time, elapsed) = (evaluation.time, evaluation.elapsed);
    let PenaltyContacts { laws, atoms, surfaces, records, meetings, .. } = &mut *contacts;
    let path = if elapsed > 0.0 { sink.bodies.path } else { f64::NAN };
    if !pairs.atoms.is_empty() {
        let bound = sink.bodies.flights.take_bound();
        let some_fly = meetings.keep((sink.bodies, &bound), &pairs.atoms, atoms, &mut records.list);
        if !some_fly {
            records.update(sink.bodies, &pairs.atoms, atoms, path);
        }
        let evaluation_time = EvaluationTime { path, time, elapsed };
        losses = kernel::follow_pairs::<N>(
            &records.list,
            (&pairs.atoms, pairs.group_ends),
            atoms,
            laws,
            &mut sink,
            deepest,
            evaluation_time,
        );
        records.lendable = !some_fly;
    }
    follow_surfaces::<N>(
        (surfaces, &pairs.surfaces),
        laws,
        (&mut sink, &mut losses),
        deepest,
        EvaluationTime { path, time, elapsed },
    );
    ledger.friction.add(losses.friction);
    ledger.inelasticity.add(losses.inelasticity);
    contacts.follow_flights(sink.bodies, pairs, elapsed);
    if let Some(touches) = touches {
        note_touches(contacts, sink.bodies, pairs, touches);
    }
}

fn note_touches(contacts: &PenaltyContacts, bodies: &Bodies, pairs: &CandidatePairs, touches: &mut Touches) {
    let body = |atom: u32| bodies.atom_body(atom as usize);
    touches.clear();
    for index in contacts.atoms.touching() {
        let AtomPair { a, b } = pairs.atoms[index];
        touches.bodies(body(a), body(b));
    }
    for index in contacts.surfaces.touching() {
        let pair = pairs.surfaces[index];
        match (pair.bodies(bodies), pair.wall(bodies)) {
            ((Some(a), b), _) => touches.bodies(a, b),
            ((None, b), Some(wall)) => touches.wall(b, wall as u32),
            _ => {}
        }
    }
}

impl PenaltyContacts {
    /// Called after all contacts were followed at the end of a tick. Touching bodies are bound, and others may fly.
    fn follow_flights(&self, bodies: &mut Bodies, pairs: &CandidatePairs, elapsed: f64) {
        // Sleep must not change the motion, and so it must not change the time at which lists are made.
        if !self.rest.is_empty() {
            return bodies.put_off_flights();
        }
        if !bodies.may_fly() {
            return;
        }
        let of_atoms = self.atoms.touching().map(|index| pairs.atoms[index]).flat_map(|pair| [pair.a, pair.b]);
        let mut touching: Vec<u32> =
            of_atoms.chain(self.surfaces.touching().map(|index| pairs.surfaces[index].probe)).collect();
        touching.sort_unstable();
        touching.iter().for_each(|&body| bodies.bind(body as usize));
        if elapsed > 0.0 {
            bodies.take_off(&touching, elapsed);
        }
    }

    /// Contacts between atoms, with their places.
    pub(super) fn atom_points(
        &self,
        bodies: &Bodies,
        pairs: &CandidatePairs,
    ) -> impl Iterator<Item = (usize, ContactPoint)> {
        self.atoms.touching().map(|index| {
            let (pair, contact) = (pairs.atoms[index], self.atoms.get(index));
            let (law, ends) =
                (self.laws.get(contact.law), (&ContactEnd::of(bodies, pair.a), &ContactEnd::of(bodies, pair.b)));
            let normal = pair.normal(bodies);
            let (_, arm) = arms(ends, normal, contact.overlap, law.shares());
            let force = contact.force(law, normal);
            let point = bodies.position[ends.1.body] + arm;
            (index, ContactPoint { body: ends.1.body, other: Other::Body(ends.0.body), point, force, normal })
        })
    }

    /// Contacts with walls and hulls, with their places.
    pub(super) fn surface_points(
        &self,
        bodies: &Bodies,
        pairs: &CandidatePairs,
    ) -> impl Iterator<Item = (usize, ContactPoint)> {
        self.surfaces.touching().map(|index| {
            let (pair, contact) =
                (PairGeometry::surface(bodies, index, pairs.surfaces[index]).pair, self.surfaces.get(index));
            let law = self.laws.get(contact.law);
            let (_, arm) = pair.arms(law.shares(), contact.overlap);
            let (force, body) = (contact.force(law, pair.normal), pair.b.body);
            let other = match pair.a {
                SideA::Atom(a) | SideA::Hull(a) => Other::Body(a.body),
                SideA::Wall(wall) => Other::Wall(wall as usize),
            };
            (index, ContactPoint { body, other, point: bodies.position[body] + arm, force, normal: pair.normal })
        })
    }
}

impl PenaltyContacts {
    /// Elastic energy of all contacts in J.
    pub fn energy(&self) -> f64 {
        let of = |list: &ContactList, index: usize| {
            let contact = list.get(index);
            contact.energy(self.laws.get(contact.law))
        };
        let atoms = self.atoms.touching().map(|index| of(&self.atoms, index));
        let surfaces = self.surfaces.touching().map(|index| of(&self.surfaces, index));
        atoms.chain(surfaces).fold(0.0, |sum, energy| sum + energy)
    }
}
