//! Transfer of contacts between their two ways of evaluation. These are stages of steps ([`super::contact_stages`]), and
//! following from state to state ([`super::apply`]).
//!
//! Both have the same modes. A slipping spring has the same elongation in both. Friction that sticks without a spring
//! gets one with zero elongation, and releases its energy on the way back. A held contact stays held as long as it is
//! at rest up to rounding. A moving contact continues in the mode of its velocity, and stops at an event. The energy of
//! springs that a transfer takes is lost to friction.

use super::apply::PenaltyContacts;
use super::contact::Contact;
use super::coulomb::{Grip, Slider};
use super::normal::{Mode, NormalForce};
use super::pair_law::PairLaw;
use super::rolling::RollingContacts;
use super::switching::View;
use crate::contacts::geometry::PairGeometry;
use crate::tick::EvaluationMode;

/// Rows of held contacts that are solved together; they cost the third power of their number.
const MOST_ROWS: usize = 64;

/// The share of a contact force over a tick that counts as rounding: the remainder of the search for rest.
const ROUNDING: f64 = 1e-9;

/// Whether more contacts are held than rows can be solved for.
pub(super) fn overloaded(contacts: &PenaltyContacts, rolling: Option<&RollingContacts>) -> bool {
    let rows =
        |contact: Contact| usize::from(contact.mode == Mode::Hold) + usize::from(contact.tangential.grip == Grip::Hold);
    let atoms = contacts.atoms.touching().map(|index| contacts.atoms.get(index));
    let surfaces = contacts.surfaces.touching().map(|index| contacts.surfaces.get(index));
    let rolling = rolling.into_iter().flat_map(|rolling| rolling.atoms.iter().chain(&rolling.surfaces));
    let rolling = rolling.filter(|slider| slider.grip == Grip::Hold).count();
    atoms.chain(surfaces).map(rows).sum::<usize>() + rolling > MOST_ROWS
}

/// The way in which contacts are evaluated changes.
pub(super) fn hand_over<N: NormalForce>(view: &mut View, mode: EvaluationMode, dt: f64) {
    view.contacts.rest.clear();
    if mode == EvaluationMode::Following {
        view.contacts.held.clear();
        return;
    }
    view.contacts.held_before = Some(view.stored(|_| true));
    for index in view.touching() {
        let (geometry, bodies) = (view.look(index), view.bodies);
        let (mut contact, law, roller) = view.whole(index, &geometry);
        let rounding = ROUNDING * contact.normal_force * dt * geometry.approach(bodies).mobility;
        contact.take_over::<N>(law, &geometry, rounding);
        if let Some((slider, _)) = roller {
            let stands = geometry.turning().abs() * geometry.pair.b.radius <= rounding;
            slider.take_over(contact.mode, stands, geometry.turning());
        }
    }
}

impl Contact {
    /// Converts the contact to a stage of a step. Velocities up to `rounding` m/s count as zero.
    fn take_over<N: NormalForce>(&mut self, law: &PairLaw, geometry: &PairGeometry, rounding: f64) {
        let (parting, sliding) = (geometry.parting(), geometry.sliding(law.shares()));
        if self.mode == Mode::Hold && parting.abs() > rounding {
            self.mode = N::chosen(self.mode, parting);
        }
        let stands = sliding.abs() <= rounding;
        if law.exact {
            // It had a spring for want of anything better.
            let grip = if stands { Grip::Hold } else { Grip::Slide };
            self.tangential = Slider { elongation: 0.0, held: 0.0_f64.copysign(sliding), grip };
        } else {
            self.tangential.take_over(self.mode, stands, sliding);
        }
    }
}

impl Slider {
    /// Converts it to a stage of a step. Its sides move with `velocity`. `stands`: that is rounding.
    fn take_over(&mut self, mode: Mode, stands: bool, velocity: f64) {
        match self.grip {
            Grip::Slip => self.held = 0.0_f64.copysign(self.elongation),
            Grip::Hold if !stands => self.give(velocity > 0.0, true),
            _ => {}
        }
        self.adapt(mode, velocity);
    }
}
