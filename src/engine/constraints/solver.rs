//! Solves `J M^-1 F x = right` for all rows of a list. Joints are solved by sparse factors, and small islands with held
//! contacts densely. In large islands the contacts are a border of the joints (`borders.rs`).
//!
//! Rows of joints have `F = J^T`, so that their matrix is symmetric and positive semidefinite. If rows depend on each
//! other, the matrix is singular. Then a share of its diagonal is added before factoring, and the answer is refined
//! until the rows are satisfied. The answer tends to the solution of least norm (proximal iteration, Rockafellar 1976).
//! The norm measures each unknown by its diagonal and by its [`Share`].

use super::block_cholesky::BlockCholesky;
use super::borders::Borders;
use super::islands::{IslandLink, Islands, find};
use super::redundant::{self, Share};
use super::row::{Row, RowKind};
use crate::world::Bodies;
use glam::DVec2;

/// The share of the diagonal that is added to a singular matrix.
const SHARE: f64 = 1e-10;
/// Refinements of an answer.
const MOST_REFINEMENTS: usize = 40;
/// An answer is good if the error of each row is below this share of the greatest right side.
const ROUNDING: f64 = 1e-15;

/// An island with held contacts and at most this many rows of joints is solved densely, which is faster there.
const MOST_DENSE: usize = 32;

/// Marks the side of a row that no force moves.
const NONE: u32 = u32::MAX;

/// A row as far as the structure of the equations depends on it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Ends {
    bodies: [u32; 2],
    held: bool,
}

/// A row among the links of which islands consist.
#[derive(Clone, Copy)]
struct Linked {
    row: usize,
    own: usize,
    other: Option<usize>,
}

impl IslandLink for Linked {
    fn other_body(&self) -> Option<usize> {
        self.other
    }

    fn own_body(&self) -> usize {
        self.own
    }
}

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
    /// The topology for which the structure was found.
    ends: Vec<Ends>,
    /// Rows of joints outside the dense islands, in the order of the unknowns of the factor.
    sparse: Vec<usize>,
    factor: BlockCholesky,
    /// Two rows and the index of their entry.
    entries: Vec<(u32, u32, u32)>,
    /// Held contacts beside the factor.
    borders: Borders,
    /// Rows of each other island with held contacts, and the matrices of those, one behind the other.
    dense: Vec<Vec<usize>>,
    matrix: Vec<f64>,
    /// Whether sparse rows depend on each other.
    dependent: bool,
    /// Bodies of sparse rows, and the velocities that a list of forces gives them.
    moved: Vec<usize>,
    velocity: Vec<DVec2>,
    spin: Vec<f64>,
    right: Vec<f64>,
    answer: Vec<f64>,
    work: Vec<f64>,
}

impl Solver {
    /// Finds the factors, and the structure if it has changed.
    pub fn prepare(&mut self, rows: &[Row], bodies: &Bodies) {
        let same = rows.len() == self.ends.len() && rows.iter().zip(&self.ends).all(|(row, e)| ends(row, bodies) == *e);
        if !same {
            self.find_structure(rows, bodies, MOST_DENSE);
        }
        self.factor_joints(rows, bodies);
        if self.dependent && !self.borders.is_empty() {
            // All rows of an island together decide which of many answers the solver takes.
            self.find_structure(rows, bodies, usize::MAX);
            self.factor_joints(rows, bodies);
        }
        self.borders.prepare(rows, &self.sparse, &self.factor, bodies);
        self.matrix.clear();
        for island in &self.dense {
            for &row in island {
                self.matrix.extend(island.iter().map(|other| rows[row].response(&rows[*other], bodies)));
            }
        }
    }

    fn factor_joints(&mut self, rows: &[Row], bodies: &Bodies) {
        // More rows than the bodies have freedoms depend on each other, whatever their directions.
        self.dependent = self.sparse.len() > 3 * self.moved.len();
        if !self.dependent {
            self.fill(rows, bodies);
            self.dependent = !self.factor.factor();
        }
        if self.dependent {
            self.fill(rows, bodies);
            self.soften(rows);
            self.factor.factor();
        }
    }

    /// Whether some rows of joints depend on each other, so that only their sum is determined.
    pub fn is_dependent(&self) -> bool {
        self.dependent
    }

    /// The least pivot of the factors as a share of its number before elimination. It exists if joints form loops and
    /// no row depends on others.
    pub fn least_pivot(&self) -> Option<f64> {
        (self.factor.watch && !self.dependent).then_some(self.factor.least_pivot)
    }

    fn fill(&mut self, rows: &[Row], bodies: &Bodies) {
        let numbers = self.factor.numbers();
        numbers.fill(0.0);
        for &(a, b, index) in &self.entries {
            numbers[index as usize] = rows[a as usize].response(&rows[b as usize], bodies);
        }
    }

    /// Adds a share of the diagonal. It is the greater, the smaller the measure of the row is.
    fn soften(&mut self, rows: &[Row]) {
        let numbers = self.factor.numbers();
        for &(row, _, index) in self.entries.iter().filter(|(a, b, _)| a == b) {
            let number = &mut numbers[index as usize];
            *number += SHARE / rows[row as usize].share.measure.powi(2) * *number;
        }
    }

    /// Islands with held contacts and at most `most_dense` rows of joints are solved densely.
    fn find_structure(&mut self, rows: &[Row], bodies: &Bodies, most_dense: usize) {
        self.ends.clear();
        self.ends.extend(rows.iter().map(|row| ends(row, bodies)));
        let mut links: Vec<Linked> = rows
            .iter()
            .enumerate()
            .filter_map(|(row, of)| {
                let [a, b] = of.sides.map(|side| side.map(|side| side.body));
                Some(Linked { row, own: b.or(a)?, other: b.and(a) })
            })
            .collect();
        let mut islands = Islands::default();
        islands.sort::<_, Linked>(&mut links, &mut [], bodies);
        (self.dense, self.sparse) = (Vec::new(), Vec::new());
        let mut borders = Vec::new();
        for island in links.chunk_by(|a, b| islands.of(a, bodies) == islands.of(b, bodies)) {
            let mut island: Vec<usize> = island.iter().map(|link| link.row).collect();
            island.sort_unstable();
            let (held, joints): (Vec<usize>, Vec<usize>) = island.iter().partition(|row| self.ends[**row].held);
            if !held.is_empty() && joints.len() <= most_dense {
                self.dense.push(island);
                continue;
            }
            self.sparse.extend(joints);
            if !held.is_empty() {
                borders.push(held);
            }
        }
        self.sparse.sort_unstable();
        self.find_nodes(bodies);
        self.find_borders(borders, rows, bodies);
    }

    fn find_borders(&mut self, borders: Vec<Vec<usize>>, rows: &[Row], bodies: &Bodies) {
        self.borders.clear();
        if borders.is_empty() {
            return;
        }
        let mut unknowns = vec![Vec::new(); bodies.len()];
        for (unknown, &row) in self.sparse.iter().enumerate() {
            let moved = self.ends[row].bodies.into_iter().filter(|body| *body != NONE);
            moved.for_each(|body| unknowns[body as usize].push(unknown));
        }
        borders.into_iter().for_each(|held| self.borders.add(held, rows, &unknowns));
    }

    /// Consecutive rows between the same bodies are a node. Nodes with a body in common have an edge.
    fn find_nodes(&mut self, bodies: &Bodies) {
        let Self { ends, sparse, .. } = self;
        let (mut size, mut owner): (Vec<u32>, Vec<(u32, u32)>) = (Vec::new(), Vec::new());
        let mut nodes_of: Vec<Vec<u32>> = vec![Vec::new(); bodies.len()];
        for (index, &row) in sparse.iter().enumerate() {
            let joins = index > 0 && sparse[index - 1] + 1 == row && ends[sparse[index - 1]] == ends[row];
            if !joins {
                size.push(0);
                let moved = ends[row].bodies.into_iter().filter(|body| *body != NONE);
                moved.for_each(|body| nodes_of[body as usize].push(size.len() as u32 - 1));
            }
            let node = size.len() - 1;
            owner.push((node as u32, size[node]));
            size[node] += 1;
        }
        let mut edges: Vec<(u32, u32)> = nodes_of
            .iter()
            .flat_map(|nodes| {
                nodes.iter().enumerate().flat_map(|(index, a)| nodes[index + 1..].iter().map(|b| (*a, *b)))
            })
            .collect();
        edges.sort_unstable();
        edges.dedup();
        let mut first = vec![0; size.len()];
        for (index, (node, own)) in owner.iter().enumerate() {
            if *own == 0 {
                first[*node as usize] = index;
            }
        }
        self.factor = BlockCholesky::new(size.clone(), edges.iter().copied());
        self.entries.clear();
        let within = |node: u32| first[node as usize]..first[node as usize] + size[node as usize] as usize;
        let pairs = (0..size.len() as u32).map(|node| (node, node)).chain(edges);
        for (a, b) in pairs {
            for row in within(a) {
                for column in within(b) {
                    let index = self.factor.entry(owner[row], owner[column]);
                    let index = index.or_else(|| self.factor.entry(owner[column], owner[row]));
                    let index = index.expect("these nodes have an edge");
                    self.entries.push((sparse[row] as u32, sparse[column] as u32, index as u32));
                }
            }
        }
        self.moved = (0..bodies.len()).filter(|body| !nodes_of[*body].is_empty()).collect();
        let nodes = first.iter().map(|index| ends[sparse[*index]].bodies);
        self.factor.watch = has_loop(nodes, bodies.len());
    }

    /// Solves for `values`, a number for each row, in their place. Dense islands with dependent rows take the answer nearest to their
    /// shares.
    pub fn solve(&mut self, rows: &[Row], bodies: &Bodies, shares: impl Fn(&Row) -> Share, values: &mut [f64]) {
        let mut matrix = self.matrix.as_slice();
        for island in &self.dense {
            let (own, others) = matrix.split_at(island.len() * island.len());
            self.answer.clear();
            self.answer.extend(island.iter().map(|row| values[*row]));
            let contacts = island.iter().filter(|row| rows[**row].kind == RowKind::Acceleration);
            let greatest = contacts.map(|row| shares(&rows[*row]).measure).fold(f64::MIN_POSITIVE, f64::max);
            let shares = |row: &usize| among_contacts(&rows[*row], shares(&rows[*row]), greatest);
            redundant::solve(own, &mut self.answer, island.iter().map(shares), &mut self.work);
            island.iter().zip(&self.answer).for_each(|(row, value)| values[*row] = *value);
            matrix = others;
        }
        if self.sparse.is_empty() {
            return;
        }
        self.right.clear();
        self.right.extend(self.sparse.iter().map(|row| values[*row]));
        self.answer.clone_from(&self.right);
        self.factor.solve(&mut self.answer);
        if self.dependent {
            self.refine(rows, bodies);
        }
        self.borders.solve((rows, &self.sparse), bodies, shares, values, &mut self.answer);
        self.sparse.iter().zip(&self.answer).for_each(|(row, value)| values[*row] = *value);
    }

    fn refine(&mut self, rows: &[Row], bodies: &Bodies) {
        let scale = self.right.iter().fold(0.0_f64, |most, value| most.max(value.abs()));
        let mut before = f64::INFINITY;
        for _ in 0..MOST_REFINEMENTS {
            self.spread(rows, bodies);
            self.work.clear();
            for (index, &row) in self.sparse.iter().enumerate() {
                self.work.push(self.right[index] - self.gathered(&rows[row]));
            }
            let worst = self.work.iter().fold(0.0_f64, |most, value| most.max(value.abs()));
            if worst <= ROUNDING * scale || worst >= 0.5 * before {
                break;
            }
            before = worst;
            self.factor.solve(&mut self.work);
            self.answer.iter_mut().zip(&self.work).for_each(|(answer, more)| *answer += more);
        }
    }

    /// The changes of velocities that the answer makes.
    fn spread(&mut self, rows: &[Row], bodies: &Bodies) {
        self.velocity.resize(bodies.len(), DVec2::ZERO);
        self.spin.resize(bodies.len(), 0.0);
        for &body in &self.moved {
            (self.velocity[body], self.spin[body]) = (DVec2::ZERO, 0.0);
        }
        for (&row, &amount) in self.sparse.iter().zip(&self.answer) {
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

/// Whether joints form a loop, found by union-find. Fixed bodies, prescribed bodies and the world count as one body.
fn has_loop(mut joints: impl Iterator<Item = [u32; 2]>, bodies: usize) -> bool {
    let mut root: Vec<u32> = (0..=bodies as u32).collect();
    let closes = |[a, b]: [u32; 2]| {
        let [a, b] = [a, b].map(|body| find(&mut root, body.min(bodies as u32)));
        root[a.max(b) as usize] = a.min(b);
        a == b
    };
    joints.any(closes)
}

fn ends(row: &Row, bodies: &Bodies) -> Ends {
    let body = |side: Option<super::RowSide>| {
        side.filter(|side| bodies.dynamic[side.body]).map_or(NONE, |side| side.body as u32)
    };
    Ends { bodies: row.sides.map(body), held: row.kind == RowKind::Acceleration }
}

#[cfg(test)]
mod tests {
    use super::super::row::RowSide;
    use super::*;
    use bevy_ecs::entity::Entity;

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
            solver.find_structure(&rows, &bodies, most_dense);
            solver.prepare(&rows, &bodies);
            solver.solve(&rows, &bodies, |row| row.share, &mut values);
            (solver.borders.is_empty(), values)
        };
        let (bordered, dense) = (solved(MOST_DENSE), solved(usize::MAX));
        assert_eq!((bordered.0, dense.0), (false, true));
        let size = dense.1.iter().fold(0.0_f64, |most, value| most.max(value.abs()));
        for (found, exact) in bordered.1.iter().zip(&dense.1) {
            assert!((found - exact).abs() < 1e4 * f64::EPSILON * size, "{found} instead of {exact}");
        }
    }
}
