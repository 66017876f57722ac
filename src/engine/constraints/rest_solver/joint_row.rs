//! A row of a joint in the rest solver: an equation without bounds, which holds a rate.

use glam::DVec2;

use super::ROUNDING;
use super::contact_direction::Mover;

/// One side of a row of a joint.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct JointRowSide {
    /// The index of its mover.
    pub mover: usize,
    /// The derivative of the row's velocity by that of the mover, and the force of one unit.
    pub direction: DVec2,
    /// The same for its spin, in metres; without unit if the row is a turn.
    pub lever: f64,
    /// Force in newtons against which rounding is judged, of one unit.
    pub load: f64,
}

/// A row of a joint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct JointRow {
    sides: [JointRowSide; 2],
    /// Velocity that one unit gives in one second, in 1/kg.
    pub mobility: f64,
    /// The velocity that is held, in m/s or rad/s.
    rate: f64,
    /// Its force in N, or torque in N m.
    force: f64,
    /// The force by which rounding is judged.
    scale: f64,
}

impl JointRow {
    /// A row with its present force; `None` if neither side moves by forces.
    pub fn new(sides: [JointRowSide; 2], movers: &[Mover], (rate, force): (f64, f64)) -> Option<Self> {
        let share = |side: &JointRowSide| {
            let Mover { inverse_mass, inverse_inertia, .. } = movers[side.mover];
            side.direction.length_squared() * inverse_mass + side.lever * side.lever * inverse_inertia
        };
        let mobility = share(&sides[0]) + share(&sides[1]);
        (mobility > 0.0).then_some(Self { sides, mobility, rate, force, scale: force.abs() })
    }

    /// Forces are judged beside `force` newtons, too.
    pub(super) fn scale(&mut self, force: f64) {
        self.scale = self.scale.max(force);
    }

    /// The held rate less the present one, in m/s or rad/s.
    #[inline]
    pub(super) fn missing(&self, movers: &[Mover]) -> f64 {
        self.rate - self.velocity(movers)
    }

    #[inline]
    pub(super) fn velocity(&self, movers: &[Mover]) -> f64 {
        let of = |side: &JointRowSide| {
            let mover = &movers[side.mover];
            side.direction.dot(mover.velocity) + side.lever * mover.spin
        };
        of(&self.sides[0]) + of(&self.sides[1])
    }

    #[inline]
    pub(super) fn push(&self, movers: &mut [Mover], impulse: f64) {
        for side in &self.sides {
            let mover = &mut movers[side.mover];
            mover.velocity += side.direction * (impulse * mover.inverse_mass);
            mover.spin += side.lever * impulse * mover.inverse_inertia;
        }
    }

    /// Adds an impulse over `dt` seconds to its force.
    pub(super) fn take_over(&mut self, movers: &mut [Mover], impulse: f64, dt: f64) {
        self.force += impulse / dt;
        self.push(movers, impulse);
    }

    /// Lets its force work over `dt` seconds so that its rate is held. Returns the change, in units of rounding.
    pub(super) fn relax(&mut self, movers: &mut [Mover], dt: f64) -> f64 {
        let impulse = self.missing(movers) / self.mobility;
        self.take_over(movers, impulse, dt);
        let rounding = ROUNDING * self.scale;
        if rounding > 0.0 { (impulse / dt).abs() / rounding } else { 0.0 }
    }

    /// Adds its force to the loads of its movers, in newtons.
    pub(super) fn load(&self, loads: &mut [f64]) {
        for side in &self.sides {
            loads[side.mover] += side.load * self.force.abs();
        }
    }
}
