//! A grid of square cells over points, for the plain loop.

/// More cells than this many times the points are not made: then cells are larger.
const CELLS_PER_POINT: f64 = 4.0;

/// Points sorted by cell.
pub struct Cells {
    low: (f64, f64),
    side: f64,
    columns: usize,
    rows: usize,
    /// The first point of each cell, and the number of points at the end.
    first: Vec<u32>,
    points: Vec<u32>,
}

impl Cells {
    /// Sorts points into cells at least `reach` wide.
    pub fn new(x: &[f64], y: &[f64], reach: f64) -> Self {
        let range = |values: &[f64]| {
            let low = values.iter().copied().fold(f64::INFINITY, f64::min);
            (low, values.iter().copied().fold(low, f64::max) - low)
        };
        let ((low_x, width), (low_y, height)) = (range(x), range(y));
        let most = CELLS_PER_POINT * x.len() as f64;
        let mut side = reach;
        // A few points far away must not cost memory without end.
        while (width / side + 1.0) * (height / side + 1.0) > most + 16.0 {
            side *= 2.0;
        }
        let (columns, rows) = ((width / side) as usize + 1, (height / side) as usize + 1);
        let mut cells = Self {
            low: (low_x, low_y),
            side,
            columns,
            rows,
            first: vec![0; columns * rows + 1],
            points: vec![0; x.len()],
        };
        let of: Vec<usize> = x.iter().zip(y).map(|(&x, &y)| cells.cell(x, y)).collect();
        of.iter().for_each(|&cell| cells.first[cell + 1] += 1);
        for cell in 0..columns * rows {
            cells.first[cell + 1] += cells.first[cell];
        }
        let mut next = cells.first.clone();
        for (point, &cell) in of.iter().enumerate() {
            cells.points[next[cell] as usize] = point as u32;
            next[cell] += 1;
        }
        cells
    }

    fn column_and_row(&self, x: f64, y: f64) -> (usize, usize) {
        let column = ((x - self.low.0) / self.side) as usize;
        let row = ((y - self.low.1) / self.side) as usize;
        (column.min(self.columns - 1), row.min(self.rows - 1))
    }

    fn cell(&self, x: f64, y: f64) -> usize {
        let (column, row) = self.column_and_row(x, y);
        row * self.columns + column
    }

    /// Visits all points in the cell of a place and in those around it.
    pub fn near(&self, x: f64, y: f64, mut visit: impl FnMut(u32)) {
        let (column, row) = self.column_and_row(x, y);
        for row in row.saturating_sub(1)..=(row + 1).min(self.rows - 1) {
            let left = row * self.columns + column.saturating_sub(1);
            let right = row * self.columns + (column + 1).min(self.columns - 1);
            // Cells side by side hold their points side by side.
            self.points[self.first[left] as usize..self.first[right + 1] as usize]
                .iter()
                .for_each(|&point| visit(point));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// All pairs nearer than the reach are found, by comparing each with each.
    #[test]
    fn whatever_is_in_reach_is_visited() {
        let x: Vec<f64> = (0..200).map(|i| f64::from(i * 37 % 101)).collect();
        let y: Vec<f64> = (0..200).map(|i| f64::from(i * 53 % 89) - 40.0).collect();
        let cells = Cells::new(&x, &y, 7.0);
        for a in 0..200 {
            let mut visited = Vec::new();
            cells.near(x[a], y[a], |b| visited.push(b as usize));
            for b in (0..200).filter(|&b| (x[a] - x[b]).hypot(y[a] - y[b]) < 7.0) {
                assert!(visited.contains(&b), "{a} {b}");
            }
            // Three cells of 7 m wide and high hold 10 points. The area is 100 m by 88 m, with 200 points spread
            // evenly.
            assert!(visited.len() < 40, "the grid leaves nothing out: {}", visited.len());
        }
    }
}
