//! Contacts that are held while velocities jump, as a rope becomes taut or a limit is reached. A spring gives no impulse, so the jump
//! goes past it. A contact whose sides move afterwards comes loose, or its hold would take that motion away.

use super::coulomb::Grip;
use super::normal::Mode;
use super::switching::View;
use crate::contacts::geometry::PairGeometry;

/// Whether one side turns on the other by more than rounding, for a velocity in m/s at the contact.
fn turns(geometry: &PairGeometry, rounding: f64) -> bool {
    geometry.turning().abs() * geometry.pair.b.radius > rounding
}

impl View<'_> {
    /// Lets go of what is held and moves after a jump of velocities.
    pub fn come_loose_by_blow(&mut self) {
        let mut moving = self.touching();
        moving.retain(|&index| self.moves_though_held(index));
        if moving.is_empty() {
            return;
        }
        self.open_account();
        for &index in &moving {
            let geometry = self.look(index);
            let parts = geometry.parting();
            if self.contact(index).0.mode == Mode::Hold && parts.abs() > self.rounding_of_velocity(index) {
                self.release(index, if parts > 0.0 { Mode::Unloading } else { Mode::Loading }, [None, None]);
            }
            self.let_slide(index);
        }
    }

    fn moves_though_held(&mut self, index: usize) -> bool {
        let (geometry, rounding) = (self.look(index), self.rounding_of_velocity(index));
        let turns = turns(&geometry, rounding);
        let (contact, law, roller) = self.whole(index, &geometry);
        let parts = contact.mode == Mode::Hold && geometry.parting().abs() > rounding;
        let grips = contact.tangential.grip == Grip::Hold;
        let slides = grips && law.tangential().acts() && geometry.sliding(law.shares()).abs() > rounding;
        let rolls = turns && roller.is_some_and(|(slider, _)| slider.grip == Grip::Hold);
        parts || slides || rolls
    }

    /// Lets a friction slide that is held between sides that slide or turn.
    fn let_slide(&mut self, index: usize) {
        let (geometry, rounding) = (self.look(index), self.rounding_of_velocity(index));
        let turns = turns(&geometry, rounding);
        let (mut contact, law, roller) = self.whole(index, &geometry);
        let sliding = geometry.sliding(law.shares());
        if contact.tangential.grip == Grip::Hold && law.tangential().acts() && sliding.abs() > rounding {
            contact.give(law, sliding > 0.0);
        }
        let normal_force = contact.normal_force;
        drop(contact);
        if let Some((slider, law)) = roller.filter(|(slider, _)| turns && slider.grip == Grip::Hold) {
            slider.give(geometry.turning() > 0.0, true);
            slider.slide(&law, normal_force);
        }
    }
}
