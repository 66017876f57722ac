//! The rows of an evaluation as linear equations for the multipliers, which keep the relative accelerations at zero.
//!
//! `J a = 0` with `a = M^-1 (f + F lambda)` gives `(J M^-1 F) lambda = -(J M^-1 f + c)`, with `c` the relative
//! accelerations without any force. If a contact slips while its normal is held, its force is not along its row. There
//! `F` differs from `J^T` (Baraff 1991). If rows depend on each other, [`super::redundant`] chooses the answer.

use glam::DVec2;

use super::cones::{Cone, ConePressure};
use super::redundant::{Equations, Share};
use super::row::{LostTo, Row, RowKind};
use super::solver::Solver;
use crate::world::Bodies;
use serde::{Deserialize, Serialize};

/// A share of a force that counts as rounding.
const ROUNDING: f64 = 1e-12;
/// A pull below this share of all forces of rows may be an error of the events that end them.
const PULL: f64 = 1e-6;
/// Rows of joints round by less: their part of that share.
const OF_JOINTS: f64 = 0.01;

/// Held contacts that are solved together at the most: their matrix has 8 MB, and a solution takes a second. More of them are handed
/// over to springs before the next step, so they keep the forces of their springs.
const MOST_TOGETHER: usize = 1024;

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
    /// For each body the index at which its load may be found.
    #[serde(skip)]
    indices: Vec<usize>,
    #[serde(skip)]
    matrix: Vec<f64>,
    answer: Vec<f64>,
    #[serde(skip)]
    equations: Equations,
    /// The multiplications from which on the search for cones ends. `None`: it goes on.
    #[serde(skip)]
    most_multiplications: Option<f64>,
    /// The number of rows that are not those of contacts.
    joints: usize,
    /// Rows that give their bounds in this evaluation, because their rates would need more.
    given: Vec<usize>,
    /// In a box, because rows are taken out and put back in each tick. `None` before rows of joints are first solved.
    #[serde(skip)]
    solver: Option<Box<Solver>>,
    /// Whether the solver is prepared for the current rows.
    #[serde(skip)]
    prepared: bool,
}

impl Rows {
    /// Whether all indices are those of rows and of so many bodies. Each row has its answer, or none has.
    pub(crate) fn fits(&self, bodies: usize) -> bool {
        let Self { rows, loads, answer, joints, given, .. } = self;
        let pressed =
            |row: &Row| !matches!(row.cone, Some(Cone { pressure: ConePressure::Row(row), .. }) if row >= rows.len());
        rows.iter().all(|row| pressed(row) && row.sides.iter().flatten().all(|side| side.body < bodies))
            && loads.iter().all(|load| load.body < bodies)
            && (answer.is_empty() || answer.len() == rows.len())
            && answer.iter().all(|force| force.is_finite())
            && *joints <= rows.len()
            && given.iter().all(|row| *row < rows.len())
    }

    /// The number of multiplications that dense equations took so far.
    pub fn multiplications(&self) -> f64 {
        self.equations.multiplications + self.solver.as_ref().map_or(0.0, |solver| solver.multiplications())
    }

    /// After so many multiplications, searches among these rows end where they are. The run is to be given up then.
    pub fn give_up_after(&mut self, multiplications: f64) {
        self.most_multiplications = Some(multiplications);
    }

    /// Whether searches are to end.
    pub(super) fn is_given_up(&self) -> bool {
        self.are_too_many() || self.most_multiplications.is_some_and(|most| self.multiplications() > most)
    }

    /// Counts those of equations that were solved apart.
    pub(super) fn count(&mut self, multiplications: f64) {
        self.equations.multiplications += multiplications;
    }

    /// Forgets all rows.
    pub fn clear(&mut self) {
        self.rows.clear();
        self.answer.clear();
        self.given.clear();
        (self.joints, self.prepared) = (0, false);
    }

    /// All rows in order.
    pub fn all(&self) -> &[Row] {
        &self.rows
    }

    /// Whether some hold more than accelerations: places or velocities.
    pub fn has_joints(&self) -> bool {
        self.joints > 0
    }

    /// Whether all hold places.
    pub fn all_in_place(&self) -> bool {
        self.rows.iter().all(|row| row.kind == RowKind::Position)
    }

    /// Rows have no acceleration of their own: forces are those that keep velocities on them in a kick.
    pub fn leave_out_turning(&mut self) {
        self.rows.iter_mut().for_each(|row| row.inertial = 0.0);
    }

    /// Removes the rows for which `keep` is false.
    pub fn retain(&mut self, keep: impl FnMut(&Row) -> bool) {
        self.rows.retain(keep);
        self.joints = self.rows.iter().filter(|row| row.kind != RowKind::Acceleration).count();
        self.given.clear();
        self.prepared = false;
    }

    /// The rows, and what solves for them.
    pub fn prepared(&mut self, bodies: &Bodies) -> (&[Row], &mut Solver) {
        let solver = self.solver.get_or_insert_default();
        if !std::mem::replace(&mut self.prepared, true) {
            solver.prepare(&self.rows, bodies);
        }
        (&self.rows, solver)
    }

    /// Whether the forces of some rows of joints are not determined, because rows depend on each other.
    pub fn is_dependent(&self) -> bool {
        self.prepared && self.solver.as_ref().is_some_and(|solver| solver.is_dependent())
    }

    /// Whether there are no rows.
    pub fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }

    /// The number of them: the index of the row that is added next.
    pub fn len(&self) -> usize {
        self.rows.len()
    }

    /// Adds a row.
    pub fn add(&mut self, row: Row) {
        self.joints += usize::from(row.kind != RowKind::Acceleration);
        self.prepared = false;
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

    pub(super) fn set_answer(&mut self, answer: Vec<f64>) {
        self.answer = answer;
    }

    /// Whether a row that only pushes would have to pull. Rounding is a small share of all forces together.
    pub fn would_pull(&self) -> bool {
        let pulls = self.rows.iter().zip(&self.answer).map(|(row, force)| -row.pushes * force);
        let all: f64 = self.answer.iter().map(|force| force.abs()).sum();
        pulls.fold(0.0, f64::max) > PULL * all
    }

    /// The sum of the absolute accelerations (m/s2 or rad/s2) of a row by the forces of each of these rows. Rounding is
    /// a share of it.
    pub fn pulls(&self, row: &Row, bodies: &Bodies) -> f64 {
        self.rows.iter().zip(&self.answer).map(|(other, force)| (row.response(other, bodies) * force).abs()).sum()
    }

    /// Finds the forces of all rows, given all others.
    pub fn solve(&mut self, bodies: &Bodies) {
        self.solve_beside(bodies, |_| 0.0);
    }

    /// The same beside rows of another list, which accelerate each row by `beside`, in m/s2 or rad/s2.
    pub(super) fn solve_beside(&mut self, bodies: &Bodies, beside: impl Fn(&Row) -> f64) {
        if self.are_too_many() {
            return self.keep_springs(bodies, beside);
        }
        self.solve_together(bodies, beside);
    }

    fn solve_together(&mut self, bodies: &Bodies, beside: impl Fn(&Row) -> f64) {
        self.answer.clear();
        self.answer.extend(self.rows.iter().map(|row| -row.acceleration(bodies) - beside(row)));
        if self.has_joints() {
            return self.solve_joined(bodies, |row| row.share);
        }
        self.fill_matrix(bodies);
        self.equations.solve(&self.matrix, &mut self.answer, self.rows.iter().map(|row| row.share));
    }

    /// After [`Rows::solve`]: rows that yield and would need more than their bounds give exactly their bounds. The
    /// others are solved again. That may bring another row to its bound, so it is repeated until no row exceeds its
    /// bound.
    pub fn give_way(&mut self, bodies: &Bodies) {
        loop {
            let before = self.given.len();
            for (index, row) in self.rows.iter().enumerate() {
                if row.yields && self.answer[index].abs() > row.bound && !self.given.contains(&index) {
                    self.answer[index] = row.bound.copysign(self.answer[index]);
                    self.given.push(index);
                }
            }
            if self.given.len() == before {
                return;
            }
            let mut others = Self::default();
            let kept: Vec<usize> = (0..self.rows.len()).filter(|index| !self.gives_its_bound(*index)).collect();
            kept.iter().for_each(|index| others.add(self.rows[*index]));
            let given = |row: &Row| -> f64 {
                self.given.iter().map(|other| row.response(&self.rows[*other], bodies) * self.answer[*other]).sum()
            };
            others.solve_beside(bodies, given);
            self.count(others.multiplications());
            kept.iter().zip(&others.answer).for_each(|(index, force)| self.answer[*index] = *force);
        }
    }

    /// Whether a row gives its bound in this evaluation, because its rate would need more.
    pub fn gives_its_bound(&self, index: usize) -> bool {
        self.given.contains(&index)
    }

    /// Whether some rows give their bounds.
    pub fn some_give_their_bounds(&self) -> bool {
        !self.given.is_empty()
    }

    /// Whether some rows may give their bounds.
    pub fn some_yield(&self) -> bool {
        self.rows.iter().any(|row| row.yields)
    }

    /// Joints and held contacts: each island with held contacts at once, all others sparsely.
    fn solve_joined(&mut self, bodies: &Bodies, shares: impl Fn(&Row) -> Share) {
        let mut answer = std::mem::take(&mut self.answer);
        let (rows, solver) = self.prepared(bodies);
        solver.solve(rows, bodies, shares, &mut answer);
        self.answer = answer;
    }

    /// Whether contacts are more than can be solved for together.
    fn are_too_many(&self) -> bool {
        self.rows.len() - self.joints > MOST_TOGETHER
    }

    /// Contacts keep the forces of their springs, and joints are solved beside them.
    fn keep_springs(&mut self, bodies: &Bodies, beside: impl Fn(&Row) -> f64) {
        self.answer.clear();
        self.answer.extend(self.rows.iter().map(|row| row.share.natural));
        let (joints, contacts): (Vec<usize>, Vec<usize>) =
            (0..self.rows.len()).partition(|index| self.rows[*index].kind != RowKind::Acceleration);
        let mut others = Self::default();
        joints.iter().for_each(|index| others.add(self.rows[*index]));
        let given = |row: &Row| -> f64 {
            contacts.iter().map(|other| row.response(&self.rows[*other], bodies) * self.answer[*other]).sum()
        };
        others.solve_together(bodies, |row| beside(row) + given(row));
        joints.iter().zip(&others.answer).for_each(|(index, force)| self.answer[*index] = *force);
    }

    fn fill_matrix(&mut self, bodies: &Bodies) {
        let rows = &self.rows;
        self.matrix.clear();
        self.matrix.extend(rows.iter().flat_map(|row| rows.iter().map(|other| row.response(other, bodies))));
    }

    /// Impulses that make the relative velocities of all rows zero. These velocities come from rounding and from the
    /// error of a step of `dt` seconds. Returns whether anything changed.
    pub fn stop(&mut self, bodies: &mut Bodies, dt: f64, mut book: impl FnMut(Booking)) -> bool {
        if self.are_too_many() {
            return false;
        }
        self.answer.clear();
        self.answer.extend(self.rows.iter().map(|row| row.rate - row.velocity(bodies)));
        let unloaded = |row: &Row| Share { natural: 0.0, ..row.share };
        if self.has_joints() {
            self.solve_joined(bodies, unloaded);
        } else {
            self.fill_matrix(bodies);
            self.equations.solve(&self.matrix, &mut self.answer, self.rows.iter().map(unloaded));
        }
        self.book_powers(bodies, &mut book);
        for (row, &impulse) in self.rows.iter().zip(&self.answer) {
            for side in row.sides.iter().flatten() {
                let (by, turned) = (bodies.inverse_mass(side.body), bodies.inverse_inertia(side.body));
                bodies.velocity[side.body] += side.force * (impulse * by);
                bodies.spin[side.body] += side.torque * (impulse * turned);
            }
        }
        self.book_powers(bodies, &mut book);
        self.halt(bodies, dt, |energy| book(Booking::Lost(LostTo::Inelasticity, energy)));
        self.answer.iter().any(|impulse| *impulse != 0.0)
    }

    /// Stops bodies whose velocities are no more than the rounding of their forces makes in `dt` seconds.
    pub fn still(&self, bodies: &mut Bodies, dt: f64) {
        self.halt(bodies, dt, |_| ());
    }

    fn halt(&self, bodies: &mut Bodies, dt: f64, mut lost: impl FnMut(f64)) {
        for Loaded { body, load } in &self.loads {
            let limit = ROUNDING * load * dt * mobility(bodies, *body);
            if bodies.velocity[*body].length() + bodies.spin[*body].abs() * bodies.extent(*body) <= limit {
                lost(bodies.kinetic_energy(*body));
                (bodies.velocity[*body], bodies.spin[*body]) = (DVec2::ZERO, 0.0);
            }
        }
    }

    /// Books the energy of the impulses of all rows, half with the velocities before them and half with those after.
    /// The part across a row is lost to friction.
    fn book_powers(&self, bodies: &Bodies, book: &mut impl FnMut(Booking)) {
        for (row, &impulse) in self.rows.iter().zip(&self.answer).filter(|(_, impulse)| **impulse != 0.0) {
            let [along, across, driven] = row.powers(bodies).map(|power| 0.5 * impulse * power);
            book(Booking::Lost(row.lost_to, -along));
            book(Booking::Lost(LostTo::Friction, -across));
            book(Booking::Work(driven));
        }
    }

    /// Bodies without velocity whose forces cancel, up to rounding, get no force. `told` receives each of them.
    pub fn cancel(&mut self, bodies: &mut Bodies, mut told: impl FnMut(&Bodies, Cancelled)) {
        self.loads.clear();
        self.indices.resize(bodies.len(), 0);
        for (row, &force) in self.rows.iter().zip(&self.answer) {
            let share = if row.kind == RowKind::Acceleration { 1.0 } else { OF_JOINTS };
            for side in row.sides.iter().flatten() {
                let extent = bodies.extent(side.body);
                let turns = side.force == DVec2::ZERO && row.kind != RowKind::Acceleration && extent > 0.0;
                let of_one = if turns { side.torque.abs() / extent } else { side.force.length() };
                let load = share * force.abs() * of_one;
                let index = self.indices[side.body];
                match self.loads.get_mut(index).filter(|loaded| loaded.body == side.body) {
                    Some(loaded) => loaded.load += load,
                    None => {
                        self.indices[side.body] = self.loads.len();
                        self.loads.push(Loaded { body: side.body, load });
                    }
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

#[cfg(test)]
mod tests {
    use bevy_ecs::entity::Entity;

    use super::super::{RowSide, Share};
    use super::*;

    /// Promise: contacts beyond the bound keep the forces of their springs, and a joint holds its body beside them. A body
    /// of 1 kg is pulled with 3 N along a joint, and each contact pushes with 0.01 N. Tolerance: rounding of a thousand sums.
    #[test]
    fn contacts_beyond_all_bounds_keep_their_springs() {
        let mut bodies = Bodies {
            entity: vec![Entity::PLACEHOLDER],
            dynamic: vec![true],
            mass: vec![1.0],
            inertia: vec![1.0],
            force: vec![DVec2::new(3.0, -10.0)],
            torque: vec![0.0],
            ..Bodies::default()
        };
        bodies.velocity.push(DVec2::ZERO);
        bodies.spin.push(0.0);
        let along = |direction: DVec2| {
            let side = RowSide { body: 0, direction, lever: 0.0, force: direction, torque: 0.0 };
            Row { sides: [None, Some(side)], ..Row::default() }
        };
        let mut rows = Rows::default();
        rows.add(Row { kind: RowKind::Position, ..along(DVec2::X) });
        let share = Share { natural: 0.01, measure: 1.0 };
        let contacts = MOST_TOGETHER + 1;
        (0..contacts).for_each(|_| rows.add(Row { share, ..along(DVec2::new(0.6, 0.8)) }));
        rows.solve(&bodies);
        assert!((1..=contacts).all(|contact| rows.force(contact) == 0.01));
        let pushed = 0.6 * 0.01 * contacts as f64;
        assert!((rows.force(0) + 3.0 + pushed).abs() < 1e-12, "{} instead of {}", rows.force(0), -3.0 - pushed);
    }
}
