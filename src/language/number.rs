//! Numbers in messages.

/// A number as people write it: neither three hundred zeros nor digits that only rounding made.
pub fn number(value: f64) -> String {
    let rounded = format!("{value:.11e}").parse().unwrap_or(value);
    if value == 0.0 || (1e-4..1e9).contains(&value.abs()) { format!("{rounded}") } else { format!("{rounded:e}") }
}

/// A number in the fewest digits that read back with the same bits. It has an exponent if that is shorter.
pub fn exact(value: f64) -> String {
    let (full, exponent) = (value.to_string(), format!("{value:e}"));
    if full.len() <= exponent.len() + 3 { full } else { exponent }
}

/// A count in words: `1 body`, `3 bodies`.
pub fn count(number: usize, one: &str, many: &str) -> String {
    format!("{number} {}", if number == 1 { one } else { many })
}

#[cfg(test)]
mod tests {
    use super::{exact, number};

    #[test]
    fn numbers_stay_short() {
        for (value, text) in
            [(0.0, "0"), (0.1 + 0.2, "0.3"), (20.0, "20"), (1e300, "1e300"), (6e-7, "6e-7"), (1e9, "1e9")]
        {
            assert_eq!(number(value), text);
        }
    }

    #[test]
    fn numbers_read_back_to_the_same_bits() {
        for value in [0.0, -0.0, 0.1 + 0.2, 1e300, -2.5e-300, 5e-324, f64::MAX, 1.0 / 3.0, 123_456_789.0] {
            assert_eq!(exact(value).parse::<f64>().map(f64::to_bits), Ok(value.to_bits()));
        }
        for (value, text) in [(20.0, "20"), (0.001, "0.001"), (1e300, "1e300"), (-2.5e-9, "-2.5e-9")] {
            assert_eq!(exact(value), text);
        }
    }
}
