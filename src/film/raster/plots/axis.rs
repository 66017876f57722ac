//! The map from values to pixels along one axis.

/// A range of values, and the pixels at its ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Scale {
    low: f64,
    high: f64,
    from: f64,
    to: f64,
    logarithmic: bool,
}

impl Scale {
    /// `low` lies at the pixel `from`, `high` at `to`.
    pub(super) fn new((low, high): (f64, f64), (from, to): (f32, f32), logarithmic: bool) -> Scale {
        Scale { low, high, from: f64::from(from), to: f64::from(to), logarithmic }
    }

    /// The pixel of a value; NaN or infinite if the axis has no place for the value.
    pub(super) fn place(&self, value: f64) -> f64 {
        let share = if self.logarithmic {
            libm::log10(value / self.low) / libm::log10(self.high / self.low)
        } else {
            (value - self.low) / (self.high - self.low)
        };
        self.from + (self.to - self.from) * share
    }
}

/// The range of values that an axis has to show. It includes zero if that is near, and is `None` without values.
pub(super) fn range_of(values: impl Iterator<Item = f64>, logarithmic: bool) -> Option<(f64, f64)> {
    let shown = values.filter(|value| value.is_finite() && (!logarithmic || *value > 0.0));
    let (low, high) = shown.map(|value| (value, value)).reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)))?;
    // Values that differ by rounding only count as one.
    let size = low.abs().max(high.abs());
    let one = high - low <= 1e-9 * size;
    if logarithmic {
        return Some(if one { (low / 10.0, high * 10.0) } else { (low, high) });
    }
    if one {
        let around = if size == 0.0 { 1.0 } else { 0.1 * size };
        return Some((low - around, high + around));
    }
    let (low, high) = if low > 0.0 && low < 0.5 * high { (0.0, high) } else { (low, high) };
    Some(if high < 0.0 && high > 0.5 * low { (low, 0.0) } else { (low, high) })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Exact: the ends of a range lie at the ends of the axis, and the middle in the middle.
    #[test]
    fn values_stand_where_they_belong() {
        let up = Scale::new((-1.0, 3.0), (210.0, 10.0), false);
        assert_eq!([-1.0, 0.0, 1.0, 3.0].map(|value| up.place(value)), [210.0, 160.0, 110.0, 10.0]);
        let decades = Scale::new((0.01, 100.0), (0.0, 400.0), true);
        for (value, place) in [(0.01, 0.0), (0.1, 100.0), (1.0, 200.0), (100.0, 400.0)] {
            // Four logarithms, each good to a few times 1e-16, of a length of 400.
            assert!((decades.place(value) - place).abs() < 1e-12);
        }
        assert!(!decades.place(0.0).is_finite() && !decades.place(-1.0).is_finite());
    }

    #[test]
    fn ranges_hold_all_values_and_zero_if_it_is_near() {
        let range = |values: &[f64]| range_of(values.iter().copied(), false);
        assert_eq!(range(&[1.0, 4.0, f64::NAN]), Some((0.0, 4.0)));
        assert_eq!(range(&[3.0, 4.0]), Some((3.0, 4.0)));
        assert_eq!(range(&[-4.0, -1.0]), Some((-4.0, 0.0)));
        assert_eq!(range(&[0.0, 0.0]), Some((-1.0, 1.0)));
        // A tenth of their size around values that differ by rounding only, here by 1e-12.
        let (low, high) = range(&[10.0, 10.0 + 1e-12]).expect("two values");
        assert!((low - 9.0).abs() < 1e-11 && (high - 11.0).abs() < 1e-11);
        assert_eq!(range(&[f64::INFINITY]), None);
        assert_eq!(range_of([0.0, 1e-3, 10.0].into_iter(), true), Some((1e-3, 10.0)));
        assert_eq!(range_of([1.0, 1.0 - 1e-12].into_iter(), true), Some(((1.0 - 1e-12) / 10.0, 10.0)));
    }
}
