//! The integration tests: one binary, a folder per kind of promise.

mod cli;
mod extend;
mod scenes;
