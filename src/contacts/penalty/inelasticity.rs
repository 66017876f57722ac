//! Normal law: a linear spring that is stiffer while loading than while unloading.
//!
//! `N = k d (1 + mu_e)` while the bodies approach and `N = k d (1 - mu_e)` while they part, with `d` the overlap. The
//! work lost in a full cycle gives the restitution `e = sqrt((1 - mu_e)/(1 + mu_e))`, whatever the speed (the idea of
//! Walton and Braun 1986). Within a mode the force has a potential, so the energy lost between two overlaps is known
//! exactly: `+-mu_e k (d1^2 - d0^2)/2`.
//!
//! At rest, `v_n = 0`, the law is set-valued: any force between the two keeps the contact there. Which one it is the
//! balance of forces decides ([`super::hold`]).

use super::law::PairLaw;

/// Phase of a contact; frozen during a step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Mode {
    /// Not touching.
    #[default]
    Open,
    /// Approaching.
    Loading,
    /// Parting.
    Unloading,
    /// At rest along the normal: the force is whatever keeps it so, between the two others.
    Hold,
}

impl Mode {
    fn sign(self) -> f64 {
        match self {
            Mode::Open | Mode::Hold => 0.0,
            Mode::Loading => 1.0,
            Mode::Unloading => -1.0,
        }
    }

    /// The mode for a contact that parts with `parting` m/s (negative: approaches). At rest it stays as it was.
    pub fn chosen(self, parting: f64) -> Self {
        if parting < 0.0 {
            Mode::Loading
        } else if parting > 0.0 {
            Mode::Unloading
        } else if self == Mode::Hold {
            Mode::Loading
        } else {
            self
        }
    }
}

/// The least and the greatest force in newtons that a contact at rest may have: the law is set-valued there.
#[inline]
pub fn band(law: &PairLaw, overlap: f64) -> (f64, f64) {
    (force(law, Mode::Unloading, overlap), force(law, Mode::Loading, overlap))
}

/// Normal force in newtons at `overlap` metres.
#[inline]
pub fn force(law: &PairLaw, mode: Mode, overlap: f64) -> f64 {
    law.stiffness * overlap * (1.0 + mode.sign() * law.inelasticity)
}

/// Energy in J that is lost between two overlaps in one mode.
#[inline]
pub fn loss(law: &PairLaw, mode: Mode, before: f64, after: f64) -> f64 {
    mode.sign() * law.inelasticity * energy(law, after) - mode.sign() * law.inelasticity * energy(law, before)
}

/// Elastic energy in J at `overlap` metres.
#[inline]
pub fn energy(law: &PairLaw, overlap: f64) -> f64 {
    0.5 * law.stiffness * overlap * overlap
}
