//! Rolling springs in stages of a step: their angles are states, and they stick and slip at events. If the normal force
//! is held and no side rolls, they are held with it ([`super::held`]).

use super::apply::{PenaltyContacts, Sink};
use super::contact::Contact;
use super::coulomb::{Grip, Slider, SliderLaw};
use super::held::Held;
use super::indicators::{PhaseEnd, Pressure, SliderMotion, tell_slider};
use super::normal::Mode;
use super::pair_law::PairLaw;
use super::rolling::{RollingContacts, twist};
use super::switching::{Base, What};
use crate::constraints::{Rows, Share};
use crate::contacts::CandidatePairs;
use crate::contacts::geometry::{Listed, PairGeometry};
use crate::tick::Indicator;
use crate::world::Bodies;

/// A rolling spring with its law.
pub(super) type Roller<'a> = (&'a mut Slider, SliderLaw);

impl RollingContacts {
    /// The spring of a contact, if it has one.
    pub(super) fn of(&mut self, geometry: &PairGeometry, pair: &PairLaw) -> Option<Roller<'_>> {
        let other = geometry.pair.other_end();
        let law = self.law(pair, other, &geometry.pair.b)?;
        let list = if geometry.pair.listed() == Listed::Atoms { &mut self.atoms } else { &mut self.surfaces };
        Some((&mut list[geometry.pair.index as usize], law))
    }
}

fn is_state((contact, slider): &(Contact, &Slider)) -> bool {
    slider.is_state(contact.mode)
}

/// All rolling springs with their contacts.
fn springs<'a>(
    contacts: &'a PenaltyContacts,
    rolling: &'a RollingContacts,
) -> impl Iterator<Item = (Contact, &'a Slider)> {
    contacts.atoms.iter().chain(contacts.surfaces.iter()).zip(rolling.atoms.iter().chain(&rolling.surfaces))
}

/// The number of angles in the state.
pub(super) fn length(contacts: &PenaltyContacts, rolling: &RollingContacts) -> usize {
    springs(contacts, rolling).filter(is_state).count()
}

/// Springs -> state.
pub(super) fn read(contacts: &PenaltyContacts, rolling: &RollingContacts, state: &mut [f64]) {
    let own = springs(contacts, rolling).filter(is_state);
    state.iter_mut().zip(own).for_each(|(state, (_, slider))| *state = slider.elongation);
}

/// State -> springs.
pub(super) fn write(contacts: &PenaltyContacts, rolling: &mut RollingContacts, state: &[f64]) {
    let RollingContacts { atoms, surfaces, .. } = rolling;
    let contacts = contacts.atoms.iter().chain(contacts.surfaces.iter());
    let own = contacts.zip(atoms.iter_mut().chain(surfaces));
    let own = own.filter(|(contact, slider)| is_state(&(*contact, &**slider)));
    state.iter().zip(own).for_each(|(state, (_, slider))| slider.elongation = *state);
}

/// The rates of angles that are state.
pub(super) fn rates(
    (bodies, pairs): (&Bodies, &CandidatePairs),
    (contacts, rolling): (&PenaltyContacts, &RollingContacts),
    rates: &mut [f64],
) {
    let spin = |atom: u32| bodies.spin[bodies.atom_body(atom as usize)];
    let turning = pairs.atoms.iter().map(|pair| spin(pair.b) - spin(pair.a));
    let turning = turning.chain(pairs.surfaces.iter().map(|pair| {
        let (a, b) = pair.bodies(bodies);
        bodies.spin[b] - a.map_or(0.0, |a| bodies.spin[a])
    }));
    let own = springs(contacts, rolling).zip(turning).filter(|(spring, _)| is_state(spring));
    rates.iter_mut().zip(own).for_each(|(rate, (_, turning))| *rate = turning);
}

/// Signed torque per newton of normal force of a slipping spring under a held normal force.
pub(super) fn slope((slider, law): &Roller, contact: &Contact) -> f64 {
    let slips = contact.mode == Mode::Hold && slider.grip.gives();
    if slips { law.friction_dynamic.copysign(slider.held) } else { 0.0 }
}

/// Evaluates the spring of a contact that touches.
pub(super) fn stage(
    (slider, law): Roller,
    (contact, pair): (&Contact, &PairLaw),
    geometry: &PairGeometry,
    sink: &mut Sink,
    (held, rows): (&mut Held, &mut Rows),
) {
    match slider.grip {
        Grip::Hold => {
            held.add_rolling(rows, geometry, share(slider, &law, pair.stiffness * geometry.overlap), sink.bodies)
        }
        Grip::Slip | Grip::Slide if contact.mode == Mode::Hold => {}
        Grip::Slip | Grip::Slide => {
            slider.slide(&law, contact.normal_force);
            push(slider, slider.sliding_force(&law, contact.normal_force), geometry, sink);
        }
        Grip::Stick => push(slider, slider.force(&law), geometry, sink),
    }
}

/// Lets the spring act with a torque, and books what slipping takes.
pub(super) fn push(slider: &Slider, torque: f64, geometry: &PairGeometry, sink: &mut Sink) {
    twist(sink.bodies, sink.rates, geometry.pair.other_end(), &geometry.pair.b, torque);
    if slider.grip.gives() {
        sink.rates.friction += torque * geometry.turning();
    }
}

/// The end of the current mode of the spring, and its indicators.
pub(super) fn tell(
    (slider, law): &Roller,
    contact: &Contact,
    pressure: Pressure,
    geometry: &PairGeometry,
    bodies: &Bodies,
    mut say: impl FnMut(What, Indicator),
) {
    let motion = SliderMotion::of_turning(geometry, bodies);
    tell_slider((slider, law), contact.mode, pressure, motion, |event, indicator| {
        say(
            match event {
                PhaseEnd::Gives(positive) => What::RollingGive(positive),
                PhaseEnd::Stops => What::RollingStop,
            },
            indicator,
        );
    });
}

/// The modes of a spring whose contact begins, under the normal force of that moment. Without a force the contact
/// exists from the beginning.
pub(super) fn begin((slider, law): Roller, contact: &Contact, geometry: &PairGeometry, base: Option<Base>) {
    let turning = geometry.turning();
    *slider = Slider { held: 0.0_f64.copysign(turning), ..Slider::default() };
    slider.grip = match base.is_none_or(|base| base.bears(&law, turning)) {
        true if turning == 0.0 && contact.mode == Mode::Hold => Grip::Hold,
        true => Grip::Stick,
        false if contact.mode == Mode::Hold => Grip::Slide,
        false => Grip::Slip,
    };
}

/// A mode of the spring or of its contact ends.
pub(super) fn switch((slider, law): Roller, contact: &Contact, what: What, geometry: &PairGeometry) {
    match what {
        What::RollingGive(positive) => {
            slider.give(positive, contact.mode == Mode::Hold || slider.grip.is_rigid());
            slider.slide(&law, contact.normal_force);
        }
        What::RollingStop => slider.stop(),
        _ => {}
    }
    adapt((slider, law), contact, geometry);
}

/// Brings the spring into line with the normal mode of its contact.
pub(super) fn adapt((slider, _): Roller, contact: &Contact, geometry: &PairGeometry) {
    if contact.mode == Mode::Open {
        *slider = Slider::default();
    }
    slider.adapt(contact.mode, geometry.turning());
}

/// The preferred load of a rolling spring on side B, if the spring of the contact pulls with `pull` newtons.
pub(super) fn share(slider: &Slider, law: &SliderLaw, pull: f64) -> Share {
    let measure = (law.friction_static * pull).max(f64::MIN_POSITIVE);
    Share { natural: -law.stiffness * slider.elongation, measure }
}
