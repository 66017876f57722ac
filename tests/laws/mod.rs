//! The laws of physics and of numerics that the engine must obey. Each file states its law and source, where its
//! tolerances come from, and what it does not test.

mod support;

mod belt;
mod bounce;
mod clumps;
mod conditioned;
mod conservation;
mod constant_acceleration;
mod convergence;
mod cradle;
mod critical_tick;
mod crowds;
mod dashpot;
mod energy;
mod forces;
mod frames;
mod friction;
mod gas;
mod impacts;
mod kinematic;
mod ledger;
mod located;
mod million;
mod momentum;
mod oblique;
mod orbit;
mod problems;
mod properties;
mod rest;
mod restitution;
mod reversal;
mod rolling;
mod rolling_resistance;
mod rotation;
mod scales;
mod slope;
mod springs;
mod stability;
mod standing;
mod sticking;
mod stiff;
mod tolerance;
mod uniform_motion;
mod unlocated;
