//! A constraint row: one direction in which two bodies do not accelerate against each other, and its force.

use glam::DVec2;

use super::{Cone, Share};
use crate::world::Bodies;
use serde::{Deserialize, Serialize};

/// The account of the energy that a row takes along its direction.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum LostTo {
    /// The loss of contacts along their normals.
    Inelasticity,
    /// The loss of contacts along their surfaces.
    Friction,
}

/// The part of the relative motion that a row holds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum RowKind {
    /// Its position: a joint. Positions, velocities and accelerations are held, and corrected after each step.
    Position,
    /// Its velocity: a motor. Velocities are brought back, places are not.
    Velocity,
    /// Its acceleration: a contact that is held for the time being.
    #[default]
    Acceleration,
}

/// One side of a row.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct RowSide {
    /// The index of its body.
    pub body: usize,
    /// Direction of the row: the factor from the body's velocity to that of the row.
    pub direction: DVec2,
    /// The factor from the body's spin to the velocity of the row, in metres. It has no unit if the row is a turn.
    pub lever: f64,
    /// Force on the body of one unit. It differs from `direction` if a contact slides.
    pub force: DVec2,
    /// Torque on the body of one unit, in metres; without unit if the row is a turn.
    pub torque: f64,
}

/// A row of the equations of an evaluation. Its velocity is `sum (direction . v + lever w)` over both sides.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// Side A, absent for walls and the world, and side B.
    pub sides: [Option<RowSide>; 2],
    /// The relative acceleration without any force, in m/s2 or rad/s2.
    pub inertial: f64,
    /// Velocity in m/s of the surface of side A, if that is a moving wall.
    pub surface: DVec2,
    /// The preferred load of the row if rows depend on each other.
    pub share: Share,
    /// The account of its losses.
    pub lost_to: LostTo,
    /// The quantity that it holds.
    pub kind: RowKind,
    /// The deviation of its position from the required one, in m or rad. Zero for rows that hold no position.
    pub gap: f64,
    /// The magnitude of the numbers from which the gap was found, in m or rad. The rounding of the gap is a share of
    /// it.
    pub size: f64,
    /// The relative velocity that is held, in m/s or rad/s.
    pub rate: f64,
    /// The greatest force in N, or torque in N m, that it can give. It is infinite for joints and for motors without a
    /// limit. A row with a bound gives no impulse.
    pub bound: f64,
    /// Whether it gives its bound if it would need more, in methods that go from tick to tick. Motors with a limit do.
    pub yields: bool,
    /// The bound of friction, in steps with stages.
    pub cone: Option<Cone>,
    /// The least and the greatest force in newtons of a normal that is held, in steps with stages.
    pub band: Option<(f64, f64)>,
    /// The sign of the only force and impulse that it gives: a limit pushes, and never pulls. Zero: both signs.
    pub pushes: f64,
    /// Whether the forces on its two sides do not balance, because other joints pass the rest on to the world. Gears
    /// and racks do that.
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
            kind: RowKind::Acceleration,
            gap: 0.0,
            size: 0.0,
            rate: 0.0,
            bound: f64::INFINITY,
            yields: false,
            cone: None,
            band: None,
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
        let of = |side: &RowSide| {
            let turning = (side.lever * bodies.spin[side.body]).abs();
            (side.direction.length() * bodies.velocity[side.body].length()).max(turning)
        };
        self.sides.iter().flatten().map(of).fold(self.rate.abs(), f64::max)
    }

    /// The relative velocity along the row, in m/s or rad/s.
    pub fn velocity(&self, bodies: &Bodies) -> f64 {
        let of = |side: &RowSide| side.direction.dot(bodies.velocity[side.body]) + side.lever * bodies.spin[side.body];
        let surface = -self.sides[1].map_or(0.0, |side| side.direction.dot(self.surface));
        self.sides.iter().flatten().map(of).fold(surface, |sum, term| sum + term)
    }

    /// Power of one unit of its force on both bodies, in watts. The parts are that along the row, the rest, and that of
    /// driven bodies and surfaces.
    pub fn powers(&self, bodies: &Bodies) -> [f64; 3] {
        let given = |side: &RowSide| {
            let whole = side.force.dot(bodies.velocity[side.body]) + side.torque * bodies.spin[side.body];
            if bodies.dynamic[side.body] { 0.0 } else { -whole }
        };
        let all = |side: &RowSide| side.force.dot(bodies.velocity[side.body]) + side.torque * bodies.spin[side.body];
        let surface = self.sides[1].map_or(0.0, |side| side.force.dot(self.surface));
        let sides = || self.sides.iter().flatten();
        let along = self.velocity(bodies);
        let whole = sides().map(all).fold(-surface, |sum, term| sum + term);
        [along, whole - along, sides().map(given).fold(surface, |sum, term| sum + term)]
    }

    /// The relative acceleration along the row under the present forces, in m/s2 or rad/s2.
    pub fn acceleration(&self, bodies: &Bodies) -> f64 {
        let of = |side: &RowSide| {
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
