//! Weighted minimum-norm solution of the linear equations for the forces of held contacts, which may be redundant.
//!
//! A wide block on many atoms is at rest with every distribution of its weight that has the right sum. Rigid statics
//! does not determine more. The loads of elastic contacts depend on their overlaps, which are part of the state. So the
//! solution is the one nearest to the current forces of the springs. Each difference is measured by the capacity of the
//! contact: `k d` for normal forces, `mu k d` for tangential ones. So the forces are unique and a function of the state
//! alone. They stay within the bounds of every contact as far as possible. The motion does not depend on the choice.

use std::ops::Range;

use serde::{Deserialize, Serialize};

/// A pivot below this share of the largest coefficient of its unknown leaves open whether rows depend on each other. It is the
/// root of the rounding: pivots before it of that share may have grown rounding to as much.
const DOUBTFUL: f64 = 1e-8;
/// A row is redundant if less than this share of it remains after the projections on other rows are subtracted.
const NOTHING_NEW: f64 = 1e-10;
/// The least measure of an unknown as a share of those in the same row: the root of [`NOTHING_NEW`]. So a row that
/// only it can satisfy still counts as new.
const LEAST_MEASURE: f64 = 1e-5;
/// The measure in newtons of an unknown without capacity among others of that kind: the squares of smaller ones vanish.
const NO_CAPACITY: f64 = 1e-100;

/// The preferred value of an unknown force.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Share {
    /// The preferred force, in newtons.
    pub natural: f64,
    /// The unit of differences, in newtons; above zero.
    pub measure: f64,
}

/// Room for equations, and what it took to solve them.
#[derive(Clone, Debug, Default)]
pub struct Equations {
    matrix: Vec<f64>,
    /// The number of multiplications so far.
    pub multiplications: f64,
}

impl Equations {
    /// Solves `matrix x = answer` in place of `answer`. The `matrix` is square. If rows depend on each other, the solution
    /// is the one nearest to `shares`.
    pub fn solve(&mut self, matrix: &[f64], answer: &mut [f64], shares: impl Iterator<Item = Share>) {
        self.matrix.clear();
        self.matrix.extend_from_slice(matrix);
        self.multiplications += matrix.len() as f64;
        let right: Vec<f64> = answer.to_vec();
        if !eliminate(&mut self.matrix, answer, &mut self.multiplications) {
            let shares: Vec<Share> = shares.collect();
            nearest(matrix, &right, &shares, answer, &mut self.multiplications);
        }
    }
}

/// Gaussian elimination with exchange of rows. Returns whether every unknown is clearly determined.
fn eliminate(matrix: &mut [f64], answer: &mut [f64], multiplications: &mut f64) -> bool {
    let size = answer.len();
    let mut free = vec![true; size];
    let mut pivots = vec![0; size];
    let largest: Vec<f64> = (0..size)
        .map(|column| (0..size).fold(0.0_f64, |largest, row| largest.max(matrix[row * size + column].abs())))
        .collect();
    for column in 0..size {
        let candidates = (0..size).filter(|&row| free[row]);
        let best = candidates.max_by(|&a, &b| {
            matrix[a * size + column].abs().total_cmp(&matrix[b * size + column].abs()).then(b.cmp(&a))
        });
        let Some(pivot) = best.filter(|&row| matrix[row * size + column].abs() > DOUBTFUL * largest[column]) else {
            return false;
        };
        free[pivot] = false;
        pivots[column] = pivot;
        for row in (0..size).filter(|&row| row != pivot) {
            let factor = matrix[row * size + column] / matrix[pivot * size + column];
            if factor != 0.0 {
                *multiplications += (size - column) as f64;
                for index in column..size {
                    matrix[row * size + index] -= factor * matrix[pivot * size + index];
                }
                answer[row] -= factor * answer[pivot];
            }
        }
    }
    let values: Vec<f64> =
        (0..size).map(|column| answer[pivots[column]] / matrix[pivots[column] * size + column]).collect();
    answer.copy_from_slice(&values);
    true
}

/// The solution of `matrix x = right` nearest to the natural forces: with `x = natural + measure y` the shortest `y`, which is
/// a sum of rows. Rows are made orthogonal one by one (Gram and Schmidt). The next row is the one of which the greatest share is
/// left (Golub and Van Loan, *Matrix Computations*, 5.4.2). So rounding in a weak direction cannot make a row of which nothing is left seem new.
///
/// Rows of bodies far apart share no unknown. So products of rows look only at the range of unknowns of
/// both. Orthogonal rows stay as they are.
fn nearest(matrix: &[f64], right: &[f64], shares: &[Share], answer: &mut [f64], multiplications: &mut f64) {
    let size = right.len();
    let measures = measures(matrix, shares);
    let scaled = |row: &[f64]| row.iter().zip(&measures).map(|(entry, of)| entry * of).collect();
    let mut left: Vec<SparseRow> = matrix.chunks_exact(size).map(|row| SparseRow::new(scaled(row))).collect();
    let whole: Vec<f64> = left.iter().map(|row| row.dot(row)).collect();
    let mut remains = whole.clone();
    let natural = |row: &[f64]| row.iter().zip(shares).fold(0.0, |sum, (entry, share)| sum + entry * share.natural);
    let mut parts: Vec<f64> = matrix.chunks_exact(size).zip(right).map(|(row, right)| right - natural(row)).collect();
    let (mut taken, mut free): (Vec<usize>, Vec<usize>) = (Vec::new(), (0..size).collect());
    let share = |remains: &[f64], row: usize| if whole[row] > 0.0 { remains[row] / whole[row] } else { 0.0 };
    loop {
        let of = |place: usize| share(&remains, free[place]);
        let most = (0..free.len()).max_by(|&a, &b| of(a).total_cmp(&of(b)).then(b.cmp(&a)));
        let Some(place) = most.filter(|&place| of(place) > NOTHING_NEW * NOTHING_NEW) else { break };
        let pivot = free.remove(place);
        let mut direction = left[pivot].clone();
        let mut part = parts[pivot];
        // Once more against all that were taken, for rounding.
        for &other in &taken {
            part -= direction.subtract(&left[other]) * parts[other];
            *multiplications += left[other].span.len() as f64;
        }
        let new = direction.dot(&direction).sqrt();
        direction.entries[direction.span.clone()].iter_mut().for_each(|entry| *entry /= new);
        parts[pivot] = part / new;
        taken.push(pivot);
        for &row in &free {
            let along = left[row].subtract(&direction);
            *multiplications += direction.span.len() as f64;
            if along != 0.0 {
                parts[row] -= along * parts[pivot];
                remains[row] = left[row].dot(&left[row]);
            }
        }
        left[pivot] = direction;
    }
    for (index, (answer, share)) in answer.iter_mut().zip(shares).enumerate() {
        let sum = taken.iter().fold(0.0, |sum, &row| sum + left[row].entries[index] * parts[row]);
        *answer = share.natural + measures[index] * sum;
    }
}

/// A row with the range of unknowns outside which it is zero.
#[derive(Clone, Debug)]
struct SparseRow {
    entries: Vec<f64>,
    span: Range<usize>,
}

impl SparseRow {
    fn new(entries: Vec<f64>) -> Self {
        let is_some = |entry: &f64| *entry != 0.0;
        let begin = entries.iter().position(is_some).unwrap_or(0);
        let end = entries.iter().rposition(is_some).map_or(begin, |last| last + 1);
        Self { entries, span: begin..end }
    }

    fn dot(&self, other: &Self) -> f64 {
        let both = self.span.start.max(other.span.start)..self.span.end.min(other.span.end);
        if both.is_empty() {
            return 0.0;
        }
        let pairs = self.entries[both.clone()].iter().zip(&other.entries[both]);
        pairs.fold(0.0, |sum, (a, b)| sum + a * b)
    }

    /// Takes the part along a direction of length one out of the row, and returns its length.
    fn subtract(&mut self, direction: &Self) -> f64 {
        let along = direction.dot(self);
        if along != 0.0 {
            let span = direction.span.clone();
            self.entries[span.clone()]
                .iter_mut()
                .zip(&direction.entries[span.clone()])
                .for_each(|(entry, direction)| *entry -= along * direction);
            self.span = self.span.start.min(span.start)..self.span.end.max(span.end);
        }
        along
    }
}

/// The measures, with a least one: a contact without capacity still holds where no other one can.
fn measures(matrix: &[f64], shares: &[Share]) -> Vec<f64> {
    let beside = |row: &[f64]| {
        let coupled = row.iter().zip(shares).filter(|(entry, _)| **entry != 0.0);
        coupled.fold(0.0_f64, |most, (_, share)| most.max(share.measure))
    };
    let rows = matrix.chunks_exact(shares.len()).zip(shares);
    rows.map(|(row, share)| share.measure.max(LEAST_MEASURE * beside(row)).max(NO_CAPACITY)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const ONE: Share = Share { natural: 0.0, measure: 1.0 };

    fn solved(matrix: &[f64], right: &[f64], shares: &[Share]) -> Vec<f64> {
        let mut answer = right.to_vec();
        Equations::default().solve(matrix, &mut answer, shares.iter().copied());
        answer
    }

    #[test]
    fn independent_rows_have_one_answer_whatever_the_shares() {
        let shares = [Share { natural: 7.0, measure: 3.0 }, ONE];
        assert_eq!(solved(&[2.0, 1.0, 1.0, 3.0], &[5.0, 10.0], &shares), [1.0, 3.0]);
    }

    /// Law: a bar rests on three equal supports, at -1, 0 and 1, and its weight acts at 1/4. Sum and moment of the
    /// forces are given. The shortest answer is linear along the bar, `1/3 + x/8` (least squares). Tolerance: rounding.
    #[test]
    fn a_bar_on_three_supports_loads_them_linearly() {
        let places = [-1.0_f64, 0.0, 1.0];
        let matrix: Vec<f64> = places.iter().flat_map(|a| places.iter().map(move |b| 1.0 + a * b)).collect();
        let right = places.map(|place| 1.0 + 0.25 * place);
        for (found, place) in solved(&matrix, &right, &[ONE; 3]).iter().zip(places) {
            assert!((found - (1.0 / 3.0 + place / 8.0)).abs() < 1e-15, "{found}");
        }
    }

    /// Law: springs bear the forces that their depths require, and a right answer is not changed. A missing force is
    /// distributed in proportion to the squares of the measures. Tolerance: rounding.
    #[test]
    fn what_springs_bear_is_kept() {
        let shares = [Share { natural: 2.0, measure: 2.0 }, Share { natural: 1.0, measure: 1.0 }];
        for (right, exact) in [(3.0, [2.0, 1.0]), (4.0, [2.8, 1.2])] {
            for (found, exact) in solved(&[1.0; 4], &[right; 2], &shares).iter().zip(exact) {
                assert!((found - exact).abs() < 4e-15, "{found} instead of {exact}");
            }
        }
    }
    /// Law: rows that rounding alone tells apart do not make forces beyond all bounds. Six slipping contacts of one
    /// block have three freedoms, with normals that differ by a few 1e-8 to 1e-5 rad. Tolerance: rounding of the rows.
    #[test]
    fn rounding_makes_no_forces() {
        let arms = [-0.199, -0.198999, -0.101, 0.199, 0.101, 0.0];
        let tilts = [-7.6e-8, 2.5e-7, 2.5e-7, -2.8e-5, 2.5e-7, 4.1e-8];
        let slopes = [0.5, 0.5, 0.5, 0.5, 0.0, 0.0];
        for turn in 0..1000 {
            let tilts = tilts.map(|tilt| tilt * (1.0 + 1e-3 * f64::from(turn)));
            let row = |slope: f64, arm: f64, tilt: f64| [tilt + slope, 1.0 - slope * tilt, arm - 0.1 * (tilt + slope)];
            let along: Vec<[f64; 3]> = (0..6).map(|index| row(0.0, arms[index], tilts[index])).collect();
            let forces: Vec<[f64; 3]> = (0..6).map(|index| row(slopes[index], arms[index], tilts[index])).collect();
            let weights = [1.0, 1.0, 75.0];
            let response = |a: &[f64; 3], b: &[f64; 3]| (0..3).fold(0.0, |sum, i| sum + a[i] * weights[i] * b[i]);
            let matrix: Vec<f64> =
                along.iter().flat_map(|a| forces.iter().map(|b| response(a, b)).collect::<Vec<_>>()).collect();
            let right: Vec<f64> = along.iter().map(|row| 30.0 * row[0] + 100.0 * row[1] + 5.0 * row[2]).collect();
            let found = solved(&matrix, &right, &[Share { natural: 57.0, measure: 57.0 }; 6]);
            assert!(found.iter().all(|force| force.abs() < 1e3), "{turn}: {found:?}");
            for (row, right) in matrix.chunks_exact(6).zip(&right) {
                assert!(
                    (row.iter().zip(&found).map(|(a, b)| a * b).sum::<f64>() - right).abs() < 1e-9,
                    "{turn}: {found:?}"
                );
            }
        }
    }

    /// Law: a contact whose springs bear nothing yet holds its body alone, whatever else depends on each other. Tolerance: rounding.
    #[test]
    fn a_contact_without_capacity_holds_alone() {
        let shares = [ONE, ONE, Share { natural: 0.0, measure: f64::MIN_POSITIVE }];
        let found = solved(&[1.0, 1.0, 0.0, 1.0, 1.0, 0.0, 0.0, 0.0, 2.0], &[4.0, 4.0, 6.0], &shares);
        for (found, exact) in found.iter().zip([2.0, 2.0, 3.0]) {
            assert!((found - exact).abs() < 1e-14, "{found} instead of {exact}");
        }
    }

    /// Promise: bodies that share no contact cost the square of their number, for the matrix, not the third power. Each has two
    /// equal supports. Twice as many bodies may take four times the multiplications and a little more.
    #[test]
    fn bodies_apart_do_not_multiply_each_others_work() {
        let work = |bodies: usize| {
            let size = 2 * bodies;
            let matrix: Vec<f64> = (0..size * size).map(|at| f64::from(at / size / 2 == at % size / 2)).collect();
            let mut equations = Equations::default();
            let mut answer = vec![1.0; size];
            equations.solve(&matrix, &mut answer, vec![ONE; size].into_iter());
            assert!(answer.iter().all(|force| (force - 0.5).abs() < 1e-15), "{answer:?}");
            equations.multiplications
        };
        let [some, more] = [100, 200].map(work);
        assert!(more < 4.2 * some, "{more} multiplications instead of {some}");
    }
}
