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
    /// The force is the one that held the contact. The spring is not drawn to it.
    Holds,
    /// The contact slides under a force to which the spring is not drawn.
    Slides,
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

/// Friction in the tick to come, in a contact that rests along its normal. Forces are in N, torques in N m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FrictionOutcome {
    /// It holds with this force, or brakes with its greatest force.
    Holds(f64),
    /// It was at rest and could not bear the load, or slid already without its spring, or was turned round. It slides against the
    /// motion with the dynamic coefficient, and its force has the sign of this number.
    Slides(f64),
    /// The contact begins to rest, perhaps for the one tick in which a collision turns. Its spring follows the motion. A spring that
    /// gives way slides on until the force of the next tick is known.
    Turns,
    /// The contact begins to rest after it parted. The normal force grows, and a spring that slipped is below its limit then.
    Lands,
    /// The contact rests on, and its spring follows the motion. A spring that slips has the limit that follows from the normal force.
    Stays,
    /// It slides with this force, and its contact moves. A hold ends, and its spring follows the motion. A spring that was not drawn to
    /// that hold, or that braked, begins on the side of this force.
    TurnsRound {
        /// In newtons.
        force: f64,
        /// Whether the hold braked a slide with its greatest force.
        braked: bool,
    },
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
