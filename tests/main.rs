//! The integration tests: one binary, a folder per kind of promise.

mod architecture;
mod audit;
mod cli;
mod determinism;
mod extend;
mod laws;
mod part;
mod scenes;
