//! Ticks of an axis, at steps of 1, 2 or 5 times a power of ten. They neither crowd the axis nor leave it bare. An axis has at
//! least two, as one alone tells no scale.

/// An axis with fewer ticks has no scale that can be read.
const FEWEST: usize = 2;

/// With so many steps allowed, a step is at most half of any range. So two multiples of it lie in the range.
const ENOUGH: usize = 5;

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
    /// Ticks of a linear axis from `low` to `high`, at least two, and at most `most` steps.
    pub(super) fn linear(low: f64, high: f64, most: usize) -> Ticks {
        let finer = (most..=ENOUGH.max(most)).map(|steps| Self::at_steps(low, high, steps));
        finer.map(|ticks| ticks.thinned(most)).find(Self::is_scale).unwrap_or_else(|| Self::at_ends(low, high))
    }

    /// Whether they tell how long the axis is: two at least, which digits tell apart.
    fn is_scale(&self) -> bool {
        let rising = self.values.windows(2).all(|pair| pair[0] < pair[1]);
        let told_apart = self.labels.windows(2).all(|pair| pair[0] != pair[1]);
        self.values.len() >= FEWEST && rising && told_apart
    }

    /// Every second, third .. of them, so that there are at most `most` steps.
    fn thinned(self, most: usize) -> Ticks {
        let every = self.values.len().saturating_sub(1).div_ceil(most.max(1)).max(1);
        let labels = self.labels.into_iter().step_by(every).collect();
        Ticks { values: self.values.into_iter().step_by(every).collect(), labels, ..self }
    }

    /// Ticks at the ends alone, where digits do not tell apart what lies between them.
    fn at_ends(low: f64, high: f64) -> Ticks {
        let values = vec![low, high];
        let label = |value: &f64| format!("{value:e}").replace("e0", "").replace('-', "−");
        Ticks { labels: values.iter().map(label).collect(), values, exponent: 0 }
    }

    /// Ticks at the multiples of the step of which no more than `most` fit.
    fn at_steps(low: f64, high: f64, most: usize) -> Ticks {
        let step = step(low, high, most);
        let (first, last) = ((low / step - 1e-9).ceil(), (high / step + 1e-9).floor());
        let count = if (last - first).abs() < 1000.0 { (last - first + 1.0).max(0.0) as i64 } else { 0 };
        let values: Vec<f64> = (0..count).map(|index| (first + index as f64) * step).collect();
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

    /// Leaves out what is no whole number: counts have no halves. A range that was asked for may lie between two counts.
    pub(super) fn keep_whole_numbers(&mut self) {
        let whole: Vec<usize> = (0..self.values.len()).filter(|place| self.values[*place].fract() == 0.0).collect();
        if whole.len() >= FEWEST {
            self.labels = whole.iter().map(|place| self.labels[*place].trim_end_matches(".0").to_owned()).collect();
            self.values = whole.iter().map(|place| self.values[*place]).collect();
        }
    }

    /// Ticks of a logarithmic axis, at least two. They stand at powers of ten. On a short axis they also stand at 2 and 5 times
    /// these. If fewer than two of them lie on the axis, it has equal steps.
    pub(super) fn logarithmic(low: f64, high: f64, most: usize) -> Ticks {
        let (first, last) = (libm::floor(libm::log10(low) + 1e-9) as i32, libm::ceil(libm::log10(high) - 1e-9) as i32);
        let decades = last.saturating_sub(first).max(0) as usize;
        let every = decades.div_ceil(most.max(1)).max(1);
        let choices: &[(usize, &[f64])] = &[(every, &[1.0]), (1, &[1.0]), (1, &[1.0, 2.0, 5.0])];
        let choices = if decades <= 2 { &choices[2..] } else { choices };
        let at = |(every, steps): &(usize, &[f64])| {
            let all =
                (first..=last).step_by(*every).flat_map(|exponent| steps.iter().map(move |step| (exponent, *step)));
            let seen = all.filter(|(exponent, step)| {
                (low * (1.0 - 1e-9)..=high * (1.0 + 1e-9)).contains(&(step * power(*exponent)))
            });
            let (values, labels) =
                seen.map(|(exponent, step)| (step * power(exponent), of_a_decade(exponent, step))).unzip();
            Ticks { values, labels, exponent: 0 }
        };
        choices.iter().map(at).find(Self::is_scale).unwrap_or_else(|| Self::linear(low, high, most))
    }
}

/// The label of the tick at `step` times a power of ten.
fn of_a_decade(exponent: i32, step: f64) -> String {
    match (exponent, step) {
        (-2..=3, _) => (step * power(exponent)).to_string(),
        (_, 1.0) => format!("10{}", superscript(exponent)),
        (_, step) => format!("{step}·10{}", superscript(exponent)),
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
            for index in 0..600 {
                let range = libm::exp10(f64::from(index) / 50.0 - 6.0);
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

    /// Ranges of many widths on both sides of zero. A width is between 1e-9 of the distance from zero and all of it.
    fn ranges() -> impl Iterator<Item = (f64, f64)> {
        let widths = (-25..=25).map(|width| libm::exp10(f64::from(width) / 1.7));
        let shares = [1e-9, 3.7e-8, 1e-6, 2.3e-4, 0.013, 0.3, 0.77, 1.0, 1.9, f64::INFINITY];
        let of_width = move |width: f64| {
            let begins = move |share: f64| [width / share, -width / share - width, -0.4 * width, 0.6 / share * width];
            shares.into_iter().flat_map(begins).map(move |low| (low, low + width))
        };
        widths.flat_map(of_width)
    }

    /// Promise: an axis has at least two ticks, and no more than the caller asks for. All lie on it, and their labels differ.
    #[test]
    fn an_axis_has_at_least_two_ticks_whose_labels_differ() {
        for (low, high) in ranges() {
            for most in 1..=10 {
                for (low, high) in [(low, high), widened(low, high, most, false)] {
                    let Ticks { values, labels, .. } = Ticks::linear(low, high, most);
                    assert!(values.len() >= 2 && values.len() <= most + 1, "{low} to {high}, {most}: {labels:?}");
                    assert!(labels.windows(2).all(|pair| pair[0] != pair[1]), "{low} to {high}, {most}: {labels:?}");
                    // A multiple of a step that equals an end to within rounding stands at this end.
                    let about = 1e-9 * (high - low) + 4.0 * f64::EPSILON * low.abs().max(high.abs());
                    assert!(values.iter().all(|value| (low - about..=high + about).contains(value)), "{low} {high}");
                }
            }
        }
    }

    #[test]
    fn a_logarithmic_axis_has_at_least_two_ticks_too() {
        for (low, high) in ranges().filter(|(low, _)| *low > 0.0) {
            for most in 1..=10 {
                for (low, high) in
                    [(low, high), widened(low, high, most, true)].into_iter().filter(|(low, high)| low < high)
                {
                    let Ticks { values, labels, .. } = Ticks::logarithmic(low, high, most);
                    assert!(values.len() >= 2, "{low} to {high}, {most}: {labels:?}");
                    assert!(labels.windows(2).all(|pair| pair[0] != pair[1]), "{low} to {high}, {most}: {labels:?}");
                }
            }
        }
    }

    /// Digits do not tell the middle of it from its ends.
    #[test]
    fn the_shortest_axis_there_is_shows_its_ends() {
        let high = 1.0 + f64::EPSILON;
        assert_eq!(Ticks::linear(1.0, high, 4).values, [1.0, high]);
    }

    #[test]
    fn powers_of_ten_are_written_high() {
        assert_eq!(Ticks::logarithmic(1e-8, 1.0, 4).labels, ["10⁻⁸", "10⁻⁶", "10⁻⁴", "0.01", "1"]);
        assert_eq!(Ticks::logarithmic(1.0, 40.0, 4).labels, ["1", "2", "5", "10", "20"]);
        assert_eq!([unit("m/s2", 0), unit("kg m^-1", 3), unit("", -6)], ["m/s²", "10³ kg m⁻¹", "10⁻⁶"]);
    }
}
