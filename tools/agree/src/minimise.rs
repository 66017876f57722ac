//! Makes a scene smaller as long as it fails: items of lists first, then optional fields.

use std::time::{Duration, Instant};

use crate::written::Written;

/// Removes items and fields while `fails` holds, for at most `time`.
pub fn minimise(
    mut sections: Vec<(String, Written)>,
    time: Duration,
    fails: impl Fn(&[(String, Written)]) -> bool,
) -> Vec<(String, Written)> {
    let begin = Instant::now();
    loop {
        let before = sections.clone();
        // The last pieces refer to the first ones.
        for piece in (0..pieces(&sections)).rev() {
            if begin.elapsed() > time {
                return sections;
            }
            let smaller = without(&sections, piece);
            if smaller != sections && fails(&smaller) {
                sections = smaller;
            }
        }
        if sections == before {
            return sections;
        }
    }
}

/// The number of pieces of which each can be removed.
fn pieces(sections: &[(String, Written)]) -> usize {
    let mut count = 0;
    let mut copy: Vec<(String, Written)> = sections.to_vec();
    copy.retain_mut(|(_, value)| keep(value, &mut count, usize::MAX));
    count
}

/// The scene without a piece.
fn without(sections: &[(String, Written)], piece: usize) -> Vec<(String, Written)> {
    let mut count = 0;
    let mut copy = sections.to_vec();
    copy.retain_mut(|(_, value)| keep(value, &mut count, piece));
    copy
}

/// Counts the pieces of a value, itself first, and removes one inside it. Says whether the value itself stays.
fn keep(value: &mut Written, count: &mut usize, piece: usize) -> bool {
    let own = *count;
    *count += 1;
    if own == piece {
        return false;
    }
    match value {
        Written::List(items) => items.retain_mut(|item| keep(item, count, piece)),
        Written::Fields(fields) | Written::Map(fields) => fields.retain_mut(|(_, value)| keep(value, count, piece)),
        Written::Named(_, inner) => {
            if let Some(fields) = inner.fields_mut() {
                fields.retain_mut(|(_, value)| keep(value, count, piece));
            }
        }
        Written::Bare(_) | Written::Text(_) | Written::Tuple(_) => {}
    }
    true
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_fails_stays() {
        let bare = |text: &str| Written::Bare(text.to_owned());
        let inner = Written::Fields(vec![("x".to_owned(), bare("1")), ("bad".to_owned(), bare("2"))]);
        let list = Written::List(vec![bare("3"), Written::Named("Thing".to_owned(), Box::new(inner))]);
        let scene = vec![("a".to_owned(), bare("4")), ("b".to_owned(), list)];
        let text = |sections: &[(String, Written)]| crate::written::scene(sections);
        let small = minimise(scene, Duration::from_secs(60), |sections| text(sections).contains("bad"));
        assert_eq!(text(&small), "Scene(\n    b: [\n        Thing(bad: 2),\n    ],\n)\n");
    }
}
