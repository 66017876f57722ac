//! Normal law: a linear spring that is stiffer while loading than while unloading.
//!
//! `N = k d (1 + mu_e)` while the bodies approach and `N = k d (1 - mu_e)` while they part, with `d` the overlap. The
//! work lost in a full cycle gives the restitution `e = sqrt((1 - mu_e)/(1 + mu_e))`, whatever the speed, the masses and
//! the number of atoms that touch at once (the idea of Walton and Braun 1986). Within a mode the force has a potential,
//! so the energy lost between two overlaps is known exactly: `+-mu_e k (d1^2 - d0^2)/2`. A contact ends when the overlap
//! does; it never pulls.
//!
//! At rest, `v_n = 0`, the law is set-valued: any force between the two keeps the contact there. Which one it is the
//! balance of forces decides ([`super::hold`]).

use super::Penalty;
use super::law::PairLaw;
use super::normal::{Approach, Change, Mode, NormalForce, elastic_energy};
use crate::simd::Lanes;

/// The law.
pub struct Inelasticity;

impl NormalForce for Inelasticity {
    const DEPENDS_ON_VELOCITY: bool = false;
    const SET_VALUED: bool = true;

    fn set_up(law: &mut PairLaw, inelasticity: f64, _: &Penalty) {
        law.inelasticity = inelasticity;
    }

    /// At rest it stays as it was.
    #[inline]
    fn chosen(present: Mode, parting: f64) -> Mode {
        if parting < 0.0 {
            Mode::Loading
        } else if parting > 0.0 {
            Mode::Unloading
        } else if present == Mode::Hold {
            Mode::Loading
        } else {
            present
        }
    }

    #[inline(always)]
    fn force<V: Lanes>(law: &PairLaw<V>, sign: V, overlap: V, _: Approach<V>) -> V {
        law.stiffness * overlap * (V::splat(1.0) + sign * law.inelasticity)
    }

    fn force_rate(law: &PairLaw, mode: Mode, approach: Approach, _: Change) -> f64 {
        -Self::force(law, mode.sign(), approach.parting, approach)
    }

    fn force_second_rate(law: &PairLaw, mode: Mode, approach: Approach, change: Change) -> f64 {
        -Self::force(law, mode.sign(), change.parting, approach)
    }

    fn stays(law: &PairLaw, mode: Mode, (parting, rate): (f64, f64), _: f64) -> Option<(f64, f64)> {
        let sign = -mode.sign();
        (law.inelasticity > 0.0).then_some((sign * parting, sign * rate))
    }

    fn after(_: Mode, parted: bool) -> Mode {
        if parted { Mode::Open } else { Mode::Hold }
    }

    #[inline]
    fn band(law: &PairLaw, overlap: f64, _: f64) -> (f64, f64) {
        let force = |mode: Mode| Self::force(law, mode.sign(), overlap, Approach::default());
        (force(Mode::Unloading), force(Mode::Loading))
    }

    #[inline(always)]
    fn loss<V: Lanes>(law: &PairLaw<V>, sign: V, (before, _): (V, V), (after, _): (V, V)) -> V {
        let share = sign * law.inelasticity;
        share * elastic_energy(law, after) - share * elastic_energy(law, before)
    }

    fn response(law: &PairLaw, _: f64) -> (f64, f64) {
        (law.stiffness * (1.0 + law.inelasticity), 0.0)
    }

    fn dissipates(law: &PairLaw) -> bool {
        law.inelasticity > 0.0
    }
}
