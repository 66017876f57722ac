//! Printing: messages for people go to standard error, results to standard output. Whoever does not read to the end
//! (`jostle .. | head`) does no harm: the macros of the standard library would panic then.

use std::io::{ErrorKind, Write};

use super::Exit;

/// Prints a message to standard error; nobody is left to be told if that fails.
pub(super) fn say(message: &str) {
    let _ = writeln!(std::io::stderr(), "{message}");
}

/// Prints a result to standard output, one line.
pub(super) fn print_line(line: &str) -> Exit {
    match writeln!(std::io::stdout(), "{line}") {
        Ok(()) => Exit::Good,
        // A reader that has gone away wants no more.
        Err(error) if error.kind() == ErrorKind::BrokenPipe => Exit::Good,
        Err(error) => {
            say(&format!("error: the result cannot be written to standard output: {error}"));
            Exit::Usage
        }
    }
}

/// A number as people write it: neither three hundred zeros nor digits that only rounding made.
pub(super) fn number(value: f64) -> String {
    let rounded = format!("{value:.11e}").parse().unwrap_or(value);
    if value == 0.0 || (1e-4..1e9).contains(&value.abs()) { format!("{rounded}") } else { format!("{rounded:e}") }
}

/// A number of things in words: `1 body`, `3 bodies`.
pub(super) fn count(number: usize, one: &str, many: &str) -> String {
    format!("{number} {}", if number == 1 { one } else { many })
}

#[cfg(test)]
mod tests {
    use super::number;

    #[test]
    fn numbers_stay_short() {
        for (value, text) in
            [(0.0, "0"), (0.1 + 0.2, "0.3"), (20.0, "20"), (1e300, "1e300"), (6e-7, "6e-7"), (1e9, "1e9")]
        {
            assert_eq!(number(value), text);
        }
    }
}
