//! Weighted minimum-norm solution of the linear equations for the forces of held contacts, which may be redundant.
//!
//! A wide block on many atoms is at rest with every distribution of its weight that has the right sum. Rigid statics
//! does not determine more. The loads of elastic contacts depend on their overlaps, which are part of the state. So the
//! solution is the one nearest to the current forces of the springs. Each difference is measured by the capacity of the
//! contact: `k d` for normal forces, `mu k d` for tangential ones. So the forces are unique and a function of the state
//! alone. They stay within the bounds of every contact as far as possible. The motion does not depend on the choice.

use serde::{Deserialize, Serialize};
/// A pivot below this share of the largest coefficient of its unknown counts as zero.
const DEPENDENT: f64 = 1e-12;
/// A row is redundant if less than this share of it remains after the projections on other rows are subtracted.
const NOTHING_NEW: f64 = 1e-10;

/// The preferred value of an unknown force.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Share {
    /// The preferred force, in newtons.
    pub natural: f64,
    /// The unit of differences, in newtons; above zero.
    pub measure: f64,
}

/// Solves `matrix x = answer` in place of `answer`. The `matrix` is square. If rows depend on each other, the solution
/// is the one nearest to `shares`.
pub fn solve(matrix: &[f64], answer: &mut [f64], shares: impl Iterator<Item = Share>, work: &mut Vec<f64>) {
    work.clear();
    work.extend_from_slice(matrix);
    let right: Vec<f64> = answer.to_vec();
    if !eliminate(work, answer) {
        let shares: Vec<Share> = shares.collect();
        nearest(matrix, &right, &shares, answer);
    }
}

/// Gaussian elimination with exchange of rows. Returns whether every unknown is determined.
fn eliminate(matrix: &mut [f64], answer: &mut [f64]) -> bool {
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
        let Some(pivot) = best.filter(|&row| matrix[row * size + column].abs() > DEPENDENT * largest[column]) else {
            return false;
        };
        free[pivot] = false;
        pivots[column] = pivot;
        for row in (0..size).filter(|&row| row != pivot) {
            let factor = matrix[row * size + column] / matrix[pivot * size + column];
            if factor != 0.0 {
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
/// a sum of rows. Rows are made orthogonal one after the other (Gram and Schmidt, twice, for rounding).
fn nearest(matrix: &[f64], right: &[f64], shares: &[Share], answer: &mut [f64]) {
    let size = right.len();
    let (mut directions, mut parts): (Vec<Vec<f64>>, Vec<f64>) = (Vec::new(), Vec::new());
    for (row, right) in matrix.chunks_exact(size).zip(right) {
        let mut left: Vec<f64> = row.iter().zip(shares).map(|(entry, share)| entry * share.measure).collect();
        let whole = length(&left);
        let mut part = row.iter().zip(shares).fold(*right, |part, (entry, share)| part - entry * share.natural);
        for _ in 0..2 {
            for (direction, known) in directions.iter().zip(&parts) {
                let along = dot(direction, &left);
                left.iter_mut().zip(direction).for_each(|(left, direction)| *left -= along * direction);
                part -= along * known;
            }
        }
        let new = length(&left);
        if new > NOTHING_NEW * whole {
            left.iter_mut().for_each(|left| *left /= new);
            directions.push(left);
            parts.push(part / new);
        }
    }
    for (index, (answer, share)) in answer.iter_mut().zip(shares).enumerate() {
        let sum = directions.iter().zip(&parts).fold(0.0, |sum, (direction, part)| sum + direction[index] * part);
        *answer = share.natural + share.measure * sum;
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).fold(0.0, |sum, (a, b)| sum + a * b)
}

fn length(a: &[f64]) -> f64 {
    dot(a, a).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    const ONE: Share = Share { natural: 0.0, measure: 1.0 };

    fn solved(matrix: &[f64], right: &[f64], shares: &[Share]) -> Vec<f64> {
        let mut answer = right.to_vec();
        solve(matrix, &mut answer, shares.iter().copied(), &mut Vec::new());
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
}
