//! One contact: its history, and the choice of its modes. `follow.rs` describes how it follows the motion of its sides.

use glam::DVec2;

use super::coulomb::Slider;
use super::normal::{Approach, Mode, NormalForce, elastic_energy};
use super::pair_law::PairLaw;
use crate::constraints::rest_solver::FrictionOutcome;

/// History of a candidate pair.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Contact {
    /// Place of its law.
    pub law: u32,
    /// Phase of the normal law.
    pub mode: Mode,
    /// Overlap in metres, zero when open.
    pub overlap: f64,
    /// Normal force in newtons.
    pub normal_force: f64,
    /// The tangential spring.
    pub tangential: Slider,
}

/// Energy lost in contacts in J.
#[derive(Clone, Copy, Debug, Default)]
pub struct Losses {
    /// To friction.
    pub friction: f64,
    /// To inelasticity and damping.
    pub inelasticity: f64,
}

impl Contact {
    /// A pair with this law that does not touch.
    pub fn open(law: u32) -> Self {
        Self { law, ..Self::default() }
    }

    /// Chooses the mode for a pair that is not to be held; `tangential`: what friction does. Returns the contact before, if that changed
    /// anything.
    #[inline]
    pub fn choose_mode<N: NormalForce>(
        &mut self,
        law: &PairLaw,
        approach: Approach,
        tangential: FrictionOutcome,
        losses: &mut Losses,
    ) -> Option<Self> {
        let chosen = N::chosen(self.mode, approach.parting);
        if chosen == self.mode && !self.tangential.grip.is_rigid() {
            return None;
        }
        let before = *self;
        if chosen != self.mode {
            self.mode = chosen;
            self.normal_force = N::force(law, chosen.sign(), self.overlap, approach);
        }
        self.take_on(law, tangential, losses);
        Some(before)
    }

    /// Holds along the normal with `normal` newtons; `tangential`: what friction does.
    pub fn hold(&mut self, law: &PairLaw, normal: f64, tangential: FrictionOutcome, losses: &mut Losses) {
        self.mode = Mode::Hold;
        self.normal_force = normal;
        self.take_on(law, tangential, losses);
    }

    /// Applies the friction that was found for the next tick. A weaker normal force holds less of it.
    fn take_on(&mut self, law: &PairLaw, friction: FrictionOutcome, losses: &mut Losses) {
        let slider = law.tangential();
        if slider.acts() {
            losses.friction += self.tangential.take_on(&slider, friction, self.normal_force);
        }
    }

    /// Tangential force in newtons: positive pulls side B back along the tangent.
    #[inline]
    pub fn tangential_force(&self, law: &PairLaw) -> f64 {
        self.tangential.force(&law.tangential())
    }

    /// Force on side B in newtons; side A receives the opposite.
    #[inline]
    pub fn force(&self, law: &PairLaw, normal: DVec2) -> DVec2 {
        normal * self.normal_force - normal.perp() * self.tangential_force(law)
    }

    /// Elastic energy in J, of both springs.
    pub fn energy(&self, law: &PairLaw) -> f64 {
        elastic_energy(law, self.overlap) + self.tangential.energy(&law.tangential())
    }
}
