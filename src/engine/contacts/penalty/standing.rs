//! Contacts in stages of a step that have come to stand without an event. Both sides stop together, as under a press at the end of its
//! path. Their modes end at roots of velocities, and a velocity that stays zero has none. They are held before the next step.
//!
//! A contact that was just released stands too, under the force at the end of its band. Held again, it would end at the same moment.

use super::apply::PenaltyContacts;
use super::contact::Contact;
use super::normal::{Mode, NormalForce};
use crate::contacts::CandidatePairs;
use crate::contacts::geometry::PairGeometry;
use crate::world::Bodies;

/// A share of velocities that counts as rounding.
const ROUNDING: f64 = 1e-12;

/// Sides stand that accelerate by at most this share of the acceleration by the spring alone. Forces that balance round so.
const STANDS: f64 = 1e-9;

/// Holds the contacts whose sides neither move nor accelerate along the normal. Returns whether there were any.
pub(super) fn hold<N: NormalForce>(contacts: &mut PenaltyContacts, bodies: &Bodies, pairs: &CandidatePairs) -> bool {
    if !N::SET_VALUED {
        return false;
    }
    let PenaltyContacts { laws, atoms, surfaces, released, .. } = contacts;
    let released = std::mem::take(released);
    let moves = |contact: &Contact| matches!(contact.mode, Mode::Loading | Mode::Unloading);
    let stands = |contact: &Contact, geometry: &PairGeometry| {
        let law = laws.get(contact.law);
        let shares = law.shares();
        let pushed = geometry.approach(bodies).mobility * law.stiffness * geometry.overlap;
        N::dissipates(law)
            && geometry.parting().abs() <= ROUNDING * geometry.speed(shares)
            && geometry.parting_rate(shares, bodies).abs() <= STANDS * pushed
    };
    let mut some = false;
    for (index, &pair) in pairs.atoms.iter().enumerate().take(atoms.len()) {
        let contact = atoms.get(index);
        let begins = moves(&contact) && !released.contains(&(index as u32));
        if begins && stands(&contact, &PairGeometry::atoms(bodies, index, pair)) {
            atoms.edit(index).mode = Mode::Hold;
            some = true;
        }
    }
    for (index, &pair) in pairs.surfaces.iter().enumerate().take(surfaces.len()) {
        let contact = surfaces.get(index);
        let begins = moves(&contact) && !released.contains(&((atoms.len() + index) as u32));
        if begins && stands(&contact, &PairGeometry::surface(bodies, index, pair)) {
            surfaces.edit(index).mode = Mode::Hold;
            some = true;
        }
    }
    some
}
