//! Decimation of a curve by minimum and maximum: each column keeps its first, lowest, highest and last sample.

use super::Sample;

/// Thins samples as they come; memory grows with the number of columns, not of samples.
#[derive(Clone, Debug, Default)]
pub struct Decimator {
    kept: Vec<Sample>,
    column: Option<Column>,
}

#[derive(Clone, Copy, Debug)]
struct Column {
    number: i64,
    first: Sample,
    lowest: Sample,
    highest: Sample,
    last: Sample,
}

impl Decimator {
    /// Adds a sample to a column. Samples come from early to late, and so do columns.
    pub fn push(&mut self, number: i64, sample: Sample) {
        match &mut self.column {
            Some(column) if column.number == number => {
                // NaN is neither low nor high. The first number is both.
                if sample.y < column.lowest.y || column.lowest.y.is_nan() {
                    column.lowest = sample;
                }
                if sample.y > column.highest.y || column.highest.y.is_nan() {
                    column.highest = sample;
                }
                column.last = sample;
            }
            _ => {
                self.close();
                self.column = Some(Column { number, first: sample, lowest: sample, highest: sample, last: sample });
            }
        }
    }

    fn close(&mut self) {
        let Some(Column { first, lowest, highest, last, .. }) = self.column.take() else { return };
        let inner = if lowest.time <= highest.time { [lowest, highest] } else { [highest, lowest] };
        for sample in [first, inner[0], inner[1], last] {
            if self.kept.last().is_none_or(|before| before.time < sample.time) {
                self.kept.push(sample);
            }
        }
    }

    /// The remaining samples, from early to late.
    pub fn finish(mut self) -> Vec<Sample> {
        self.close();
        self.kept
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Law: each column keeps its lowest, highest, first and last sample, hence at most four. Exact: samples are
    /// chosen, never computed.
    #[test]
    fn the_extremes_of_every_column_are_kept() {
        let noise = |index: u32| {
            let word = index.wrapping_mul(2_654_435_761) >> 7;
            f64::from(word % 1000) * libm::sin(f64::from(index) * 0.01)
        };
        let all: Vec<Sample> =
            (0..10_000).map(|index| Sample { time: f64::from(index), x: f64::from(index), y: noise(index) }).collect();
        for per_column in [1, 2, 7, 137, 20_000] {
            let mut decimator = Decimator::default();
            let column = |sample: &Sample| sample.x as i64 / per_column;
            all.iter().for_each(|sample| decimator.push(column(sample), *sample));
            let kept = decimator.finish();
            assert!(kept.is_sorted_by(|a, b| a.time < b.time));
            for whole in all.chunk_by(|a, b| column(a) == column(b)) {
                let left: Vec<&Sample> = kept.iter().filter(|sample| column(sample) == column(&whole[0])).collect();
                let extremes = |values: &mut dyn Iterator<Item = f64>| {
                    values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), y| (low.min(y), high.max(y)))
                };
                assert_eq!(extremes(&mut left.iter().map(|s| s.y)), extremes(&mut whole.iter().map(|s| s.y)));
                assert_eq!((left[0], left.last()), (&whole[0], whole.last().as_ref()));
                assert!(left.len() <= 4);
            }
        }
    }

    #[test]
    fn nan_hides_no_extreme() {
        let mut decimator = Decimator::default();
        for (index, y) in [f64::NAN, 3.0, -1.0, f64::NAN].into_iter().enumerate() {
            decimator.push(0, Sample { time: index as f64, x: 0.0, y });
        }
        let kept: Vec<f64> = decimator.finish().iter().map(|sample| sample.y).collect();
        assert!(kept[0].is_nan() && kept[3].is_nan() && kept[1..3] == [3.0, -1.0]);
    }
}
