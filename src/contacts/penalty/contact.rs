//! One contact: its history, and what a touch does to it.

use glam::DVec2;

use super::coulomb::Slider;
use super::law::PairLaw;
use super::normal::{Approach, Mode, NormalForce, elastic_energy, lost_work};

/// History of a candidate pair.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Contact {
    /// Distance of centres (or height over a wall) below which the pair touches, in metres.
    pub reach: f64,
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

/// Geometry of a touch of side A and side B.
#[derive(Clone, Copy, Debug)]
pub struct Touch {
    /// Unit normal from A to B.
    pub normal: DVec2,
    /// Overlap in metres, positive when touching.
    pub overlap: f64,
    /// How the sides approach, for laws that depend on it.
    pub approach: Approach,
    /// Displacement of B's centre relative to A's since the last accepted state, in metres.
    pub displacement: DVec2,
    /// Turn of the line of centres in that time, in radians; zero for walls.
    pub swing: f64,
    /// Radius and turn of side A since then.
    pub rolled_a: (f64, f64),
    /// Radius and turn of side B since then.
    pub rolled_b: (f64, f64),
}

impl Touch {
    /// Unit tangent: the normal turned a quarter turn counter-clockwise.
    #[inline]
    pub fn tangent(&self) -> DVec2 {
        self.normal.perp()
    }

    /// Share of the displacement that was made in touch, if the pair did not touch before. Without it a contact that
    /// begins inside a tick and sticks would be of first order.
    fn share_in_touch(&self) -> f64 {
        let approached = -self.displacement.dot(self.normal);
        if approached > self.overlap { self.overlap.max(0.0) / approached } else { 1.0 }
    }

    /// Displacement of B relative to A along the contact, in metres, to second order in the step: tangent and lever
    /// arms are those of its middle.
    #[inline]
    fn tangential_displacement(&self, law: &PairLaw, overlap_before: f64) -> f64 {
        let overlap = 0.5 * (overlap_before + self.overlap.max(0.0));
        let along = self.displacement.dot(self.tangent()) + 0.5 * self.swing * self.displacement.dot(self.normal);
        let arm = |(radius, turn): (f64, f64), share: f64| (radius - share * overlap) * turn;
        along - arm(self.rolled_a, law.share_a) - arm(self.rolled_b, law.share_b)
    }
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
    /// Follows the pair to the state that `touch` describes, in its present mode. A pair that was open begins to load.
    /// `elapsed` seconds have passed since the last accepted state.
    #[inline(always)]
    pub fn follow<N: NormalForce>(&mut self, law: &PairLaw, touch: &Touch, elapsed: f64, losses: &mut Losses) {
        let before = (self.overlap, self.normal_force);
        let mut share = 1.0;
        if self.mode == Mode::Open {
            self.mode = Mode::Loading;
            share = touch.share_in_touch();
        }
        self.overlap = touch.overlap.max(0.0);
        let loss = if self.mode == Mode::Hold && N::SET_VALUED {
            lost_work(law, before, (self.overlap, self.normal_force))
        } else {
            self.normal_force = N::force(law, self.mode, self.overlap, touch.approach);
            N::loss(law, self.mode, before, (self.overlap, self.normal_force))
        };
        // Bodies that are put into each other, at the start or by hand, have done no work.
        losses.inelasticity += if elapsed > 0.0 { loss } else { 0.0 };
        let slider = law.tangential();
        if slider.acts() {
            let displacement = (elapsed > 0.0).then(|| share * touch.tangential_displacement(law, before.0));
            losses.friction += self.tangential.follow(&slider, displacement, self.normal_force);
        }
        if touch.overlap <= 0.0 {
            losses.friction += self.tangential.energy(&slider);
            *self = Self { reach: self.reach, law: self.law, ..Self::default() };
        }
    }

    /// Chooses the mode for a pair that is not to be held. Returns what it was before if that changed anything.
    #[inline]
    pub fn choose_mode<N: NormalForce>(
        &mut self,
        law: &PairLaw,
        approach: Approach,
        losses: &mut Losses,
    ) -> Option<Self> {
        let chosen = N::chosen(self.mode, approach.parting);
        if chosen == self.mode {
            return None;
        }
        let before = *self;
        self.mode = chosen;
        self.normal_force = N::force(law, chosen, self.overlap, approach);
        self.let_go(law, losses);
        Some(before)
    }

    /// Holds along the normal with `normal` newtons, and along the tangent if `tangential` newtons are given.
    pub fn hold(&mut self, law: &PairLaw, normal: f64, tangential: Option<f64>, losses: &mut Losses) {
        self.mode = Mode::Hold;
        self.normal_force = normal;
        match tangential {
            Some(tangential) => self.tangential.hold(tangential),
            None => self.let_go(law, losses),
        }
    }

    /// The tangential spring takes over; a weaker normal force holds less friction.
    fn let_go(&mut self, law: &PairLaw, losses: &mut Losses) {
        let slider = law.tangential();
        if slider.acts() {
            losses.friction += self.tangential.let_go(&slider);
            losses.friction += self.tangential.follow(&slider, None, self.normal_force);
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
