//! The command line program: parse, call, report.

use std::process::ExitCode;

use clap::Parser;
use jostle::cli::CommandLine;

fn main() -> ExitCode {
    CommandLine::parse().execute().into()
}
