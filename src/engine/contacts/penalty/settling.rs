//! The choice of modes from the forces of a state, without regard to the mode before. It serves states that these contacts have
//! not made themselves, and states behind an event, at which forces have jumped.

use super::coulomb::{Grip, Slider, SliderLaw};
use super::normal::{Mode, NormalForce};
use super::pair_law::PairLaw;
use super::rolling_stages;
use super::switching::{Base, View, standing};
use crate::constraints::HOLDS;
use crate::contacts::geometry::PairGeometry;
use crate::world::Bodies;

/// The mode of a contact that is not held although it should be. Two contacts at one point with different curvatures
/// cannot both stay.
fn moves_on(law: &PairLaw, geometry: &PairGeometry, bodies: &Bodies) -> Option<Mode> {
    let rate = geometry.parting_rate(law.shares(), bodies);
    let pushed = geometry.approach(bodies).mobility * law.stiffness * geometry.overlap;
    let size = pushed + geometry.inertial(law.shares(), bodies).0.abs();
    (rate.abs() > HOLDS * size).then_some(if rate > 0.0 { Mode::Unloading } else { Mode::Loading })
}

impl View<'_> {
    /// Corrects modes that cannot last under the forces just evaluated. Says whether there were any.
    ///
    /// Friction waits for the normal forces. A contact that is tried as held has a separate force until it is released.
    pub fn settle<N: NormalForce>(&mut self) -> bool {
        if self.contacts.held_before.is_none() {
            // Another model may have ended the step: what springs that slip have given in it is lost too.
            let slid = self.close_slides();
            self.contacts.held_before = Some(self.stored(|_| true) + slid);
            self.contacts.before.clear();
            self.contacts.stopped.clear();
        }
        let corrected = self.settle_held_friction::<N>()
            || self.settle_normals::<N>()
            || self.settle_friction::<N>(|grip| grip != Grip::Hold)
            || self.settle_friction::<N>(|grip| grip == Grip::Hold);
        if !corrected {
            self.contacts.slid = self.sliding_energy();
        }
        corrected
    }

    /// Lets friction slide that holds beyond its cone, if a normal force leaves its bounds. A friction without a bound makes normal
    /// forces that the real one does not. So its cone follows from a force within the bounds. Says whether there was any.
    fn settle_held_friction<N: NormalForce>(&mut self) -> bool {
        if !(0..self.len()).any(|index| self.is_out_of_band::<N>(index)) {
            return false;
        }
        let mut corrected = false;
        let springs = std::mem::take(&mut self.contacts.before);
        for index in 0..self.len() {
            let (mut contact, law) = self.contact(index);
            if contact.mode == Mode::Hold && contact.tangential.grip == Grip::Hold {
                let (least, greatest) = N::band(law, contact.overlap, contact.normal_force);
                let base = Base { force: contact.normal_force.min(greatest).max(least), rate: 0.0 };
                let before = springs.get(index).copied().unwrap_or_default();
                corrected |= contact.tangential.settle_force(&law.tangential(), base, before[0]);
            }
        }
        self.contacts.before = springs;
        corrected
    }

    /// Whether a normal force that is held has left its bounds.
    fn is_out_of_band<N: NormalForce>(&mut self, index: usize) -> bool {
        let (contact, law) = self.contact(index);
        let (least, greatest) = N::band(law, contact.overlap, contact.normal_force);
        contact.mode == Mode::Hold && (contact.normal_force < least || contact.normal_force > greatest)
    }

    /// Lets go of contacts that are held by forces out of their bounds, and of those that no force holds. Says whether there were any.
    fn settle_normals<N: NormalForce>(&mut self) -> bool {
        let mut corrected = false;
        let springs = std::mem::take(&mut self.contacts.before);
        for index in 0..self.len() {
            let before = springs.get(index).copied().unwrap_or_default();
            let (geometry, bodies) = (self.look(index), self.bodies);
            let (mut contact, law, mut roller) = self.whole(index, &geometry);
            if contact.mode != Mode::Hold {
                continue;
            }
            let (least, greatest) = N::band(law, contact.overlap, contact.normal_force);
            if contact.normal_force < least || contact.normal_force > greatest {
                let (base, is_below) = (Base { force: least, rate: 0.0 }, contact.normal_force < least);
                // Its motion may come from springs that were held for a first try. It may also come from springs that
                // stick under no force within the bounds.
                let gives = |slider: &mut Slider, law: &SliderLaw, before: Option<Slider>| {
                    let below = is_below && slider.grip == Grip::Stick;
                    slider.swing_back(before) || below && slider.settle_force(law, base, None)
                };
                let rolls = roller.as_mut().is_some_and(|(slider, law)| gives(slider, law, before[1]));
                let slider_law = law.tangential();
                if slider_law.acts() && gives(&mut contact.tangential, &slider_law, before[0]) || rolls {
                    corrected = true;
                    continue;
                }
                contact.mode = if contact.normal_force < least { Mode::Unloading } else { Mode::Loading };
                contact.come_loose(law, &geometry);
                if let Some((slider, law)) = &mut roller {
                    rolling_stages::come_loose((slider, *law), &contact, &geometry);
                }
                corrected = true;
            } else if let Some(mode) = moves_on(law, &geometry, bodies) {
                contact.mode = mode;
                contact.come_loose(law, &geometry);
                if let Some((slider, law)) = &mut roller {
                    rolling_stages::come_loose((slider, *law), &contact, &geometry);
                }
                corrected = true;
            }
        }
        self.contacts.before = springs;
        corrected
    }

    /// Ends phases of friction whose normal force has jumped. It jumps at the turn from loading to unloading, or as a
    /// dashpot goes slack. A spring beyond the cone slips at once. A spring sticks if it would slip backwards, or is
    /// not stretched to its limit. Returns whether there was any. `which`: only of those grips. Holding friction waits
    /// for springs, because its load depends on them.
    fn settle_friction<N: NormalForce>(&mut self, which: impl Fn(Grip) -> bool) -> bool {
        let mut corrected = false;
        let springs = std::mem::take(&mut self.contacts.before);
        for index in 0..self.len() {
            let before = springs.get(index).copied().unwrap_or_default();
            let (geometry, bodies) = (self.look(index), self.bodies);
            let (mut contact, law, roller) = self.whole(index, &geometry);
            if contact.mode == Mode::Open {
                continue;
            }
            let base = Base::of::<N>(&contact, law, &geometry, bodies);
            if law.tangential().acts() && which(contact.tangential.grip) {
                let motion = (geometry.sliding(law.shares()), geometry.speed(law.shares()));
                let slider = &mut contact.tangential;
                // A spring that gives has its new elongation once it was evaluated.
                corrected |= slider.settle_jump(&law.tangential(), before[0], motion.0)
                    || slider.settle_force(&law.tangential(), base, before[0])
                    || !(law.exact || slider.yielded(before[0]))
                        && slider.settle_motion(&law.tangential(), base, motion);
            }
            if let Some((slider, law)) = roller.filter(|(slider, _)| which(slider.grip)) {
                let motion = (geometry.turning(), geometry.turning_speed());
                corrected |= slider.settle_jump(&law, before[1], motion.0)
                    || slider.settle_force(&law, base, before[1])
                    || !slider.yielded(before[1]) && slider.settle_motion(&law, base, motion);
            }
        }
        self.contacts.before = springs;
        corrected
    }

    /// Chooses all modes of a state that did not follow from the one before.
    pub fn take_stock<N: NormalForce>(&mut self) {
        for index in 0..self.len() {
            let geometry = self.look(index);
            let (mut contact, law, roller) = self.whole(index, &geometry);
            if contact.mode == Mode::Open && geometry.overlap > 0.0 {
                contact.overlap = geometry.overlap;
                contact.begin::<N>(law, &geometry, None);
                if let Some(roller) = roller {
                    rolling_stages::begin(roller, &contact, &geometry, None);
                }
            }
            if contact.mode != Mode::Open && contact.mode != Mode::Hold {
                contact.mode = standing::<N>(law, contact.mode, geometry.parting());
            }
        }
    }
}
