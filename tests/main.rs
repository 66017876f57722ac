//! The integration tests: one binary, a folder per kind of promise.

#[global_allocator]
static COUNTING: jostle::simd::Counting = jostle::simd::Counting;

mod architecture;
mod audit;
mod cli;
mod determinism;
mod extend;
mod laws;
mod part;
mod scenes;
