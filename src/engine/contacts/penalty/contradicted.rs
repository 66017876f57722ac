//! Rigid friction that contradicts other rows. Wheels that motors turn at one rate each cannot all roll without slip on a bent line.
//! Springs of friction give then. Rigid friction ([`super::TangentialLaw::Exact`]) has nothing that gives, so the equations have no
//! solution. The solver holds some of the rows, and the motion is not that of the scene.

use super::coulomb::Grip;
use super::normal::Mode;
use super::switching::View;
use crate::constraints::Rows;
use serde::{Deserialize, Serialize};

/// A body that rigid friction holds against other rows.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Contradicted {
    /// The index of the body.
    pub body: usize,
    /// The first such moment in s.
    pub since: f64,
}

impl View<'_> {
    /// Notes the first body whose rigid friction contradicts others of these rows. They were solved for the present state, that of
    /// `time` seconds.
    pub(super) fn note_contradicted(&mut self, rows: &Rows, time: f64) {
        if self.contacts.contradicted.is_some() {
            return;
        }
        let mut gripped = self.touching();
        gripped.retain(|index| {
            let (contact, law) = self.contact(*index);
            law.exact && contact.mode == Mode::Hold && contact.tangential.grip == Grip::Hold
        });
        if gripped.is_empty() {
            return;
        }
        let reached = rows.contradicted(self.bodies, self.greatest_load());
        let body = gripped.into_iter().flat_map(|index| self.movable(index)).find(|body| reached.contains(body));
        self.contacts.contradicted = body.map(|body| Contradicted { body, since: time });
    }
}
