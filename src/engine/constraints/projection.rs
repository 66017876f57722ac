//! Projection of positions and velocities onto the joints, along the directions in which joints push.
//!
//! Positions: `g(q + M^-1 F mu) = 0`, by iteration with the factor of one state. Source: Hairer, Lubich, Wanner, Geometric
//! Numerical Integration, 2nd ed. 2006, section VII.1.4. Velocities: `J(q) (v + M^-1 F mu) = rate`, by one solution and one
//! refinement. Both make the least change of the state, measured by mass.

use glam::DVec2;

use super::row::Row;
use super::solver::Solver;
use super::{Rows, Share};
use crate::world::Bodies;

/// Iterations of which each has to gain something.
const MOST_ITERATIONS: usize = 60;
/// A gap of less than this share of its size is rounding.
const ROUNDING: f64 = 1e-15;
/// An iteration that leaves more than this share of the greatest gap does not converge. It may do so if the gap is
/// within [`GOOD`] of the size.
const SLOW: f64 = 0.9;
/// A rate that is off by more than this share of the greatest speed contradicts other rows. A rate that follows from
/// other rows is solved more precisely.
const CONTRADICTS: f64 = 1e-6;
/// A row of which others leave less than this share follows from them.
const DEPENDENT: f64 = 1e-10;
/// A gap within this share of its size is good enough where iterations gain no more.
const GOOD: f64 = 1e-13;

/// The treatment of bodies without velocity whose gaps are good enough.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Standing {
    /// They are not moved.
    Stays,
    /// They are moved as all others.
    Moves,
}

/// How far positions were from what joints hold.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Gap {
    /// The greatest gap that is left, in metres or radians.
    pub left: f64,
    /// The index of its row.
    pub row: usize,
    /// Whether the iteration found no state that the joints allow.
    pub failed: bool,
}

/// Working memory of projections: the rows of a state that differs from that of the last evaluation.
#[derive(Debug, Default)]
pub struct Projection {
    /// The rows of the present positions.
    pub rows: Rows,
    values: Vec<f64>,
    /// For the caller: one number for each row.
    pub noted: Vec<f64>,
    /// Impulses or displacements so far, one for each row of the directions.
    sums: Vec<f64>,
}

impl Projection {
    /// Moves bodies along the directions of `along` until the rows that `find` adds to [`Projection::rows`] have no
    /// gaps. Both have the same rows in the same order. Bodies without velocity may stay if their gaps are good enough,
    /// because rounding would move bodies at rest. Returns the remaining gap.
    pub fn place(
        &mut self,
        along: &[Row],
        solver: &mut Solver,
        (bodies, stay): (&mut Bodies, Standing),
        mut find: impl FnMut(&mut Rows, &Bodies),
    ) -> Gap {
        self.sums.clear();
        self.sums.resize(along.len(), 0.0);
        let mut before = f64::INFINITY;
        let mut slow = 0;
        for _ in 0..MOST_ITERATIONS {
            self.rows.clear();
            find(&mut self.rows, bodies);
            let gap = self.greatest_gap();
            let settled = |row: &Row| row.gap.abs() <= ROUNDING * size(row, bodies) || is_left(row, bodies, stay);
            let settled = self.rows.all().iter().all(settled);
            if settled || self.rows.len() != along.len() {
                return gap;
            }
            slow = if gap.left > SLOW * before { slow + 1 } else { 0 };
            let diverges = gap.left.is_nan() || gap.left > 1e3 * before;
            if slow > 1 || diverges {
                return Gap { failed: !self.is_good(), ..gap };
            }
            before = gap.left;
            self.values.clear();
            let wanted = |row: &Row| if is_left(row, bodies, stay) { 0.0 } else { -row.gap };
            self.values.extend(self.rows.all().iter().map(wanted));
            solver.solve(along, bodies, unmeasured, &mut self.values);
            for ((row, &amount), sum) in along.iter().zip(&self.values).zip(&mut self.sums) {
                *sum += amount;
                for side in row.sides.iter().flatten() {
                    let (by, turned) = (bodies.inverse_mass(side.body), bodies.inverse_inertia(side.body));
                    bodies.displace(side.body, side.force * (amount * by), side.torque * (amount * turned));
                }
            }
        }
        self.rows.clear();
        find(&mut self.rows, bodies);
        Gap { failed: !self.is_good(), ..self.greatest_gap() }
    }

    /// For each row of the directions the sum of its corrections. Times the inverse mass it is a displacement.
    pub fn sums(&self) -> &[f64] {
        &self.sums
    }

    /// Whether gaps are as small as rounding of the greatest numbers allows, from which one was found.
    fn is_good(&self) -> bool {
        let rows = self.rows.all();
        let size = rows.iter().fold(0.0_f64, |most, row| most.max(row.size));
        rows.iter().all(|row| row.gap.abs() <= GOOD * size)
    }

    fn greatest_gap(&self) -> Gap {
        let gaps = self.rows.all().iter().map(|row| row.gap.abs()).enumerate();
        let worst = gaps.max_by(|a, b| a.1.total_cmp(&b.1).then(b.0.cmp(&a.0)));
        worst.map_or(Gap::default(), |(row, left)| Gap { left, row, failed: false })
    }

    /// Changes velocities until the rates of `rows` have their required values. `told` receives the index and the
    /// impulse of each row. Returns the index of a row whose rate contradicts the others.
    pub fn speed(
        &mut self,
        rows: &[Row],
        solver: &mut Solver,
        bodies: &mut Bodies,
        mut told: impl FnMut(&Bodies, usize, f64),
    ) -> Option<usize> {
        for _ in 0..2 {
            self.values.clear();
            self.values.extend(rows.iter().map(|row| row.rate - row.velocity(bodies)));
            solver.solve(rows, bodies, unmeasured, &mut self.values);
            for (index, (row, &impulse)) in rows.iter().zip(&self.values).enumerate() {
                told(bodies, index, impulse);
                for side in row.sides.iter().flatten() {
                    let (by, turned) = (bodies.inverse_mass(side.body), bodies.inverse_inertia(side.body));
                    bodies.velocity[side.body] += side.force * (impulse * by);
                    bodies.spin[side.body] += side.torque * (impulse * turned);
                }
            }
        }
        // Rows without a rate never contradict each other, because zero velocity satisfies all of them.
        if rows.iter().all(|row| row.rate == 0.0) {
            return None;
        }
        let fastest = rows.iter().map(|row| row.speeds(bodies)).fold(0.0, f64::max);
        rows.iter().position(|row| (row.rate - row.velocity(bodies)).abs() > CONTRADICTS * fastest)
    }

    /// The velocity along a row, in m/s for each N s, under one unit of impulse. The `others` keep their velocities.
    /// Zero means that the others leave the row no free motion.
    pub fn compliance(&mut self, row: &Row, others: &[Row], solver: &mut Solver, bodies: &Bodies) -> f64 {
        self.values.clear();
        self.values.extend(others.iter().map(|other| other.response(row, bodies)));
        solver.solve(others, bodies, unmeasured, &mut self.values);
        let own = row.response(row, bodies);
        let back = others.iter().zip(&self.values).map(|(other, amount)| row.response(other, bodies) * amount);
        let left = back.fold(own, |sum, term| sum - term);
        if left > DEPENDENT * own { left } else { 0.0 }
    }
}

/// Whether a row is left unchanged, because its bodies have no velocity and its gap is good enough.
fn is_left(row: &Row, bodies: &Bodies, stay: Standing) -> bool {
    let stands = || row.sides.iter().flatten().all(|side| bodies.stands(side.body));
    stay == Standing::Stays && row.gap.abs() <= GOOD * size(row, bodies) && stands()
}

/// The magnitude of the numbers from which a gap was found. The position of a wheel that turns about the origin is
/// zero, but its extent is not.
fn size(row: &Row, bodies: &Bodies) -> f64 {
    row.sides.iter().flatten().fold(row.size, |most, side| most.max(bodies.extent(side.body)))
}

/// Corrections have no natural amount.
fn unmeasured(_: &Row) -> Share {
    Share { natural: 0.0, measure: 1.0 }
}

impl Bodies {
    /// Whether a body has no velocity.
    fn stands(&self, body: usize) -> bool {
        self.velocity[body] == DVec2::ZERO && self.spin[body] == 0.0
    }

    /// All bodies that move by forces go on with their velocities for `length` seconds.
    pub(crate) fn coast(&mut self, length: f64) {
        for body in 0..self.len() {
            if self.dynamic[body] {
                let (by, turn) = (self.velocity[body] * length, self.spin[body] * length);
                self.position[body] += by;
                self.angle[body] += turn;
            }
        }
        (self.posed, self.recorded) = (false, false);
    }

    /// Moves a body beside its velocity. The displacement since the last accepted state follows.
    fn displace(&mut self, body: usize, by: DVec2, turn: f64) {
        self.position[body] += by;
        self.angle[body] += turn;
        if let Some(drift) = self.drift.get_mut(body) {
            *drift += by;
            self.turn[body] += turn;
        }
        (self.posed, self.recorded) = (false, false);
    }
}
