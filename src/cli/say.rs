//! Printing: messages for people go to standard error, results to standard output. A reader that ends early (`jostle
//! .. | head`) does no harm, unlike with the macros of the standard library, which panic.

use std::io::{ErrorKind, Write};
use std::sync::atomic::{AtomicBool, Ordering};

use super::Exit;

pub(super) use crate::scene::{count, number};

/// Longer lines than this many bytes are cut, because they may hold a name or a cell of any length.
const LONGEST_LINE: usize = 10_000;

/// Prints a message to standard error. A failure of that cannot be reported.
pub(super) fn say(message: &str) {
    let mut text = String::with_capacity(message.len() + 1);
    for line in message.split('\n') {
        let end = line.floor_char_boundary(LONGEST_LINE);
        let cut = if end < line.len() { format!(" ... ({} bytes left out)", line.len() - end) } else { String::new() };
        text.extend([&line[..end], &cut, "\n"]);
    }
    let _ = std::io::stderr().write_all(text.as_bytes());
}

/// Whether the failure of standard output was reported.
static TOLD: AtomicBool = AtomicBool::new(false);

/// Prints a result to standard output, one line.
pub(super) fn print_line(line: &str) -> Exit {
    match writeln!(std::io::stdout(), "{line}") {
        Ok(()) => Exit::Good,
        // A reader that has gone away wants no more.
        Err(error) if error.kind() == ErrorKind::BrokenPipe => Exit::Good,
        Err(error) => {
            // Results of many lines would report it many times.
            if !TOLD.swap(true, Ordering::Relaxed) {
                say(&format!("error: the result cannot be written to standard output: {error}"));
            }
            Exit::Usage
        }
    }
}
