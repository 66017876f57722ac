//! The optional parts of a joint: limits, friction, and a force at which it breaks.

use serde::{Deserialize, Serialize};

use super::bounded::Bounded;
use super::ends::EndPair;
use super::law::JointLaw;
use super::limit::{Arrival, Limit, Press};
use crate::constraints::{RowKind, Rows};
use crate::scene::Diagnostics;
use crate::scene::units::{Dimension, Quantity, Scalar};
use crate::tick::{Bend, Blow, BlowAtJoint, EvaluationMode, Indicator, State};
use jostle_language::numbers::number;

/// The share of the break force from which on the card tells of a blow.
const TOLD: f64 = 0.01;

/// The request of the scene, in SI units.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Asked {
    /// Least and greatest value of the free motion, in rad or m.
    pub limits: Option<[f64; 2]>,
    /// The share of the speed of arrival that a limit returns.
    pub restitution: f64,
    /// The greatest friction in N m or N.
    pub friction: Option<f64>,
    /// The force in N at which the joint breaks.
    pub break_force: Option<f64>,
    /// Frequency in Hz and damping ratio of a soft joint.
    pub softness: Option<[f64; 2]>,
}

/// Reports limits that are no two finite numbers in order.
pub(super) fn check_limits<D: Dimension>(limits: Option<&(Quantity<D>, Quantity<D>)>, report: &mut Diagnostics) {
    let Some(limits) = limits else { return };
    let (low, high) = (limits.0.si(), limits.1.si());
    if report.finite("limits[0]", low) && report.finite("limits[1]", high) && low >= high {
        let message = format!("the lower limit, {low}, is not below the upper one, {high}");
        report.error("limits", message).help("give the lower limit first, such as `limits: (-0.5, 0.5)`");
    }
}

/// Reports a restitution that is no share, or that has no limits to come back from.
pub(super) fn check_restitution(restitution: Scalar, has_limits: bool, report: &mut Diagnostics) {
    if report.between("restitution", restitution, 0.0, 1.0) && restitution.si() > 0.0 && !has_limits {
        report
            .error("restitution", "the joint has no limits to come back from")
            .help("give it `limits`, or leave out `restitution`");
    }
}

/// Reports a friction below zero.
pub(super) fn check_friction<D: Dimension>(friction: Option<Quantity<D>>, report: &mut Diagnostics) {
    if let Some(friction) = friction {
        report.not_negative("friction", friction);
    }
}

/// Limits, friction and breaking of a joint: their modes.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct JointParts {
    limit: Option<Limit>,
    friction: Option<Bounded>,
    break_force: Option<f64>,
    /// When it broke, in seconds.
    pub broken: Option<f64>,
    /// The greatest blow so far, if it has a break force; if a blow broke it, this one.
    blow: Option<BlowAtJoint>,
    /// The number of rows, of the limit and of friction.
    rows: [usize; 2],
}

impl JointParts {
    /// Whether others, from a file, have the same limits, friction and strength.
    pub(super) fn has_parameters_of(&self, saved: &Self) -> bool {
        let limit = match (&self.limit, &saved.limit) {
            (Some(own), Some(saved)) => own.has_parameters_of(saved),
            (own, saved) => own.is_none() && saved.is_none(),
        };
        let friction = match (&self.friction, &saved.friction) {
            (Some(own), Some(saved)) => own.has_parameters_of(saved),
            (own, saved) => own.is_none() && saved.is_none(),
        };
        limit && friction && self.break_force == saved.break_force && saved.rows.iter().all(|row| *row <= 1)
    }

    pub(super) fn new(asked: &Asked) -> Self {
        Self {
            limit: asked.limits.map(|limits| Limit::new(limits, asked.restitution)),
            friction: asked.friction.filter(|most| *most > 0.0).map(|most| Bounded::new(0.0, most)),
            break_force: asked.break_force,
            ..Self::default()
        }
    }

    /// Whether all parts are absent.
    pub fn is_empty(&self) -> bool {
        self.limit.is_none() && self.friction.is_none() && self.break_force.is_none()
    }

    /// The active friction. At a limit there is none: statics does not determine how limit and friction share a load. A
    /// share beyond the bound would push the joint away from its limit.
    fn acting(&mut self) -> Option<&mut Bounded> {
        let held = self.limit.as_ref().is_some_and(Limit::holds);
        self.friction.as_mut().filter(|_| !held)
    }

    /// Whether there are limits.
    pub fn has_limits(&self) -> bool {
        self.limit.is_some()
    }

    /// Before the first tick: friction against a motion.
    pub fn start(&mut self, law: &dyn JointLaw, pair: &EndPair) {
        if let (Some(friction), Some(freedom)) = (&mut self.friction, law.freedom(pair)) {
            friction.choose(pair, &freedom.along);
        }
    }

    /// The distance of the joint beyond its limits, in rad or m.
    pub fn beyond(&self, law: &dyn JointLaw, pair: &EndPair) -> f64 {
        let freedom = law.freedom(pair);
        self.limit.as_ref().zip(freedom).map_or(0.0, |(limit, freedom)| limit.beyond(pair, &freedom))
    }

    /// Adds the rows of the limit and of friction, in this order.
    pub fn add_rows(&mut self, law: &dyn JointLaw, pair: &EndPair, rows: &mut Rows) {
        self.rows = [0, 0];
        let Some(freedom) = law.freedom(pair) else { return };
        let limit = self.limit.as_ref().and_then(|limit| limit.row(pair, &freedom));
        let friction = self.acting().and_then(|friction| friction.row(pair, &freedom.along));
        self.rows = [limit, friction].map(|row| {
            row.map_or(0, |row| {
                rows.add(row);
                1
            })
        });
    }

    /// Takes the answers of its rows, which begin at an index.
    pub fn take_rows(&mut self, first: usize, rows: &Rows) {
        let [limit, friction] = self.rows;
        if let (Some(part), 1) = (&mut self.limit, limit) {
            part.note(rows.force(first));
        }
        if let (Some(part), 1) = (&mut self.friction, friction) {
            part.note(rows.force(first + limit));
        }
    }

    /// Adds the friction of a joint that slips. Returns its torque in N m, or force in N.
    pub fn apply_forces(
        &mut self,
        law: &dyn JointLaw,
        pair: &EndPair,
        state: &mut State,
    ) -> Option<(super::ends::Along, f64)> {
        let amount = self.acting()?.given()?;
        let along = law.freedom(pair)?.along;
        let into = pair.push(&along, amount, state);
        let lost = -amount * pair.rate(&along);
        let rates = state.bodies_and_rates().1;
        rates.friction += lost;
        rates.work += into + lost;
        Some((along, amount))
    }

    /// Before a step. Returns whether a mode has changed; [`JointParts::broken`] shows whether the joint has broken.
    pub fn begin_step(&mut self, law: &dyn JointLaw, pair: &EndPair, force: f64, state: &mut State) -> bool {
        let now = state.span().begin;
        let located = state.evaluation().mode == EvaluationMode::Frozen;
        if !located && self.breaks(force, now) {
            return true;
        }
        let Some(freedom) = law.freedom(pair) else { return false };
        self.limit.iter_mut().for_each(Limit::accept);
        self.acting().into_iter().for_each(|friction| friction.accept(pair, &freedom.along));
        let mut changed = false;
        if let Some(limit) = &mut self.limit {
            let lets_go = !located && limit.follow();
            changed |= lets_go;
            if lets_go && let Some(friction) = &mut self.friction {
                friction.hold();
            }
            let acceleration = || pair.row(&freedom.along, RowKind::Position).acceleration(state.bodies());
            let press = (!located).then(|| Press { acceleration: acceleration(), tick: state.span().length });
            match limit.begin_step(pair, &freedom, press) {
                Some(Arrival::Stays) => state.strike(Blow::Stops),
                Some(Arrival::Rebounds(row)) => state.strike(Blow::Rebounds(row)),
                None => {}
            }
        }
        if let Some(friction) = self.acting()
            && !located
            && friction.follow(pair, &freedom.along)
        {
            changed = true;
            if friction.given().is_none() {
                state.strike(Blow::Sticks);
            }
        }
        changed
    }

    /// Velocities have jumped: friction may not suffice to hold them, and limits let go.
    pub fn after_blow(&mut self, law: &dyn JointLaw, pair: &EndPair) {
        if let (Some(limit), Some(freedom)) = (&mut self.limit, law.freedom(pair)) {
            limit.after_blow(pair, &freedom);
        }
        if let (Some(friction), Some(freedom)) = (&mut self.friction, law.freedom(pair)) {
            friction.after_blow(pair, &freedom.along);
        }
    }

    /// The force in N at which it breaks, if it has not broken yet.
    pub fn break_force(&self) -> Option<f64> {
        self.break_force.filter(|_| self.broken.is_none())
    }

    /// Takes a blow, and breaks by it or not.
    pub fn take_blow(&mut self, blow: BlowAtJoint, breaks: bool) {
        if breaks {
            self.broken = Some(blow.time);
        }
        if breaks || self.blow.is_none_or(|greatest| blow.force() > greatest.force()) {
            self.blow = Some(blow);
        }
    }

    /// A sentence on whether it has broken, and on its greatest blow.
    pub fn remark(&self, name: &str) -> Option<String> {
        let counts = |blow: &BlowAtJoint| {
            let [impulse, force, time] = [blow.impulse, blow.force(), blow.lasts].map(number);
            format!(
                "{impulse} N s. It counts as {force} N, because a blow at a rigid joint counts as if it took {time} s"
            )
        };
        match (self.broken, &self.blow) {
            (Some(broken), Some(blow)) if blow.time == broken => {
                Some(format!("the joint `{name}` broke at {} s by a blow of {}", number(broken), counts(blow)))
            }
            (Some(broken), _) => Some(format!("the joint `{name}` broke at {} s", number(broken))),
            (None, Some(blow)) if blow.force() > TOLD * self.break_force.unwrap_or(f64::INFINITY) => Some(format!(
                "the joint `{name}` bore a blow at {} s. The blow was {}",
                number(blow.time),
                counts(blow)
            )),
            _ => None,
        }
    }

    fn breaks(&mut self, force: f64, now: f64) -> bool {
        let breaks = self.broken.is_none() && self.break_force.is_some_and(|most| force > most);
        if breaks {
            self.broken = Some(now);
        }
        breaks
    }

    /// Adds the indicators of all modes, if the joint bears this force in N.
    pub fn tell(&mut self, law: &dyn JointLaw, pair: &EndPair, force: f64, state: &State, told: &mut Vec<Indicator>) {
        if let Some(most) = self.break_force {
            let bend = Bend::AtMost(pair.bend(2.0 * most, state));
            told.push(Indicator { rounding: 1e-13 * most, ..Indicator::of_value(most - force, bend) });
        }
        let Some(freedom) = law.freedom(pair) else { return };
        if let Some(limit) = &self.limit {
            limit.tell(pair, &freedom, state, told);
        }
        if let Some(friction) = self.acting() {
            friction.tell(pair, &freedom.along, state, told);
        }
    }

    /// The indicator at a place has vanished.
    pub fn switch(&mut self, index: usize, now: f64) {
        let breaking = usize::from(self.break_force.is_some());
        let limits = breaking + self.limit.as_ref().map_or(0, Limit::count);
        match (&mut self.limit, &mut self.friction) {
            _ if index < breaking => self.broken = Some(now),
            (Some(limit), friction) if index < limits => {
                let held = limit.holds();
                limit.switch(index - breaking);
                friction.iter_mut().filter(|_| held).for_each(Bounded::hold);
            }
            (_, Some(friction)) => friction.switch(index - limits),
            _ => {}
        }
    }

    /// Modes of something else change. Says whether its own do too.
    pub fn look_again(&mut self) -> bool {
        self.acting().is_some_and(Bounded::look_again)
    }

    /// Corrects modes after an evaluation.
    pub fn settle(&mut self, law: &dyn JointLaw, pair: &EndPair, force: f64, state: &State) -> bool {
        if self.breaks(force, state.evaluation().time) {
            return true;
        }
        let Some(freedom) = law.freedom(pair) else { return false };
        if self.limit.as_mut().is_some_and(|limit| limit.settle(pair, &freedom, state)) {
            self.friction.iter_mut().for_each(Bounded::hold);
            return true;
        }
        self.acting().is_some_and(|friction| friction.settle(pair, &freedom.along, state))
    }
}
