//! The command line program: parse, call, report.

use std::process::ExitCode;

use clap::Parser;
use jostle::cli::CommandLine;

#[global_allocator]
static LINES: jostle::simd::Lines = jostle::simd::Lines;

fn main() -> ExitCode {
    CommandLine::parse().execute().into()
}
