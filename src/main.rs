//! The command line program: parse, call, report.

use std::process::ExitCode;

use jostle::cli::{CommandLine, tell_commit};

#[global_allocator]
static LINES: jostle::simd::Lines = jostle::simd::Lines;

/// Digits of the commit that the program shows.
const DIGITS: usize = 12;

/// The commit in the files of Git. Only this file depends on them, so that a new commit does not change the library.
const CHECKED_OUT: Option<[u8; DIGITS]> =
    checked_out(include_bytes!(env!("JOSTLE_GIT_HEAD")), include_bytes!(env!("JOSTLE_GIT_LOG")));

fn main() -> ExitCode {
    let checked_out = CHECKED_OUT.and_then(|digits| String::from_utf8(digits.to_vec()).ok());
    if let Some(commit) = option_env!("JOSTLE_COMMIT").map(str::to_owned).or(checked_out) {
        tell_commit(commit);
    }
    CommandLine::read().execute().into()
}

/// `head` is a commit, or it names a branch. Then the last line of the branch's log has the earlier and the current
/// commit.
const fn checked_out(head: &[u8], log: &[u8]) -> Option<[u8; DIGITS]> {
    if !head.is_empty() && head[0] != b'r' {
        return digits_from(head, 0);
    }
    let mut start = log.len().saturating_sub(1);
    while start > 0 && log[start - 1] != b'\n' {
        start -= 1;
    }
    while start < log.len() && log[start] != b' ' {
        start += 1;
    }
    digits_from(log, start + 1)
}

const fn digits_from(text: &[u8], start: usize) -> Option<[u8; DIGITS]> {
    if text.len() < start + DIGITS {
        return None;
    }
    let mut digits = [0; DIGITS];
    let mut index = 0;
    while index < DIGITS {
        digits[index] = text[start + index];
        index += 1;
    }
    Some(digits)
}
