//! One contact: its history, and what a touch does to it.

use glam::DVec2;

use super::inelasticity::{self, Mode};
use super::law::PairLaw;
use super::tangential;

/// History of a candidate pair.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Contact {
    /// Distance of centres (or height over a wall) below which the pair touches, in metres.
    pub reach: f64,
    /// Place of its law.
    pub law: u32,
    /// Phase of the normal law.
    pub mode: Mode,
    /// Whether the tangential spring has given way.
    pub slipping: bool,
    /// Overlap in metres, zero when open.
    pub overlap: f64,
    /// Elongation of the tangential spring in metres.
    pub elongation: f64,
}

/// Geometry of a touch of side A and side B.
#[derive(Clone, Copy, Debug)]
pub struct Touch {
    /// Unit normal from A to B.
    pub normal: DVec2,
    /// Overlap in metres, positive when touching.
    pub overlap: f64,
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
    /// To inelasticity.
    pub inelasticity: f64,
}

impl Contact {
    /// Follows the pair to the state that `touch` describes, in its present mode. A pair that was open begins to load.
    #[inline(always)]
    pub fn follow(&mut self, law: &PairLaw, touch: &Touch, losses: &mut Losses) {
        let before = self.overlap;
        if self.mode == Mode::Open {
            self.mode = Mode::Loading;
        }
        self.overlap = touch.overlap.max(0.0);
        losses.inelasticity += inelasticity::loss(law, self.mode, before, self.overlap);
        if law.friction_static > 0.0 || law.friction_dynamic > 0.0 {
            let displacement = touch.tangential_displacement(law, before);
            self.stretch(law, displacement, losses);
        }
        if touch.overlap <= 0.0 {
            self.mode = Mode::Open;
            self.slipping = false;
        }
    }

    /// Chooses the mode for a pair that parts with `parting` m/s (negative: approaches). Returns what it was before if
    /// that changed anything.
    #[inline]
    pub fn choose_mode(&mut self, law: &PairLaw, parting: f64, losses: &mut Losses) -> Option<Self> {
        let chosen = self.mode.chosen(parting);
        if chosen == self.mode {
            return None;
        }
        let before = *self;
        self.mode = chosen;
        // A weaker normal force holds less friction.
        self.stretch(law, 0.0, losses);
        Some(before)
    }

    #[inline(always)]
    fn stretch(&mut self, law: &PairLaw, displacement: f64, losses: &mut Losses) {
        let normal_force = inelasticity::force(law, self.mode, self.overlap);
        let stretched = tangential::stretch(law, self.elongation, self.slipping, displacement, normal_force);
        self.elongation = stretched.elongation;
        self.slipping = stretched.slipping;
        losses.friction += stretched.loss;
    }

    /// Force on side B in newtons; side A receives the opposite.
    #[inline]
    pub fn force(&self, law: &PairLaw, normal: DVec2) -> DVec2 {
        normal * inelasticity::force(law, self.mode, self.overlap)
            - normal.perp() * (law.tangential_stiffness * self.elongation)
    }

    /// Elastic energy in J, of both springs.
    pub fn energy(&self, law: &PairLaw) -> f64 {
        inelasticity::energy(law, self.overlap) + tangential::energy(law, self.elongation)
    }
}
