//! Velocity Verlet, kick - drift - kick: `v½ = v + a dt/2`, `x' = x + v½ dt`, `v' = v½ + a' dt/2`.
//!
//! Order 2, symplectic, one evaluation per tick (the second kick's forces are the next tick's first), stable while
//! `omega dt < 2` (Swope, Andersen, Berens, Wilson 1982; Hairer, Lubich, Wanner 2003).
//!
//! Forces that depend on velocities see `v½ + a dt/2` at the end of the tick, an estimate of `v'` with an error of
//! order dt²: that keeps order 2 for drag and anything a plugin adds, where `v½` alone would fall to order 1.

use glam::DVec2;

use super::{Description, Integrator, Method};
use crate::tick::Tick;

/// Velocity Verlet.
#[derive(Default)]
pub struct VelocityVerlet {
    half_step: Vec<(DVec2, f64)>,
}

pub(super) const DESCRIPTION: Description = Description {
    name: "VelocityVerlet",
    order: 2,
    stability_limit: 2.0,
    make: || Method(Box::<VelocityVerlet>::default()),
};

impl Integrator for VelocityVerlet {
    fn advance(&mut self, tick: &mut Tick) {
        let dt = tick.dt;
        tick.kick(dt / 2.0);
        tick.drift(dt);
        if tick.velocity_dependent() {
            let mut bodies = tick.bodies();
            self.half_step.clear();
            self.half_step.extend(bodies.velocity.iter().copied().zip(bodies.spin.iter().copied()));
            bodies.kick(dt / 2.0);
            tick.evaluate(dt);
            let mut bodies = tick.bodies();
            for (body, &(velocity, spin)) in self.half_step.iter().enumerate() {
                bodies.velocity[body] = velocity;
                bodies.spin[body] = spin;
            }
        } else {
            tick.evaluate(dt);
        }
        tick.kick(dt / 2.0);
    }
}
