//! Numbers in messages.

/// A number as people write it: neither three hundred zeros nor digits that only rounding made.
pub fn number(value: f64) -> String {
    let rounded = format!("{value:.11e}").parse().unwrap_or(value);
    if value == 0.0 || (1e-4..1e9).contains(&value.abs()) { format!("{rounded}") } else { format!("{rounded:e}") }
}

/// A count in words: `1 body`, `3 bodies`.
pub fn count(number: usize, one: &str, many: &str) -> String {
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
