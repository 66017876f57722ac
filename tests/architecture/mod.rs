//! The promises of ARCHITECTURE.md about the code itself.

mod arrow;
mod pay;
mod schedule;
