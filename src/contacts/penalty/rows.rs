//! Contacts that do not move, as rows of linear equations: the forces that keep the relative accelerations at zero.
//!
//! `J a = 0` with `a = M^-1 (f + F lambda)` gives `(J M^-1 F) lambda = -(J M^-1 f + c)`, with `c` what the relative
//! accelerations are without any force. A contact that slips along its tangent while its normal is held has a force that is
//! not along its row: `F` differs from `J^T` there (Baraff 1991). Where rows depend on each other, [`super::split`] says which
//! answer is taken.

use glam::DVec2;

use super::contact::Contact;
use super::law::PairLaw;
use super::split::{self, Share};
use super::staged::Look;
use crate::tick::balance::kinetic_energy_of;
use crate::tick::{Balance, Ledger};
use crate::world::Bodies;

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

/// What of a contact a row holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    Normal,
    Tangent,
    Rolling,
}

struct Row {
    look: Look,
    kind: Kind,
    sides: [Option<Side>; 2],
    /// The relative acceleration without any force.
    inertial: f64,
    /// Velocity of the surface of the wall in m/s.
    belt: DVec2,
    /// What it bears where rows depend on each other.
    share: Share,
}

impl Row {
    fn velocity(&self, bodies: &Bodies) -> f64 {
        let of = |side: &Side| side.direction.dot(bodies.velocity[side.body]) + side.lever * bodies.spin[side.body];
        let belt = -self.sides[1].map_or(0.0, |side| side.direction.dot(self.belt));
        self.sides.iter().flatten().map(of).fold(belt, |sum, term| sum + term)
    }

    /// Power of one unit of its force on both bodies, in watts: of the part along the row, of the rest, and of what drives.
    fn powers(&self, bodies: &Bodies) -> [f64; 3] {
        let given = |side: &Side| {
            let whole = side.force.dot(bodies.velocity[side.body]) + side.torque * bodies.spin[side.body];
            if bodies.dynamic[side.body] { 0.0 } else { -whole }
        };
        let all = |side: &Side| side.force.dot(bodies.velocity[side.body]) + side.torque * bodies.spin[side.body];
        let belt = self.sides[1].map_or(0.0, |side| side.force.dot(self.belt));
        let sides = || self.sides.iter().flatten();
        let along = self.velocity(bodies);
        let whole = sides().map(all).fold(-belt, |sum, term| sum + term);
        [along, whole - along, sides().map(given).fold(belt, |sum, term| sum + term)]
    }

    fn acceleration(&self, bodies: &Bodies) -> f64 {
        let of = |side: &Side| {
            let (force, torque) = (bodies.force[side.body], bodies.torque[side.body]);
            side.direction.dot(force) * bodies.inverse_mass(side.body)
                + side.lever * torque * bodies.inverse_inertia(side.body)
        };
        self.sides.iter().flatten().map(of).fold(self.inertial, |sum, term| sum + term)
    }

    /// The acceleration of this row that one unit of the other one's force makes.
    fn response(&self, other: &Row, bodies: &Bodies) -> f64 {
        let mut sum = 0.0;
        for own in self.sides.iter().flatten() {
            for side in other.sides.iter().flatten().filter(|side| side.body == own.body) {
                sum += own.direction.dot(side.force) * bodies.inverse_mass(own.body)
                    + own.lever * side.torque * bodies.inverse_inertia(own.body);
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
    work: Vec<f64>,
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

    /// The normal of a contact is held. While it slips its tangential force is `slope` times the normal one, while its
    /// rolling spring does, that one's torque is `twist` times it.
    pub fn add_normal(&mut self, look: &Look, law: &PairLaw, (slope, twist): (f64, f64), bodies: &Bodies) {
        let normal = look.case.normal;
        let force = normal - normal.perp() * slope;
        let natural = law.stiffness * look.overlap;
        let share = Share { natural, measure: natural.max(f64::MIN_POSITIVE) };
        self.add(look, law, (Kind::Normal, normal, force), look.inertial(law, bodies).0, share, bodies);
        let [a, b] = &mut self.rows.last_mut().expect("added above").sides;
        for (side, sign) in [(a, 1.0), (b, -1.0)] {
            side.iter_mut().for_each(|side| side.torque += sign * twist);
        }
    }

    /// The tangent of a contact is held.
    pub fn add_tangent(&mut self, look: &Look, law: &PairLaw, contact: &Contact, bodies: &Bodies) {
        let tangent = look.case.normal.perp();
        let measure = (law.friction_static * law.stiffness * look.overlap).max(f64::MIN_POSITIVE);
        let share = Share { natural: -law.tangential_stiffness * contact.tangential.elongation, measure };
        self.add(look, law, (Kind::Tangent, tangent, tangent), look.inertial(law, bodies).1, share, bodies);
    }

    /// The turn of a contact is held.
    pub fn add_rolling(&mut self, look: &Look, share: Share, bodies: &Bodies) {
        let side = |body: usize, sign: f64| Side { body, lever: sign, torque: sign, ..Side::default() };
        let sides = [look.case.other_body().map(|body| side(body, -1.0)), Some(side(look.case.end.body, 1.0))];
        let turning = |side: &Side| side.lever * bodies.prescribed.acceleration(side.body).1;
        let inertial = sides.iter().flatten().map(turning).fold(0.0, |sum, term| sum + term);
        self.rows.push(Row { look: *look, kind: Kind::Rolling, sides, inertial, belt: DVec2::ZERO, share });
    }

    fn add(
        &mut self,
        look: &Look,
        law: &PairLaw,
        (kind, direction, force): (Kind, DVec2, DVec2),
        inertial: f64,
        share: Share,
        bodies: &Bodies,
    ) {
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
        let belt = look.case.belt(bodies).map_or(DVec2::ZERO, |belt| belt.velocity);
        self.rows.push(Row { look: *look, kind, sides, inertial, belt, share });
    }

    /// Finds the forces, given all others.
    pub fn solve(&mut self, bodies: &Bodies) {
        self.answer.clear();
        if self.is_empty() {
            return;
        }
        let rows = &self.rows;
        self.matrix.clear();
        self.matrix.extend(rows.iter().flat_map(|row| rows.iter().map(|other| row.response(other, bodies))));
        self.answer.extend(rows.iter().map(|row| -row.acceleration(bodies)));
        split::solve(&self.matrix, &mut self.answer, rows.iter().map(|row| row.share), &mut self.work);
    }

    /// Impulses that make the relative velocities of all rows zero: what rounding and the error of a step have left there.
    /// What that takes of energy is lost, to inelasticity along normals, to friction along tangents. Says whether anything
    /// changed.
    pub fn stop(&mut self, bodies: &mut Bodies, dt: f64, ledger: &mut Ledger) -> bool {
        let rows = &self.rows;
        self.matrix.clear();
        self.matrix.extend(rows.iter().flat_map(|row| rows.iter().map(|other| row.response(other, bodies))));
        self.answer.clear();
        self.answer.extend(rows.iter().map(|row| -row.velocity(bodies)));
        let shares = rows.iter().map(|row| Share { natural: 0.0, ..row.share });
        split::solve(&self.matrix, &mut self.answer, shares, &mut self.work);
        self.book_powers(bodies, ledger);
        for (row, &impulse) in self.rows.iter().zip(&self.answer) {
            for side in row.sides.iter().flatten() {
                let (by, turned) = (bodies.inverse_mass(side.body), bodies.inverse_inertia(side.body));
                bodies.velocity[side.body] += side.force * (impulse * by);
                bodies.spin[side.body] += side.torque * (impulse * turned);
            }
        }
        self.book_powers(bodies, ledger);
        for Loaded { body, load } in &self.loads {
            let limit = ROUNDING * load * dt * mobility(bodies, *body);
            if bodies.velocity[*body].length() + bodies.spin[*body].abs() * bodies.extent(*body) <= limit {
                ledger.inelasticity.add(kinetic_energy_of(bodies, *body));
                (bodies.velocity[*body], bodies.spin[*body]) = (DVec2::ZERO, 0.0);
            }
        }
        self.answer.iter().any(|impulse| *impulse != 0.0)
    }

    /// Books the energy of the impulses of all rows, in two halves: with the velocities before them and after.
    fn book_powers(&self, bodies: &Bodies, ledger: &mut Ledger) {
        for (row, &impulse) in self.rows.iter().zip(&self.answer).filter(|(_, impulse)| **impulse != 0.0) {
            let [along, across, driven] = row.powers(bodies).map(|power| 0.5 * impulse * power);
            if row.kind == Kind::Normal { &mut ledger.inelasticity } else { &mut ledger.friction }.add(-along);
            ledger.friction.add(-across);
            ledger.work.add(driven);
        }
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
            let turning = torque.abs() * bodies.inverse_inertia(body) * bodies.extent(body);
            let limit = ROUNDING * load * mobility(bodies, body);
            if bodies.dynamic[body] && stands && force.length() * bodies.inverse_mass(body) + turning <= limit {
                balance.outside(bodies.position[body], -force, -torque);
                (bodies.force[body], bodies.torque[body]) = (DVec2::ZERO, 0.0);
            }
        }
    }

    /// The contact of each row, what of it is held, and the force in newtons or torque in N m on side B.
    pub fn answers(&self) -> impl Iterator<Item = (Look, Kind, f64)> + '_ {
        self.rows.iter().zip(&self.answer).map(|(row, &force)| (row.look, row.kind, force))
    }
}

/// The greatest acceleration that a newton gives a point of a body, in 1/kg.
fn mobility(bodies: &Bodies, body: usize) -> f64 {
    bodies.inverse_mass(body) + bodies.extent(body).powi(2) * bodies.inverse_inertia(body)
}
