//! The integration tests: one binary, a folder per kind of promise.

mod architecture;
mod determinism;
mod extend;
mod laws;
