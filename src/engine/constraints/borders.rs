//! The Schur complement: held contacts of large islands beside sparse factors of their joints.
//!
//! `A x + B y = a` and `C x + D y = b`, with `A` the matrix of the joints, give `(D - C A^-1 B) y = b - C A^-1 a`. The
//! factors of `A` exist, so an island of many joints and few contacts costs little more than its joints. The remaining
//! matrix is dense, with one row for each contact. It need not be symmetric, because the force of a sliding contact is
//! not along its row.

use super::block_cholesky::BlockCholesky;
use super::redundant::{Equations, Share};
use super::row::Row;
use crate::world::Bodies;

/// The held contacts of one island.
#[derive(Debug, Default)]
struct Border {
    /// Indices of their rows.
    held: Vec<usize>,
    /// A contact, by its place among them, and an unknown of the factor that move one body.
    couples: Vec<(usize, usize)>,
}

/// The held contacts of all islands that have borders.
#[derive(Debug, Default)]
pub(super) struct Borders {
    islands: Vec<Border>,
    /// `A^-1 B`, contact by contact.
    columns: Vec<f64>,
    /// `D - C A^-1 B`, island by island.
    matrix: Vec<f64>,
    answer: Vec<f64>,
}

impl Borders {
    /// Whether there are no contacts.
    pub fn is_empty(&self) -> bool {
        self.islands.is_empty()
    }

    /// Adds the held contacts of an island. `unknowns` names, for each body, the unknowns of the factor that move it.
    pub fn add(&mut self, held: Vec<usize>, rows: &[Row], unknowns: &[Vec<usize>]) {
        let mut couples = Vec::new();
        for (index, &row) in held.iter().enumerate() {
            let sides = rows[row].sides.iter().flatten();
            couples.extend(sides.flat_map(|side| unknowns[side.body].iter().map(|unknown| (index, *unknown))));
        }
        couples.sort_unstable();
        couples.dedup();
        self.islands.push(Border { held, couples });
    }

    /// Finds the matrices of the contacts. `joints` are the rows of the unknowns of the factor.
    pub fn prepare(&mut self, rows: &[Row], joints: &[usize], factor: &BlockCholesky, bodies: &Bodies) {
        self.columns.clear();
        self.matrix.clear();
        for Border { held, couples } in &self.islands {
            let first = self.columns.len();
            self.columns.resize(first + held.len() * joints.len(), 0.0);
            for &(index, unknown) in couples {
                let response = rows[joints[unknown]].response(&rows[held[index]], bodies);
                self.columns[first + index * joints.len() + unknown] = response;
            }
            let columns = &mut self.columns[first..];
            columns.chunks_exact_mut(joints.len()).for_each(|column| factor.solve(column));
            let begin = self.matrix.len();
            for &row in held {
                self.matrix.extend(held.iter().map(|other| rows[row].response(&rows[*other], bodies)));
            }
            let matrix = &mut self.matrix[begin..];
            for &(index, unknown) in couples {
                let response = rows[held[index]].response(&rows[joints[unknown]], bodies);
                for (entry, column) in matrix[index * held.len()..].iter_mut().zip(columns.chunks_exact(joints.len())) {
                    *entry -= response * column[unknown];
                }
            }
        }
    }

    /// Finds the forces of the contacts in `values`. `joint_answer` is the answer of the joints, first without contacts
    /// and then with them.
    pub fn solve(
        &mut self,
        (rows, joints): (&[Row], &[usize]),
        bodies: &Bodies,
        shares: impl Fn(&Row) -> Share,
        values: &mut [f64],
        (joint_answer, equations): (&mut [f64], &mut Equations),
    ) {
        let (mut columns, mut matrix) = (self.columns.as_slice(), self.matrix.as_slice());
        for Border { held, couples } in &self.islands {
            self.answer.clear();
            self.answer.extend(held.iter().map(|row| values[*row]));
            for &(index, unknown) in couples {
                self.answer[index] -=
                    rows[held[index]].response(&rows[joints[unknown]], bodies) * joint_answer[unknown];
            }
            let (own, others) = matrix.split_at(held.len() * held.len());
            equations.solve(own, &mut self.answer, held.iter().map(|row| shares(&rows[*row])));
            let (of_island, rest) = columns.split_at(held.len() * joints.len());
            for ((row, force), column) in held.iter().zip(&self.answer).zip(of_island.chunks_exact(joints.len())) {
                values[*row] = *force;
                joint_answer.iter_mut().zip(column).for_each(|(answer, entry)| *answer -= force * entry);
            }
            (columns, matrix) = (rest, others);
        }
    }
}
