//! Normal law: a linear spring that is stiffer while loading than while unloading.
//!
//! `N = k d (1 + mu_e)` while the bodies approach and `N = k d (1 - mu_e)` while they part, with `d` the overlap. The
//! work lost in a full cycle gives the restitution `e = sqrt((1 - mu_e)/(1 + mu_e))`. It does not depend on speed,
//! masses and the number of touching atoms (the idea of Walton and Braun 1986). Within a mode the force has a
//! potential. So the energy lost between two overlaps is known exactly: `+-mu_e k (d1^2 - d0^2)/2`. A contact ends when
//! the overlap does; it never pulls.
//!
//! At rest, `v_n = 0`, the law is set-valued: every force between the two keeps the contact at rest. The balance of
//! forces determines it ([`crate::constraints::rest_solver`]).

use super::Penalty;
use super::normal::{Approach, Change, Mode, NormalForce, elastic_energy};
use super::pair_law::PairLaw;
use crate::world::Materials;
use crate::world::material::Rebound;
use jostle_simd::Lanes;

/// The inelasticity of a material, from 0 to 1. For a restitution `e` it is `mu_e = (1 - e^2)/(1 + e^2)`.
pub fn inelasticity_of(rebound: Rebound) -> f64 {
    match rebound {
        Rebound::Inelasticity(inelasticity) => inelasticity,
        Rebound::Restitution(restitution) => (1.0 - restitution * restitution) / (1.0 + restitution * restitution),
    }
}

/// The restitution that an inelasticity gives.
pub fn restitution_of(inelasticity: f64) -> f64 {
    ((1.0 - inelasticity) / (1.0 + inelasticity)).sqrt()
}

/// The inelasticity of a pair: the mean of both.
pub(super) fn mean_inelasticity([a, b]: [Rebound; 2]) -> f64 {
    (inelasticity_of(a) + inelasticity_of(b)) / 2.0
}

/// The greatest inelasticity that any pair may have.
pub(super) fn largest_inelasticity(materials: &Materials) -> f64 {
    materials.rebounds().map(inelasticity_of).fold(0.0, f64::max)
}

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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn restitution_and_inelasticity_are_one_thing() {
        for restitution in [0.0, 0.3, 0.8, 1.0] {
            // Rounding of three operations.
            let inelasticity = inelasticity_of(Rebound::Restitution(restitution));
            assert!((restitution_of(inelasticity) - restitution).abs() < 1e-15);
        }
    }

    #[test]
    fn a_pair_has_the_mean_inelasticity() {
        assert_eq!(mean_inelasticity([Rebound::Inelasticity(0.5), Rebound::Restitution(1.0)]), 0.25);
    }
}
