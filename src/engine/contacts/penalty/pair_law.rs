//! The coefficients of a pair of materials and stiffnesses, computed once per kind of pair.

use std::collections::BTreeMap;

use super::coulomb::SliderLaw;
use super::dashpot::Damping;
use super::inelasticity::mean_inelasticity;
use super::normal::NormalForce;
use super::{Penalty, TangentialLaw};
use crate::contacts::geometry::Shares;
use crate::world::{MaterialIndex, Materials};
use jostle_simd::{Lanes, Record};
use serde::{Deserialize, Serialize};

/// Coefficients of one kind of pair, or of several side by side.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct PairLaw<V = f64> {
    /// Stiffness of both sides in series, `1/(1/ka + 1/kb)`, in N/m.
    pub stiffness: V,
    /// `mu_e`, between 0 (elastic) and 1. Zero if the normal law is another one.
    pub inelasticity: V,
    /// Damping. Zero if the normal law has none.
    pub damping: Damping<V>,
    /// Coulomb coefficient of a sticking contact.
    pub friction_static: V,
    /// Coulomb coefficient of a slipping contact.
    pub friction_dynamic: V,
    /// Stiffness of the tangential spring in N/m.
    pub tangential_stiffness: V,
    /// Elongation in metres over the normal force in newtons of a tangential spring that slips; zero without friction.
    pub slip: V,
    /// Whether friction sticks without a spring.
    pub exact: bool,
    /// Share of the overlap that side A gives way: the softer side gives way more.
    pub share_a: V,
    /// Share of the overlap that side B gives way.
    pub share_b: V,
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

    /// The shares of the sides in their overlap.
    #[inline]
    pub(crate) fn shares(&self) -> Shares {
        Shares { a: self.share_a, b: self.share_b }
    }

    fn row(&self) -> Record {
        Record([
            self.stiffness,
            // A law has either of them.
            self.inelasticity + self.damping.number(),
            self.friction_static,
            self.friction_dynamic,
            self.tangential_stiffness,
            self.slip,
            self.share_a,
            self.share_b,
        ])
    }
}

/// Stiffness and material of one side.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PairSide {
    /// Stiffness in N/m; infinite for walls.
    pub stiffness: f64,
    /// Material.
    pub material: MaterialIndex,
}

impl PairSide {
    fn key(self) -> (u64, MaterialIndex) {
        (self.stiffness.to_bits(), self.material)
    }
}

type Key = ((u64, MaterialIndex), (u64, MaterialIndex));

/// All kinds of pairs met so far.
#[derive(Debug, Default, Serialize, Deserialize)]
pub struct LawTable {
    laws: Vec<PairLaw>,
    /// The same as records.
    rows: Vec<Record>,
    indices: BTreeMap<Key, u32>,
    /// The pair asked for last: neighbours are often of one kind.
    last: Option<(Key, u32)>,
}

impl LawTable {
    /// Whether each law is the one that follows from its two sides, and each has its place.
    pub(super) fn fits<N: NormalForce>(&self, materials: &Materials, settings: &Penalty) -> bool {
        let Self { laws, rows, indices, last } = self;
        let side = |(stiffness, material)| PairSide { stiffness: f64::from_bits(stiffness), material };
        let known = |(_, material): (u64, MaterialIndex)| materials.has(material);
        let own = |(&(a, b), &index): (&Key, &u32)| {
            let (saved, row) = (laws.get(index as usize), rows.get(index as usize));
            known(a) && known(b) && {
                let law = pair_law::<N>(side(a), side(b), materials, settings);
                saved == Some(&law) && row == Some(&law.row())
            }
        };
        let mut places: Vec<u32> = indices.values().copied().collect();
        places.sort_unstable();
        places.into_iter().eq(0..laws.len() as u32)
            && rows.len() == laws.len()
            && indices.iter().all(own)
            && last.is_none_or(|(key, index)| indices.get(&key) == Some(&index))
    }

    /// The number of laws.
    pub(super) fn len(&self) -> usize {
        self.laws.len()
    }

    /// The law at `place`.
    #[inline]
    pub fn get(&self, index: u32) -> &PairLaw {
        &self.laws[index as usize]
    }

    /// The laws at the first places of a list, side by side.
    #[inline(always)]
    pub fn lanes<V: Lanes>(&self, indices: &[u32]) -> PairLaw<V> {
        let [stiffness, loss, friction_static, friction_dynamic, tangential_stiffness, slip, share_a, share_b] =
            V::records(&self.rows, indices);
        // All pairs of a scene have damping of one kind.
        let (damping, exact) = (self.laws[0].damping.kind(loss), self.laws[0].exact);
        PairLaw {
            stiffness,
            inelasticity: loss,
            damping,
            friction_static,
            friction_dynamic,
            tangential_stiffness,
            slip,
            exact,
            share_a,
            share_b,
        }
    }

    /// Place of the law between two sides.
    pub fn index<N: NormalForce>(
        &mut self,
        a: PairSide,
        b: PairSide,
        materials: &Materials,
        settings: &Penalty,
    ) -> u32 {
        let key = (a.key(), b.key());
        if let Some((last, index)) = self.last
            && last == key
        {
            return index;
        }
        let index = *self.indices.entry(key).or_insert_with(|| {
            let law = pair_law::<N>(a, b, materials, settings);
            self.laws.push(law);
            self.rows.push(law.row());
            self.laws.len() as u32 - 1
        });
        self.last = Some((key, index));
        index
    }
}

fn pair_law<N: NormalForce>(a: PairSide, b: PairSide, materials: &Materials, settings: &Penalty) -> PairLaw {
    let stiffness = 1.0 / (1.0 / a.stiffness + 1.0 / b.stiffness);
    let pair = materials.pair(a.material.index(), b.material.index());
    let (ratio, exact) = (settings.tangential.ratio(), settings.tangential == TangentialLaw::Exact);
    let friction = |coefficient: f64| if ratio.is_some() { coefficient } else { 0.0 };
    let tangential_stiffness = if exact { stiffness } else { ratio.unwrap_or(0.0) * stiffness };
    let mut law = PairLaw {
        stiffness,
        friction_static: friction(pair.friction_static),
        friction_dynamic: friction(pair.friction_dynamic),
        tangential_stiffness,
        slip: if friction(pair.friction_dynamic) > 0.0 { pair.friction_dynamic / tangential_stiffness } else { 0.0 },
        exact,
        share_a: stiffness / a.stiffness,
        share_b: stiffness / b.stiffness,
        ..PairLaw::default()
    };
    N::set_up(&mut law, mean_inelasticity(pair.rebounds), settings);
    law
}
