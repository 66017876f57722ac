//! Penalty contacts applied: every candidate pair is followed, forces go to the bodies, losses to the ledger.

use bevy_ecs::prelude::*;
use glam::DVec2;

use super::Penalty;
use super::contact::{Contact, Losses, Touch};
use super::critical::Watch;
use super::law::{LawTable, PairLaw, Side};
use super::normal::{Approach, Mode, NormalForce};
use super::rest::Rest;
use super::rolling::RollingContacts;
use super::rows::Rows;
use super::staged;
use super::switching::Told;
use crate::contacts::events::Touches;
use crate::contacts::points::{ContactPoint, Other};
use crate::contacts::search::NEW;
use crate::contacts::{AtomPair, CandidatePairs, ContactForces, DeepestOverlap, WallPair};
use crate::tick::{Balance, Evaluation, Ledger};
use crate::world::{Bodies, Materials, PackedWall};

/// History of all candidate pairs, beside the lists of [`CandidatePairs`].
#[derive(Resource, Debug, Default)]
pub struct PenaltyContacts {
    version: u64,
    pub(super) settings: Penalty,
    pub(super) materials: Materials,
    pub(super) laws: LawTable,
    /// One for each pair of atoms.
    pub atoms: Vec<Contact>,
    /// One for each atom near a wall.
    pub walls: Vec<Contact>,
    pub(super) touching_atoms: Vec<Touching>,
    pub(super) touching_walls: Vec<Touching>,
    pub(super) rest: Rest,
    pub(super) watch: Watch,
    pub(super) rows: Rows,
    pub(super) told: Told,
    /// Energy in J of the tangential springs before modes were switched.
    pub(super) held_before: Option<f64>,
    /// Energy in J of the tangential springs that slip, at the beginning of the step.
    pub(super) slid: f64,
}

/// A pair that touches in the present state.
#[derive(Clone, Copy, Debug)]
pub(super) struct Touching {
    /// Place in the list of candidate pairs.
    pub place: u32,
    /// Unit normal from A to B.
    pub normal: DVec2,
}

/// Gives every pair of a new list its slot, with its history if it had one.
fn carry_history<N: NormalForce>(contacts: &mut PenaltyContacts, bodies: &Bodies, pairs: &CandidatePairs) {
    contacts.version = pairs.version;
    let side = |atom: u32| Side {
        stiffness: bodies.atom_stiffness[atom as usize],
        material: bodies.atom_material[atom as usize],
    };
    let radius = |atom: u32| bodies.atom_radius[atom as usize];
    let PenaltyContacts { laws, materials, settings, atoms, walls, .. } = contacts;
    *atoms = carried(&pairs.atoms, &pairs.atoms_before, atoms, laws, |pair, laws| {
        let law = laws.place::<N>(side(pair.a), side(pair.b), materials, settings);
        Contact { reach: radius(pair.a) + radius(pair.b), law, ..Default::default() }
    });
    *walls = carried(&pairs.walls, &pairs.walls_before, walls, laws, |pair, laws| {
        let wall = Side { stiffness: f64::INFINITY, material: bodies.walls[pair.wall as usize].material };
        let law = laws.place::<N>(wall, side(pair.atom), materials, settings);
        Contact { reach: radius(pair.atom), law, ..Default::default() }
    });
}

fn carried<P>(
    pairs: &[P],
    before: &[u32],
    old: &[Contact],
    laws: &mut LawTable,
    fresh: impl Fn(&P, &mut LawTable) -> Contact,
) -> Vec<Contact> {
    let slot = |(pair, &place): (&P, &u32)| {
        let fresh = fresh(pair, laws);
        if place == NEW { fresh } else { Contact { reach: fresh.reach, law: fresh.law, ..old[place as usize] } }
    };
    pairs.iter().zip(before).map(slot).collect()
}

/// One side of a contact.
#[derive(Clone, Copy)]
pub(super) struct End {
    pub body: usize,
    /// Centre of the atom from the centre of mass of its body, in metres.
    pub arm: DVec2,
    /// Radius of the atom in metres.
    pub radius: f64,
}

impl End {
    #[inline]
    pub fn of(bodies: &Bodies, atom: u32) -> Self {
        let atom = atom as usize;
        let body = bodies.atom_body[atom] as usize;
        Self { body, arm: bodies.atom_position[atom] - bodies.position[body], radius: bodies.atom_radius[atom] }
    }

    /// Relative velocity along `normal` that an impulse of one newton second makes on this side, in 1/kg.
    #[inline]
    pub fn mobility(&self, bodies: &Bodies, normal: DVec2) -> f64 {
        let lever = self.arm.perp_dot(normal);
        bodies.inverse_mass[self.body] + lever * lever * bodies.inverse_inertia[self.body]
    }

    /// Displacement of the atom's centre since the last accepted state (the chord of its arc, to second order), and
    /// the turn of its body.
    #[inline]
    fn displacement(&self, bodies: &Bodies) -> (DVec2, f64) {
        let turn = bodies.turn[self.body];
        (bodies.drift[self.body] + self.arm.perp() * turn + self.arm * (0.5 * turn * turn), turn)
    }

    #[inline]
    pub fn velocity(&self, bodies: &Bodies) -> DVec2 {
        bodies.velocity_at(self.body, self.arm)
    }
}

/// How side B approaches side A; `None` is a wall.
#[inline]
pub(super) fn approach(bodies: &Bodies, a: Option<&End>, b: &End, normal: DVec2) -> Approach {
    let (velocity, mobility) = a.map_or((DVec2::ZERO, 0.0), |a| (a.velocity(bodies), a.mobility(bodies, normal)));
    Approach { parting: (b.velocity(bodies) - velocity).dot(normal), mobility: mobility + b.mobility(bodies, normal) }
}

#[inline]
fn approach_if_needed<N: NormalForce>(bodies: &Bodies, a: Option<&End>, b: &End, normal: DVec2) -> Approach {
    if N::DEPENDS_ON_VELOCITY { approach(bodies, a, b, normal) } else { Approach::default() }
}

/// Where the forces of contacts go.
pub(super) struct Sink<'a> {
    pub bodies: &'a mut Bodies,
    pub balance: &'a mut Balance,
    pub forces: Option<&'a mut ContactForces>,
}

/// Arms of both sides to the point where they touch: between the centres, nearer to the undeformed surface of the harder
/// side.
#[inline]
pub(super) fn arms((a, b): (&End, &End), normal: DVec2, overlap: f64, law: &PairLaw) -> (DVec2, DVec2) {
    (a.arm + normal * (a.radius - law.share_a * overlap), b.arm - normal * (b.radius - law.share_b * overlap))
}

impl Sink<'_> {
    /// `force` acts on the body of `end`, `arm` metres from its centre of mass.
    #[inline]
    fn on_body(&mut self, end: &End, arm: DVec2, force: DVec2) {
        self.bodies.push(end.body, arm, force);
        if let Some(forces) = &mut self.forces {
            forces.on_body[end.body] += force;
        }
    }

    /// `force` acts on side B, the opposite on side A, at the point where they touch.
    #[inline]
    pub fn between(&mut self, (a, b): (&End, &End), normal: DVec2, overlap: f64, law: &PairLaw, force: DVec2) {
        let (arm_a, arm_b) = arms((a, b), normal, overlap, law);
        self.on_body(a, arm_a, -force);
        self.on_body(b, arm_b, force);
        // What a fixed body gives comes from outside.
        if !self.bodies.dynamic[a.body] {
            self.balance.outside(self.bodies.position[b.body] + arm_b, force, 0.0);
            self.driven(a, arm_a, force);
        }
        if !self.bodies.dynamic[b.body] {
            self.balance.outside(self.bodies.position[a.body] + arm_a, -force, 0.0);
            self.driven(b, arm_b, -force);
        }
    }

    /// Books the work of a body that moves as prescribed and gives `force`.
    #[inline]
    fn driven(&mut self, end: &End, arm: DVec2, force: DVec2) {
        if self.bodies.moves[end.body] {
            self.balance.work += force.dot(self.bodies.velocity_at(end.body, arm));
        }
    }

    /// `force` acts on an atom where it touches the wall, `height` metres from its centre.
    #[inline]
    pub fn wall_pushes(&mut self, end: &End, wall: u32, normal: DVec2, height: f64, force: DVec2) {
        let arm = end.arm - normal * height;
        self.on_body(end, arm, force);
        self.balance.outside(self.bodies.position[end.body] + arm, force, 0.0);
        if let Some(&belt) = self.bodies.belts.get(wall as usize) {
            self.balance.work += force.dot(belt);
        }
        if let Some(forces) = &mut self.forces {
            forces.on_wall[wall as usize] -= force;
        }
    }
}

#[inline]
fn touch_atoms<N: NormalForce>(
    bodies: &Bodies,
    (a, b): (&End, &End),
    normal: DVec2,
    distance: f64,
    reach: f64,
) -> Touch {
    let ((moved_a, turn_a), (moved_b, turn_b)) = (a.displacement(bodies), b.displacement(bodies));
    let displacement = moved_b - moved_a;
    let swing = if distance > 0.0 { displacement.dot(normal.perp()) / distance } else { 0.0 };
    let (rolled_a, rolled_b) = ((a.radius, turn_a), (b.radius, turn_b));
    let approach = approach_if_needed::<N>(bodies, Some(a), b, normal);
    Touch { normal, overlap: reach - distance, approach, displacement, swing, rolled_a, rolled_b }
}

#[inline]
fn touch_wall<N: NormalForce>(bodies: &Bodies, end: &End, normal: DVec2, height: f64) -> Touch {
    let (displacement, turn) = end.displacement(bodies);
    let rolled_b = (end.radius, turn);
    let approach = approach_if_needed::<N>(bodies, None, end, normal);
    let overlap = end.radius - height;
    Touch { normal, overlap, approach, displacement, swing: 0.0, rolled_a: (0.0, 0.0), rolled_b }
}

#[inline]
fn height_over(wall: &PackedWall, position: DVec2) -> f64 {
    (position - wall.point).dot(wall.normal)
}

/// The system of [`crate::tick::EvaluateStage::Contacts`].
#[expect(clippy::too_many_arguments, reason = "a system's parameters are its declaration of access")]
pub(super) fn apply_penalty<N: NormalForce>(
    mut bodies: ResMut<Bodies>,
    pairs: Res<CandidatePairs>,
    mut contacts: ResMut<PenaltyContacts>,
    mut balance: ResMut<Balance>,
    mut ledger: ResMut<Ledger>,
    mut deepest: ResMut<DeepestOverlap>,
    evaluation: Res<Evaluation>,
    mut forces: Option<ResMut<ContactForces>>,
    (touches, mut rolling): (Option<ResMut<Touches>>, Option<ResMut<RollingContacts>>),
) {
    if contacts.version != pairs.version {
        carry_history::<N>(&mut contacts, &bodies, &pairs);
    }
    if let Some(forces) = &mut forces {
        forces.clear(&bodies);
    }
    let mut losses = Losses::default();
    let mut sink = Sink { bodies: &mut bodies, balance: &mut balance, forces: forces.as_deref_mut() };
    if evaluation.style.is_staged() {
        if let Some(rolling) = &mut rolling {
            rolling.carry(&pairs);
        }
        staged::evaluate::<N>(&mut contacts, rolling.as_deref_mut(), &pairs, evaluation.style, &mut sink);
        if let Some(mut touches) = touches {
            note_touches(&contacts, &bodies, &pairs, &mut touches);
        }
        return;
    }
    let PenaltyContacts { laws, atoms, walls, touching_atoms, touching_walls, .. } = &mut *contacts;
    touching_atoms.clear();
    for (place, (&AtomPair { a, b }, contact)) in pairs.atoms.iter().zip(atoms).enumerate() {
        let between = sink.bodies.atom_position[b as usize] - sink.bodies.atom_position[a as usize];
        let squared = between.length_squared();
        if squared >= contact.reach * contact.reach && contact.mode == Mode::Open {
            continue;
        }
        let distance = squared.sqrt();
        // Centres in one place have no direction: up is as good as any.
        let normal = if distance > 0.0 { between / distance } else { DVec2::Y };
        let law = laws.get(contact.law);
        let ends = (&End::of(sink.bodies, a), &End::of(sink.bodies, b));
        let touch = touch_atoms::<N>(sink.bodies, ends, normal, distance, contact.reach);
        contact.follow::<N>(law, &touch, evaluation.elapsed, &mut losses);
        if contact.mode == Mode::Open {
            continue;
        }
        touching_atoms.push(Touching { place: place as u32, normal });
        deepest.note(contact.overlap, ends.0.radius.min(ends.1.radius), evaluation.time, || {
            (sink.bodies.entity[ends.0.body], sink.bodies.entity[ends.1.body])
        });
        sink.between(ends, normal, contact.overlap, law, contact.force(law, normal));
    }
    touching_walls.clear();
    for (place, (&WallPair { wall, atom }, contact)) in pairs.walls.iter().zip(walls).enumerate() {
        let packed = sink.bodies.walls[wall as usize];
        let height = height_over(&packed, sink.bodies.atom_position[atom as usize]);
        if height >= contact.reach && contact.mode == Mode::Open {
            continue;
        }
        let law = laws.get(contact.law);
        let end = End::of(sink.bodies, atom);
        let mut touch = touch_wall::<N>(sink.bodies, &end, packed.normal, height);
        if let Some(&belt) = sink.bodies.belts.get(wall as usize) {
            touch.displacement -= belt * evaluation.elapsed;
        }
        contact.follow::<N>(law, &touch, evaluation.elapsed, &mut losses);
        if contact.mode == Mode::Open {
            continue;
        }
        touching_walls.push(Touching { place: place as u32, normal: packed.normal });
        deepest.note(contact.overlap, end.radius, evaluation.time, || (sink.bodies.entity[end.body], packed.entity));
        sink.wall_pushes(&end, wall, packed.normal, height, contact.force(law, packed.normal));
    }
    ledger.friction.add(losses.friction);
    ledger.inelasticity.add(losses.inelasticity);
    if let Some(mut touches) = touches {
        note_touches(&contacts, &bodies, &pairs, &mut touches);
    }
}

fn note_touches(contacts: &PenaltyContacts, bodies: &Bodies, pairs: &CandidatePairs, touches: &mut Touches) {
    let body = |atom: u32| bodies.atom_body[atom as usize] as usize;
    touches.clear();
    for touching in &contacts.touching_atoms {
        let AtomPair { a, b } = pairs.atoms[touching.place as usize];
        touches.bodies(body(a), body(b));
    }
    for touching in &contacts.touching_walls {
        let WallPair { wall, atom } = pairs.walls[touching.place as usize];
        touches.wall(body(atom), wall);
    }
}

/// All contacts of the present state, in canonical order.
pub(super) fn contact_points(world: &World) -> Vec<ContactPoint> {
    let (bodies, pairs) = (world.resource::<Bodies>(), world.resource::<CandidatePairs>());
    let contacts = world.resource::<PenaltyContacts>();
    let at = |end: &End, arm: DVec2| bodies.position[end.body] + arm;
    let between = |touching: &Touching| {
        let (pair, contact) = (pairs.atoms[touching.place as usize], &contacts.atoms[touching.place as usize]);
        let (law, ends) = (contacts.laws.get(contact.law), (&End::of(bodies, pair.a), &End::of(bodies, pair.b)));
        let (_, arm) = arms(ends, touching.normal, contact.overlap, law);
        let force = contact.force(law, touching.normal);
        ContactPoint { body: ends.1.body, other: Other::Body(ends.0.body), point: at(ends.1, arm), force }
    };
    let on_wall = |touching: &Touching| {
        let (pair, contact) = (pairs.walls[touching.place as usize], &contacts.walls[touching.place as usize]);
        let (law, end) = (contacts.laws.get(contact.law), End::of(bodies, pair.atom));
        let arm = end.arm - touching.normal * (end.radius - contact.overlap);
        let force = contact.force(law, touching.normal);
        ContactPoint { body: end.body, other: Other::Wall(pair.wall as usize), point: at(&end, arm), force }
    };
    let bodies_touch = contacts.touching_atoms.iter().map(between);
    bodies_touch.chain(contacts.touching_walls.iter().map(on_wall)).collect()
}

impl PenaltyContacts {
    /// Elastic energy of all contacts in J.
    pub fn energy(&self) -> f64 {
        let all = self.atoms.iter().chain(&self.walls).filter(|contact| contact.mode != Mode::Open);
        all.map(|contact| contact.energy(self.laws.get(contact.law))).fold(0.0, |sum, energy| sum + energy)
    }
}
