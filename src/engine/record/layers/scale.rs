//! Scales of arrows: the ratio of an arrow's length to its quantity. Length is proportional to the quantity, and the
//! corner of the picture states the scale.

use glam::DVec2;

use super::{Mark, MarkShape};

/// The length of an arrow of the scale's quantity, as a share of the picture's height.
const REFERENCE: f64 = 0.1;

/// The longest arrow, as a share of the picture's height. Longer ones are cut, and have two heads.
const LONGEST: f64 = 0.3;

/// The shortest arrow, as a share of the picture's height. Shorter ones are left out, because they would be all head.
const SHORTEST: f64 = 0.01;

/// How long arrows are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Scale {
    /// The quantity for an arrow of length [`REFERENCE`], in SI units.
    reference: f64,
    /// The height of the picture in metres.
    height: f64,
    unit: &'static str,
    color: &'static str,
}

impl Scale {
    /// The scale on which `reference`, in SI units of the given symbol, is a tenth of the picture's `height` (m).
    pub(super) fn new(reference: f64, height: f64, unit: &'static str, color: &'static str) -> Self {
        Self { reference, height, unit, color }
    }

    /// The mark that states it.
    pub(super) fn key(&self) -> Mark {
        let text = with_unit(self.reference, self.unit);
        Mark::new(MarkShape::Key { length: REFERENCE * self.height, text }, self.color)
    }

    /// An arrow for a quantity, beginning at a point; `None` for one that is too small to see.
    pub(super) fn arrow(&self, from: DVec2, quantity: DVec2) -> Option<Mark> {
        let length = quantity.length() / self.reference * REFERENCE;
        if !(length >= SHORTEST && length.is_finite()) {
            return None;
        }
        let direction = quantity.normalize_or_zero() * self.height;
        Some(if length > LONGEST {
            Mark::new(MarkShape::LongArrow(from, from + direction * LONGEST), self.color)
        } else {
            Mark::new(MarkShape::Arrow(from, from + direction * length), self.color)
        })
    }
}

/// The nearest 1, 2 or 5 times a power of ten, by ratio. It is 1 for NaN and for values not above zero.
pub(super) fn round(value: f64) -> f64 {
    if !(value.is_normal() && value > 0.0) {
        return 1.0;
    }
    let exponent = value.log10().floor() as i32;
    // Read back from decimal digits, so that it is the number a scene would give.
    let candidates = [format!("1e{exponent}"), format!("2e{exponent}"), format!("5e{exponent}")];
    let next = format!("1e{}", exponent + 1);
    let numbers = candidates.iter().chain([&next]).filter_map(|digits| digits.parse::<f64>().ok());
    let ratio = |round: &f64| (round / value).max(value / round);
    numbers.into_iter().min_by(|a, b| ratio(a).total_cmp(&ratio(b))).unwrap_or(value)
}

const PREFIXES: [(f64, &str); 7] =
    [(1e9, "G"), (1e6, "M"), (1e3, "k"), (1.0, ""), (1e-3, "m"), (1e-6, "µ"), (1e-9, "n")];

/// A quantity as people write it: `0.5 N`, `20 kN`, `5 mm/s`.
fn with_unit(value: f64, unit: &str) -> String {
    // Tenths and hundredths are read as easily as whole numbers.
    let fits = |(size, _): &&(f64, &str)| value >= size * (1.0 - 1e-9) || *size == 1.0 && value >= 0.01;
    let (size, prefix) = PREFIXES.iter().find(fits).unwrap_or(&(1.0, ""));
    let digits = format!("{:.3}", value / size);
    let digits = digits.trim_end_matches('0').trim_end_matches('.');
    if digits.is_empty() || digits.len() > 8 || digits == "0" {
        return format!("{value:e} {unit}");
    }
    format!("{digits} {prefix}{unit}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scales_are_round_and_written_as_people_do() {
        for (value, expected) in [(0.48, 0.5), (0.5, 0.5), (1.1, 1.0), (3.0, 2.0), (8.0, 10.0), (0.0, 1.0)] {
            assert_eq!(round(value), expected, "{value}");
        }
        for (value, expected) in
            [(0.5, "0.5 N"), (10.0, "10 N"), (2e4, "20 kN"), (5e-3, "5 mN"), (0.05, "0.05 N"), (1e12, "1000 GN")]
        {
            assert_eq!(with_unit(value, "N"), expected);
        }
        assert_eq!(with_unit(1e-30, "N"), "1e-30 N");
        assert_eq!(with_unit(1e200, "N"), "1e200 N");
    }

    /// The length of arrows is proportional to their quantity, up to the longest.
    #[test]
    fn length_is_proportional_to_the_quantity() {
        let scale = Scale::new(2.0, 7.2, "N", "force");
        // Length, and whether it is cut.
        let drawn = |force: f64| match scale.arrow(DVec2::ONE, DVec2::new(0.0, force))?.shape {
            MarkShape::Arrow(from, to) => Some((to - from, false)),
            MarkShape::LongArrow(from, to) => Some((to - from, true)),
            _ => None,
        };
        for (force, length, cut) in [(2.0, 0.72, false), (1.0, 0.36, false), (-1.5, -0.54, false), (60.0, 2.16, true)] {
            let (found, is_cut) = drawn(force).expect("large enough to be seen");
            // Rounding of a few operations.
            assert!((found - DVec2::new(0.0, length)).length() < 1e-14 && is_cut == cut, "{force}: {found}");
        }
        assert_eq!((drawn(0.1), drawn(0.0), drawn(f64::NAN)), (None, None, None));
        assert_eq!(scale.key().shape, MarkShape::Key { length: 0.1 * 7.2, text: "2 N".into() });
    }
}
