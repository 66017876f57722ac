//! Contacts in stages of a step: forces as a function of the state, in frozen modes.
//!
//! Here the elongation of springs is part of the state, and losses are powers that the method integrates. Elsewhere
//! both follow from state to state. Normal forces continue smoothly beyond the end of the mode, so that a contact pulls
//! there. The reason is that a trial step may overshoot an event before it is located.

use super::apply::{PenaltyContacts, Sink, approach};
use super::contact::Contact;
use super::coulomb::Grip;
use super::held::{Held, HeldPart};
use super::normal::{Approach, Change, Mode, NormalForce};
use super::pair_law::PairLaw;
use super::rolling::RollingContacts;
use super::rolling_stages::{self, Roller};
use crate::constraints::Rows;
use crate::contacts::CandidatePairs;
use crate::contacts::geometry::{Listed, PairGeometry};
use crate::tick::EvaluationMode;
use crate::world::Bodies;

/// Evaluates all contacts of a state. Those that are held give rows.
pub(super) fn evaluate<N: NormalForce>(
    contacts: &mut PenaltyContacts,
    mut rolling: Option<&mut RollingContacts>,
    pairs: &CandidatePairs,
    mode: EvaluationMode,
    (sink, rows): (&mut Sink, &mut Rows),
) {
    let PenaltyContacts { laws, atoms, surfaces, held, .. } = contacts;
    held.begin(rows);
    for (index, &pair) in pairs.atoms.iter().enumerate() {
        if mode == EvaluationMode::Instant || atoms.is_touching(index) {
            let geometry = PairGeometry::atoms(sink.bodies, index, pair);
            let mut contact = atoms.edit(index);
            let law = laws.get(contact.law);
            let roller = rolling.as_deref_mut().and_then(|rolling| rolling.of(&geometry, law));
            stage::<N>((&mut contact, law, roller), &geometry, mode, sink, (held, rows));
        }
    }
    for (index, &pair) in pairs.surfaces.iter().enumerate() {
        if mode == EvaluationMode::Instant || surfaces.is_touching(index) {
            let geometry = PairGeometry::surface(sink.bodies, index, pair);
            let mut contact = surfaces.edit(index);
            let law = laws.get(contact.law);
            let roller = rolling.as_deref_mut().and_then(|rolling| rolling.of(&geometry, law));
            stage::<N>((&mut contact, law, roller), &geometry, mode, sink, (held, rows));
        }
    }
}

/// Held contacts take the forces that were found for them.
pub(super) fn take_rows(
    contacts: &mut PenaltyContacts,
    mut rolling: Option<&mut RollingContacts>,
    rows: &Rows,
    sink: &mut Sink,
) {
    let PenaltyContacts { laws, atoms, surfaces, held, .. } = contacts;
    for (geometry, kind, force) in held.answers(rows) {
        let list = if geometry.pair.listed() == Listed::Atoms { &mut *atoms } else { &mut *surfaces };
        let mut contact = list.edit(geometry.pair.index as usize);
        let law = laws.get(contact.law);
        let roller = rolling.as_deref_mut().and_then(|rolling| rolling.of(geometry, law));
        let (normal, tangent_force) = match (kind, roller) {
            (HeldPart::Rolling, roller) => {
                if let Some((slider, rolling_law)) = roller {
                    slider.held = -force;
                    rolling_stages::push(slider, slider.force(&rolling_law), geometry, sink);
                }
                continue;
            }
            (HeldPart::Tangent, _) => {
                contact.tangential.held = -force;
                (None, -force)
            }
            (HeldPart::Normal, roller) => {
                contact.normal_force = force;
                if let Some((slider, rolling_law)) = roller
                    && slider.grip.gives()
                {
                    slider.slide(&rolling_law, force);
                    rolling_stages::push(slider, slider.sliding_force(&rolling_law, force), geometry, sink);
                }
                let sliding = contact.tangential.grip.gives();
                if sliding {
                    contact.slide(law, force);
                }
                (Some(force), if sliding { contact.tangential.sliding_force(&law.tangential(), force) } else { 0.0 })
            }
        };
        let push = geometry.pair.normal * normal.unwrap_or(0.0) - geometry.pair.normal.perp() * tangent_force;
        geometry.pair.push(sink, law, geometry.overlap, push);
        book(&contact, law, geometry, sink, normal, tangent_force);
    }
}

/// Evaluates one contact.
fn stage<N: NormalForce>(
    (contact, law, roller): (&mut Contact, &PairLaw, Option<Roller>),
    geometry: &PairGeometry,
    mode: EvaluationMode,
    sink: &mut Sink,
    (held, rows): (&mut Held, &mut Rows),
) {
    let approach = geometry.approach(sink.bodies);
    if mode == EvaluationMode::Instant {
        contact.adapt::<N>(law, geometry, approach);
        if contact.mode == Mode::Open {
            return;
        }
    }
    contact.overlap = geometry.overlap;
    let normal_held = contact.mode == Mode::Hold;
    if !normal_held {
        contact.normal_force = N::smooth_force(law, contact.mode, geometry.overlap, approach);
    }
    let slides = contact.tangential.grip.gives();
    if slides && !normal_held {
        contact.slide(law, contact.normal_force);
    }
    let acts = law.tangential().acts();
    let tangent_held = acts && contact.tangential.grip == Grip::Hold;
    let tangent_waits = !acts || tangent_held || (normal_held && slides);
    let normal = (!normal_held).then_some(contact.normal_force);
    let tangential = match contact.tangential.grip {
        _ if tangent_waits => 0.0,
        Grip::Slip | Grip::Slide => contact.tangential.sliding_force(&law.tangential(), contact.normal_force),
        _ => contact.tangential_force(law),
    };
    if normal_held {
        let slope = if slides { law.friction_dynamic.copysign(contact.tangential.held) } else { 0.0 };
        let twist = roller.as_ref().map_or(0.0, |roller| rolling_stages::slope(roller, contact));
        let band = N::SET_VALUED.then(|| N::band(law, contact.overlap, contact.normal_force));
        held.add_normal(rows, geometry, law, (slope, twist, band), sink.bodies);
    }
    if tangent_held {
        held.add_tangent(rows, geometry, law, contact, sink.bodies);
    }
    if normal.is_some() || tangential != 0.0 {
        let push = geometry.pair.normal * normal.unwrap_or(0.0) - geometry.pair.normal.perp() * tangential;
        geometry.pair.push(sink, law, geometry.overlap, push);
        book(contact, law, geometry, sink, normal, tangential);
    }
    if let Some(roller) = roller {
        rolling_stages::stage(roller, (contact, law), geometry, sink, (held, rows));
    }
}

/// Books the powers of a contact force, in two parts if necessary. The power that the force takes from the bodies and
/// the springs do not store is lost. The spring of the elastic part stores `k d` for every force, and is booked with
/// the normal force. A slipping spring books the change of its energy at the end of a step ([`super::switching`]).
fn book(
    contact: &Contact,
    law: &PairLaw,
    geometry: &PairGeometry,
    sink: &mut Sink,
    normal: Option<f64>,
    tangential: f64,
) {
    // Also without a force, if a contact has gone slack: the spring releases its energy.
    if let Some(normal) = normal {
        sink.rates.inelasticity -= geometry.parting() * (normal - law.stiffness * geometry.overlap);
    }
    if tangential != 0.0 && contact.tangential.grip.gives() {
        sink.rates.friction += tangential * geometry.sliding(law.shares());
    }
}

impl PairGeometry {
    /// The approach of side B to side A.
    #[inline]
    pub(super) fn approach(&self, bodies: &Bodies) -> Approach {
        approach(bodies, self.pair.other_end(), &self.pair.b, self.pair.normal)
    }

    /// The derivative of [`PairGeometry::approach`] under the present forces.
    pub(super) fn change(&self, law: &PairLaw, bodies: &Bodies) -> Change {
        Change { parting: self.parting_rate(law.shares(), bodies), mobility: self.mobility_rate(bodies) }
    }
}
