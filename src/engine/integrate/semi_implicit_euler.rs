//! Semi-implicit (symplectic) Euler: `v' = v + a(x) dt`, `x' = x + v' dt`.
//!
//! Order 1, symplectic, one evaluation per tick, stable while `omega dt < 2`. The source is Hairer, Lubich, Wanner,
//! *Geometric Numerical Integration*, 2006, I.1. With damping `c` it is stable while `(omega dt)^2 + 2 c/m dt < 4`. The
//! method of most games, and of the first recorded trajectories.

use super::Description;
use crate::tick::Tick;
use crate::tick::snapshot::Memory;
use crate::tick::{Integrator, Method};

/// Semi-implicit Euler.
pub struct SemiImplicitEuler;

pub(super) const DESCRIPTION: Description = Description {
    name: "SemiImplicitEuler",
    order: 1,
    symplectic: true,
    drifts: true,
    stability_limit: 2.0,
    damping_limit: 2.0,
    whole_ticks: Some(|| Method(Box::new(SemiImplicitEuler))),
    one_step: Some(|| Box::new(super::steps::SemiImplicitEulerStep::default())),
};

impl Integrator for SemiImplicitEuler {
    fn save(&self) -> Memory {
        Memory::Nothing
    }

    fn advance(&mut self, tick: &mut Tick) {
        let dt = tick.dt;
        tick.advance(dt, dt, None);
        tick.evaluate(dt);
        tick.hold_velocities();
    }
}
