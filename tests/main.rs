//! The integration tests: one binary, a folder per kind of promise.

mod determinism;
mod laws;
