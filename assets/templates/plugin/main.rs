//! The program `jostle` with this plugin: every command knows its entries, its sensor and its layer.

use std::process::ExitCode;

#[global_allocator]
static LINES: jostle::simd::Lines = jostle::simd::Lines;

fn main() -> ExitCode {
    jostle::cli::main_with(home_spring::plugin)
}
