//! Forces: each file one. A force adds to the sums of the bodies and keeps its account in
//! [`Balance`](crate::tick::Balance).

pub mod attraction;
pub mod drag;
pub mod gravity;
mod targets;
pub mod thrust;
pub mod torque;

pub use targets::Targets;
