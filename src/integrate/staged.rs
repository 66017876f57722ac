//! Steps of a one-step method from event to event inside a tick.
//!
//! Within a step the modes of all models are frozen, so forces are smooth and the method shows its full order. After a
//! trial step the indicators of events are looked at; where one has changed its sign, the event is found with the same
//! one-step map, so that its time has the order of the method (Hairer, Norsett, Wanner, *Solving Ordinary Differential
//! Equations I*, 1993, II.6). The step is accepted up to there, the modes that ended change, all others stay, and the
//! rest of the tick goes on from there.

use bevy_ecs::prelude::*;
use glam::DVec2;

use super::Integrator;
use super::locate::{Bracket, Moment};
use super::steps::{Flow, OneStep, Start};
use crate::tick::{Indicator, Models, Style, Tick, WorldFlow};
use crate::world::Bodies;

/// Events that are located in one tick; whatever happens beyond takes place at the end of a step.
const MOST_EVENTS: u32 = 256;

/// How often a step is made again with lists that reach farther, each time four times as far. What outgrows them all moves
/// beyond all numbers, and the run ends with that.
const MOST_RENEWALS: u32 = 16;

/// How many events were located, and how many ticks had too many.
#[derive(Resource, Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LocatedEvents {
    /// Events.
    pub count: u64,
    /// Ticks in which `MOST_EVENTS` were reached, so that the rest of the tick went on without locating.
    pub given_up: u64,
}

/// A one-step method as the integrator of a run.
pub struct Staged {
    method: Box<dyn OneStep>,
    located: bool,
    /// The state at the end of the last tick, and what rounding left over of it.
    state: Vec<f64>,
    rest: Vec<f64>,
    work: Work,
}

/// Working memory.
#[derive(Default)]
struct Work {
    rates: Vec<f64>,
    change: Vec<f64>,
    trial: Vec<f64>,
    indicators: Vec<Indicator>,
    from: Vec<(DVec2, f64)>,
}

impl Staged {
    /// A method; `located`: events are located inside ticks.
    pub fn new(method: Box<dyn OneStep>, located: bool) -> Self {
        Self { method, located, state: Vec::new(), rest: Vec::new(), work: Work::default() }
    }

    /// Adds the change of a step to the state, with compensation.
    fn accept(&mut self) {
        for ((state, rest), change) in self.state.iter_mut().zip(&mut self.rest).zip(&self.work.change) {
            let step = change + *rest;
            let after = *state + step;
            *rest = step - (after - *state);
            *state = after;
        }
    }

    /// Takes up the present state; what rounding left over is kept where it is the one that was left.
    fn take_up(&mut self, flow: &WorldFlow) {
        let before = std::mem::take(&mut self.state);
        flow.read(&mut self.state);
        self.rest.resize(self.state.len(), 0.0);
        let same = |place: usize| before.get(place) == Some(&self.state[place]);
        let accounts = flow.places_of_accounts();
        for place in 0..self.state.len() {
            if !same(place) || accounts.contains(&place) {
                self.rest[place] = 0.0;
            }
        }
    }

    /// Goes on from `from` towards `until` seconds with frozen modes, no further than to the first event. Returns how far it
    /// came and which indicators vanished there. The state there is the present one, and evaluated.
    fn go(&mut self, flow: &mut WorldFlow, from: f64, until: f64, locate: bool) -> (f64, Vec<usize>) {
        let length = until - from;
        let mut reach_of_lists = 1.5;
        flow.tick.reserve(length, reach_of_lists);
        let mut went = self.attempt(flow, from, until, locate);
        for _ in 0..MOST_RENEWALS {
            if !flow.tick.outgrown() {
                break;
            }
            // Forces grew inside the step: from its beginning once more, with lists that reach farther.
            reach_of_lists *= 4.0;
            flow.write(&self.state);
            flow.tick.renew_lists(from);
            flow.tick.reserve(length, reach_of_lists);
            went = self.attempt(flow, from, until, locate);
        }
        self.accept();
        flow.book(&self.work.change);
        went
    }

    fn attempt(&mut self, flow: &mut WorldFlow, from: f64, until: f64, locate: bool) -> (f64, Vec<usize>) {
        let length = until - from;
        let Work { rates, change, trial, indicators, .. } = &mut self.work;
        rates.resize(flow.dimension(), 0.0);
        change.resize(flow.dimension(), 0.0);
        flow.read_rates(rates);
        indicators.clear();
        if locate {
            flow.tick.tell(indicators);
        }
        let start = Start { time: from, state: &self.state, rates };
        let (method, rest) = (&mut self.method, &self.rest);
        let mut told = Vec::new();
        let mut reach = |flow: &mut WorldFlow, share: f64, told: &mut Vec<Indicator>| {
            method.step(flow, start, share * length, change);
            trial.clear();
            let sum = |((state, rest), change): ((&f64, &f64), &f64)| state + (change + rest);
            trial.extend(start.state.iter().zip(rest).zip(&*change).map(sum));
            flow.write(trial);
            // The end of a tick is the beginning of the next to the last bit.
            flow.tick.evaluate_stage(if share == 1.0 { until } else { from + share * length });
            told.clear();
            if locate {
                flow.tick.tell(told);
            }
        };
        reach(flow, 1.0, &mut told);
        let mut share = 1.0;
        let mut fired = Vec::new();
        if let Some(mut bracket) = Bracket::around(indicators, &told, length) {
            while let Some(next) = bracket.next() {
                reach(flow, next, &mut told);
                bracket.narrow(Moment { share: next, indicators: told.clone() });
            }
            share = bracket.share();
            if share != bracket.last_tried() {
                reach(flow, share, &mut told);
            }
            fired = bracket.fired(&told);
        }
        (if share == 1.0 { until } else { from + share * length }, fired)
    }
}

impl Integrator for Staged {
    fn style(&self) -> Style {
        if self.located { Style::Frozen } else { Style::Instant }
    }

    fn advance(&mut self, tick: &mut Tick) {
        let bodies = tick.world.resource::<Bodies>();
        self.work.from.clear();
        self.work.from.extend(bodies.position.iter().copied().zip(bodies.angle.iter().copied()));
        let (mut now, end) = (tick.begin, tick.end);
        let mut events = 0;
        while now < end {
            let models = tick.world.resource::<Models>().clone();
            let edge = models.edges.iter().map(|edge| edge(tick.world, now)).fold(f64::INFINITY, f64::min);
            let until = if edge < end { edge } else { end };
            tick.choose_modes(now, until);
            let locate = self.located && events < MOST_EVENTS;
            let mut flow = WorldFlow::new(tick);
            self.take_up(&flow);
            let (reached, fired) = self.go(&mut flow, now, until, locate);
            now = reached;
            // A step cut short counts, whatever it was for: so a tick comes to its end.
            events += u32::from(now < until || !fired.is_empty());
            tick.end_step(&fired);
        }
        let from = std::mem::take(&mut self.work.from);
        tick.book_travel(&from);
        self.work.from = from;
        let mut located = tick.world.get_resource_or_init::<LocatedEvents>();
        located.count += u64::from(events);
        located.given_up += u64::from(events >= MOST_EVENTS);
    }
}
