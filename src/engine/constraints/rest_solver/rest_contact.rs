//! The input of the rest solver for a contact, and its output.

use glam::DVec2;

/// How a spring with a Coulomb limit acts before the tick.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SpringPhase {
    /// It follows the motion, drawn by less than its limit.
    #[default]
    Follows,
    /// It follows the motion at its limit.
    Slips,
    /// The force is the one that held the contact, without the spring.
    Holds,
    /// The contact slides under a force without the spring.
    Slides,
}

impl SpringPhase {
    /// Whether friction acts without its spring.
    pub fn is_rigid(self) -> bool {
        matches!(self, Self::Holds | Self::Slides)
    }
}

/// A spring with a Coulomb limit: a force in N, or a torque in N m with lengths for coefficients.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CoulombSpring {
    /// Share of the normal force that it may hold.
    pub limit: f64,
    /// Share of the normal force beyond which it gives way, or slips on.
    pub gives: f64,
    /// Share of the normal force that it has in slip.
    pub slips: f64,
    /// The present force.
    pub force: f64,
    /// Its phase.
    pub phase: SpringPhase,
}

impl CoulombSpring {
    /// Whether it has a force, or could have one.
    pub(super) fn acts(&self) -> bool {
        self.limit > 0.0 || self.force != 0.0
    }
}

/// A contact as input of the rest solver.
#[derive(Clone, Copy, Debug)]
pub struct RestContact {
    /// Places of both sides in the list of movers.
    pub ends: (usize, usize),
    /// Arms of both sides in metres.
    pub arms: (DVec2, DVec2),
    /// Unit normal from A to B.
    pub normal: DVec2,
    /// Least and greatest normal force in newtons.
    pub band: (f64, f64),
    /// Normal force in newtons.
    pub normal_force: f64,
    /// Force in newtons that rounding of positions makes.
    pub noise: f64,
    /// Whether the tangential and the rolling force may hold though their springs are stretched. They may once the normal force
    /// has held for a tick. So a contact that turns from loading to unloading in a collision keeps the energy of its springs.
    pub engaged: bool,
    /// Whether the contact parts.
    pub parts: bool,
    /// The tangential spring; its force acts along minus the tangent on B.
    pub tangential: CoulombSpring,
    /// The rolling spring; its torque acts against B's turn.
    pub rolling: CoulombSpring,
}

/// Friction in the tick to come. Forces are in N, torques in N m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FrictionOutcome {
    /// It holds with this force, or brakes with its greatest force.
    Holds(f64),
    /// It slides against the motion with the dynamic coefficient and without its spring. Its force has the sign of this number.
    Slides(f64),
    /// The contact begins to rest after it parted. The normal force grows, and a spring that slipped is below its limit then.
    Lands,
    /// Its spring follows the motion.
    Follows,
}

/// The motion of a contact in the tick to come.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ContactOutcome {
    /// It moves along its normal; the normal force wants it to approach or to part.
    Moves {
        /// Whether the normal force is at its upper bound: the contact approaches.
        approaches: bool,
        /// Friction along the tangent.
        tangential: FrictionOutcome,
        /// Friction against rolling.
        rolling: FrictionOutcome,
    },
    /// It rests along its normal.
    Rests {
        /// Normal force in newtons.
        normal: f64,
        /// Friction along the tangent.
        tangential: FrictionOutcome,
        /// Friction against rolling.
        rolling: FrictionOutcome,
        /// Whether friction holds all that it could hold in this contact.
        entirely: bool,
    },
}

impl ContactOutcome {
    /// Friction along the tangent.
    pub fn tangential(self) -> FrictionOutcome {
        match self {
            Self::Moves { tangential, .. } | Self::Rests { tangential, .. } => tangential,
        }
    }
}
