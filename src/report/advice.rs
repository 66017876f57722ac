//! The advice of a run: one number that answers all its warnings.

use std::fmt;

use jostle_language::numbers::number;

/// The next setting to try.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Remedy {
    /// A tick in seconds.
    Tick(f64),
    /// A tolerance, where that chooses the steps.
    Tolerance(f64),
    /// A method that has a stable tick.
    Method,
}

impl fmt::Display for Remedy {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Tick(tick) => write!(formatter, "--tick {}", number(*tick)),
            Self::Tolerance(tolerance) => write!(formatter, "--tolerance {}", number(*tolerance)),
            Self::Method => formatter.write_str("--method VelocityVerlet"),
        }
    }
}

impl Remedy {
    /// The same, where less of it would do as well.
    pub fn or_finer(&self) -> String {
        if *self == Self::Method { format!("`{self}`") } else { format!("`{self}` or finer") }
    }
}

/// The time scales of a run, in seconds.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct RunScales {
    /// The tick of the run.
    pub tick: f64,
    /// The longest stable tick, if there is a limit.
    pub critical: Option<f64>,
    /// The duration of the briefest contact, if contacts are possible.
    pub shortest_contact: Option<f64>,
    /// The longest way in a tick over the smallest radius.
    pub travel: f64,
}

impl RunScales {
    /// A quarter of the tick, or less if that is still too long. The limits are a tenth of the critical tick, a twentieth of the
    /// briefest contact, half a radius of way. Rounded down to few digits.
    ///
    /// Above the critical tick nothing else counts, because the instability itself makes bodies fast and contacts brief.
    pub fn advised_tick(&self) -> f64 {
        let critical = self.critical.map_or(f64::INFINITY, |critical| critical / 10.0);
        let wanted = if critical < self.tick / 10.0 {
            critical
        } else {
            let contact = self.shortest_contact.map_or(f64::INFINITY, |shortest| shortest / 20.0);
            let travel = if self.travel > 1.0 && self.travel.is_finite() {
                self.tick / (2.0 * self.travel)
            } else {
                f64::INFINITY
            };
            (self.tick / 4.0).min(critical).min(contact).min(travel)
        };
        rounded_down(wanted)
    }
}

/// The next lower of 1, 2, 2.5 and 5 times a power of ten.
pub(super) fn rounded_down(value: f64) -> f64 {
    // A demand for zero time gets the shortest number.
    let value = value.max(f64::MIN_POSITIVE);
    let exponent = value.log10().floor() as i32;
    let candidates = [(5.0, exponent), (2.5, exponent), (2.0, exponent), (1.0, exponent), (5.0, exponent - 1)];
    // Read back from decimal digits, so that it equals the number on a command line. A part in 1e12 is rounding.
    let numbers = candidates.into_iter().filter_map(|(digits, exponent)| format!("{digits}e{exponent}").parse().ok());
    numbers.into_iter().find(|number: &f64| *number <= value * (1.0 + 1e-12)).unwrap_or(value)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tick_four_times_as_fine_has_few_digits() {
        for (tick, finer) in [(1e-3, 2.5e-4), (2e-3, 5e-4), (1e-2, 2.5e-3), (4e-4, 1e-4), (3e-4, 5e-5)] {
            assert_eq!(RunScales { tick, ..RunScales::default() }.advised_tick(), finer);
        }
    }

    #[test]
    fn each_limit_that_the_tick_breaks_counts() {
        let known = RunScales { tick: 1e-3, critical: Some(6e-3), shortest_contact: Some(9e-3), travel: 0.5 };
        assert_eq!(known.advised_tick(), 2.5e-4);
        assert_eq!(RunScales { shortest_contact: Some(4e-3), ..known }.advised_tick(), 2e-4);
        assert_eq!(RunScales { travel: 3.0, ..known }.advised_tick(), 1e-4);
        assert_eq!(RunScales { critical: Some(9e-4), travel: 1e6, ..known }.advised_tick(), 5e-5);
        assert_eq!(RunScales { travel: f64::MAX, ..known }.advised_tick(), 2e-308);
    }
}
