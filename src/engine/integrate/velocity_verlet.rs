//! Velocity Verlet, kick - drift - kick: `v½ = v + a dt/2`, `x' = x + v½ dt`, `v' = v½ + a' dt/2`.
//!
//! Order 2, symplectic, one evaluation per tick (the second kick's forces are the next tick's first). It is stable
//! while `omega dt < 2`. Sources: Swope, Andersen, Berens, Wilson 1982; Hairer, Lubich, Wanner 2003.
//!
//! At the end of the tick, forces that depend on velocities use `v½ + a dt/2`. It is an estimate of `v'` with an error
//! of order dt². That keeps order 2 for drag and for forces of plugins, while `v½` alone would reduce it to order 1.
//! With damping `c` it is stable while `(omega dt)^2 + 4 c/m dt < 4`, up to a part in 400 (the roots of its
//! recurrence).

use super::Description;
use crate::tick::Tick;
use crate::tick::snapshot::Memory;
use crate::tick::{Integrator, Method};

/// Velocity Verlet.
pub struct VelocityVerlet;

pub(super) const DESCRIPTION: Description = Description {
    name: "VelocityVerlet",
    order: 2,
    symplectic: true,
    drifts: true,
    stability_limit: 2.0,
    damping_limit: 1.0,
    whole_ticks: Some(|| Method(Box::new(VelocityVerlet))),
    one_step: Some(|| Box::new(super::steps::VelocityVerletStep::default())),
};

impl Integrator for VelocityVerlet {
    fn save(&self) -> Memory {
        Memory::Nothing
    }

    fn advance(&mut self, tick: &mut Tick) {
        let dt = tick.dt;
        let ahead = tick.velocity_dependent().then_some(dt / 2.0);
        tick.advance(dt / 2.0, dt, ahead);
        tick.evaluate(dt);
        tick.kick_at_end(dt / 2.0);
    }

    fn flies(&self) -> bool {
        true
    }
}
