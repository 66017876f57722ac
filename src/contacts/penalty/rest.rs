//! Bodies at rest: islands whose contacts hold every load stand still to the last bit until something changes.
//!
//! A body is laid to rest only with its whole island, when [`super::hold`] found forces within the bounds of the contact
//! law that balance all loads and take the last velocity away. It stays while the sum of all forces on it does not change
//! by a bit; anything new (a touch, another load, a changed velocity or place) wakes it.

use bevy_ecs::prelude::*;
use glam::DVec2;

use super::apply::PenaltyContacts;
use crate::tick::Balance;
use crate::world::Bodies;

/// Largest imbalance of a body laid to rest, as a share of the forces on it: what rounding leaves.
const IMBALANCE: f64 = 1e-9;

/// A body at rest.
#[derive(Clone, Copy, Debug)]
struct Resting {
    body: usize,
    position: DVec2,
    angle: f64,
    /// Force against which its imbalance is judged, in newtons; see [`super::hold::loads`].
    load: f64,
    /// Sum of all forces and torques: what rounding leaves of zero. `None` before the first evaluation.
    left_over: Option<(DVec2, f64)>,
}

/// Which bodies are at rest.
#[derive(Debug, Default)]
pub(super) struct Rest {
    generation: u64,
    resting: Vec<Resting>,
    /// For each body whether it is at rest.
    still: Vec<bool>,
}

impl Rest {
    /// Whether `body` is at rest.
    #[inline]
    pub fn has(&self, body: usize) -> bool {
        self.still.get(body).copied().unwrap_or(false)
    }

    /// Whether any body is.
    pub fn is_empty(&self) -> bool {
        self.resting.is_empty()
    }

    /// Lays `body` to rest under contact forces of `load` newtons in all: velocities become zero.
    pub fn lay(&mut self, body: usize, load: f64, bodies: &mut Bodies) {
        self.generation = bodies.generation;
        self.still.resize(bodies.len(), false);
        self.still[body] = true;
        bodies.velocity[body] = DVec2::ZERO;
        bodies.spin[body] = 0.0;
        if !bodies.estimated_velocity.is_empty() {
            bodies.estimated_velocity[body] = DVec2::ZERO;
            bodies.estimated_spin[body] = 0.0;
        }
        bodies.force[body] = DVec2::ZERO;
        bodies.torque[body] = 0.0;
        let (position, angle) = (bodies.position[body], bodies.angle[body]);
        self.resting.push(Resting { body, position, angle, load, left_over: None });
    }

    /// Wakes all.
    pub fn clear(&mut self) {
        self.resting.clear();
        self.still.clear();
    }

    /// Wakes `body`; returns whether it was at rest.
    pub fn wake(&mut self, body: usize) -> bool {
        let was = self.has(body);
        if was {
            self.still[body] = false;
            self.resting.retain(|resting| resting.body != body);
        }
        was
    }

    /// After an evaluation: bodies on which nothing changed stay at rest, what rounding left of their balance is given
    /// by what carries them. The others wake.
    pub fn settle(&mut self, bodies: &mut Bodies, balance: &mut Balance) {
        if self.resting.is_empty() {
            return;
        }
        if self.generation != bodies.generation {
            // Places have changed. Whoever rests is found at rest again before the next step.
            self.clear();
            return;
        }
        let still = &mut self.still;
        self.resting.retain_mut(|resting| {
            let stays = resting.unchanged(bodies);
            let body = resting.body;
            if stays {
                let (force, torque) = (bodies.force[body], bodies.torque[body]);
                balance.outside(bodies.position[body], -force, -torque);
                bodies.force[body] = DVec2::ZERO;
                bodies.torque[body] = 0.0;
            } else {
                still[body] = false;
            }
            stays
        });
        if self.resting.len() == (0..bodies.len()).filter(|&body| bodies.dynamic[body]).count() {
            // Nothing moves: what comes from outside cancels, and rounding of its sum must not add up over the ticks.
            (balance.force, balance.torque) = (DVec2::ZERO, 0.0);
        }
    }
}

/// The system of [`crate::tick::Evaluate`] after all forces.
pub(super) fn settle_rest(
    mut contacts: ResMut<PenaltyContacts>,
    mut bodies: ResMut<Bodies>,
    mut balance: ResMut<Balance>,
) {
    contacts.rest.settle(&mut bodies, &mut balance);
}

impl Resting {
    fn unchanged(&mut self, bodies: &Bodies) -> bool {
        let body = self.body;
        let (force, torque) = (bodies.force[body], bodies.torque[body]);
        let balanced = match self.left_over {
            Some(left_over) => left_over == (force, torque),
            None => {
                self.left_over = Some((force, torque));
                let limit = IMBALANCE * self.load;
                force.length() <= limit && torque.abs() <= limit * bodies.extent[body]
            }
        };
        let stands = bodies.position[body] == self.position && bodies.angle[body] == self.angle;
        balanced && stands && bodies.velocity[body] == DVec2::ZERO && bodies.spin[body] == 0.0
    }
}
