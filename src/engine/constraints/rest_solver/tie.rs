//! A row of a joint in the search for rest: its force has no bounds, and its rate is held.

use glam::DVec2;

use super::ROUNDING;
use super::row::Mover;

/// One side of a row of a joint.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TieSide {
    /// The index of its mover.
    pub mover: usize,
    /// How the velocity of the row depends on that of the mover, and the force of one unit.
    pub direction: DVec2,
    /// The same for its spin, in metres; without unit if the row is a turn.
    pub lever: f64,
    /// Force in newtons against which rounding is judged, of one unit.
    pub load: f64,
}

/// A row of a joint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tie {
    sides: [TieSide; 2],
    /// Velocity that one unit gives in one second, in 1/kg.
    pub mobility: f64,
    /// The velocity that is held, in m/s or rad/s.
    rate: f64,
    /// Its force in N, or torque in N m.
    force: f64,
    /// A force of which rounding is a share.
    scale: f64,
}

impl Tie {
    /// A row with its present force; `None` if nothing that moves by forces would follow it.
    pub fn new(sides: [TieSide; 2], movers: &[Mover], (rate, force): (f64, f64)) -> Option<Self> {
        let share = |side: &TieSide| {
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

    /// What its velocity lacks, in m/s or rad/s.
    #[inline]
    pub(super) fn missing(&self, movers: &[Mover]) -> f64 {
        self.rate - self.velocity(movers)
    }

    #[inline]
    pub(super) fn velocity(&self, movers: &[Mover]) -> f64 {
        let of = |side: &TieSide| {
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

    /// Lets its force work over `dt` seconds so that its rate is held. Returns the change over what counts as rounding.
    pub(super) fn relax(&mut self, movers: &mut [Mover], dt: f64) -> f64 {
        let impulse = self.missing(movers) / self.mobility;
        self.take_over(movers, impulse, dt);
        let rounding = ROUNDING * self.scale;
        if rounding > 0.0 { (impulse / dt).abs() / rounding } else { 0.0 }
    }

    /// Adds what it bears to the loads of its movers, in newtons.
    pub(super) fn load(&self, loads: &mut [f64]) {
        for side in &self.sides {
            loads[side.mover] += side.load * self.force.abs();
        }
    }
}
