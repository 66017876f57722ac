//! Makes a failing scene smaller as long as it fails in the same way: whole lines first, then groups of tokens.

use std::time::{Duration, Instant};

use crate::tokens::tokens;

/// Removes pieces of a text while `fails` holds, for at most `time`.
pub fn minimise(text: &str, time: Duration, mut fails: impl FnMut(&str) -> bool) -> String {
    let begin = Instant::now();
    let lines: Vec<String> = text.split_inclusive('\n').map(str::to_owned).collect();
    let lines = shrink(lines, begin, time, &mut fails);
    let pieces = tokens(&lines.concat()).into_iter().map(|token| token.text).collect();
    shrink(pieces, begin, time, &mut fails).concat()
}

/// Removes runs of pieces, long ones first (after "Simplifying and isolating failure-inducing input", Zeller and
/// Hildebrandt 2002).
fn shrink(
    mut pieces: Vec<String>,
    begin: Instant,
    time: Duration,
    fails: &mut impl FnMut(&str) -> bool,
) -> Vec<String> {
    let mut length = pieces.len().div_ceil(2);
    while length > 0 {
        let (mut index, mut removed) = (0, false);
        while index < pieces.len() {
            if begin.elapsed() > time {
                return pieces;
            }
            let end = (index + length).min(pieces.len());
            let rest: Vec<String> = pieces[..index].iter().chain(&pieces[end..]).cloned().collect();
            if fails(&rest.concat()) {
                (pieces, removed) = (rest, true);
            } else {
                index = end;
            }
        }
        // A removal may make another one possible, down to single pieces until none is.
        length = if length == 1 && removed { 1 } else { length / 2 };
    }
    pieces
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_fails_stays() {
        let text = "one\ntwo(3, bad)\nthree\nfour bad five\n";
        let small = minimise(text, Duration::from_secs(60), |text| text.matches("bad").count() == 2);
        assert_eq!(small, "badbad");
    }
}
