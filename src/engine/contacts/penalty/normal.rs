//! The interface of normal laws. Each law is one file: [`super::inelasticity`], [`super::dashpot`].

use super::Penalty;
use super::pair_law::PairLaw;
use jostle_simd::Lanes;
use serde::{Deserialize, Serialize};

/// Phase of a contact; frozen during a step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Mode {
    /// Not touching.
    #[default]
    Open,
    /// Approaching, or touching under a law that makes no difference.
    Loading,
    /// Parting.
    Unloading,
    /// At rest along the normal: the force is whatever keeps it so, within the bounds of the law.
    Hold,
}

impl Mode {
    /// 1 while loading, -1 while unloading, else zero.
    #[inline]
    pub fn sign(self) -> f64 {
        match self {
            Self::Open | Self::Hold => 0.0,
            Self::Loading => 1.0,
            Self::Unloading => -1.0,
        }
    }
}

/// How two sides approach each other.
#[derive(Clone, Copy, Debug, Default)]
pub struct Approach<V = f64> {
    /// Velocity with which they part in m/s; negative: they approach.
    pub parting: V,
    /// Relative velocity along the normal that an impulse of one newton second makes, in 1/kg.
    pub mobility: V,
}

/// How an [`Approach`] changes.
#[derive(Clone, Copy, Debug, Default)]
pub struct Change {
    /// Rate of the velocity with which the sides part, in m/s2.
    pub parting: f64,
    /// Rate of the mobility in 1/(kg s): lever arms turn.
    pub mobility: f64,
}

/// A normal law over the spring of the pair.
pub trait NormalForce: Send + Sync + 'static {
    /// Whether the force depends on velocities. If not, [`Approach`] is left empty.
    const DEPENDS_ON_VELOCITY: bool;

    /// Whether the force may have several values at rest. If not, a held contact still follows its law.
    const SET_VALUED: bool;

    /// Fills in the coefficients of the law for a pair of materials with this inelasticity.
    fn set_up(law: &mut PairLaw, inelasticity: f64, settings: &Penalty);

    /// The mode for a contact that is not open and parts with `parting` m/s.
    fn chosen(present: Mode, parting: f64) -> Mode;

    /// Normal force in newtons, never below zero. `sign` is that of the mode, [`Mode::sign`].
    fn force<V: Lanes>(law: &PairLaw<V>, sign: V, overlap: V, approach: Approach<V>) -> V;

    /// Its smooth continuation beyond the end of the mode, also below zero. Default: the force itself.
    fn smooth_force(law: &PairLaw, mode: Mode, overlap: f64, approach: Approach) -> f64 {
        Self::force(law, mode.sign(), overlap, approach)
    }

    /// The rate of [`NormalForce::smooth_force`] in N/s, for this motion and acceleration of the contact.
    fn force_rate(law: &PairLaw, mode: Mode, approach: Approach, change: Change) -> f64;

    /// The rate of [`NormalForce::force_rate`] in N/s2, without changes of other forces on both sides.
    fn force_second_rate(law: &PairLaw, mode: Mode, approach: Approach, change: Change) -> f64;

    /// A number that is positive while the contact lasts, from the overlap and the force of its law. The second value
    /// is true if the number is the overlap itself.
    fn remaining(_: Mode, overlap: f64, _: f64) -> (f64, bool) {
        (overlap, true)
    }

    /// A number that is positive while a contact stays in its mode, apart from [`NormalForce::remaining`], and its
    /// rate. The rate is NaN if it is unknown. The inputs are the parting velocity (m/s), its rate (m/s2), and the
    /// force of the contact if it were loading. `None`: the mode does not end.
    fn stays(law: &PairLaw, mode: Mode, parting: (f64, f64), loading: f64) -> Option<(f64, f64)>;

    /// The mode for a first try when [`NormalForce::stays`] or [`NormalForce::remaining`] came to its end.
    fn after(mode: Mode, parted: bool) -> Mode;

    /// The least and the greatest force in newtons of a contact at rest whose current force is `present`.
    fn band(law: &PairLaw, overlap: f64, present: f64) -> (f64, f64);

    /// Energy in J that is lost between two states of one mode. Each state is an overlap in metres and a force in
    /// newtons.
    fn loss<V: Lanes>(law: &PairLaw<V>, sign: V, before: (V, V), after: (V, V)) -> V;

    /// The greatest stiffness in N/m and the damping in N s/m, for a mobility of the contact in 1/kg.
    fn response(law: &PairLaw, mobility: f64) -> (f64, f64);

    /// Whether the law takes energy from a pair. Pairs without losses never come to rest, and keep the motion of their
    /// springs.
    fn dissipates(law: &PairLaw) -> bool;
}

/// Elastic energy in J at `overlap` metres.
#[inline(always)]
pub fn elastic_energy<V: Lanes>(law: &PairLaw<V>, overlap: V) -> V {
    V::splat(0.5) * law.stiffness * overlap * overlap
}

/// The work in J that the force took from the bodies and that the spring does not store. It is mean force times the
/// change of overlap, minus the change of elastic energy. It is exact for a constant force, else of second order in the
/// step.
#[inline(always)]
pub fn lost_work<V: Lanes>(law: &PairLaw<V>, before: (V, V), after: (V, V)) -> V {
    let work = V::splat(0.5) * (before.1 + after.1) * (after.0 - before.0);
    work - (elastic_energy(law, after.0) - elastic_energy(law, before.0))
}
