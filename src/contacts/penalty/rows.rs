//! Contacts that do not move, as rows of linear equations: the forces that keep the relative accelerations at zero.
//!
//! `J a = 0` with `a = M^-1 (f + F lambda)` gives `(J M^-1 F) lambda = -(J M^-1 f + c)`, with `c` what the relative
//! accelerations are without any force. A contact that slips along its tangent while its normal is held has a force that is
//! not along its row: `F` differs from `J^T` there (Baraff 1991). Where rows depend on each other the later one gets no
//! force.

use glam::DVec2;

use super::law::PairLaw;
use super::staged::Look;
use crate::tick::Balance;
use crate::world::Bodies;

/// A pivot below this share of the largest one counts as zero: its row says nothing new.
const DEPENDENT: f64 = 1e-12;

/// One side of a row.
#[derive(Clone, Copy, Default)]
struct Side {
    body: usize,
    /// Direction and lever of the row.
    direction: DVec2,
    lever: f64,
    /// Force and torque of one unit.
    force: DVec2,
    torque: f64,
}

struct Row {
    look: Look,
    tangent: bool,
    sides: [Option<Side>; 2],
    /// The relative acceleration without any force.
    inertial: f64,
}

impl Row {
    fn velocity(&self, bodies: &Bodies) -> f64 {
        let of = |side: &Side| side.direction.dot(bodies.velocity[side.body]) + side.lever * bodies.spin[side.body];
        self.sides.iter().flatten().map(of).fold(0.0, |sum, term| sum + term)
    }

    fn acceleration(&self, bodies: &Bodies) -> f64 {
        let of = |side: &Side| {
            let (force, torque) = (bodies.force[side.body], bodies.torque[side.body]);
            side.direction.dot(force) * bodies.inverse_mass[side.body]
                + side.lever * torque * bodies.inverse_inertia[side.body]
        };
        self.sides.iter().flatten().map(of).fold(self.inertial, |sum, term| sum + term)
    }

    /// The acceleration of this row that one unit of the other one's force makes.
    fn response(&self, other: &Row, bodies: &Bodies) -> f64 {
        let mut sum = 0.0;
        for own in self.sides.iter().flatten() {
            for side in other.sides.iter().flatten().filter(|side| side.body == own.body) {
                sum += own.direction.dot(side.force) * bodies.inverse_mass[own.body]
                    + own.lever * side.torque * bodies.inverse_inertia[own.body];
            }
        }
        sum
    }
}

/// A share of a force that counts as rounding.
const ROUNDING: f64 = 1e-12;

/// A body with the sum of the forces that hold it, in newtons.
struct Loaded {
    body: usize,
    load: f64,
}

/// The rows of one evaluation.
#[derive(Default)]
pub(super) struct Rows {
    rows: Vec<Row>,
    loads: Vec<Loaded>,
    matrix: Vec<f64>,
    answer: Vec<f64>,
}

impl std::fmt::Debug for Rows {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        write!(f, "Rows({})", self.rows.len())
    }
}

impl Rows {
    pub fn clear(&mut self) {
        self.rows.clear();
    }

    pub fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }

    /// The normal of a contact is held. While it slips its tangential force is `slope` times the normal one.
    pub fn add_normal(&mut self, look: &Look, law: &PairLaw, slope: f64, bodies: &Bodies) {
        let normal = look.case.normal;
        self.add(look, law, false, normal, normal - normal.perp() * slope, look.inertial(law, bodies).0);
    }

    /// The tangent of a contact is held.
    pub fn add_tangent(&mut self, look: &Look, law: &PairLaw, bodies: &Bodies) {
        let tangent = look.case.normal.perp();
        self.add(look, law, true, tangent, tangent, look.inertial(law, bodies).1);
    }

    fn add(&mut self, look: &Look, law: &PairLaw, tangent: bool, direction: DVec2, force: DVec2, inertial: f64) {
        let (arm_a, arm_b) = look.contact_arms(law);
        let side = |body: usize, arm: DVec2, sign: f64| Side {
            body,
            direction: sign * direction,
            lever: sign * arm.perp_dot(direction),
            force: sign * force,
            torque: sign * arm.perp_dot(force),
        };
        let other = look.case.other_body().map(|body| side(body, arm_a, -1.0));
        let sides = [other, Some(side(look.case.end.body, arm_b, 1.0))];
        self.rows.push(Row { look: *look, tangent, sides, inertial });
    }

    /// Finds the forces, given all others.
    pub fn solve(&mut self, bodies: &Bodies) {
        let rows = &self.rows;
        self.matrix.clear();
        self.matrix.extend(rows.iter().flat_map(|row| rows.iter().map(|other| row.response(other, bodies))));
        self.answer.clear();
        self.answer.extend(rows.iter().map(|row| -row.acceleration(bodies)));
        eliminate(&mut self.matrix, &mut self.answer);
    }

    /// Impulses that make the relative velocities of all rows zero: what rounding and the error of a step have left there.
    /// Says whether anything changed.
    pub fn stop(&mut self, bodies: &mut Bodies, dt: f64) -> bool {
        let rows = &self.rows;
        self.matrix.clear();
        self.matrix.extend(rows.iter().flat_map(|row| rows.iter().map(|other| row.response(other, bodies))));
        self.answer.clear();
        self.answer.extend(rows.iter().map(|row| -row.velocity(bodies)));
        eliminate(&mut self.matrix, &mut self.answer);
        for (row, &impulse) in self.rows.iter().zip(&self.answer) {
            for side in row.sides.iter().flatten() {
                bodies.velocity[side.body] += side.force * (impulse * bodies.inverse_mass[side.body]);
                bodies.spin[side.body] += side.torque * (impulse * bodies.inverse_inertia[side.body]);
            }
        }
        for Loaded { body, load } in &self.loads {
            let limit = ROUNDING * load * dt * mobility(bodies, *body);
            if bodies.velocity[*body].length() + bodies.spin[*body].abs() * bodies.extent[*body] <= limit {
                (bodies.velocity[*body], bodies.spin[*body]) = (DVec2::ZERO, 0.0);
            }
        }
        self.answer.iter().any(|impulse| *impulse != 0.0)
    }

    /// Bodies that stand and whose forces cancel but for rounding: what rounding leaves is no force.
    pub fn cancel(&mut self, bodies: &mut Bodies, balance: &mut Balance) {
        self.loads.clear();
        for (row, &force) in self.rows.iter().zip(&self.answer) {
            for side in row.sides.iter().flatten() {
                let load = force.abs() * side.force.length();
                match self.loads.iter_mut().find(|loaded| loaded.body == side.body) {
                    Some(loaded) => loaded.load += load,
                    None => self.loads.push(Loaded { body: side.body, load }),
                }
            }
        }
        for &Loaded { body, load } in &self.loads {
            let stands = bodies.velocity[body] == DVec2::ZERO && bodies.spin[body] == 0.0;
            let (force, torque) = (bodies.force[body], bodies.torque[body]);
            let turning = torque.abs() * bodies.inverse_inertia[body] * bodies.extent[body];
            let limit = ROUNDING * load * mobility(bodies, body);
            if stands && force.length() * bodies.inverse_mass[body] + turning <= limit {
                balance.outside(bodies.position[body], -force, -torque);
                (bodies.force[body], bodies.torque[body]) = (DVec2::ZERO, 0.0);
            }
        }
    }

    /// The contact of each row, whether it is its tangent, and its force in newtons on side B.
    pub fn answers(&self) -> impl Iterator<Item = (Look, bool, f64)> + '_ {
        self.rows.iter().zip(&self.answer).map(|(row, &force)| (row.look, row.tangent, force))
    }
}

/// The greatest acceleration that a newton gives a point of a body, in 1/kg.
fn mobility(bodies: &Bodies, body: usize) -> f64 {
    bodies.inverse_mass[body] + bodies.extent[body].powi(2) * bodies.inverse_inertia[body]
}

/// Gaussian elimination with exchange of rows; unknowns whose pivot vanishes become zero.
fn eliminate(matrix: &mut [f64], answer: &mut [f64]) {
    let size = answer.len();
    let largest = matrix.iter().fold(0.0_f64, |largest, entry| largest.max(entry.abs()));
    let mut free = vec![true; size];
    let mut pivots = vec![None; size];
    for column in 0..size {
        let candidates = (0..size).filter(|&row| free[row]);
        let best = candidates.max_by(|&a, &b| {
            matrix[a * size + column].abs().total_cmp(&matrix[b * size + column].abs()).then(b.cmp(&a))
        });
        let Some(pivot) = best.filter(|&row| matrix[row * size + column].abs() > DEPENDENT * largest) else { continue };
        free[pivot] = false;
        pivots[column] = Some(pivot);
        for row in (0..size).filter(|&row| row != pivot) {
            let factor = matrix[row * size + column] / matrix[pivot * size + column];
            if factor != 0.0 {
                for place in column..size {
                    matrix[row * size + place] -= factor * matrix[pivot * size + place];
                }
                answer[row] -= factor * answer[pivot];
            }
        }
    }
    let values: Vec<f64> = (0..size)
        .map(|column| pivots[column].map_or(0.0, |pivot| answer[pivot] / matrix[pivot * size + column]))
        .collect();
    answer.copy_from_slice(&values);
}
