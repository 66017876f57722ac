//! Contacts that begin in equilibrium ([`super::equilibrium`]): their springs are drawn before the first evaluation.

use std::collections::BTreeMap;

use super::apply::PenaltyContacts;
use super::contact::Contact;
use super::coulomb::{Grip, Slider};
use super::normal::{Mode, NormalForce};
use super::rolling::RollingContacts;
use crate::contacts::{AtomPair, CandidatePairs};
use crate::tick::EvaluationMode;
use serde::{Deserialize, Serialize};

/// The names of a pair: two atoms, or a surface and a probe.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub(super) enum Named {
    Atoms(AtomPair),
    Surface((u32, u32)),
}

/// A spring along the surface or against rolling. Its elongation is in metres or rad, its force in N or N m.
#[derive(Clone, Copy, Debug, Default, Serialize, Deserialize)]
pub(super) struct Drawn {
    pub elongation: f64,
    pub force: f64,
    /// Whether it slips with that force.
    pub slips: bool,
}

/// A contact that begins in equilibrium.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub(super) struct Begun {
    pub pair: Named,
    /// In metres.
    pub overlap: f64,
    /// In newtons.
    pub normal_force: f64,
    pub tangential: Drawn,
    /// `None`: sharp sides have no rolling radius, and so no spring.
    pub rolling: Option<Drawn>,
    /// Whether no side slides or rolls over the other.
    pub still: bool,
}

/// The contacts of the first evaluation take up their springs. Those that dissipate are at rest. The others follow their law.
pub(super) fn take_over<N: NormalForce>(
    contacts: &mut PenaltyContacts,
    mut rolling: Option<&mut RollingContacts>,
    pairs: &CandidatePairs,
    mode: EvaluationMode,
) {
    let begun = std::mem::take(&mut contacts.begun);
    if let Some(rolling) = &mut rolling {
        rolling.carry(pairs);
    }
    let of_atoms = pairs.atoms.iter().enumerate().map(|(index, pair)| (Named::Atoms(*pair), index));
    let of_surfaces = pairs.surfaces.iter().enumerate().map(|(index, pair)| (Named::Surface(pair.names()), index));
    let indices: BTreeMap<Named, usize> = of_atoms.chain(of_surfaces).collect();
    for Begun { pair, overlap, normal_force, tangential, rolling: turned, still } in begun {
        // In stages of a step a contact that slides finds its direction and its force by itself.
        let Some(&index) = indices.get(&pair).filter(|_| still || !mode.is_staged()) else { continue };
        let (list, sliders) = match pair {
            Named::Atoms(_) => (&mut contacts.atoms, rolling.as_deref_mut().map(|rolling| &mut rolling.atoms)),
            Named::Surface(_) => (&mut contacts.surfaces, rolling.as_deref_mut().map(|rolling| &mut rolling.surfaces)),
        };
        let law = *contacts.laws.get(list.get(index).law);
        // In stages of a step a law with one force at rest is never held.
        let rests = N::dissipates(&law) && (N::SET_VALUED || mode == EvaluationMode::Following);
        let drawn = |Drawn { elongation, force, slips }: Drawn, rests: bool| Slider {
            elongation,
            held: if rests || slips { force } else { 0.0_f64.copysign(force) },
            grip: match (slips, rests) {
                (true, false) => Grip::Slip,
                (true, true) => Grip::Slide,
                (false, true) => Grip::Hold,
                (false, false) => Grip::Stick,
            },
        };
        let contact = Contact {
            law: list.get(index).law,
            mode: if rests { Mode::Hold } else { Mode::Loading },
            overlap,
            normal_force,
            tangential: if law.tangential().acts() {
                drawn(tangential, still && (rests || law.exact))
            } else {
                Slider::default()
            },
        };
        list.set(index, &contact);
        if let (Some(sliders), Some(turned)) = (sliders, turned) {
            sliders[index] = drawn(turned, still && rests);
        }
    }
}
