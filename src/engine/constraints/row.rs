//! A row: one direction in which two bodies do not accelerate against each other, and the force that sees to it.

use glam::DVec2;

use super::Share;
use crate::world::Bodies;
use serde::{Deserialize, Serialize};

/// The account of the energy that a row takes along its direction.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum LostTo {
    /// What contacts lose along their normals.
    Inelasticity,
    /// What contacts lose along their surfaces.
    Friction,
}

/// What of the relative motion along a row is held.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Kind {
    /// Its place: a joint. Places, velocities and accelerations are held, and brought back to what they should be after each step.
    Position,
    /// Its velocity: a motor. Velocities are brought back, places are not.
    Velocity,
    /// Its acceleration: a contact that is held for the time being.
    #[default]
    Acceleration,
}

/// One side of a row.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Side {
    /// The index of its body.
    pub body: usize,
    /// Direction of the row: how its velocity depends on that of the body.
    pub direction: DVec2,
    /// How the velocity of the row depends on the body's spin, in metres; without unit if the row is a turn.
    pub lever: f64,
    /// Force on the body of one unit. It differs from `direction` where a contact slides.
    pub force: DVec2,
    /// Torque on the body of one unit, in metres; without unit if the row is a turn.
    pub torque: f64,
}

/// A row of the equations of an evaluation. Its velocity is `sum (direction . v + lever w)` over both sides.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// Side A, absent for walls and the world, and side B.
    pub sides: [Option<Side>; 2],
    /// The relative acceleration without any force, in m/s2 or rad/s2.
    pub inertial: f64,
    /// Velocity in m/s of the surface of side A, if that is a wall with one.
    pub surface: DVec2,
    /// What the row bears where rows depend on each other.
    pub share: Share,
    /// The account of what it takes.
    pub lost_to: LostTo,
    /// What of it is held.
    pub kind: Kind,
    /// How far its place is from where it should be, in m or rad. Zero for rows that hold no place.
    pub gap: f64,
    /// The numbers from which the gap was found, in m or rad: rounding of the gap is a share of that.
    pub size: f64,
    /// The relative velocity that is held, in m/s or rad/s.
    pub rate: f64,
    /// The greatest force in N, or torque in N m, that it can give; infinite for joints and motors without a limit. A row with a bound
    /// gives no impulse.
    pub bound: f64,
    /// Whether it gives its bound at once where it would need more, from tick to tick: motors with a limit.
    pub yields: bool,
    /// The sign of the only force and impulse that it gives: a limit pushes, and never pulls. Zero: both signs.
    pub pushes: f64,
    /// Whether its forces on both sides do not balance, because other joints pass the rest on to the world: gears and racks.
    pub grounded: bool,
}

impl Default for Row {
    /// A contact row between nothing.
    fn default() -> Self {
        Self {
            sides: [None, None],
            inertial: 0.0,
            surface: DVec2::ZERO,
            share: Share { natural: 0.0, measure: 1.0 },
            lost_to: LostTo::Friction,
            kind: Kind::Acceleration,
            gap: 0.0,
            size: 0.0,
            rate: 0.0,
            bound: f64::INFINITY,
            yields: false,
            pushes: 0.0,
            grounded: false,
        }
    }
}

impl Row {
    /// Whether its forces come from inside: they balance, on two bodies that move by forces.
    pub fn is_inside(&self, bodies: &Bodies) -> bool {
        !self.grounded && self.sides.iter().all(|side| side.is_some_and(|side| bodies.dynamic[side.body]))
    }

    /// Whether its force is bounded.
    pub fn gives_way(&self) -> bool {
        self.bound.is_finite()
    }

    /// The greatest speed that counts in its velocity, in m/s or rad/s: rounding is a share of it.
    pub fn speeds(&self, bodies: &Bodies) -> f64 {
        let of = |side: &Side| {
            let turning = (side.lever * bodies.spin[side.body]).abs();
            (side.direction.length() * bodies.velocity[side.body].length()).max(turning)
        };
        self.sides.iter().flatten().map(of).fold(self.rate.abs(), f64::max)
    }

    /// The relative velocity along the row, in m/s or rad/s.
    pub fn velocity(&self, bodies: &Bodies) -> f64 {
        let of = |side: &Side| side.direction.dot(bodies.velocity[side.body]) + side.lever * bodies.spin[side.body];
        let surface = -self.sides[1].map_or(0.0, |side| side.direction.dot(self.surface));
        self.sides.iter().flatten().map(of).fold(surface, |sum, term| sum + term)
    }

    /// Power of one unit of its force on both bodies, in watts: of the part along the row, of the rest, and of what drives.
    pub fn powers(&self, bodies: &Bodies) -> [f64; 3] {
        let given = |side: &Side| {
            let whole = side.force.dot(bodies.velocity[side.body]) + side.torque * bodies.spin[side.body];
            if bodies.dynamic[side.body] { 0.0 } else { -whole }
        };
        let all = |side: &Side| side.force.dot(bodies.velocity[side.body]) + side.torque * bodies.spin[side.body];
        let surface = self.sides[1].map_or(0.0, |side| side.force.dot(self.surface));
        let sides = || self.sides.iter().flatten();
        let along = self.velocity(bodies);
        let whole = sides().map(all).fold(-surface, |sum, term| sum + term);
        [along, whole - along, sides().map(given).fold(surface, |sum, term| sum + term)]
    }

    /// The relative acceleration along the row under the present forces, in m/s2 or rad/s2.
    pub fn acceleration(&self, bodies: &Bodies) -> f64 {
        let of = |side: &Side| {
            let (force, torque) = (bodies.force[side.body], bodies.torque[side.body]);
            side.direction.dot(force) * bodies.inverse_mass(side.body)
                + side.lever * torque * bodies.inverse_inertia(side.body)
        };
        self.sides.iter().flatten().map(of).fold(self.inertial, |sum, term| sum + term)
    }

    /// The acceleration of this row that one unit of the other one's force makes.
    pub fn response(&self, other: &Self, bodies: &Bodies) -> f64 {
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
