//! Gaussian elimination with partial pivoting, in place and in a fixed order: `a x = b` for small full matrices.
//!
//! It takes `n^3/3` multiplications, and allocates nothing after the largest matrix (Golub, Van Loan, Matrix
//! Computations, section 3.4). A singular matrix gives infinities and not a guess, which shows the caller that there is
//! no answer.

/// A square matrix, and after [`Elimination::eliminate`] its triangular factors.
#[derive(Default)]
pub(super) struct Elimination {
    size: usize,
    /// Row after row.
    entries: Vec<f64>,
    /// The row that was exchanged with each.
    exchanges: Vec<usize>,
}

impl Elimination {
    /// Makes room for a matrix; its entries are to be set.
    pub(super) fn begin(&mut self, size: usize) {
        self.size = size;
        self.entries.resize(size * size, 0.0);
        self.exchanges.resize(size, 0);
    }

    /// An entry of the matrix.
    pub(super) fn entry(&mut self, row: usize, column: usize) -> &mut f64 {
        &mut self.entries[row * self.size + column]
    }

    /// Makes the factors.
    pub(super) fn eliminate(&mut self) {
        let size = self.size;
        for step in 0..size {
            let mut largest = step;
            for row in step + 1..size {
                if self.entry(row, step).abs() > self.entry(largest, step).abs() {
                    largest = row;
                }
            }
            self.exchanges[step] = largest;
            if largest != step {
                for column in 0..size {
                    self.entries.swap(step * size + column, largest * size + column);
                }
            }
            let (above, below) = self.entries.split_at_mut((step + 1) * size);
            let pivot_row = &above[step * size..];
            for row in below.chunks_exact_mut(size) {
                if row[step] == 0.0 {
                    continue;
                }
                row[step] /= pivot_row[step];
                let factor = row[step];
                for (entry, pivot) in row[step + 1..].iter_mut().zip(&pivot_row[step + 1..]) {
                    *entry -= factor * pivot;
                }
            }
        }
    }

    /// Turns the right-hand side into the answer.
    pub(super) fn solve(&self, values: &mut [f64]) {
        for (step, &other) in self.exchanges.iter().enumerate() {
            values.swap(step, other);
        }
        for (row, entries) in self.entries.chunks_exact(self.size.max(1)).enumerate() {
            for column in 0..row {
                values[row] -= entries[column] * values[column];
            }
        }
        for (row, entries) in self.entries.chunks_exact(self.size.max(1)).enumerate().rev() {
            for column in row + 1..self.size {
                values[row] -= entries[column] * values[column];
            }
            values[row] /= entries[row];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ROWS: [[f64; 4]; 4] =
        [[0.0, 2.0, 1.0, -3.0], [1e-9, 1.0, 4.0, 1.0], [5.0, -1.0, 2.0, 2.0], [1.0, 3.0, -2.0, 7.0]];

    fn factors(rows: [[f64; 4]; 4]) -> Elimination {
        let mut matrix = Elimination::default();
        matrix.begin(4);
        for (row, entries) in rows.iter().enumerate() {
            for (column, entry) in entries.iter().enumerate() {
                *matrix.entry(row, column) = *entry;
            }
        }
        matrix.eliminate();
        matrix
    }

    /// Law: elimination with row exchanges leaves a residual of rounding. The first pivot may be zero and the next
    /// tiny. The growth is at most 8 for four rows (section 3.4 of the source).
    #[test]
    fn solves() {
        let answer = [1.0, -2.0, 3.0, 0.5];
        let mut values = ROWS.map(|row| row.iter().zip(&answer).map(|(a, x)| a * x).sum::<f64>());
        let right = values;
        factors(ROWS).solve(&mut values);
        for (row, right) in ROWS.iter().zip(right) {
            let left: f64 = row.iter().zip(&values).map(|(a, x)| a * x).sum();
            assert!((left - right).abs() <= 8.0 * 7.0 * 20.0 * f64::EPSILON, "{left} instead of {right}");
        }
    }

    /// No answer is made up for a singular matrix.
    #[test]
    fn a_singular_matrix_has_no_answer() {
        let mut rows = ROWS;
        rows[3] = rows[2];
        let mut values = [1.0, 2.0, 3.0, 4.0];
        factors(rows).solve(&mut values);
        assert!(values.iter().any(|value| !value.is_finite()));
    }
}
