//! A contact as it comes to the search for rest, and what becomes of it.

use glam::DVec2;

/// A spring with a Coulomb limit as it comes to the search for rest: a force in N, or a torque in N m with lengths for coefficients.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Drawn {
    /// Share of the normal force that it may hold.
    pub limit: f64,
    /// Share of the normal force beyond which it gives way, or slips on.
    pub gives: f64,
    /// Share of the normal force that it has in slip.
    pub slips: f64,
    /// The present force.
    pub force: f64,
}

impl Drawn {
    /// Whether it does something, or could.
    pub(super) fn acts(&self) -> bool {
        self.limit > 0.0 || self.force != 0.0
    }
}

/// A contact as it comes to the search for rest.
#[derive(Clone, Copy, Debug)]
pub struct Seen {
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
    /// Whether the tangential and the rolling force may hold though their springs are drawn out: not before the normal
    /// force has held for a tick, so that a contact that turns in a collision keeps what its springs hold.
    pub engaged: bool,
    /// Whether the contact parts.
    pub parts: bool,
    /// Whether the contact slides and rolls without its springs, under the dynamic coefficient.
    pub slides: (bool, bool),
    /// The tangential spring; its force acts along minus the tangent on B.
    pub tangential: Drawn,
    /// The rolling spring; its torque acts against B's turn.
    pub rolling: Drawn,
}

/// What friction does in the tick to come, in a contact that rests along its normal. Forces are in N, torques in N m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Friction {
    /// It holds with this force, or brakes with all that it can hold.
    Holds(f64),
    /// It was at rest and could not bear the load, or slid already without its spring: it slides with the dynamic coefficient,
    /// against the motion, and its force has the sign of this number.
    Slides(f64),
    /// The contact begins to rest, perhaps for the one tick in which a collision turns: its spring follows the motion, and what
    /// gives way slides on until the force of the next tick is known.
    Turns,
    /// The contact begins to rest after it parted: the normal force grows, and what slipped is no longer drawn to its limit.
    Lands,
    /// The contact rests on: its spring follows the motion, and what slips has the limit of the normal force, which depends on it.
    Stays,
    /// Its spring follows the motion.
    Follows,
}

/// What becomes of a contact in the tick to come.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Verdict {
    /// It moves along its normal; the normal force wants it to approach or to part.
    Moves {
        /// Whether the normal force is at its upper bound: the contact approaches.
        approaches: bool,
    },
    /// It rests along its normal.
    Rests {
        /// Normal force in newtons.
        normal: f64,
        /// What friction does along the tangent.
        tangential: Friction,
        /// What it does against rolling.
        rolling: Friction,
        /// Whether nothing in it moves that friction could hold.
        entirely: bool,
    },
}
