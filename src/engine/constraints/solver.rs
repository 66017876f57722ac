//! Solves `J M^-1 F x = right` for all rows of a list. Joints are solved by sparse factors, and small islands with held
//! contacts densely. In large islands the contacts are a border of the joints (`borders.rs`).
//!
//! Rows of joints have `F = J^T`, so that their matrix is symmetric and positive semidefinite. If rows depend on each
//! other, the matrix is singular. Then a share of its diagonal is added before factoring, and the answer is refined
//! until the rows are satisfied. The answer tends to the solution of least norm (proximal iteration, Rockafellar 1976).
//! The norm measures each unknown by its diagonal and by its [`Share`].

use super::redundant::{Equations, Share};
use super::row::{Row, RowKind};
use super::structure::{Structure, islands};
use crate::world::Bodies;
use glam::DVec2;

/// The share of the diagonal that is added to a singular matrix.
const SHARE: f64 = 1e-10;
/// Refinements of an answer.
const MOST_REFINEMENTS: usize = 40;
/// An answer is good if the error of each row is below this share of the greatest right side.
const ROUNDING: f64 = 1e-15;
/// Rows that depend on each other contradict each other if the answer misses them by this share. A contradiction of the share [`SHARE`]
/// alone makes forces as great as all others. So this one makes a thousandth of them.
const CONTRADICTION: f64 = 1e-3 * SHARE;

/// An island with held contacts and at most this many rows of joints is solved densely, which is faster there.
const MOST_DENSE: usize = 32;

/// Structures that are kept beside the present one. Each stage of a tick has rows of its own: joints alone, or with held contacts.
/// Islands of those may be dense. The stages of the next tick find their structures again.
const KEPT: usize = 3;

/// A joint bears all that contacts leave. Its measure is so many times that of the contacts beside it. The square of
/// this is the share by which contacts depart from their springs.
const BEARS: f64 = 1e4;

/// The share of a row in an island with contacts, whose greatest measure is given. A joint has no spring and no preferred force.
fn among_contacts(row: &Row, share: Share, greatest: f64) -> Share {
    if row.kind == RowKind::Acceleration { share } else { Share { measure: share.measure * BEARS * greatest, ..share } }
}

/// The equations of some rows.
#[derive(Debug, Default)]
pub struct Solver {
    /// The structure of the present rows, and those of others.
    structure: Structure,
    others: Vec<Structure>,
    /// The matrices of dense islands, one behind the other.
    matrix: Vec<f64>,
    /// Whether sparse rows depend on each other.
    dependent: bool,
    /// The velocities that a list of forces gives to the bodies of sparse rows.
    velocity: Vec<DVec2>,
    spin: Vec<f64>,
    right: Vec<f64>,
    answer: Vec<f64>,
    work: Vec<f64>,
    equations: Equations,
}

impl Solver {
    /// The number of multiplications that dense equations took so far.
    pub fn multiplications(&self) -> f64 {
        self.equations.multiplications
    }

    /// Finds the factors, and the structure if it is a new one.
    pub fn prepare(&mut self, rows: &[Row], bodies: &Bodies) {
        self.prepare_with(rows, bodies, MOST_DENSE);
    }

    fn prepare_with(&mut self, rows: &[Row], bodies: &Bodies, most_dense: usize) {
        self.take_structure(rows, bodies, most_dense);
        self.factor_joints(rows, bodies);
        if self.dependent && !self.structure.borders.is_empty() {
            // All rows of an island together decide which of many answers the solver takes.
            self.take_structure(rows, bodies, usize::MAX);
            self.factor_joints(rows, bodies);
        }
        let Structure { sparse, factor, borders, dense, .. } = &mut self.structure;
        borders.prepare(rows, sparse, factor, bodies);
        self.matrix.clear();
        for island in dense {
            for &row in &*island {
                self.matrix.extend(island.iter().map(|other| rows[row].response(&rows[*other], bodies)));
            }
        }
    }

    /// Takes the structure of these rows. Islands with held contacts and at most `most_dense` rows of joints are dense.
    fn take_structure(&mut self, rows: &[Row], bodies: &Bodies, most_dense: usize) {
        let Self { structure, others, .. } = self;
        let fits = |structure: &Structure| structure.is_of(rows, bodies, most_dense);
        if fits(structure) {
            return;
        }
        if let Some(known) = others.iter_mut().find(|known| fits(known)) {
            std::mem::swap(structure, known);
            return;
        }
        if others.len() == KEPT {
            others.remove(0);
        }
        others.push(std::mem::replace(structure, Structure::find(rows, bodies, most_dense)));
    }

    fn factor_joints(&mut self, rows: &[Row], bodies: &Bodies) {
        // More rows than the bodies have freedoms depend on each other, whatever their directions.
        self.dependent = self.structure.sparse.len() > 3 * self.structure.moved.len();
        if !self.dependent {
            self.fill(rows, bodies);
            self.dependent = !self.structure.factor.factor();
        }
        if self.dependent {
            self.fill(rows, bodies);
            self.soften(rows);
            self.structure.factor.factor();
        }
    }

    /// Whether some rows of joints depend on each other, so that only their sum is determined.
    pub fn is_dependent(&self) -> bool {
        self.dependent
    }

    /// The least pivot of the factors as a share of its number before elimination. It exists if joints form loops and
    /// no row depends on others.
    pub fn least_pivot(&self) -> Option<f64> {
        (self.structure.factor.watch && !self.dependent).then_some(self.structure.factor.least_pivot)
    }

    fn fill(&mut self, rows: &[Row], bodies: &Bodies) {
        let numbers = self.structure.factor.numbers();
        numbers.fill(0.0);
        for &(a, b, index) in &self.structure.entries {
            numbers[index as usize] = rows[a as usize].response(&rows[b as usize], bodies);
        }
    }

    /// Adds a share of the diagonal. It is the greater, the smaller the measure of the row is.
    fn soften(&mut self, rows: &[Row]) {
        let numbers = self.structure.factor.numbers();
        for &(row, _, index) in self.structure.entries.iter().filter(|(a, b, _)| a == b) {
            let number = &mut numbers[index as usize];
            *number += SHARE / rows[row as usize].share.measure.powi(2) * *number;
        }
    }

    /// Solves for `values`, a number for each row, in their place. Dense islands with dependent rows take the answer nearest to their
    /// shares.
    pub fn solve(&mut self, rows: &[Row], bodies: &Bodies, shares: impl Fn(&Row) -> Share, values: &mut [f64]) {
        let mut matrix = self.matrix.as_slice();
        for island in &self.structure.dense {
            let (own, others) = matrix.split_at(island.len() * island.len());
            self.answer.clear();
            self.answer.extend(island.iter().map(|row| values[*row]));
            let contacts = island.iter().filter(|row| rows[**row].kind == RowKind::Acceleration);
            let greatest = contacts.map(|row| shares(&rows[*row]).measure).fold(f64::MIN_POSITIVE, f64::max);
            let shares = |row: &usize| among_contacts(&rows[*row], shares(&rows[*row]), greatest);
            self.equations.solve(own, &mut self.answer, island.iter().map(shares));
            island.iter().zip(&self.answer).for_each(|(row, value)| values[*row] = *value);
            matrix = others;
        }
        if self.structure.sparse.is_empty() {
            return;
        }
        self.right.clear();
        self.right.extend(self.structure.sparse.iter().map(|row| values[*row]));
        self.answer.clone_from(&self.right);
        self.structure.factor.solve(&mut self.answer);
        if self.dependent && self.refine(rows, bodies) > CONTRADICTION {
            self.make_consistent(rows, bodies);
            self.answer.clone_from(&self.right);
            self.structure.factor.solve(&mut self.answer);
            self.refine(rows, bodies);
        }
        let Self { structure, equations, answer, .. } = self;
        structure.borders.solve((rows, &structure.sparse), bodies, shares, values, (answer, equations));
        self.structure.sparse.iter().zip(&self.answer).for_each(|(row, value)| values[*row] = *value);
    }

    /// Takes from the right sides what no force can give, as a body that turns cannot keep two points still. The softened matrix would
    /// answer with an enormous force that does nothing. Each product leaves a share of rounding over [`SHARE`] of the contradiction. So two
    /// make it harmless. An island with a row that may give way keeps its enormous force, which tells the row that does.
    fn make_consistent(&mut self, rows: &[Row], bodies: &Bodies) {
        let right = self.right.clone();
        for _ in 0..2 {
            self.answer.clone_from(&self.right);
            self.structure.factor.solve(&mut self.answer);
            self.spread(rows, bodies);
            for (index, &row) in self.structure.sparse.iter().enumerate() {
                self.right[index] = self.gathered(&rows[row]);
            }
        }
        let gives_way = |island: &Vec<usize>| island.iter().any(|row| rows[*row].gives_way());
        for row in islands(rows, bodies).into_iter().filter(gives_way).flatten() {
            if let Ok(index) = self.structure.sparse.binary_search(&row) {
                self.right[index] = right[index];
            }
        }
    }

    /// Refines the answer. Returns the greatest error of a row that is left, as a share of the greatest right side.
    fn refine(&mut self, rows: &[Row], bodies: &Bodies) -> f64 {
        let scale = self.right.iter().fold(0.0_f64, |most, value| most.max(value.abs()));
        let mut before = f64::INFINITY;
        for _ in 0..MOST_REFINEMENTS {
            self.spread(rows, bodies);
            self.work.clear();
            for (index, &row) in self.structure.sparse.iter().enumerate() {
                self.work.push(self.right[index] - self.gathered(&rows[row]));
            }
            let worst = self.work.iter().fold(0.0_f64, |most, value| most.max(value.abs()));
            if worst <= ROUNDING * scale || worst >= 0.5 * before {
                before = worst;
                break;
            }
            before = worst;
            self.structure.factor.solve(&mut self.work);
            self.answer.iter_mut().zip(&self.work).for_each(|(answer, more)| *answer += more);
        }
        if scale > 0.0 { before / scale } else { 0.0 }
    }

    /// The changes of velocities that the answer makes.
    fn spread(&mut self, rows: &[Row], bodies: &Bodies) {
        self.velocity.resize(bodies.len(), DVec2::ZERO);
        self.spin.resize(bodies.len(), 0.0);
        for &body in &self.structure.moved {
            (self.velocity[body], self.spin[body]) = (DVec2::ZERO, 0.0);
        }
        for (&row, &amount) in self.structure.sparse.iter().zip(&self.answer) {
            for side in rows[row].sides.iter().flatten() {
                self.velocity[side.body] += side.force * (amount * bodies.inverse_mass(side.body));
                self.spin[side.body] += side.torque * (amount * bodies.inverse_inertia(side.body));
            }
        }
    }

    fn gathered(&self, row: &Row) -> f64 {
        let of =
            |side: &super::RowSide| side.direction.dot(self.velocity[side.body]) + side.lever * self.spin[side.body];
        row.sides.iter().flatten().map(of).fold(0.0, |sum, term| sum + term)
    }
}

#[cfg(test)]
mod tests {
    use super::super::row::RowSide;
    use super::*;
    use bevy_ecs::entity::Entity;

    /// Law: rows that contradict each other make no force that does nothing. Two welds hold one body: six rows for three freedoms. Forces
    /// for right sides that no motion satisfies are no greater than those without the contradiction.
    #[test]
    fn a_contradiction_makes_no_enormous_forces() {
        let bodies = Bodies {
            entity: vec![Entity::PLACEHOLDER],
            dynamic: vec![true],
            mass: vec![0.2],
            inertia: vec![1e-3],
            ..Bodies::default()
        };
        let weld = |arm: DVec2| {
            let side =
                |direction: DVec2, lever: f64| RowSide { body: 0, direction, lever, force: direction, torque: lever };
            let along = [DVec2::X, DVec2::Y].map(|direction| side(direction, arm.perp_dot(direction)));
            let all = [along[0], along[1], side(DVec2::ZERO, 1.0)];
            all.map(|side| Row { sides: [None, Some(side)], kind: RowKind::Position, ..Row::default() })
        };
        let arms = [DVec2::new(-0.39, -0.64), DVec2::new(0.15, -0.098)];
        let rows: Vec<Row> = arms.into_iter().flat_map(weld).collect();
        let response = |forces: &[f64]| -> Vec<f64> {
            rows.iter()
                .map(|row| rows.iter().zip(forces).map(|(other, f)| row.response(other, &bodies) * f).sum())
                .collect()
        };
        let solved = |right: &[f64]| {
            let (mut solver, mut values) = (Solver::default(), right.to_vec());
            solver.prepare(&rows, &bodies);
            assert!(solver.is_dependent());
            solver.solve(&rows, &bodies, |row| row.share, &mut values);
            values
        };
        let right = response(&[2.0, -1.0, 0.3, 0.0, 0.0, 0.0]);
        let plain = solved(&right);
        // Two points of a body that turns at 1 rad/s are to keep still.
        let turns = [-0.39, -0.64, 0.0, 0.15, -0.098, 0.0];
        let contradicted: Vec<f64> = right.iter().zip(turns).map(|(right, more)| right + more).collect();
        let found = solved(&contradicted);
        let size = |forces: &[f64]| forces.iter().fold(0.0_f64, |most, force| most.max(force.abs()));
        assert!(size(&found) < 3.0 * size(&plain), "{found:?} instead of {plain:?}");
        // The rest, each row by its diagonal, has no part that a force could give.
        let left = rows.iter().zip(contradicted.iter().zip(response(&found)));
        let left: Vec<f64> = left.map(|(row, (right, got))| (right - got) / row.response(row, &bodies)).collect();
        let gain = size(&response(&left));
        assert!(gain < 1e-6 * size(&response(&right)), "{gain:e}");
    }

    /// Law: a border gives the forces that the whole dense matrix gives. A chain of forty links hangs by its ends; contacts hold
    /// some of them, one slides. Tolerance: rounding times the condition of the matrix, which is below 1e4.
    #[test]
    fn a_border_gives_the_forces_of_the_dense_matrix() {
        const LINKS: usize = 40;
        let bodies = Bodies {
            entity: vec![Entity::PLACEHOLDER; LINKS],
            dynamic: vec![true; LINKS],
            mass: vec![2.0; LINKS],
            inertia: vec![0.5; LINKS],
            ..Bodies::default()
        };
        let side = |body: usize, way: f64, direction: DVec2, arm: f64| {
            let direction = direction * way;
            let sag = 0.1 * body as f64 - 2.0;
            let lever = DVec2::new(arm, sag * arm).perp_dot(direction);
            Some(RowSide { body, direction, lever, force: direction, torque: lever })
        };
        let mut rows = Vec::new();
        for link in 0..=LINKS {
            for direction in [DVec2::X, DVec2::Y] {
                let a = link.checked_sub(1).and_then(|body| side(body, -1.0, direction, 0.5));
                let b = (link < LINKS).then(|| side(link, 1.0, direction, -0.5)).flatten();
                rows.push(Row { sides: [a, b], kind: RowKind::Position, ..Row::default() });
            }
        }
        for link in [3, 17, 18, 30] {
            let mut row = Row { sides: [None, side(link, 1.0, DVec2::new(0.6, 0.8), 0.3)], ..Row::default() };
            if let (17, Some(side)) = (link, &mut row.sides[1]) {
                side.force += DVec2::new(0.1, -0.2);
            }
            rows.push(row);
        }
        let right: Vec<f64> = (0..rows.len()).map(|row| ((7 * row) % 11) as f64 - 5.0).collect();
        let solved = |most_dense: usize| {
            let (mut solver, mut values) = (Solver::default(), right.clone());
            solver.prepare_with(&rows, &bodies, most_dense);
            solver.solve(&rows, &bodies, |row| row.share, &mut values);
            (solver.structure.borders.is_empty(), values)
        };
        let (bordered, dense) = (solved(MOST_DENSE), solved(usize::MAX));
        assert_eq!((bordered.0, dense.0), (false, true));
        let size = dense.1.iter().fold(0.0_f64, |most, value| most.max(value.abs()));
        for (found, exact) in bordered.1.iter().zip(&dense.1) {
            assert!((found - exact).abs() < 1e4 * f64::EPSILON * size, "{found} instead of {exact}");
        }
    }
}
