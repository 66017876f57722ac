//! The limits of a joint: its free motion stays between two values. A joint that reaches a limit stops, or rebounds
//! with a share of its speed (Newton's law of impact). At the limit a row holds it until the row would have to pull.

use glam::DVec2;
use serde::{Deserialize, Serialize};

use super::ends::EndPair;
use super::law::Freedom;
use crate::constraints::{Row, RowKind};
use crate::tick::{Bend, Indicator, State};

/// A share of its size within which a value is at the limit.
const AT: f64 = 1e-14;
/// A share of the greatest force at the limit below which a pull is rounding.
const PULL: f64 = 1e-12;
/// Rebounds slower than this share of the fastest arrival end: the joint stays at its limit.
const STAYS: f64 = 1e-6;

/// The limit at which a joint is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
enum Side {
    Low,
    High,
}

impl Side {
    /// The sign of the direction away from the limit.
    fn sign(self) -> f64 {
        match self {
            Side::Low => 1.0,
            Side::High => -1.0,
        }
    }
}

/// The limits of a joint, and whether it is at one.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Limit {
    /// Least and greatest value in rad or m.
    bounds: (f64, f64),
    restitution: f64,
    /// The limit at which the joint is held.
    at: Option<Side>,
    /// The limit whose indicator has vanished, and the one that was left since the last step.
    reached: Option<Side>,
    left: Option<Side>,
    /// The force of the last evaluation, and the greatest in accepted states since the joint is held.
    force: f64,
    greatest: f64,
    /// The fastest arrival so far, in rad/s or m/s.
    fastest: f64,
}

/// The behaviour of a joint that reaches its limit.
#[derive(Clone, Debug, PartialEq)]
pub enum Arrival {
    /// It stays there.
    Stays,
    /// It rebounds, with the velocity of this row.
    Rebounds(Box<Row>),
}

/// The push on a joint from tick to tick.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Press {
    /// The acceleration along the free motion, in rad/s2 or m/s2.
    pub acceleration: f64,
    /// The length of the tick in s.
    pub tick: f64,
}

impl Press {
    /// Whether a rebound ends before it becomes visible. It ends if the joint is pushed back `outwards` within the
    /// tick, or before it returns to the limit. `beyond` is the distance beyond the limit.
    fn ends(self, outwards: f64, speed: f64, beyond: f64) -> bool {
        let press = outwards * self.acceleration;
        2.0 * speed <= press * self.tick || speed * speed <= 2.0 * press * beyond
    }
}

impl Limit {
    /// Whether another one, from a file, lies where this one does.
    pub(super) fn has_parameters_of(&self, saved: &Self) -> bool {
        (self.bounds, self.restitution) == (saved.bounds, saved.restitution) && saved.force.is_finite()
    }

    /// Limits in rad or m; an absent limit is infinite.
    pub fn new(bounds: [f64; 2], restitution: f64) -> Self {
        Self {
            bounds: (bounds[0], bounds[1]),
            restitution,
            at: None,
            reached: None,
            left: None,
            force: 0.0,
            greatest: 0.0,
            fastest: 0.0,
        }
    }

    fn bound(&self, side: Side) -> f64 {
        match side {
            Side::Low => self.bounds.0,
            Side::High => self.bounds.1,
        }
    }

    fn sides(&self) -> impl Iterator<Item = Side> + use<> {
        let bounds = self.bounds;
        let there = move |side: &Side| match side {
            Side::Low => bounds.0.is_finite(),
            Side::High => bounds.1.is_finite(),
        };
        [Side::Low, Side::High].into_iter().filter(there)
    }

    /// The distance of the value from a limit, positive inside, and the numbers from which it follows.
    fn room(&self, side: Side, pair: &EndPair, freedom: &Freedom) -> (f64, f64) {
        let (bound, value) = (self.bound(side), freedom.value);
        let turns = freedom.along.sides.iter().all(|side| side.0 == DVec2::ZERO);
        let size = if turns { 1.0 } else { pair.size() };
        (side.sign() * (value - bound), value.abs() + bound.abs() + size)
    }

    /// The distance of the joint beyond the limits, in rad or m.
    pub fn beyond(&self, pair: &EndPair, freedom: &Freedom) -> f64 {
        let beyond = |side| {
            let (room, size) = self.room(side, pair, freedom);
            if room < -1e-9 * size { -room } else { 0.0 }
        };
        self.sides().map(beyond).fold(0.0, f64::max)
    }

    /// Whether the joint is held at one of them.
    pub fn holds(&self) -> bool {
        self.at.is_some()
    }

    /// The row that keeps the joint at its limit.
    pub fn row(&self, pair: &EndPair, freedom: &Freedom) -> Option<Row> {
        let side = self.at?;
        let (room, size) = self.room(side, pair, freedom);
        Some(Row { gap: side.sign() * room, size, pushes: side.sign(), ..pair.row(&freedom.along, RowKind::Position) })
    }

    /// Takes the force of its row.
    pub fn note(&mut self, force: f64) {
        self.force = self.at.map_or(0.0, |side| side.sign() * force);
    }

    /// The last evaluation was that of an accepted state. Trial states may have forces beyond all bounds.
    pub fn accept(&mut self) {
        self.greatest = self.greatest.max(self.force.abs());
    }

    fn leave(&mut self) {
        self.left = self.at;
        (self.at, self.force, self.greatest) = (None, 0.0, 0.0);
    }

    /// Before a step: takes or leaves a limit that the joint has reached. From tick to tick `press` is the push along
    /// the freedom.
    pub fn begin_step(&mut self, pair: &EndPair, freedom: &Freedom, press: Option<Press>) -> Option<Arrival> {
        let reached = self.reached.take();
        let left = self.left.take();
        let rate = pair.rate(&freedom.along);
        let still = rate.abs() <= self.rounding(pair, freedom);
        let arrives = |side: &Side| {
            let (room, size) = self.room(*side, pair, freedom);
            let there = reached == Some(*side) || room <= AT * size;
            let pressed = press.is_some_and(|press| side.sign() * press.acceleration < 0.0);
            let rests = still && pressed && left != Some(*side);
            there && self.at.is_none() && (side.sign() * rate < 0.0 && !still || rests)
        };
        let side = self.sides().find(arrives)?;
        self.fastest = self.fastest.max(rate.abs());
        let back = self.restitution * rate.abs();
        let beyond = -self.room(side, pair, freedom).0;
        let ends = press.is_some_and(|press| press.ends(-side.sign(), back, beyond));
        if back > STAYS * self.fastest && !ends {
            let row = Row { rate: side.sign() * back, ..pair.row(&freedom.along, RowKind::Position) };
            return Some(Arrival::Rebounds(Box::new(row)));
        }
        (self.at, self.force, self.greatest) = (Some(side), 0.0, 0.0);
        Some(Arrival::Stays)
    }

    /// After a jump of velocities: leaves a limit from which the joint departs.
    pub fn after_blow(&mut self, pair: &EndPair, freedom: &Freedom) {
        let away = self.at.map_or(0.0, |side| side.sign() * pair.rate(&freedom.along));
        if away > self.rounding(pair, freedom) {
            self.leave();
        }
    }

    /// A rate in rad/s or m/s that is rounding. Behind a blow that stops the bodies, their speeds are rounding themselves.
    fn rounding(&self, pair: &EndPair, freedom: &Freedom) -> f64 {
        PULL * pair.speeds(&freedom.along).max(self.fastest)
    }

    /// Between ticks: leaves a limit that would have to pull. Says whether it did.
    pub fn follow(&mut self) -> bool {
        let pulls = self.pulls();
        if pulls {
            self.leave();
        }
        pulls
    }

    fn pulls(&self) -> bool {
        self.at.is_some() && self.force < -PULL * self.greatest
    }

    /// Adds the indicators of its mode: the way to each limit, or the force of the one that holds.
    pub fn tell(&self, pair: &EndPair, freedom: &Freedom, state: &State, told: &mut Vec<Indicator>) {
        if self.at.is_some() {
            let rounding = PULL * self.greatest;
            let row = pair.row(&freedom.along, RowKind::Position);
            let bend = Bend::AtMost(pair.bend_of_row(&row, 2.0 * self.greatest, state));
            return told.push(Indicator { rounding, ..Indicator::of_value(self.force, bend) });
        }
        let bend = pair.row(&freedom.along, RowKind::Position).acceleration(state.bodies()).abs();
        let rate = pair.rate(&freedom.along);
        told.extend(self.sides().map(|side| {
            let (value, size) = self.room(side, pair, freedom);
            Indicator { rounding: AT * size, ..Indicator::new(value, side.sign() * rate, Bend::AtMost(bend)) }
        }));
    }

    /// The number of indicators.
    pub fn count(&self) -> usize {
        if self.at.is_some() { 1 } else { self.sides().count() }
    }

    /// The indicator at a place has vanished.
    pub fn switch(&mut self, index: usize) {
        match self.at {
            Some(_) => self.leave(),
            None => self.reached = self.sides().nth(index),
        }
    }

    /// Corrects the mode after an evaluation.
    pub fn settle(&mut self, pair: &EndPair, freedom: &Freedom, state: &State) -> bool {
        if self.at.is_some() {
            return self.follow();
        }
        let rate = pair.rate(&freedom.along);
        let row = pair.row(&freedom.along, RowKind::Position);
        let acceleration = row.acceleration(state.bodies());
        // A limit that was left in this tick pushes away only by rounding.
        let rests = |side: &Side| {
            let (room, size) = self.room(*side, pair, freedom);
            let still = rate.abs() <= self.rounding(pair, freedom);
            self.left != Some(*side) && room.abs() <= AT * size && still && side.sign() * acceleration < 0.0
        };
        // Friction that holds the joint, or another one, leaves rounding of the forces of all rows.
        let presses = |side: &Side| -side.sign() * acceleration > PULL * state.rows().pulls(&row, state.bodies());
        let side = self.sides().find(rests).filter(presses);
        if side.is_some() {
            (self.at, self.force, self.greatest) = (side, 0.0, 0.0);
        }
        side.is_some()
    }
}
