//! What ARCHITECTURE.md promises about the code itself.

mod arrow;
mod pay;
mod schedule;
