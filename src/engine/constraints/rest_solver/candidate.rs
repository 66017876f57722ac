//! A contact in the search for rest: its forces and their bounds, and what becomes of it.

use glam::DVec2;

use super::ROUNDING;
use super::row::{Mover, Row, Sides};

/// A force or torque whose limit is a share of the normal force.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Bounded {
    pub row: Row,
    pub coefficient: f64,
    /// Whether it may hold in the tick to come; if not it stays as it is.
    pub engaged: bool,
    /// Whether it slides without its spring.
    slides: bool,
    /// Whether it would have to be greater than its limit to stop the contact. Comparing the force with the limit would
    /// leave that to rounding.
    pub at_limit: bool,
    pub force: f64,
    /// Its spring.
    drawn: Drawn,
    /// Velocity at the beginning of the tick.
    begin: f64,
}

impl Bounded {
    pub fn is_free(&self) -> bool {
        self.engaged && !self.at_limit
    }

    /// Whether it brakes without stopping: `velocity` at the end of the tick is less than at the beginning, and the force
    /// is against it. So a body that is taken by surprise is caught within some ticks by what could hold it.
    fn brakes(&self, velocity: f64) -> bool {
        self.engaged && self.force * velocity < 0.0 && velocity.abs() < self.begin.abs()
    }
}

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
    /// What the spring has left under a normal force.
    fn under(&self, normal_force: f64) -> f64 {
        let beyond = self.force.abs() > self.gives * normal_force;
        if beyond { (self.slips * normal_force).copysign(self.force) } else { self.force }
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

/// A contact that may come to rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Candidate {
    pub(super) ends: (usize, usize),
    normal: Row,
    band: (f64, f64),
    /// Whether the normal force would have to leave its band to stop the contact.
    pub(super) at_limit: bool,
    /// Force in newtons that rounding of positions makes.
    rounding: f64,
    /// Force in newtons too small to be told from none when the verdict is found.
    noise: f64,
    pub(super) normal_force: f64,
    /// Whether it held in the tick before.
    held: bool,
    /// Whether it parted.
    parted: bool,
    pub(super) bounded: [Bounded; 2],
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

impl Candidate {
    pub(super) fn new(begin: &[Mover], end: &[Mover], grips: &[[f64; 2]], seen: &Seen, dt: f64) -> Self {
        let (begin, sides) = (Sides::of(begin, seen.ends), Sides::of(end, seen.ends));
        let grips = (grips[seen.ends.0], grips[seen.ends.1]);
        let along = |direction: DVec2| {
            let levers = (seen.arms.0.perp_dot(direction), seen.arms.1.perp_dot(direction));
            Row::new(&sides, levers, direction)
        };
        let turn = Row::new(&sides, (-1.0, -1.0), DVec2::ZERO);
        let bounded = |place: usize, row: Row, drawn: Drawn, slides: bool| {
            let Drawn { limit: coefficient, force, .. } = drawn;
            // From one limit to the other, and as much again by what the neighbours do: what is faster slides on.
            let (of_a, of_b) = row.mobilities(&sides);
            let reach = 4.0 * (grips.0[place] * of_a + grips.1[place] * of_b) * dt;
            let engaged = (seen.engaged || force == 0.0) && coefficient > 0.0 && row.velocity(&sides).abs() <= reach;
            Bounded { row, coefficient, engaged, slides, at_limit: false, force, drawn, begin: row.velocity(&begin) }
        };
        Self {
            ends: seen.ends,
            normal: along(seen.normal),
            band: seen.band,
            at_limit: false,
            rounding: seen.noise,
            noise: seen.noise.max(1e3 * ROUNDING * seen.band.1),
            normal_force: seen.normal_force,
            held: seen.engaged,
            parted: seen.parts,
            bounded: [
                bounded(0, along(-seen.normal.perp()), seen.tangential, seen.slides.0),
                bounded(1, turn, seen.rolling, seen.slides.1),
            ],
        }
    }

    /// Adds the force against which rounding of its movers is to be judged, in newtons.
    pub(super) fn load(&self, loads: &mut [f64]) {
        for place in [self.ends.0, self.ends.1] {
            loads[place] += self.normal_force + self.rounding / ROUNDING;
        }
    }

    /// Lets all forces work over `dt` seconds so that the contact stops, as far as their bounds allow. Returns the
    /// greatest change of a force over what counts as rounding.
    #[inline(always)]
    pub(super) fn relax(&mut self, movers: &mut [Mover], dt: f64) -> f64 {
        let mut sides = Sides::of(movers, self.ends);
        let wanted = self.normal_force - self.normal.velocity(&sides) / (self.normal.mobility * dt);
        let mut change = self.set_normal(&mut sides, wanted, dt);
        for place in 0..self.bounded.len() {
            let Bounded { row, engaged, force, drawn, .. } = &self.bounded[place];
            if *engaged {
                let wanted = force - row.velocity(&sides) / (row.mobility * dt);
                change = change.max(self.set_bounded(&mut sides, place, wanted, dt));
            } else if drawn.force != 0.0 {
                let left = drawn.under(self.normal_force);
                change = change.max(self.set_drawn(&mut sides, place, left, dt));
            }
        }
        sides.put_back(movers, self.ends);
        change
    }

    /// Sets the normal force to what is wanted, as far as its band allows. Returns the change over what counts as rounding.
    #[inline(always)]
    pub(super) fn set_normal(&mut self, sides: &mut Sides, wanted: f64, dt: f64) -> f64 {
        let force = nearest(wanted, self.band);
        self.at_limit = force != wanted;
        let change = force - self.normal_force;
        self.normal_force = force;
        self.normal.push(sides, change * dt);
        change.abs() / (ROUNDING * self.band.1)
    }

    #[inline(always)]
    pub(super) fn set_bounded(&mut self, sides: &mut Sides, place: usize, wanted: f64, dt: f64) -> f64 {
        let bounded = &mut self.bounded[place];
        let limit = bounded.coefficient * self.normal_force;
        let force = nearest(wanted, (-limit, limit));
        bounded.at_limit = force != wanted;
        self.set_drawn(sides, place, force, dt)
    }

    /// Sets a force to what its spring has. Returns the change over what counts as rounding.
    #[inline(always)]
    fn set_drawn(&mut self, sides: &mut Sides, place: usize, force: f64, dt: f64) -> f64 {
        let bounded = &mut self.bounded[place];
        let change = force - bounded.force;
        bounded.force = force;
        bounded.row.push(sides, change * dt);
        change.abs() / (ROUNDING * bounded.coefficient * self.band.1)
    }

    fn stands(&self, row: &Row, sides: &Sides, dt: f64) -> bool {
        row.velocity(sides).abs() <= self.noise * row.mobility * dt
    }

    /// The rows that no bound holds.
    pub(super) fn free_rows(&self) -> impl Iterator<Item = Row> + '_ {
        let bounded = self.bounded.iter().filter(|bounded| bounded.is_free()).map(|bounded| bounded.row);
        (!self.at_limit).then_some(self.normal).into_iter().chain(bounded)
    }

    /// What the contact does in the tick to come.
    pub fn verdict(&self, movers: &[Mover], dt: f64) -> Verdict {
        let sides = Sides::of(movers, self.ends);
        if self.at_limit && !self.stands(&self.normal, &sides, dt) {
            return Verdict::Moves { approaches: self.normal_force > self.band.0 };
        }
        let stops = |bounded: &Bounded| bounded.engaged && (bounded.is_free() || self.stands(&bounded.row, &sides, dt));
        let of = |bounded: &Bounded| {
            let velocity = bounded.row.velocity(&sides);
            let stood = bounded.begin.abs() <= self.noise * bounded.row.mobility * dt;
            let gives_way = bounded.engaged && stood && bounded.force * velocity < 0.0;
            if stops(bounded) {
                Friction::Holds(bounded.force)
            } else if bounded.slides || gives_way {
                Friction::Slides(-velocity)
            } else if bounded.brakes(velocity) {
                Friction::Holds(bounded.force)
            } else if self.held {
                Friction::Stays
            } else if self.parted {
                Friction::Lands
            } else {
                Friction::Turns
            }
        };
        let entirely = self.bounded.iter().all(|bounded| bounded.coefficient == 0.0 || stops(bounded));
        let [tangential, rolling] = [0, 1].map(|place| of(&self.bounded[place]));
        Verdict::Rests { normal: self.normal_force, tangential, rolling, entirely }
    }
}

/// The force nearest to the one wanted within its bounds. Where overlaps have grown beyond all numbers the bounds are
/// none: the force then is none either, and the run ends with that.
fn nearest(wanted: f64, (least, greatest): (f64, f64)) -> f64 {
    if least <= greatest { wanted.clamp(least, greatest) } else { f64::NAN }
}
