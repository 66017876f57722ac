//! Penalty contacts applied: every candidate pair is followed, forces go to the bodies, losses to the ledger.

use bevy_ecs::prelude::*;
use glam::DVec2;

use super::contact::{Contact, Losses, Touch};
use super::law::{LawTable, Side};
use super::{Penalty, inelasticity::Mode};
use crate::contacts::search::NEW;
use crate::contacts::{AtomPair, CandidatePairs, ContactForces, DeepestOverlap, WallPair};
use crate::tick::{Balance, Evaluation, Ledger};
use crate::world::{Bodies, Materials};

/// History of all candidate pairs, beside the lists of [`CandidatePairs`].
#[derive(Resource, Debug, Default)]
pub struct PenaltyContacts {
    version: u64,
    laws: LawTable,
    /// One for each pair of atoms.
    pub atoms: Vec<Contact>,
    /// One for each atom near a wall.
    pub walls: Vec<Contact>,
    /// Places of the pairs of atoms that touch.
    touching_atoms: Vec<u32>,
    /// Places of the atoms near walls that touch.
    touching_walls: Vec<u32>,
}

/// Gives every pair of a new list its slot, with its history if it had one.
pub(super) fn carry_history(
    bodies: Res<Bodies>,
    pairs: Res<CandidatePairs>,
    materials: Res<Materials>,
    settings: Res<Penalty>,
    mut contacts: ResMut<PenaltyContacts>,
) {
    if contacts.version == pairs.version {
        return;
    }
    let contacts = &mut *contacts;
    contacts.version = pairs.version;
    let side = |atom: u32| Side {
        stiffness: bodies.atom_stiffness[atom as usize],
        material: bodies.atom_material[atom as usize],
    };
    let radius = |atom: u32| bodies.atom_radius[atom as usize];
    let laws = &mut contacts.laws;
    contacts.atoms = carried(&pairs.atoms, &pairs.atoms_before, &contacts.atoms, laws, |pair, laws| {
        let law = laws.place(side(pair.a), side(pair.b), &materials, &settings);
        Contact { reach: radius(pair.a) + radius(pair.b), law, ..Default::default() }
    });
    contacts.walls = carried(&pairs.walls, &pairs.walls_before, &contacts.walls, laws, |pair, laws| {
        let wall = Side { stiffness: f64::INFINITY, material: bodies.walls[pair.wall as usize].material };
        let law = laws.place(wall, side(pair.atom), &materials, &settings);
        Contact { reach: radius(pair.atom), law, ..Default::default() }
    });
    contacts.touching_atoms = touching(&contacts.atoms);
    contacts.touching_walls = touching(&contacts.walls);
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

fn touching(contacts: &[Contact]) -> Vec<u32> {
    (0..contacts.len() as u32).filter(|&place| contacts[place as usize].mode != Mode::Open).collect()
}

/// Where the forces of contacts go.
struct Sink<'a> {
    bodies: &'a mut Bodies,
    balance: &'a mut Balance,
    forces: Option<&'a mut ContactForces>,
}

impl Sink<'_> {
    fn on_atom(&mut self, atom: usize, point: DVec2, force: DVec2) -> bool {
        let body = self.bodies.atom_body[atom] as usize;
        let arm = point - self.bodies.position[body];
        self.bodies.push(body, arm, force);
        if let Some(forces) = &mut self.forces {
            forces.on_body[body] += force;
        }
        self.bodies.dynamic[body]
    }

    /// `force` acts on atom `b` at `point`, the opposite on atom `a`.
    fn between_atoms(&mut self, pair: AtomPair, point: DVec2, force: DVec2) {
        let dynamic_a = self.on_atom(pair.a as usize, point, -force);
        let dynamic_b = self.on_atom(pair.b as usize, point, force);
        if !dynamic_a {
            self.balance.outside(point, force, 0.0);
        }
        if !dynamic_b {
            self.balance.outside(point, -force, 0.0);
        }
    }

    fn on_wall(&mut self, pair: WallPair, point: DVec2, force: DVec2) {
        self.on_atom(pair.atom as usize, point, force);
        self.balance.outside(point, force, 0.0);
        if let Some(forces) = &mut self.forces {
            forces.on_wall[pair.wall as usize] -= force;
        }
    }
}

/// Unit normal from A to B and distance of the centres. Centres in one place have no direction: up is as good as any.
#[inline]
fn line_of_centres(bodies: &Bodies, pair: AtomPair) -> (DVec2, f64) {
    let between = bodies.atom_position[pair.b as usize] - bodies.atom_position[pair.a as usize];
    let distance = between.length();
    (if distance > 0.0 { between / distance } else { DVec2::Y }, distance)
}

/// Displacement of an atom's centre since the last accepted state, and the turn of its body.
#[inline]
fn displacement(bodies: &Bodies, atom: usize) -> (DVec2, f64) {
    let body = bodies.atom_body[atom] as usize;
    let (arm, turn) = (bodies.atom_position[atom] - bodies.position[body], bodies.turn[body]);
    // The chord of the arc, to second order.
    (bodies.drift[body] + arm.perp() * turn + arm * (0.5 * turn * turn), turn)
}

fn touch_atoms(bodies: &Bodies, pair: AtomPair, normal: DVec2, distance: f64, reach: f64) -> Touch {
    let (a, b) = (pair.a as usize, pair.b as usize);
    let ((moved_a, turn_a), (moved_b, turn_b)) = (displacement(bodies, a), displacement(bodies, b));
    let displacement = moved_b - moved_a;
    let swing = if distance > 0.0 { displacement.dot(normal.perp()) / distance } else { 0.0 };
    let (rolled_a, rolled_b) = ((bodies.atom_radius[a], turn_a), (bodies.atom_radius[b], turn_b));
    Touch { normal, overlap: reach - distance, displacement, swing, rolled_a, rolled_b }
}

fn touch_wall(bodies: &Bodies, pair: WallPair, normal: DVec2, height: f64, reach: f64) -> Touch {
    let atom = pair.atom as usize;
    let (displacement, turn) = displacement(bodies, atom);
    let rolled_b = (bodies.atom_radius[atom], turn);
    Touch { normal, overlap: reach - height, displacement, swing: 0.0, rolled_a: (0.0, 0.0), rolled_b }
}

/// The contact point lies between the centres, nearer to the softer side's undeformed surface.
#[inline]
fn point_between(bodies: &Bodies, pair: AtomPair, normal: DVec2, overlap: f64, share_a: f64) -> DVec2 {
    let a = pair.a as usize;
    bodies.atom_position[a] + normal * (bodies.atom_radius[a] - share_a * overlap)
}

#[inline]
fn wall_height(bodies: &Bodies, pair: WallPair) -> (DVec2, f64) {
    let wall = &bodies.walls[pair.wall as usize];
    (wall.normal, (bodies.atom_position[pair.atom as usize] - wall.point).dot(wall.normal))
}

/// The system of [`crate::tick::EvaluateStage::Contacts`].
#[allow(clippy::too_many_arguments)]
pub(super) fn apply_penalty(
    mut bodies: ResMut<Bodies>,
    pairs: Res<CandidatePairs>,
    mut contacts: ResMut<PenaltyContacts>,
    mut balance: ResMut<Balance>,
    mut ledger: ResMut<Ledger>,
    mut deepest: ResMut<DeepestOverlap>,
    evaluation: Res<Evaluation>,
    mut forces: Option<ResMut<ContactForces>>,
) {
    if let Some(forces) = &mut forces {
        forces.on_body.clear();
        forces.on_body.resize(bodies.len(), DVec2::ZERO);
        forces.on_wall.clear();
        forces.on_wall.resize(bodies.walls.len(), DVec2::ZERO);
    }
    let mut losses = Losses::default();
    let mut sink = Sink { bodies: &mut bodies, balance: &mut balance, forces: forces.as_deref_mut() };
    let PenaltyContacts { laws, atoms, walls, touching_atoms, touching_walls, .. } = &mut *contacts;
    touching_atoms.clear();
    for (place, (&pair, contact)) in pairs.atoms.iter().zip(atoms).enumerate() {
        let between = sink.bodies.atom_position[pair.b as usize] - sink.bodies.atom_position[pair.a as usize];
        if contact.mode == Mode::Open && between.length_squared() >= contact.reach * contact.reach {
            continue;
        }
        let (normal, distance) = line_of_centres(sink.bodies, pair);
        let law = laws.get(contact.law);
        let touch = touch_atoms(sink.bodies, pair, normal, distance, contact.reach);
        contact.follow(law, &touch, &mut losses);
        if contact.mode == Mode::Open {
            continue;
        }
        touching_atoms.push(place as u32);
        let smaller = touch.rolled_a.0.min(touch.rolled_b.0);
        deepest.note(contact.overlap, smaller, evaluation.time, || {
            let entity = |atom: u32| sink.bodies.entity[sink.bodies.atom_body[atom as usize] as usize];
            (entity(pair.a), entity(pair.b))
        });
        let point = point_between(sink.bodies, pair, normal, contact.overlap, law.share_a);
        sink.between_atoms(pair, point, contact.force(law, normal));
    }
    touching_walls.clear();
    for (place, (&pair, contact)) in pairs.walls.iter().zip(walls).enumerate() {
        let (normal, height) = wall_height(sink.bodies, pair);
        if contact.mode == Mode::Open && height >= contact.reach {
            continue;
        }
        let law = laws.get(contact.law);
        let touch = touch_wall(sink.bodies, pair, normal, height, contact.reach);
        contact.follow(law, &touch, &mut losses);
        if contact.mode == Mode::Open {
            continue;
        }
        touching_walls.push(place as u32);
        deepest.note(contact.overlap, contact.reach, evaluation.time, || {
            let body = sink.bodies.atom_body[pair.atom as usize] as usize;
            (sink.bodies.entity[body], sink.bodies.walls[pair.wall as usize].entity)
        });
        let point = sink.bodies.atom_position[pair.atom as usize] - normal * height;
        sink.on_wall(pair, point, contact.force(law, normal));
    }
    ledger.friction.add(losses.friction);
    ledger.inelasticity.add(losses.inelasticity);
}

/// The system of [`crate::tick::Modes`]: touching pairs choose loading or unloading for the coming step; where that
/// changes a force, the sums are corrected by the difference.
pub(super) fn choose_modes(
    mut bodies: ResMut<Bodies>,
    pairs: Res<CandidatePairs>,
    mut contacts: ResMut<PenaltyContacts>,
    mut balance: ResMut<Balance>,
    mut ledger: ResMut<Ledger>,
    mut forces: Option<ResMut<ContactForces>>,
) {
    let mut losses = Losses::default();
    let mut sink = Sink { bodies: &mut bodies, balance: &mut balance, forces: forces.as_deref_mut() };
    let PenaltyContacts { laws, atoms, walls, touching_atoms, touching_walls, .. } = &mut *contacts;
    for &place in &*touching_atoms {
        let (pair, contact) = (pairs.atoms[place as usize], &mut atoms[place as usize]);
        let law = laws.get(contact.law);
        let (normal, _) = line_of_centres(sink.bodies, pair);
        let parting = (velocity(sink.bodies, pair.b) - velocity(sink.bodies, pair.a)).dot(normal);
        if let Some(before) = contact.choose_mode(law, parting, &mut losses) {
            let point = point_between(sink.bodies, pair, normal, contact.overlap, law.share_a);
            sink.between_atoms(pair, point, contact.force(law, normal) - before.force(law, normal));
        }
    }
    for &place in &*touching_walls {
        let (pair, contact) = (pairs.walls[place as usize], &mut walls[place as usize]);
        let law = laws.get(contact.law);
        let (normal, height) = wall_height(sink.bodies, pair);
        let parting = velocity(sink.bodies, pair.atom).dot(normal);
        if let Some(before) = contact.choose_mode(law, parting, &mut losses) {
            let point = sink.bodies.atom_position[pair.atom as usize] - normal * height;
            sink.on_wall(pair, point, contact.force(law, normal) - before.force(law, normal));
        }
    }
    ledger.friction.add(losses.friction);
}

#[inline]
fn velocity(bodies: &Bodies, atom: u32) -> DVec2 {
    let body = bodies.atom_body[atom as usize] as usize;
    bodies.velocity_at(body, bodies.atom_position[atom as usize] - bodies.position[body])
}

impl PenaltyContacts {
    /// Elastic energy of all contacts in J.
    pub fn energy(&self) -> f64 {
        let all = self.atoms.iter().chain(&self.walls);
        all.filter(|contact| contact.mode != Mode::Open).map(|c| c.energy(self.laws.get(c.law))).sum()
    }
}
