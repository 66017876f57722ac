//! Contacts in stages of a step that have come to stand without an event. Both sides stop together, as under a press at the end of its
//! path. Their modes end at roots of velocities, and a velocity that stays zero has none. They are held before the next step.
//!
//! A contact that was just released stands too, under the force at the end of its band. Held again, it would end at the same moment.

use super::apply::PenaltyContacts;
use super::contact::Contact;
use super::coulomb::{Grip, ROUNDING};
use super::indicators::SliderMotion;
use super::normal::{Mode, NormalForce};
use super::pair_law::PairLaw;
use super::switching::View;
use crate::contacts::CandidatePairs;
use crate::contacts::geometry::PairGeometry;
use crate::world::Bodies;

/// Sides stand that accelerate by at most this share of the acceleration by the spring alone. Forces that balance round so.
const STANDS: f64 = 1e-9;

/// Whether a contact presses or relaxes with a law that may hold it.
fn moves<N: NormalForce>(contact: &Contact, law: &PairLaw) -> bool {
    N::dissipates(law) && matches!(contact.mode, Mode::Loading | Mode::Unloading)
}

/// Whether a contact that presses or relaxes has sides that stand along the normal.
pub(super) fn is_still<N: NormalForce>(contact: &Contact, law: &PairLaw, geometry: &PairGeometry) -> bool {
    moves::<N>(contact, law) && geometry.parting().abs() <= ROUNDING * geometry.speed(law.shares())
}

impl View<'_> {
    /// A velocity in m/s that is rounding at a contact. Its scale is the speed of the sides, and the speed that its spring would give.
    pub(super) fn rounding_of_velocity(&mut self, index: usize) -> f64 {
        let (geometry, bodies) = (self.look(index), self.bodies);
        let law = self.contact(index).1;
        let swing = geometry.overlap * (law.stiffness * geometry.approach(bodies).mobility).sqrt();
        ROUNDING * (geometry.speed(law.shares()) + swing)
    }
}

/// Contacts stop with those of `named`, which an event has stopped, if they have no velocity left. That may be along the normal or
/// along the surface. A body that tilts between two others stops on all of them at once. One that pivots stops in all directions.
/// Rounding decides which of them the event names. So does the error of the step: among normals that turn, it tells no velocity below
/// `error` m/s from zero. Friction that stops too early loses its spring, so it waits for its own event. The stop reaches contacts
/// of the same bodies, and of those held by them.
pub(super) fn stop_together<N: NormalForce>(view: &mut View, named: &[u32], error: f64) {
    let mut reached: Vec<usize> = named.iter().flat_map(|&index| view.movable(index as usize)).collect();
    let mut first = 0;
    while let Some(&body) = reached.get(first) {
        first += 1;
        for index in view.touching() {
            if !view.movable(index).any(|other| other == body) {
                continue;
            }
            let (geometry, rounding) = (view.look(index), view.rounding_of_velocity(index));
            let (mut contact, law) = view.contact(index);
            let shares = law.shares();
            let mut joined = false;
            if N::SET_VALUED && moves::<N>(&contact, law) && geometry.parting().abs() <= rounding.max(error) {
                contact.mode = Mode::Hold;
                contact.adapt_friction(law, &geometry);
                joined = true;
            }
            let grips = contact.tangential.grip == Grip::Slide && geometry.sliding(shares).abs() <= rounding;
            if grips {
                contact.tangential.grip = Grip::Hold;
            }
            let (holds, slider) = (contact.mode == Mode::Hold, contact.tangential);
            drop(contact);
            if joined {
                view.contacts.turned.push(index as u32);
            }
            if grips {
                view.note_stopped(index, slider);
            }
            if holds {
                reached.extend(view.movable(index).filter(|other| !reached.contains(other)).collect::<Vec<_>>());
            }
        }
    }
}

/// Holds the friction of a contact whose normal is held, if its sides neither move nor accelerate along the surface. Other
/// contacts hold them. A spring would keep its force while theirs change, and they would slip below the sum of all cones.
/// Says whether it is held now.
fn hold_friction(contact: &mut Contact, law: &PairLaw, geometry: &PairGeometry, bodies: &Bodies) -> bool {
    let sticks = contact.mode == Mode::Hold && contact.tangential.grip == Grip::Stick;
    if !sticks || law.exact {
        return false;
    }
    let motion = SliderMotion::along(geometry, law.shares(), bodies);
    let pushed = motion.mobility * law.stiffness * geometry.overlap;
    if motion.rate.abs() <= STANDS * pushed {
        contact.tangential.hold_still(&law.tangential(), &motion);
    }
    contact.tangential.grip == Grip::Hold
}

/// Holds the contacts whose sides neither move nor accelerate along the normal. Returns whether there were any.
pub(super) fn hold<N: NormalForce>(contacts: &mut PenaltyContacts, bodies: &Bodies, pairs: &CandidatePairs) -> bool {
    if !N::SET_VALUED {
        return false;
    }
    let PenaltyContacts { laws, atoms, surfaces, released, .. } = contacts;
    let count = atoms.len();
    let touches = |index: usize| match index.checked_sub(count) {
        Some(surface) => surface < surfaces.len() && surfaces.is_touching(surface),
        None => atoms.is_touching(index),
    };
    released.retain(|&released| touches(released as usize));
    let mut held = |index: usize, mut contact: Contact, geometry: &PairGeometry| {
        let law = laws.get(contact.law);
        let still = is_still::<N>(&contact, law, geometry);
        let waits = released.contains(&(index as u32));
        if waits && !still {
            released.retain(|&released| released as usize != index);
        }
        let pushed = geometry.approach(bodies).mobility * law.stiffness * geometry.overlap;
        let stands = still && !waits && geometry.parting_rate(law.shares(), bodies).abs() <= STANDS * pushed;
        if stands {
            contact.mode = Mode::Hold;
            contact.adapt_friction(law, geometry);
        }
        let grips = hold_friction(&mut contact, law, geometry, bodies);
        (stands || grips).then_some(contact)
    };
    let mut some = false;
    for index in atoms.touching().collect::<Vec<_>>() {
        let geometry = PairGeometry::atoms(bodies, index, pairs.atoms[index]);
        if let Some(contact) = held(index, atoms.get(index), &geometry) {
            atoms.set(index, &contact);
            some = true;
        }
    }
    for index in surfaces.touching().collect::<Vec<_>>() {
        let geometry = PairGeometry::surface(bodies, index, pairs.surfaces[index]);
        if let Some(contact) = held(count + index, surfaces.get(index), &geometry) {
            surfaces.set(index, &contact);
            some = true;
        }
    }
    some
}
