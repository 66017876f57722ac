//! The coefficients of a pair of materials and stiffnesses, worked out once per kind of pair.

use std::collections::BTreeMap;

use super::coulomb::SliderLaw;
use super::dashpot::Damping;
use super::normal::NormalForce;
use super::{Penalty, TangentialLaw};
use crate::world::{MaterialIndex, Materials};

/// Coefficients of one kind of pair.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PairLaw {
    /// Stiffness of both sides in series, `1/(1/ka + 1/kb)`, in N/m.
    pub stiffness: f64,
    /// `mu_e`, between 0 (elastic) and 1. Zero if the normal law is another one.
    pub inelasticity: f64,
    /// Damping. None if the normal law has none.
    pub damping: Damping,
    /// Coulomb coefficient of a sticking contact.
    pub friction_static: f64,
    /// Coulomb coefficient of a slipping contact.
    pub friction_dynamic: f64,
    /// Stiffness of the tangential spring in N/m.
    pub tangential_stiffness: f64,
    /// Whether friction sticks without a spring.
    pub exact: bool,
    /// Share of the overlap that side A gives way: the softer side gives way more.
    pub share_a: f64,
    /// Share of the overlap that side B gives way.
    pub share_b: f64,
}

impl PairLaw {
    /// The tangential spring.
    #[inline]
    pub fn tangential(&self) -> SliderLaw {
        SliderLaw {
            stiffness: self.tangential_stiffness,
            friction_static: self.friction_static,
            friction_dynamic: self.friction_dynamic,
        }
    }
}

/// Stiffness and material of one side.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Side {
    /// Stiffness in N/m; infinite for walls.
    pub stiffness: f64,
    /// Material.
    pub material: MaterialIndex,
}

impl Side {
    fn key(self) -> (u64, MaterialIndex) {
        (self.stiffness.to_bits(), self.material)
    }
}

type Key = ((u64, MaterialIndex), (u64, MaterialIndex));

/// All kinds of pairs met so far.
#[derive(Debug, Default)]
pub struct LawTable {
    laws: Vec<PairLaw>,
    places: BTreeMap<Key, u32>,
}

impl LawTable {
    /// The law at `place`.
    #[inline]
    pub fn get(&self, place: u32) -> &PairLaw {
        &self.laws[place as usize]
    }

    /// Place of the law between two sides.
    pub fn place<N: NormalForce>(&mut self, a: Side, b: Side, materials: &Materials, settings: &Penalty) -> u32 {
        *self.places.entry((a.key(), b.key())).or_insert_with(|| {
            self.laws.push(pair_law::<N>(a, b, materials, settings));
            self.laws.len() as u32 - 1
        })
    }
}

fn pair_law<N: NormalForce>(a: Side, b: Side, materials: &Materials, settings: &Penalty) -> PairLaw {
    let stiffness = 1.0 / (1.0 / a.stiffness + 1.0 / b.stiffness);
    let pair = materials.pair(a.material.place(), b.material.place());
    let (ratio, exact) = (settings.tangential.ratio(), settings.tangential == TangentialLaw::Exact);
    let friction = |coefficient: f64| if ratio.is_some() { coefficient } else { 0.0 };
    let mut law = PairLaw {
        stiffness,
        friction_static: friction(pair.friction_static),
        friction_dynamic: friction(pair.friction_dynamic),
        tangential_stiffness: if exact { stiffness } else { ratio.unwrap_or(0.0) * stiffness },
        exact,
        share_a: stiffness / a.stiffness,
        share_b: stiffness / b.stiffness,
        ..PairLaw::default()
    };
    N::set_up(&mut law, pair.inelasticity, settings);
    law
}
