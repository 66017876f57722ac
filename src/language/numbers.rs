//! Numbers in sentences, with the digits that a reader needs.

/// Errors below this are rounding alone, so no message gives a smaller one.
pub const LEAST: f64 = 1e-16;

/// A number of which only the size counts.
pub fn rough(value: f64) -> String {
    if value.is_nan() {
        return "unknown".to_owned();
    }
    let value = value.max(LEAST);
    format!("{value:.0e}").parse().map_or_else(|_| number(value), number)
}

/// A number in at most five digits, as people write it.
pub fn number(value: f64) -> String {
    let short = |text: &str| {
        if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text.to_owned() }
    };
    if value == 0.0 || (1e-4..1e6).contains(&value.abs()) {
        let digits = (4 - value.abs().max(1e-300).log10().floor() as i32).clamp(0, 8) as usize;
        return short(&format!("{value:.digits$}"));
    }
    let text = format!("{value:.4e}");
    text.split_once('e').map_or_else(|| text.clone(), |(digits, exponent)| format!("{}e{exponent}", short(digits)))
}

/// A share as a percentage with one digit behind the point. One beyond a million has an exponent instead.
pub fn percentage(share: f64) -> String {
    let hundredths = 100.0 * share;
    if hundredths.abs() < 1e6 { format!("{hundredths:.1} %") } else { format!("{hundredths:.0e} %") }
}

/// A share in words.
pub fn percent(share: f64) -> String {
    if share == 0.0 {
        "nothing".to_owned()
    } else if share >= 1e6 {
        format!("{:.0e} %", share * 100.0)
    } else if share >= 0.1 {
        format!("{:.0} %", share * 100.0)
    } else if share >= 1e-4 {
        format!("{:.2} %", share * 100.0)
    } else {
        format!("{share:.0e}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_written_as_people_do() {
        assert_eq!(number(20.0), "20");
        assert_eq!(number(0.001), "0.001");
        assert_eq!(number(0.0123456), "0.012346");
        assert_eq!(number(1.5e-7), "1.5e-7");
        assert_eq!(number(5e-7), "5e-7");
    }

    #[test]
    fn shares_are_written_with_few_digits() {
        let written = [0.0, 2e-5, 0.0123, 0.5, 12.0, 1.11e180].map(percent);
        assert_eq!(written, ["nothing", "2e-5", "1.23 %", "50 %", "1200 %", "1e182 %"]);
        assert_eq!([0.0, 0.1234, 5e298].map(percentage), ["0.0 %", "12.3 %", "5e300 %"]);
    }
}
