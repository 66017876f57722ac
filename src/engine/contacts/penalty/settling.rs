//! The choice of modes from the forces of a state, without regard to the mode before. It serves states that these contacts have
//! not made themselves, and states behind an event, at which forces have jumped.

use super::coulomb::{Grip, Slider, SliderLaw};
use super::indicators::SliderMotion;
use super::normal::{Mode, NormalForce};
use super::pair_law::PairLaw;
use super::rolling_stages;
use super::standing;
use super::switching::{Base, View, standing_mode};
use crate::constraints::{HOLDS, Rows};
use crate::contacts::geometry::PairGeometry;
use crate::world::Bodies;

/// The mode for the acceleration of a contact that stands. `None`: it stays at rest. Two contacts at one point with different
/// curvatures cannot both stay.
fn moves_on(law: &PairLaw, geometry: &PairGeometry, bodies: &Bodies) -> Option<Mode> {
    let rate = geometry.parting_rate(law.shares(), bodies);
    let mobility = geometry.approach(bodies).mobility;
    let size = mobility * law.stiffness * geometry.overlap + geometry.inertial(law.shares(), bodies).0.abs();
    let rounding = geometry.unknown_acceleration(law, mobility, bodies);
    (rate.abs() > (HOLDS * size).max(rounding)).then_some(if rate > 0.0 { Mode::Unloading } else { Mode::Loading })
}

impl View<'_> {
    /// Corrects modes that cannot last under the forces just evaluated. Says whether there were any.
    ///
    /// Friction waits for the normal forces, and for `rows` that contradict each other. A contact that is tried as held has a
    /// separate force until it is released.
    pub fn settle<N: NormalForce>(&mut self, rows: &Rows) -> bool {
        self.open_account();
        let corrected = self.share_cones(true)
            || self.settle_held_friction::<N>()
            || self.settle_normals::<N>()
            || self.settle_unheld()
            || self.settle_contradictions(rows)
            || self.settle_friction::<N>(|grip| grip != Grip::Hold)
            || self.settle_friction::<N>(|grip| grip == Grip::Hold)
            || self.hold_again::<N>();
        if !corrected {
            self.direct_springs();
            self.contacts.slid = self.sliding_energy();
        }
        corrected
    }

    /// Notes the energy and the springs before modes change. The loss of energy is booked when all modes have settled.
    pub(super) fn open_account(&mut self) {
        if self.contacts.held_before.is_none() {
            // Another model may have ended the step: what springs that slip have given in it is lost too.
            let slid = self.close_slides();
            self.contacts.held_before = Some(self.stored(|_| true) + slid);
            self.note_springs();
            self.contacts.stopped.clear();
        }
    }

    /// Springs that stand begin to swing with the forces of the modes that were found. Only beside a normal force that is held does
    /// the end of a swing count.
    fn direct_springs(&mut self) {
        for index in self.touching() {
            if self.contact(index).0.mode != Mode::Hold {
                continue;
            }
            let (geometry, bodies) = (self.look(index), self.bodies);
            let (mut contact, law, roller) = self.whole(index, &geometry);
            if law.tangential().acts() {
                contact.tangential.direct(&SliderMotion::along(&geometry, law.shares(), bodies));
            }
            if let Some((slider, _)) = roller {
                slider.direct(&SliderMotion::of_turning(&geometry, bodies));
            }
        }
    }

    /// Lets friction slide that holds beyond its cone, if a normal force leaves its bounds. A friction without a bound makes normal
    /// forces that the real one does not. So its cone follows from a force within the bounds. Says whether there was any.
    fn settle_held_friction<N: NormalForce>(&mut self) -> bool {
        if !self.touching().into_iter().any(|index| self.is_out_of_band::<N>(index)) {
            return false;
        }
        let mut corrected = false;
        let springs = std::mem::take(&mut self.contacts.before);
        for index in self.touching() {
            let (mut contact, law) = self.contact(index);
            if contact.mode == Mode::Hold && contact.tangential.grip == Grip::Hold {
                let (least, greatest) = N::band(law, contact.overlap, contact.normal_force);
                let base = Base { force: contact.normal_force.min(greatest).max(least), rate: 0.0, is_slack: false };
                let before = springs.get(index).copied().unwrap_or_default();
                corrected |= contact.tangential.settle_force(&law.tangential(), base, before[0], true);
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

    /// Lets go of contacts that are held by forces out of their bounds. Says whether there were any.
    fn settle_normals<N: NormalForce>(&mut self) -> bool {
        let mut corrected = false;
        let springs = std::mem::take(&mut self.contacts.before);
        let mut released = std::mem::take(&mut self.contacts.released);
        for index in self.touching() {
            let (mut contact, law) = self.contact(index);
            let (least, greatest) = N::band(law, contact.overlap, contact.normal_force);
            let (is_below, is_above) = (contact.normal_force < least, contact.normal_force > greatest);
            if contact.mode != Mode::Hold || !(is_below || is_above) {
                continue;
            }
            corrected = true;
            let before = springs.get(index).copied().unwrap_or_default();
            let base = Base { force: least, rate: 0.0, is_slack: false };
            // Its motion may come from springs that were held for a first try. It may also come from springs that
            // stick under no force within the bounds.
            let gives = |slider: &mut Slider, law: &SliderLaw, before: Option<Slider>| {
                let below = is_below && slider.grip == Grip::Stick;
                slider.swing_back(before) || below && slider.settle_force(law, base, None, true)
            };
            let slider_law = law.tangential();
            let gave = slider_law.acts() && gives(&mut contact.tangential, &slider_law, before[0]);
            drop(contact);
            let geometry = self.look(index);
            let roller = self.whole(index, &geometry).2;
            let rolled = roller.is_some_and(|(slider, law)| gives(slider, &law, before[1]));
            if gave || rolled {
                continue;
            }
            self.release(index, if is_below { Mode::Unloading } else { Mode::Loading }, before);
            released.push(index as u32);
        }
        (self.contacts.before, self.contacts.released) = (springs, released);
        corrected
    }

    /// A held contact goes on in a mode. Its springs are as drawn as `before`: a slide that was tried at this moment drew none.
    /// Friction that slid up to this moment slides on.
    pub(super) fn release(&mut self, index: usize, mode: Mode, mut before: [Option<Slider>; 2]) {
        if self.contacts.stopped.contains(&(index as u32)) {
            before[0] = None;
        }
        let geometry = self.look(index);
        let (mut contact, law, roller) = self.whole(index, &geometry);
        contact.mode = mode;
        contact.tangential.undo_slide(before[0]);
        contact.adapt_friction(law, &geometry);
        if let Some((slider, law)) = roller {
            slider.undo_slide(before[1]);
            rolling_stages::adapt((slider, law), &contact, &geometry);
        }
    }

    /// Lets go of contacts that no force holds, once all that hold are within their bounds. Says whether there were any.
    fn settle_unheld(&mut self) -> bool {
        let mut corrected = false;
        for index in self.touching() {
            if self.contact(index).0.mode != Mode::Hold {
                continue;
            }
            let (geometry, bodies) = (self.look(index), self.bodies);
            let law = self.contact(index).1;
            if let Some(mode) = moves_on(law, &geometry, bodies) {
                let before = self.contacts.before.get(index).copied().unwrap_or_default();
                self.release(index, mode, before);
                corrected = true;
            }
        }
        corrected
    }

    /// Lets springs swing where rows contradict each other, because friction that holds is a row too. Says whether there were any.
    /// Those tried as held at this moment come first: without them, the others may hold.
    fn settle_contradictions(&mut self, rows: &Rows) -> bool {
        let holds = |slider: &Slider| slider.grip == Grip::Hold;
        let some_hold = self.touching().into_iter().any(|index| {
            let geometry = self.look(index);
            let (contact, _, roller) = self.whole(index, &geometry);
            holds(&contact.tangential) || roller.is_some_and(|(slider, _)| holds(slider))
        });
        if !some_hold {
            return false;
        }
        let reached = rows.contradicted(self.bodies, self.greatest_load());
        !reached.is_empty() && (self.swing_among(&reached, true) || self.swing_among(&reached, false))
    }

    /// The greatest acceleration in m/s2 that a normal force alone would make.
    pub(super) fn greatest_load(&mut self) -> f64 {
        let mut greatest = 0.0_f64;
        for index in self.touching() {
            let mobility = self.look(index).approach(self.bodies).mobility;
            greatest = greatest.max(mobility * self.contact(index).0.normal_force.abs());
        }
        greatest
    }

    /// Lets springs of these bodies swing that hold: those that were `tried`, or the others. Says whether there were any.
    fn swing_among(&mut self, reached: &[usize], tried: bool) -> bool {
        let mut corrected = false;
        let springs = std::mem::take(&mut self.contacts.before);
        for index in self.touching() {
            if !self.movable(index).any(|body| reached.contains(&body)) {
                continue;
            }
            let before = springs.get(index).copied().unwrap_or_default();
            let (geometry, bodies) = (self.look(index), self.bodies);
            let (mut contact, law, roller) = self.whole(index, &geometry);
            if !law.exact && contact.tangential.holds(tried, before[0]) {
                let motion = SliderMotion::along(&geometry, law.shares(), bodies);
                contact.tangential.swing(&law.tangential(), &motion, before[0]);
                corrected = true;
            }
            if let Some((slider, law)) = roller.filter(|(slider, _)| slider.holds(tried, before[1])) {
                slider.swing(&law, &SliderMotion::of_turning(&geometry, bodies), before[1]);
                corrected = true;
            }
        }
        self.contacts.before = springs;
        corrected
    }

    /// Holds the first contact again that was let go and is drawn back by others that were. So the contacts of a body find their
    /// modes together (principal pivoting by the least index: Murty 1974). Says whether there was any. Friction that stands is tried
    /// as held beside it. It is tried once, because it may make the normal force leave its bounds.
    fn hold_again<N: NormalForce>(&mut self) -> bool {
        let mut released = std::mem::take(&mut self.contacts.released);
        released.sort_unstable();
        let twice: Vec<u32> = released.windows(2).filter(|pair| pair[0] == pair[1]).map(|pair| pair[0]).collect();
        released.dedup();
        let drawn_back = |index: &&u32| {
            let (geometry, bodies) = (self.look(**index as usize), self.bodies);
            let (contact, law) = self.contact(**index as usize);
            let still = standing::is_still::<N>(&contact, law, &geometry);
            still && moves_on(law, &geometry, bodies).is_some_and(|mode| mode != contact.mode)
        };
        let first = released.iter().find(drawn_back).copied();
        if let Some(index) = first {
            let (geometry, bodies) = (self.look(index as usize), self.bodies);
            let (mut contact, law, roller) = self.whole(index as usize, &geometry);
            contact.mode = Mode::Hold;
            contact.adapt_friction(law, &geometry);
            if !twice.contains(&index) && !law.exact {
                contact.tangential.hold_still(&law.tangential(), &SliderMotion::along(&geometry, law.shares(), bodies));
                if let Some((slider, law)) = roller {
                    slider.hold_still(&law, &SliderMotion::of_turning(&geometry, bodies));
                }
            }
        }
        self.contacts.released = released;
        first.is_some()
    }

    /// Ends phases of friction whose normal force has jumped. It jumps at the turn from loading to unloading, or as a
    /// dashpot goes slack. A spring beyond the cone slips at once. A spring sticks if it would slip backwards, or is
    /// not stretched to its limit. Returns whether there was any. `which`: only of those grips. Holding friction waits
    /// for springs, because its load depends on them.
    fn settle_friction<N: NormalForce>(&mut self, which: impl Fn(Grip) -> bool) -> bool {
        let mut corrected = false;
        let springs = std::mem::take(&mut self.contacts.before);
        for index in self.touching() {
            let before = springs.get(index).copied().unwrap_or_default();
            let (geometry, bodies) = (self.look(index), self.bodies);
            let (mut contact, law, roller) = self.whole(index, &geometry);
            if contact.mode == Mode::Open {
                continue;
            }
            let base = Base::of::<N>(&contact, law, &geometry, bodies);
            if law.tangential().acts() && which(contact.tangential.grip) {
                let motion = (geometry.sliding(law.shares()), geometry.speed(law.shares()));
                let rigid = contact.holds_rigidly(law);
                let slider = &mut contact.tangential;
                // A spring that gives has its new elongation once it was evaluated.
                corrected |= slider.settle_jump(&law.tangential(), before[0], motion.0)
                    || slider.settle_force(&law.tangential(), base, before[0], rigid)
                    || !(law.exact || slider.yielded(before[0]))
                        && slider.settle_motion(&law.tangential(), base, motion);
            }
            let rests = contact.mode == Mode::Hold;
            if let Some((slider, law)) = roller.filter(|(slider, _)| which(slider.grip)) {
                let motion = (geometry.turning(), geometry.turning_speed());
                corrected |= slider.settle_jump(&law, before[1], motion.0)
                    || slider.settle_force(&law, base, before[1], rests)
                    || !slider.yielded(before[1]) && slider.settle_motion(&law, base, motion);
            }
        }
        self.contacts.before = springs;
        corrected
    }

    /// Chooses all modes of a state that did not follow from the one before.
    pub fn take_stock<N: NormalForce>(&mut self) {
        let mut fresh = Vec::new();
        for index in 0..self.len() {
            let geometry = self.look(index);
            let (mut contact, law, roller) = self.whole(index, &geometry);
            if contact.mode == Mode::Open && geometry.overlap > 0.0 {
                contact.overlap = geometry.overlap;
                contact.begin::<N>(law, &geometry, None);
                if let Some(roller) = roller {
                    rolling_stages::begin(roller, &contact, &geometry, None);
                }
                fresh.push(index as u32);
            }
            if contact.mode != Mode::Open && contact.mode != Mode::Hold {
                contact.mode = standing_mode::<N>(law, contact.mode, geometry.parting());
            }
        }
        self.contacts.fresh = fresh;
    }
}
