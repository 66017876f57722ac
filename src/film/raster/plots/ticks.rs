//! Ticks of an axis: at 1, 2 or 5 times a power of ten. Their number neither crowds the axis nor leaves it bare.

/// The positions of the ticks of an axis, and their labels.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Ticks {
    /// Values from low to high.
    pub(super) values: Vec<f64>,
    /// The label of each tick.
    pub(super) labels: Vec<String>,
    /// The power of ten that all labels leave out.
    pub(super) exponent: i32,
}

/// The smallest 1, 2 or 5 times a power of ten with at most `most` steps between two values.
pub(super) fn step(low: f64, high: f64, most: usize) -> f64 {
    let wanted = (high - low) / most.max(1) as f64;
    let exponent = libm::floor(libm::log10(wanted));
    let decade = power(exponent as i32);
    // The tolerance accepts a step that misses by rounding only.
    let fits = |step: &f64| step * decade >= wanted * (1.0 - 1e-9);
    [1.0, 2.0, 5.0].into_iter().find(fits).unwrap_or(10.0) * decade
}

/// The power of ten that is nearest to its decimal digits.
fn power(exponent: i32) -> f64 {
    format!("1e{exponent}").parse().unwrap_or(1.0)
}

/// A range widened to round ends. They lie at ticks or half-way between, so that little room is empty. On a logarithmic
/// axis they are powers of ten.
pub(super) fn widened(low: f64, high: f64, most: usize, logarithmic: bool) -> (f64, f64) {
    if logarithmic {
        return (
            power(libm::floor(libm::log10(low) + 1e-9) as i32),
            power(libm::ceil(libm::log10(high) - 1e-9) as i32),
        );
    }
    let step = step(low, high, 2 * most);
    // An end stays if it is a whole step, up to rounding.
    ((low / step + 1e-9).floor() * step, (high / step - 1e-9).ceil() * step)
}

impl Ticks {
    /// Ticks of a linear axis from `low` to `high`, at most `most` steps.
    pub(super) fn linear(low: f64, high: f64, most: usize) -> Ticks {
        let step = step(low, high, most);
        let (first, last) = ((low / step - 1e-9).ceil(), (high / step + 1e-9).floor());
        let count = if (last - first).abs() < 1000.0 { (last - first + 1.0).max(0.0) as i64 } else { 0 };
        let values: Vec<f64> = (0..count).map(|place| (first + place as f64) * step).collect();
        let largest = low.abs().max(high.abs());
        // Powers of a thousand, if the labels would be long.
        let magnitude = libm::floor(libm::log10(largest) + 1e-9) as i32;
        let exponent = if largest > 0.0 && !(-3..=4).contains(&magnitude) { magnitude.div_euclid(3) * 3 } else { 0 };
        let decimals = (exponent - libm::floor(libm::log10(step) + 1e-9) as i32).max(0) as usize;
        let label = |value: &f64| {
            let text = format!("{:.decimals$}", value / power(exponent));
            let zero = text.trim_start_matches('-').bytes().all(|digit| matches!(digit, b'0' | b'.'));
            if zero { text.trim_start_matches('-').to_owned() } else { text.replace('-', "−") }
        };
        Ticks { labels: values.iter().map(label).collect(), values, exponent }
    }

    /// Ticks of a logarithmic axis at powers of ten. If there is only one, also at 2 and 5 times them.
    pub(super) fn logarithmic(low: f64, high: f64, most: usize) -> Ticks {
        let (first, last) = (libm::floor(libm::log10(low) + 1e-9) as i32, libm::ceil(libm::log10(high) - 1e-9) as i32);
        let every = ((last - first) as usize).div_ceil(most.max(1)).max(1);
        let steps: &[f64] = if last - first <= 2 { &[1.0, 2.0, 5.0] } else { &[1.0] };
        let mut values = Vec::new();
        let mut labels = Vec::new();
        for exponent in (first..=last).step_by(every) {
            for step in steps {
                let value = step * power(exponent);
                if (low * (1.0 - 1e-9)..=high * (1.0 + 1e-9)).contains(&value) {
                    values.push(value);
                    labels.push(match (exponent, *step) {
                        (-2..=3, _) => value.to_string(),
                        (_, 1.0) => format!("10{}", superscript(exponent)),
                        (_, step) => format!("{step}·10{}", superscript(exponent)),
                    });
                }
            }
        }
        Ticks { values, labels, exponent: 0 }
    }
}

/// A whole number written high.
pub(super) fn superscript(number: i32) -> String {
    let high = |letter: char| match letter {
        '-' => '⁻',
        '1' => '¹',
        '2' => '²',
        '3' => '³',
        digit => digit.to_digit(10).and_then(|digit| char::from_u32(0x2070 + digit)).unwrap_or(digit),
    };
    number.to_string().chars().map(high).collect()
}

/// A typeset unit: its powers are raised, and the omitted power of ten precedes it.
pub(super) fn unit(unit: &str, exponent: i32) -> String {
    let mut set = String::new();
    let mut powers = unit.chars().peekable();
    let mut after_letter = false;
    while let Some(letter) = powers.next() {
        let power = letter.is_ascii_digit() || (letter == '-' && powers.peek().is_some_and(char::is_ascii_digit));
        match letter {
            '^' => (),
            _ if after_letter && power => set.push_str(&superscript_letter(letter)),
            _ => {
                set.push(letter);
                after_letter = letter.is_alphabetic();
            }
        }
    }
    match (exponent, set.as_str()) {
        (0, _) => set,
        (exponent, "") => format!("10{}", superscript(exponent)),
        (exponent, set) => format!("10{} {set}", superscript(exponent)),
    }
}

fn superscript_letter(letter: char) -> String {
    letter.to_digit(10).map_or_else(|| "⁻".to_owned(), |digit| superscript(digit as i32))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Law: steps are 1, 2 or 5 times a power of ten, the smallest that keeps to the allowed number. So a range has at
    /// least 2/5 of the allowed number of steps. Rounding: a part in 1e-9.
    #[test]
    fn steps_are_one_two_or_five_and_as_small_as_allowed() {
        for most in [1, 2, 4, 5, 10] {
            for place in 0..600 {
                let range = libm::exp10(f64::from(place) / 50.0 - 6.0);
                let step = step(0.0, range, most);
                let mantissa = step / power(libm::floor(libm::log10(step) + 1e-9) as i32);
                assert!([1.0, 2.0, 5.0].iter().any(|nice| (mantissa / nice - 1.0).abs() < 1e-9), "{step}");
                assert!(range / step <= most as f64 * (1.0 + 1e-8), "{range} in steps of {step}");
                assert!(range / step > most as f64 * 0.4 * (1.0 - 1e-8), "{range} in steps of {step}");
            }
        }
    }

    #[test]
    fn ticks_stand_at_whole_steps_with_the_digits_they_need() {
        for (low, high, most, labels, exponent) in [
            (0.0, 100.0, 5, &["0", "20", "40", "60", "80", "100"][..], 0),
            (0.0, 1.0, 4, &["0.0", "0.5", "1.0"], 0),
            (-0.3, 0.31, 4, &["−0.2", "0.0", "0.2"], 0),
            (0.0, 2.5e6, 5, &["0.0", "0.5", "1.0", "1.5", "2.0", "2.5"], 6),
            (0.0, 4e-5, 2, &["0", "20", "40"], -6),
            (7.0, 8.0, 2, &["7.0", "7.5", "8.0"], 0),
            (0.0, 20.0, 4, &["0", "5", "10", "15", "20"], 0),
            (0.0, 20_000.0, 2, &["0", "10000", "20000"], 0),
        ] {
            let ticks = Ticks::linear(low, high, most);
            assert_eq!((ticks.labels, ticks.exponent), (labels.iter().map(|&l| l.into()).collect(), exponent));
        }
        assert_eq!(widened(0.1, 11.9, 5, false), (0.0, 12.0));
        assert_eq!(widened(0.0, 10.0, 5, false), (0.0, 10.0));
        assert_eq!(widened(-1.5, 12.2, 2, false), (-5.0, 15.0));
        assert_eq!(widened(0.02, 3.0, 4, true), (0.01, 10.0));
    }

    #[test]
    fn powers_of_ten_are_written_high() {
        assert_eq!(Ticks::logarithmic(1e-8, 1.0, 4).labels, ["10⁻⁸", "10⁻⁶", "10⁻⁴", "0.01", "1"]);
        assert_eq!(Ticks::logarithmic(1.0, 40.0, 4).labels, ["1", "2", "5", "10", "20"]);
        assert_eq!([unit("m/s2", 0), unit("kg m^-1", 3), unit("", -6)], ["m/s²", "10³ kg m⁻¹", "10⁻⁶"]);
    }
}
