//! Rolling law: a torque against rolling, `k_r theta` up to `mu_r R N` (type C of Ai, Chen, Rotter and Ooi 2011).
//!
//! `theta` is the relative turn of both sides while they touch. It is zero if a pair turns as one rigid body. `R` is
//! the rolling radius, `1/R = 1/Ra + 1/Rb`, or that of the atom on a wall. The stiffness is `k_r = ratio k R^2`, that
//! of a tangential spring at the rim. A constant torque would change its sign at rest, but the spring with its Coulomb
//! limit comes to rest. On a slope it holds up to `tan(slope) = mu_r`.

use bevy_ecs::prelude::*;
use glam::DVec2;

use super::apply::{PenaltyContacts, Shared};
use super::contact::{Contact, Losses};
use super::coulomb::{Slider, SliderLaw};
use super::normal::{Mode, NormalForce};
use super::pair_law::PairLaw;
use crate::contacts::geometry::{ContactEnd, PairGeometry};
use crate::contacts::{AtomPair, CandidatePairs};
use crate::tick::Rates;
use crate::tick::pairs::NEW;
use crate::world::Bodies;
use serde::{Deserialize, Serialize};

/// Rolling springs of all candidate pairs, beside the lists of [`CandidatePairs`]. Present in scenes with a rolling
/// law.
#[derive(Resource, Debug, Default, Serialize, Deserialize)]
pub struct RollingContacts {
    /// `mu_r`: torque over normal force and rolling radius, at which the spring gives way.
    pub friction: f64,
    /// Stiffness at the rim over the normal stiffness.
    pub ratio: f64,
    pub(super) version: u64,
    /// One for each pair of atoms.
    pub atoms: Vec<Slider>,
    /// One for each probe near a surface.
    pub surfaces: Vec<Slider>,
}

impl RollingContacts {
    /// No contacts yet.
    pub fn new(friction: f64, ratio: f64) -> Self {
        Self { friction, ratio, ..Self::default() }
    }

    /// The law of a pair: torques in N m over angles in radians. `None`: sharp sides have no rolling radius, and so no spring.
    #[inline]
    pub(super) fn law(&self, pair: &PairLaw, a: Option<&ContactEnd>, b: &ContactEnd) -> Option<SliderLaw> {
        let radius = rolling_radius(a, b);
        let coefficient = self.friction * radius;
        let law = SliderLaw {
            stiffness: stiffness(self.ratio, pair.stiffness, radius),
            friction_static: coefficient,
            friction_dynamic: coefficient,
        };
        Some(law).filter(SliderLaw::acts)
    }

    /// Gives every pair of a new list its spring, with its history if it had one.
    pub(super) fn carry(&mut self, pairs: &CandidatePairs) {
        if self.version != pairs.version {
            self.version = pairs.version;
            self.atoms = carried(&pairs.atoms_before, &self.atoms);
            self.surfaces = carried(&pairs.surfaces_before, &self.surfaces);
        }
    }

    /// Elastic energy in J.
    pub fn energy(&self, bodies: &Bodies, pairs: &CandidatePairs, contacts: &PenaltyContacts) -> f64 {
        let mut energy = 0.0;
        for (&AtomPair { a, b }, (slider, contact)) in
            pairs.atoms.iter().zip(self.atoms.iter().zip(contacts.atoms.iter()))
        {
            let (a, b) = (ContactEnd::of(bodies, a), ContactEnd::of(bodies, b));
            let law = self.law(contacts.laws.get(contact.law), Some(&a), &b);
            energy += law.map_or(0.0, |law| slider.energy(&law));
        }
        for (index, (&pair, (slider, contact))) in
            pairs.surfaces.iter().zip(self.surfaces.iter().zip(contacts.surfaces.iter())).enumerate()
        {
            let pair = PairGeometry::surface(bodies, index, pair).pair;
            let law = self.law(contacts.laws.get(contact.law), pair.other_end(), &pair.b);
            energy += law.map_or(0.0, |law| slider.energy(&law));
        }
        energy
    }
}

/// In metres; `None` is a wall.
#[inline]
pub(super) fn rolling_radius(a: Option<&ContactEnd>, b: &ContactEnd) -> f64 {
    a.map_or(b.radius, |a| 1.0 / (1.0 / a.radius + 1.0 / b.radius))
}

/// Stiffness of a rolling spring in N m.
#[inline]
pub(super) fn stiffness(ratio: f64, normal: f64, radius: f64) -> f64 {
    ratio * normal * radius * radius
}

/// Applies `torque` to side A of a contact, and its opposite to the other side. Without a body A, only the other side turns. A
/// side that does not move by forces takes the torque from outside, and does work as it turns.
pub(super) fn twist(bodies: &mut Bodies, rates: &mut Rates, a: Option<&ContactEnd>, b: &ContactEnd, torque: f64) {
    bodies.torque[b.body] -= torque;
    match a {
        Some(a) => {
            bodies.torque[a.body] += torque;
            for (end, given) in [(a, -torque), (b, torque)] {
                if !bodies.dynamic[end.body] {
                    rates.outside(DVec2::ZERO, DVec2::ZERO, given);
                    rates.work += given * bodies.spin[end.body];
                }
            }
        }
        None => rates.outside(DVec2::ZERO, DVec2::ZERO, -torque),
    }
}

/// Updates the springs of a list: those of open pairs release, and the others follow the turn.
struct Follow<'a> {
    bodies: &'a mut Bodies,
    rates: &'a mut Rates,
    elapsed: f64,
    /// Whether the normal force has a band at rest.
    set_valued: bool,
    losses: Losses,
}

impl Follow<'_> {
    fn pair(
        &mut self,
        slider: &mut Slider,
        law: &SliderLaw,
        contact: &Contact,
        a: Option<&ContactEnd>,
        b: &ContactEnd,
    ) {
        if contact.mode == Mode::Open {
            self.losses.friction += slider.energy(law);
            *slider = Slider::default();
            return;
        }
        let turn_of = |end: &ContactEnd| self.bodies.displacement(end.body).1;
        let turn = turn_of(b) - a.map_or(0.0, turn_of);
        let turn = (self.elapsed > 0.0).then_some(turn);
        let rests = self.set_valued && contact.mode == Mode::Hold;
        self.losses.friction += slider.follow(law, turn, contact.normal_force, rests);
        twist(self.bodies, self.rates, a, b, slider.force(law));
    }
}

fn carried(before: &[u32], old: &[Slider]) -> Vec<Slider> {
    before.iter().map(|&index| if index == NEW { Slider::default() } else { old[index as usize] }).collect()
}

/// All rolling springs follow the state, behind their contacts.
pub(super) fn apply<N: NormalForce>(
    Shared { bodies, rates, ledger, evaluation, .. }: Shared,
    pairs: &CandidatePairs,
    contacts: &PenaltyContacts,
    rolling: &mut RollingContacts,
) {
    rolling.carry(pairs);
    if evaluation.mode.is_staged() {
        // They have acted with their contacts.
        return;
    }
    let (mut atoms, mut surfaces) = (std::mem::take(&mut rolling.atoms), std::mem::take(&mut rolling.surfaces));
    let mut follow =
        Follow { bodies, rates, elapsed: evaluation.elapsed, set_valued: N::SET_VALUED, losses: Losses::default() };
    for (index, slider) in atoms.iter_mut().enumerate() {
        let contact = contacts.atoms.get(index);
        if contacts.atoms.is_asleep(index) {
            continue;
        }
        if contact.mode != Mode::Open || *slider != Slider::default() {
            let AtomPair { a, b } = pairs.atoms[index];
            let (a, b) = (ContactEnd::of(follow.bodies, a), ContactEnd::of(follow.bodies, b));
            let Some(law) = rolling.law(contacts.laws.get(contact.law), Some(&a), &b) else { continue };
            follow.pair(slider, &law, &contact, Some(&a), &b);
        }
    }
    for (index, slider) in surfaces.iter_mut().enumerate() {
        let contact = contacts.surfaces.get(index);
        if contacts.surfaces.is_asleep(index) {
            continue;
        }
        if contact.mode != Mode::Open || *slider != Slider::default() {
            let pair = PairGeometry::surface(follow.bodies, index, pairs.surfaces[index]).pair;
            let Some(law) = rolling.law(contacts.laws.get(contact.law), pair.other_end(), &pair.b) else { continue };
            follow.pair(slider, &law, &contact, pair.other_end(), &pair.b);
        }
    }
    ledger.friction.add(follow.losses.friction);
    (rolling.atoms, rolling.surfaces) = (atoms, surfaces);
}
