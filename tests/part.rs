//! The part of the cases of long tests that one check takes. All of them are promises, but each change breaks most of a kind or none.
//! `tools/check` takes another part for each commit. `tools/check --all` and `cargo test` take all.
//!
//! The variable `JOSTLE_PART` has the form `2/4`: of each four cases the one with the index 2.

/// Which cases are taken: those with the first number as index, of each so many.
fn taken() -> (usize, usize) {
    let Ok(text) = std::env::var("JOSTLE_PART") else { return (0, 1) };
    let numbers = text.split_once('/').and_then(|(index, of)| Some((index.parse().ok()?, of.parse().ok()?)));
    match numbers {
        Some((index, of)) if index < of => (index, of),
        _ => panic!("JOSTLE_PART is `{text}`, and not a number below another one, such as 2/4"),
    }
}

/// Whether all cases are taken.
pub fn is_all() -> bool {
    taken().1 == 1
}

/// The cases of a list that are taken.
pub fn of<T>(cases: impl IntoIterator<Item = T>) -> Vec<T> {
    let (index, of) = taken();
    cases.into_iter().skip(index).step_by(of).collect()
}

/// At least so many of all cases must be there: the same share of those that are taken.
pub fn least(all: usize) -> usize {
    all / taken().1
}
