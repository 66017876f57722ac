//! The laws of physics and of numerics that the engine must obey. Each file states its law and source, where its
//! tolerances come from, and what it does not test.

mod support;

mod bounce;
mod constant_acceleration;
mod convergence;
mod energy;
mod forces;
mod friction;
mod ledger;
mod momentum;
mod orbit;
mod problems;
mod restitution;
mod rotation;
mod standing;
mod sticking;
mod uniform_motion;
