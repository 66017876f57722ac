//! The positions of bodies after a drift, before they are brought back onto joints.

use glam::DVec2;

use super::stabilisation::FromOutside;
use crate::world::Bodies;

/// Places after a drift.
pub(super) struct Drifted {
    position: Vec<DVec2>,
    angle: Vec<f64>,
    drift: Vec<DVec2>,
    turn: Vec<f64>,
}

impl Drifted {
    /// The present places.
    pub fn of(bodies: &Bodies) -> Self {
        Self {
            position: bodies.position.clone(),
            angle: bodies.angle.clone(),
            drift: bodies.drift.clone(),
            turn: bodies.turn.clone(),
        }
    }

    /// Restores the positions of bodies.
    pub fn put_back(&self, bodies: &mut Bodies) {
        bodies.position.clone_from(&self.position);
        bodies.angle.clone_from(&self.angle);
        bodies.drift.clone_from(&self.drift);
        bodies.turn.clone_from(&self.turn);
        (bodies.posed, bodies.recorded) = (false, false);
    }

    /// Velocities follow places that were brought back after a drift of `elapsed` seconds. Returns the impulse from outside: forces from
    /// inside cancel in the sum.
    pub fn follow(&self, bodies: &mut Bodies, elapsed: f64) -> FromOutside {
        let mut outside = FromOutside::default();
        for body in (0..bodies.len()).filter(|body| bodies.jointed[*body] && bodies.dynamic[*body]).collect::<Vec<_>>()
        {
            let by = (bodies.position[body] - self.position[body]) / elapsed;
            let turned = (bodies.angle[body] - self.angle[body]) / elapsed;
            bodies.velocity[body] += by;
            bodies.spin[body] += turned;
            if let Some(velocity) = bodies.estimated_velocity.get_mut(body) {
                *velocity += by;
                bodies.estimated_spin[body] += turned;
            }
            // Forces acted at the beginning of the drift.
            let was = bodies.position[body] - bodies.velocity[body] * elapsed;
            let impulse = by * bodies.mass[body];
            outside.impulse += impulse;
            outside.angular += was.perp_dot(impulse) + turned * bodies.inertia[body];
        }
        outside
    }
}
