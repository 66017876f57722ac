//! The Coulomb slider (Cundall and Strack 1979): a spring with a Coulomb limit, for tangential friction and rolling
//! resistance.
//!
//! The spring's elongation `s` follows a displacement (along the contact, or the turn of one side against the other).
//! It pulls with `k s` as long as that is at most `mu N`. Beyond that it slips, and the elongation is `mu N / k`. A
//! sticking spring yields at the static coefficient, and the dynamic one limits a slipping spring. The energy in the
//! spring when the contact opens, and the work of slipping, are lost to friction.
//!
//! At rest the law is set-valued: every force up to `mu N` keeps the contact at rest. The balance of forces determines
//! it ([`crate::constraints::rest_solver`]). From then on friction is rigid until the contact opens. No motion stretches its spring any
//! more, which would have to give way first whenever loads change.

use super::indicators::SliderMotion;
use super::normal::Mode;
use super::switching::Base;
use crate::constraints::rest_solver::{CoulombSpring, FrictionOutcome, SpringPhase};
use serde::{Deserialize, Serialize};

/// A share of a force or of a velocity that counts as rounding.
pub(super) const ROUNDING: f64 = 1e-12;

/// A spring that begins to stick has the force with which it slipped. The normal force of the rows then differs by at
/// most this share.
const BEYOND: f64 = 1e-9;

/// A swing of less than this share of its spring's limit is rounding: forces of dependent rows leave 1e-10.
const STILL: f64 = 1e-9;

/// Phase of a spring with a Coulomb limit.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Grip {
    /// The spring holds.
    #[default]
    Stick,
    /// The spring has given way and pulls with `mu N`. In stages of a step the direction is that of [`Slider::held`].
    Slip,
    /// At rest: the force is whatever keeps it so, up to the static limit.
    Hold,
    /// It slides against the force in [`Slider::held`], without its spring. It has rested before, or rests along the normal.
    Slide,
}

impl Grip {
    /// Whether it slips or slides.
    pub(super) fn gives(self) -> bool {
        matches!(self, Self::Slip | Self::Slide)
    }

    /// Whether it acts without its spring.
    pub(super) fn is_rigid(self) -> bool {
        matches!(self, Self::Hold | Self::Slide)
    }
}

/// Coefficients of a spring with a Coulomb limit. For rolling, forces are torques, displacements angles and the
/// coefficients lengths.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SliderLaw {
    /// In N/m; above zero if a coefficient is.
    pub stiffness: f64,
    /// Coulomb coefficient while it holds.
    pub friction_static: f64,
    /// Coulomb coefficient while it slips.
    pub friction_dynamic: f64,
}

impl SliderLaw {
    /// Whether there is any friction.
    #[inline]
    pub fn acts(&self) -> bool {
        self.friction_static > 0.0
    }

    /// Elongation in metres of a spring that slips.
    pub(super) fn slipped(&self, normal_force: f64) -> f64 {
        self.friction_dynamic * normal_force / self.stiffness
    }
}

/// A spring with a Coulomb limit.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Slider {
    /// Elongation in metres.
    pub elongation: f64,
    /// Force in newtons while it holds or slides; it counts as the pull of the spring does.
    pub held: f64,
    /// Its phase.
    pub grip: Grip,
}

impl Slider {
    /// Force in newtons: positive pulls side B back.
    #[inline]
    pub fn force(&self, law: &SliderLaw) -> f64 {
        match self.grip {
            Grip::Hold | Grip::Slide => self.held,
            Grip::Stick | Grip::Slip => law.stiffness * self.elongation,
        }
    }

    /// The force in newtons of a slip or slide in a stage of a step. Behind the moment at which its contact is let go, both forces pull.
    pub(super) fn sliding_force(&self, law: &SliderLaw, normal_force: f64) -> f64 {
        law.friction_dynamic.copysign(self.held) * normal_force
    }

    /// Slips or slides against the force of a normal force.
    pub(super) fn slide(&mut self, law: &SliderLaw, normal_force: f64) {
        self.held = (law.friction_dynamic * normal_force).abs().copysign(self.held);
        if self.grip == Grip::Slip {
            self.elongation = self.held / law.stiffness;
        }
    }

    /// Gives way with a force of this sign. A spring slips if it is not `rigid`.
    pub(super) fn give(&mut self, positive: bool, rigid: bool) {
        self.grip = if rigid { Grip::Slide } else { Grip::Slip };
        self.held = 0.0_f64.copysign(if positive { 1.0 } else { -1.0 });
    }

    /// Stops. A spring that slipped sticks.
    pub(super) fn stop(&mut self) {
        self.grip = if self.grip == Grip::Slip { Grip::Stick } else { Grip::Hold };
    }

    /// Whether its elongation is state in stages of a step.
    pub(super) fn is_state(&self, mode: Mode) -> bool {
        self.grip == Grip::Stick && mode != Mode::Open
    }

    /// Follows the mode of its contact, whose sides move with `velocity`. At rest along the normal a slip goes on without its spring.
    pub(super) fn adapt(&mut self, mode: Mode, velocity: f64) {
        match self.grip {
            Grip::Slip if mode == Mode::Hold => self.grip = Grip::Slide,
            Grip::Stick => self.held = 0.0_f64.copysign(velocity),
            _ => {}
        }
    }

    /// The spring as the search for rest sees it.
    pub(super) fn drawn(&self, law: &SliderLaw) -> CoulombSpring {
        let SliderLaw { friction_static: limit, friction_dynamic: slips, .. } = *law;
        let gives = if self.grip == Grip::Slip { slips } else { limit };
        let phase = match self.grip {
            Grip::Hold => SpringPhase::Holds,
            Grip::Slide => SpringPhase::Slides,
            Grip::Slip => SpringPhase::Slips,
            Grip::Stick => SpringPhase::Follows,
        };
        CoulombSpring { limit, gives, slips, force: self.force(law), phase }
    }

    /// Elastic energy in J.
    #[inline]
    pub fn energy(&self, law: &SliderLaw) -> f64 {
        0.5 * law.stiffness * self.elongation * self.elongation
    }

    /// Follows a displacement in metres under the normal force `normal_force`. Returns the energy lost in J.
    ///
    /// `None`: no time has passed, only the normal force may be another one. A contact that slips begins to stick by
    /// moving back, never by being looked at.
    ///
    /// `rests`: its contact is held in this tick by a normal force that has a band. A slip keeps its force then. In the tick of a turn, the normal
    /// force depends on the time of the turn. A spring that stuck by it would bear more than one that slips.
    #[inline(always)]
    pub fn follow(&mut self, law: &SliderLaw, displacement: Option<f64>, normal_force: f64, rests: bool) -> f64 {
        if self.grip.is_rigid() || rests && self.grip == Grip::Slip {
            return self.force(law) * displacement.unwrap_or(0.0);
        }
        let before = self.elongation;
        let trial = before + displacement.unwrap_or(0.0);
        let coefficient = if self.grip == Grip::Slip { law.friction_dynamic } else { law.friction_static };
        let beyond = law.stiffness * trial.abs() > coefficient * normal_force;
        if !beyond && displacement.is_none() {
            return 0.0;
        }
        (self.grip, self.elongation) =
            if beyond { (Grip::Slip, law.slipped(normal_force).copysign(trial)) } else { (Grip::Stick, trial) };
        // Mean force times the displacement that the spring did not take up.
        0.5 * law.stiffness * (before + self.elongation) * (trial - self.elongation)
    }

    /// Makes a spring stick that slipped in the state `before`, if its limit has jumped beyond that. Only the motion of
    /// its ends stretches it farther. They slide with the relative velocity `velocity`. Returns whether it did.
    pub(super) fn settle_jump(&mut self, law: &SliderLaw, before: Option<Self>, velocity: f64) -> bool {
        let Some(drawn) = before.filter(|before| before.grip == Grip::Slip).map(|before| before.elongation) else {
            return false;
        };
        let short = self.grip == Grip::Slip && self.held.abs() > law.stiffness * drawn.abs() * (1.0 + ROUNDING);
        if short {
            *self = Self { grip: Grip::Stick, elongation: drawn, held: 0.0_f64.copysign(velocity) };
        }
        short
    }

    /// Whether it held `before` and slides now. Forces have chosen its direction, and its velocity is a rounding remainder.
    pub(super) fn yielded(&self, before: Option<Self>) -> bool {
        self.grip == Grip::Slide && before.is_some_and(|before| before.grip == Grip::Hold)
    }

    /// Takes back a slip or slide that was tried at one moment with another grip in the state `before`.
    pub(super) fn undo_slide(&mut self, before: Option<Self>) {
        if let Some(before) = before.filter(|before| self.grip.gives() && before.grip != self.grip) {
            *self = before;
        }
    }

    /// Lets a sticking spring hold whose swing is rounding, below a normal force that comes to be held. A long step would make that
    /// swing grow. A spring whose ends stand is tried as held, too. Rounding decides whether its ends stopped before the normal did.
    pub(super) fn stop_still_swing(&mut self, law: &SliderLaw, normal_force: f64, motion: &SliderMotion) {
        let limit = law.friction_static * normal_force / law.stiffness;
        let swing = self.elongation.hypot(motion.velocity / (law.stiffness * motion.mobility).sqrt());
        if self.grip == Grip::Stick && law.acts() && swing <= STILL * limit {
            (self.grip, self.held) = (Grip::Hold, self.force(law));
        }
        self.hold_still(law, motion);
    }

    /// Tries a sticking spring as held whose ends stand.
    pub(super) fn hold_still(&mut self, law: &SliderLaw, motion: &SliderMotion) {
        if self.grip == Grip::Stick && law.acts() && motion.is_still() {
            (self.grip, self.held) = (Grip::Hold, self.force(law));
        }
    }

    /// A spring that sticks and stands begins its swing in the direction of the forces. The sign of a velocity of rounding would end
    /// it at once, and at each new beginning.
    pub(super) fn direct(&mut self, motion: &SliderMotion) {
        if self.grip == Grip::Stick && motion.is_still() {
            self.held = 0.0_f64.copysign(motion.rate);
        }
    }

    /// Lets a spring swing back that stuck `before`, and was tried as held at its turning point. Returns whether it
    /// did.
    pub(super) fn swing_back(&mut self, before: Option<Self>) -> bool {
        let Some(before) = before.filter(|before| before.grip == Grip::Stick && self.grip == Grip::Hold) else {
            return false;
        };
        *self = Self { held: 0.0_f64.copysign(-before.held), ..before };
        true
    }

    /// Whether it holds. `tried`: those that stuck `before` and are tried as held, or those that held before.
    pub(super) fn holds(&self, tried: bool, before: Option<Self>) -> bool {
        self.grip == Grip::Hold && tried == before.is_some_and(|before| before.grip == Grip::Stick)
    }

    /// Swings as it did `before`, or on from where it holds.
    pub(super) fn swing(&mut self, law: &SliderLaw, motion: &SliderMotion, before: Option<Self>) {
        if !self.swing_back(before) {
            self.let_go(law);
            self.held = 0.0_f64.copysign(motion.rate);
        }
    }

    /// Lets a spring slip that is beyond its cone, or swing back if it stuck `before`. `rigid`: it slides. Says whether it was.
    pub(super) fn settle_force(&mut self, law: &SliderLaw, base: Base, before: Option<Self>, rigid: bool) -> bool {
        // At the beginning or end of a contact, rounding may leave a normal force below zero.
        let (force, limit) = (self.force(law), law.friction_static * base.force.max(0.0));
        let gives = match self.grip {
            Grip::Hold => force.abs() > limit,
            Grip::Stick => force.abs() > limit * (1.0 + BEYOND),
            Grip::Slip | Grip::Slide => false,
        };
        if gives && !self.swing_back(before) {
            let slides = rigid || self.grip == Grip::Hold;
            (self.grip, self.held) = (if slides { Grip::Slide } else { Grip::Slip }, force);
        }
        gives
    }

    /// Lets a spring stick that would slip against its force, and one slip that would stick without any normal force. Turns a slide
    /// round that took over the force of a spring which pushed along the motion. Its ends
    /// move past each other with `velocity`, a difference of velocities as great as `speed`. Says whether there was either. Without
    /// any speed it keeps the direction that forces have chosen.
    pub(super) fn settle_motion(&mut self, law: &SliderLaw, base: Base, (velocity, speed): (f64, f64)) -> bool {
        let follows = law.friction_dynamic.copysign(self.held) * base.rate / law.stiffness;
        let rounding = ROUNDING * (speed + follows.abs());
        match self.grip {
            // Friction of a slack contact has no force in either grip. The sign of a velocity of rounding would change it without end.
            Grip::Slip if base.is_slack => return false,
            Grip::Slide if velocity * self.held.signum() < -ROUNDING * speed => {
                self.held = self.held.abs().copysign(velocity);
            }
            Grip::Stick if base.is_slack && self.force(law) == 0.0 => {
                (self.grip, self.held) = (Grip::Slip, 0.0_f64.copysign(velocity));
            }
            Grip::Slip if speed > 0.0 && (velocity - follows) * self.held.signum() < -rounding => {
                // A holding spring remembers its direction.
                (self.grip, self.held) = (Grip::Stick, 0.0_f64.copysign(velocity));
            }
            Grip::Stick if base.force == 0.0 && velocity.abs() > rounding && !base.bears(law, velocity) => {
                (self.grip, self.held) = (Grip::Slip, 0.0_f64.copysign(velocity));
            }
            _ => return false,
        }
        true
    }

    /// Applies the friction that was found for the next tick, under the normal force `normal_force`. Returns the energy
    /// lost in J.
    pub(super) fn take_on(&mut self, law: &SliderLaw, friction: FrictionOutcome, normal_force: f64) -> f64 {
        match friction {
            FrictionOutcome::Holds(force) => {
                (self.grip, self.held) = (Grip::Hold, force);
                0.0
            }
            FrictionOutcome::Slides(against) => {
                let lost = if self.grip == Grip::Slip { self.energy(law) } else { 0.0 };
                if lost > 0.0 {
                    self.elongation = 0.0;
                }
                (self.grip, self.held) = (Grip::Slide, (law.friction_dynamic * normal_force).copysign(against));
                lost
            }
            FrictionOutcome::Lands if self.grip == Grip::Slip => {
                self.grip = Grip::Stick;
                self.follow(law, None, normal_force, false)
            }
            FrictionOutcome::Follows | FrictionOutcome::Lands => {
                self.let_go(law) + self.follow(law, None, normal_force, false)
            }
        }
    }

    /// The phase in the next tick, for the friction that was found for it.
    pub(super) fn grip_after(&self, friction: FrictionOutcome) -> Grip {
        match (friction, self.grip) {
            (FrictionOutcome::Holds(_), _) => Grip::Hold,
            (FrictionOutcome::Slides(_), _) => Grip::Slide,
            (_, Grip::Hold | Grip::Stick) => Grip::Stick,
            (_, Grip::Slide | Grip::Slip) => Grip::Slip,
        }
    }

    /// The spring replaces a hold or a slide, as far as its energy allows. Returns the energy lost in J.
    pub fn let_go(&mut self, law: &SliderLaw) -> f64 {
        if !self.grip.is_rigid() {
            return 0.0;
        }
        let before = self.energy(law);
        let wanted = (self.held / law.stiffness).abs();
        self.elongation = wanted.min(self.elongation.abs()).copysign(self.held);
        self.grip = if self.grip == Grip::Slide { Grip::Slip } else { Grip::Stick };
        before - self.energy(law)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LAW: SliderLaw = SliderLaw { stiffness: 80.0, friction_static: 0.6, friction_dynamic: 0.4 };

    #[test]
    fn a_sticking_spring_holds_up_to_the_static_limit_and_loses_nothing() {
        let mut slider = Slider::default();
        assert_eq!(slider.follow(&LAW, Some(0.59 * 10.0 / 80.0), 10.0, false), 0.0);
        assert_eq!(slider.grip, Grip::Stick);
        slider.follow(&LAW, Some(0.02 * 10.0 / 80.0), 10.0, false);
        assert_eq!(slider.grip, Grip::Slip);
        assert_eq!(slider.elongation, 0.4 * 10.0 / 80.0);
    }

    #[test]
    fn a_spring_that_is_let_go_never_has_more_energy_than_it_had() {
        for (before, held, after) in [(0.1, 4.0, 0.05), (0.1, -4.0, -0.05), (-0.01, 4.0, 0.01)] {
            let mut slider = Slider { elongation: before, held, grip: Grip::Hold };
            let loss = slider.let_go(&LAW);
            assert_eq!(slider.elongation, after);
            assert_eq!(loss, 40.0 * (before * before) - 40.0 * (after * after));
        }
    }

    #[test]
    fn steady_slip_loses_force_times_way() {
        let limit = 0.4 * 10.0 / 80.0;
        let mut slider = Slider { elongation: limit, held: 0.0, grip: Grip::Slip };
        let loss = slider.follow(&LAW, Some(0.01), 10.0, false);
        assert!((loss - 0.4 * 10.0 * 0.01).abs() < 1e-15);
    }
}
