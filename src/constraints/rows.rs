//! All rows of an evaluation as linear equations: the forces that keep the relative accelerations at zero.
//!
//! `J a = 0` with `a = M^-1 (f + F lambda)` gives `(J M^-1 F) lambda = -(J M^-1 f + c)`, with `c` the relative accelerations
//! without any force. A contact that slips along its tangent while its normal is held has a force that is not along its row:
//! `F` differs from `J^T` there (Baraff 1991). Where rows depend on each other, [`super::redundant`] says which answer is
//! taken.

use glam::DVec2;

use super::redundant::{self, Share};
use super::row::{LostTo, Row};
use crate::world::Bodies;
use serde::{Deserialize, Serialize};

/// A share of a force that counts as rounding.
const ROUNDING: f64 = 1e-12;

/// A body with the sum of the forces that hold it, in newtons.
#[derive(Debug, Serialize, Deserialize)]
struct Loaded {
    body: usize,
    load: f64,
}

/// Energy in J that impulses of rows move.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Booking {
    /// It is lost.
    Lost(LostTo, f64),
    /// It comes from bodies and surfaces that move as prescribed.
    Work(f64),
}

/// A force and a torque from outside on a body, which cancel what rounding left of forces that balance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cancelled {
    /// The index of the body.
    pub body: usize,
    /// In newtons.
    pub force: DVec2,
    /// In N m.
    pub torque: f64,
}

/// The rows of one evaluation, in the order in which models added them.
#[derive(Debug, Default, Serialize, Deserialize)]
pub struct Rows {
    rows: Vec<Row>,
    loads: Vec<Loaded>,
    #[serde(skip)]
    matrix: Vec<f64>,
    answer: Vec<f64>,
    #[serde(skip)]
    work: Vec<f64>,
}

impl Rows {
    /// Forgets all rows.
    pub fn clear(&mut self) {
        self.rows.clear();
        self.answer.clear();
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }

    /// How many there are: the index of the row that is added next.
    pub fn len(&self) -> usize {
        self.rows.len()
    }

    /// Adds a row.
    pub fn add(&mut self, row: Row) {
        self.rows.push(row);
    }

    /// A row.
    pub fn row(&self, index: usize) -> &Row {
        &self.rows[index]
    }

    /// The force of a row in newtons, or its torque in N m; positive on side B along its direction.
    pub fn force(&self, index: usize) -> f64 {
        self.answer[index]
    }

    /// Finds the forces of all rows, given all others.
    pub fn solve(&mut self, bodies: &Bodies) {
        self.fill_matrix(bodies);
        self.answer.clear();
        self.answer.extend(self.rows.iter().map(|row| -row.acceleration(bodies)));
        redundant::solve(&self.matrix, &mut self.answer, self.rows.iter().map(|row| row.share), &mut self.work);
    }

    fn fill_matrix(&mut self, bodies: &Bodies) {
        let rows = &self.rows;
        self.matrix.clear();
        self.matrix.extend(rows.iter().flat_map(|row| rows.iter().map(|other| row.response(other, bodies))));
    }

    /// Impulses that make the relative velocities of all rows zero: what rounding and the error of a step of `dt` seconds have
    /// left there. Says whether anything changed.
    pub fn stop(&mut self, bodies: &mut Bodies, dt: f64, mut book: impl FnMut(Booking)) -> bool {
        self.fill_matrix(bodies);
        self.answer.clear();
        self.answer.extend(self.rows.iter().map(|row| -row.velocity(bodies)));
        let shares = self.rows.iter().map(|row| Share { natural: 0.0, ..row.share });
        redundant::solve(&self.matrix, &mut self.answer, shares, &mut self.work);
        self.book_powers(bodies, &mut book);
        for (row, &impulse) in self.rows.iter().zip(&self.answer) {
            for side in row.sides.iter().flatten() {
                let (by, turned) = (bodies.inverse_mass(side.body), bodies.inverse_inertia(side.body));
                bodies.velocity[side.body] += side.force * (impulse * by);
                bodies.spin[side.body] += side.torque * (impulse * turned);
            }
        }
        self.book_powers(bodies, &mut book);
        for Loaded { body, load } in &self.loads {
            let limit = ROUNDING * load * dt * mobility(bodies, *body);
            if bodies.velocity[*body].length() + bodies.spin[*body].abs() * bodies.extent(*body) <= limit {
                book(Booking::Lost(LostTo::Inelasticity, bodies.kinetic_energy(*body)));
                (bodies.velocity[*body], bodies.spin[*body]) = (DVec2::ZERO, 0.0);
            }
        }
        self.answer.iter().any(|impulse| *impulse != 0.0)
    }

    /// Books the energy of the impulses of all rows, in two halves: with the velocities before them and after. What is not along
    /// a row is lost to friction.
    fn book_powers(&self, bodies: &Bodies, book: &mut impl FnMut(Booking)) {
        for (row, &impulse) in self.rows.iter().zip(&self.answer).filter(|(_, impulse)| **impulse != 0.0) {
            let [along, across, driven] = row.powers(bodies).map(|power| 0.5 * impulse * power);
            book(Booking::Lost(row.lost_to, -along));
            book(Booking::Lost(LostTo::Friction, -across));
            book(Booking::Work(driven));
        }
    }

    /// Bodies that stand and whose forces cancel but for rounding get none. `told` hears of each.
    pub fn cancel(&mut self, bodies: &mut Bodies, mut told: impl FnMut(&Bodies, Cancelled)) {
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
            let turning = torque.abs() * bodies.inverse_inertia(body) * bodies.extent(body);
            let limit = ROUNDING * load * mobility(bodies, body);
            if bodies.dynamic[body] && stands && force.length() * bodies.inverse_mass(body) + turning <= limit {
                told(bodies, Cancelled { body, force: -force, torque: -torque });
                (bodies.force[body], bodies.torque[body]) = (DVec2::ZERO, 0.0);
            }
        }
    }
}

/// The greatest acceleration that a newton gives a point of a body, in 1/kg.
fn mobility(bodies: &Bodies, body: usize) -> f64 {
    bodies.inverse_mass(body) + bodies.extent(body).powi(2) * bodies.inverse_inertia(body)
}
