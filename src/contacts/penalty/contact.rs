//! One contact: its history, and what a touch does to it.

use glam::DVec2;

use super::inelasticity::{self, Mode};
use super::law::PairLaw;
use super::tangential::{self, Grip};

/// History of a candidate pair.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Contact {
    /// Distance of centres (or height over a wall) below which the pair touches, in metres.
    pub reach: f64,
    /// Place of its law.
    pub law: u32,
    /// Phase of the normal law.
    pub mode: Mode,
    /// Phase of the tangential law.
    pub grip: Grip,
    /// Normal force in newtons while the normal law holds.
    pub held_normal: f64,
    /// Tangential force in newtons while the tangential law holds; it counts as the pull of the spring does.
    pub held_tangential: f64,
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
    /// `elapsed` seconds have passed since the last accepted state.
    #[inline(always)]
    pub fn follow(&mut self, law: &PairLaw, touch: &Touch, elapsed: f64, losses: &mut Losses) {
        let before = self.overlap;
        if self.mode == Mode::Open {
            self.mode = Mode::Loading;
        }
        self.overlap = touch.overlap.max(0.0);
        losses.inelasticity += match self.mode {
            Mode::Hold => {
                let stored = inelasticity::energy(law, self.overlap) - inelasticity::energy(law, before);
                self.held_normal * (self.overlap - before) - stored
            }
            mode => inelasticity::loss(law, mode, before, self.overlap),
        };
        if law.friction_static > 0.0 || law.friction_dynamic > 0.0 {
            let displacement = (elapsed > 0.0).then(|| touch.tangential_displacement(law, before));
            if self.grip == Grip::Hold {
                losses.friction += self.held_tangential * displacement.unwrap_or(0.0);
            } else {
                self.stretch(law, displacement, losses);
            }
        }
        if touch.overlap <= 0.0 {
            losses.friction += tangential::energy(law, self.elongation);
            *self = Self { reach: self.reach, law: self.law, ..Self::default() };
        }
    }

    /// Chooses the mode for a pair that parts with `parting` m/s (negative: approaches). Returns what it was before if
    /// that changed anything.
    #[inline]
    pub fn choose_mode(&mut self, law: &PairLaw, parting: f64, losses: &mut Losses) -> Option<Self> {
        let chosen = self.mode.chosen(parting);
        if chosen == self.mode && self.grip != Grip::Hold {
            return None;
        }
        let before = *self;
        self.mode = chosen;
        self.let_go(law, losses);
        // A weaker normal force holds less friction.
        self.stretch(law, None, losses);
        Some(before)
    }

    /// Holds along the normal with `normal` newtons, and along the tangent if `tangential` newtons are given.
    pub fn hold(&mut self, law: &PairLaw, normal: f64, tangential: Option<f64>, losses: &mut Losses) {
        self.mode = Mode::Hold;
        self.held_normal = normal;
        if let Some(tangential) = tangential {
            self.grip = Grip::Hold;
            self.held_tangential = tangential;
        } else {
            self.let_go(law, losses);
            self.stretch(law, None, losses);
        }
    }

    /// The spring takes over from a hold.
    fn let_go(&mut self, law: &PairLaw, losses: &mut Losses) {
        if self.grip == Grip::Hold {
            let elongation = tangential::released(law, self.elongation, self.held_tangential);
            losses.friction += tangential::energy(law, self.elongation) - tangential::energy(law, elongation);
            self.elongation = elongation;
            self.grip = Grip::Stick;
        }
    }

    #[inline(always)]
    fn stretch(&mut self, law: &PairLaw, displacement: Option<f64>, losses: &mut Losses) {
        if law.tangential_stiffness > 0.0 {
            let stretched = tangential::stretch(law, self.elongation, self.grip, displacement, self.normal_force(law));
            self.elongation = stretched.elongation;
            self.grip = stretched.grip;
            losses.friction += stretched.loss;
        }
    }

    /// Normal force in newtons.
    #[inline]
    pub fn normal_force(&self, law: &PairLaw) -> f64 {
        match self.mode {
            Mode::Hold => self.held_normal,
            mode => inelasticity::force(law, mode, self.overlap),
        }
    }

    /// Tangential force in newtons: positive pulls side B back along the tangent.
    #[inline]
    pub fn tangential_force(&self, law: &PairLaw) -> f64 {
        match self.grip {
            Grip::Hold => self.held_tangential,
            Grip::Stick | Grip::Slip => law.tangential_stiffness * self.elongation,
        }
    }

    /// Force on side B in newtons; side A receives the opposite.
    #[inline]
    pub fn force(&self, law: &PairLaw, normal: DVec2) -> DVec2 {
        normal * self.normal_force(law) - normal.perp() * self.tangential_force(law)
    }

    /// Elastic energy in J, of both springs.
    pub fn energy(&self, law: &PairLaw) -> f64 {
        inelasticity::energy(law, self.overlap) + tangential::energy(law, self.elongation)
    }
}
