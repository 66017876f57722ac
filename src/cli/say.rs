//! Printing: messages for people go to standard error, results to standard output. A reader that ends early (`jostle
//! .. | head`) does no harm, unlike with the macros of the standard library, which panic.
//!
//! Texts of scenes and names of files may hold characters that a terminal obeys. All of them leave as escapes.

use std::borrow::Cow;
use std::io::{ErrorKind, IsTerminal, Write};
use std::sync::atomic::{AtomicBool, Ordering};

use serde::Serialize;

use super::Exit;
use crate::scene::{SceneErrors, visible, visible_json};

pub(super) use crate::scene::{count, number};

/// Longer lines than this many bytes are cut, because they may hold a name or a cell of any length.
const LONGEST_LINE: usize = 10_000;

/// Prints a message to standard error. A failure of that cannot be reported.
pub(super) fn say(message: &str) {
    write_lines(message, visible);
}

/// Prints the mistakes of a scene to standard error, on a terminal with colours. The texts of the scene are masked before they
/// get their colours, which are characters that the terminal obeys.
pub(super) fn say_mistakes(errors: &SceneErrors) {
    let text = errors.render(std::io::stderr().is_terminal());
    write_lines(text.trim_end(), |line| line.into());
}

fn write_lines(message: &str, masked: impl Fn(&str) -> Cow<'_, str>) {
    let mut text = String::with_capacity(message.len() + 1);
    for line in message.split('\n') {
        let line = line.strip_suffix('\r').unwrap_or(line);
        let end = line.floor_char_boundary(LONGEST_LINE);
        let cut = if end < line.len() { format!(" ... ({} bytes left out)", line.len() - end) } else { String::new() };
        text.extend([&*masked(&line[..end]), &cut, "\n"]);
    }
    let _ = std::io::stderr().write_all(text.as_bytes());
}

/// Whether the failure of standard output was reported.
static TOLD: AtomicBool = AtomicBool::new(false);

/// Prints a result to standard output, and ends its line.
pub(super) fn print_line(line: &str) -> Exit {
    print(&visible(line).replace("\r\n", "\n"))
}

/// Prints a result as JSON to standard output, one line.
pub(super) fn print_json(result: &impl Serialize) -> Exit {
    match serde_json::to_string(result) {
        Ok(json) => print(&visible_json(&json)),
        Err(error) => {
            say(&format!("error: the result cannot be written as JSON: {error}"));
            Exit::RunWrong
        }
    }
}

fn print(line: &str) -> Exit {
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
