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

    /// The law beside another contact that sticks: see [`super::partial_slip`]. `None`: it is the same.
    fn in_partial_slip(&self) -> Option<Self> {
        let drops = self.friction_static > self.friction_dynamic;
        let slip = self.friction_static / self.tangential_stiffness;
        drops.then_some(Self { friction_dynamic: self.friction_static, slip, ..*self })
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
    /// For each law the place of the one in partial slip, which stands behind it, and the other way round. A law without
    /// such a one has its own place.
    twins: Vec<u32>,
    indices: BTreeMap<Key, u32>,
    /// The pair asked for last: neighbours are often of one kind.
    last: Option<(Key, u32)>,
}

impl LawTable {
    /// Whether each law is the one that follows from its two sides, and each has its place.
    pub(super) fn fits<N: NormalForce>(&self, materials: &Materials, settings: &Penalty) -> bool {
        let side = |(stiffness, material)| PairSide { stiffness: f64::from_bits(stiffness), material };
        let mut keys: Vec<(u32, Key)> = self.indices.iter().map(|(key, index)| (*index, *key)).collect();
        keys.sort_unstable_by_key(|(index, _)| *index);
        if !keys.iter().all(|(_, (a, b))| materials.has(a.1) && materials.has(b.1)) {
            return false;
        }
        let mut own = Self::default();
        for (_, (a, b)) in keys {
            own.index::<N>(side(a), side(b), materials, settings);
        }
        let same = own.laws == self.laws && own.rows == self.rows && own.twins == self.twins;
        same && own.indices == self.indices
            && self.last.is_none_or(|(key, index)| self.indices.get(&key) == Some(&index))
    }

    /// The number of laws.
    pub(super) fn len(&self) -> usize {
        self.laws.len()
    }

    /// Whether some law has one for partial slip.
    pub(super) fn some_drop(&self) -> bool {
        self.twins.len() > self.indices.len()
    }

    /// The place of the law for partial slip that belongs to one for slip, or the other way round.
    pub(super) fn twin(&self, index: u32) -> u32 {
        self.twins[index as usize]
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
            let (place, partial) = (self.laws.len() as u32, law.in_partial_slip());
            self.laws.extend([Some(law), partial].into_iter().flatten());
            self.rows.extend([Some(law), partial].into_iter().flatten().map(|law| law.row()));
            self.twins.extend(if partial.is_some() { vec![place + 1, place] } else { vec![place] });
            place
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
