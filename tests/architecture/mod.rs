//! The promises of ARCHITECTURE.md about the code itself.

mod allocations;
mod arrow;
mod pay;
mod schedule;
