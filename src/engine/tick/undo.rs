//! Undo of a tick. Its ways still count among those of ticks, as that of a trial.

use glam::DVec2;

use super::{Ledger, Tick};

/// The state at the beginning of a tick. Candidate lists keep their state, and models must have no history of the tick.
#[derive(Default)]
pub struct Undo {
    position: Vec<DVec2>,
    angle: Vec<f64>,
    velocity: Vec<DVec2>,
    spin: Vec<f64>,
    ledger: Ledger,
}

impl Tick<'_> {
    /// Remembers the present state.
    pub fn remember(&self, undo: &mut Undo) {
        let bodies = &self.state.bodies;
        undo.position.clone_from(&bodies.position);
        undo.angle.clone_from(&bodies.angle);
        undo.velocity.clone_from(&bodies.velocity);
        undo.spin.clone_from(&bodies.spin);
        undo.ledger.clone_from(&self.state.ledger);
    }

    /// Goes back to the state that was remembered. It is to be evaluated.
    pub fn take_back(&mut self, undo: &Undo) {
        let bodies = self.bodies();
        bodies.position.clone_from(&undo.position);
        bodies.angle.clone_from(&undo.angle);
        bodies.velocity.clone_from(&undo.velocity);
        bodies.spin.clone_from(&undo.spin);
        bodies.estimated_velocity.clear();
        bodies.estimated_spin.clear();
        self.state.ledger.clone_from(&undo.ledger);
    }
}
