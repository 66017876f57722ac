//! Event-driven stepping of a one-step method: steps from event to event inside a tick.
//!
//! Within a step the modes of all models are frozen. So forces are smooth and the method shows its full order. After a
//! trial step the indicators of events are checked. If one has changed its sign, the same one-step map finds the event.
//! So its time has the order of the method. The source is Hairer, Norsett, Wanner, *Solving Ordinary Differential
//! Equations I*, 1993, II.6. The step is accepted up to there, the modes that ended change, and all others stay. The
//! rest of the tick continues from there.

use glam::DVec2;

mod dead_ends;
mod inner_looks;
mod present;
mod saved;

use saved::Remembered;

use super::control::{Allowance, Control};
use super::event_free_ticks::EventFreeTicks;
use super::event_overload::EventOverload;
use super::interior_events::{Inside, StageValues};
use super::locate::{Bracket, IndicatorSample, vanished};
use super::step_bounds::{AFTER_OVERFLOW, MOST_OVERFLOWS, is_finite};
use super::step_bounds::{longest_among_many, longest_under_loads, rounding_of_time};
use super::steps::{Divided, OneStep, Start};
use crate::tick::Flow;
use crate::tick::Integrator;
use crate::tick::snapshot::{Memory, UnfitSnapshot, demand, recall};
use crate::tick::{EvaluationMode, Indicator, State, Tick, WorldFlow};
use serde::{Deserialize, Serialize};

/// If steps follow their error, a tick is a frame of the film. It may have this factor more events than other ticks.
const EVENTS_PER_FRAME: u32 = 16;

/// The number of times that a step is repeated with lists of a larger reach. Each time the reach is four times as
/// large. If bodies outgrow them all, their motion is beyond all bounds, and the run ends with an error.
const MOST_RENEWALS: u32 = 16;

/// The number of times that a step is repeated because its error was too large. After that it is accepted, and the
/// error of the run shows it.
const MOST_REJECTIONS: u64 = 60;

/// How a tick is divided into steps, when nothing happens in it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum StepPace {
    /// This many equal steps.
    Even(u32),
    /// Steps whose length follows from their error, even beyond a tick. They need a method that estimates its error.
    Allowed(Allowance),
}

/// How finely a run is made beside its ticks: two runs that differ in it have no step in common.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Detail {
    /// Equal parts of each step.
    pub parts: u32,
    /// Ticks per frame. They share the number of events that may be located in a frame.
    pub looks: u32,
    /// The largest angle over which springs of a contact swing in a step, as a share. The whole is the angle at which
    /// the method becomes unstable. A contact lasts half a turn.
    pub swing: f64,
}

impl Default for Detail {
    /// Whole steps of at most a third of the stable length. Methods of low order have five or more in a contact,
    /// `Dop853` has two.
    fn default() -> Self {
        Self { parts: 1, looks: 1, swing: 1.0 / 3.0 }
    }
}

/// A one-step method as the integrator of a run.
pub struct EventStepper {
    method: Box<dyn OneStep>,
    located: bool,
    /// Steps per tick, if no control sets their length.
    parts: u32,
    control: Option<Control>,
    /// The angle in rad over which springs of contacts may swing in a step.
    swing: f64,
    /// The state at the end of the last tick, or at the beginning of an unfinished step. `rest` is its rounding remainder.
    state: Vec<f64>,
    rest: Vec<f64>,
    /// The step that extends beyond the last tick.
    under_way: Option<Made>,
    /// Steps made, and the time in s of the last look at how far they lead.
    steps: u64,
    looked: f64,
    work: Work,
    overload: EventOverload,
    whole: Option<EventFreeTicks>,
}

/// A step that was made: its change of the state is in the working memory.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct Made {
    from: f64,
    until: f64,
    /// Length in s of the step whose inner states the method has; whether the method was asked to prepare them.
    length: f64,
    dense: bool,
    /// The indicators that vanish at its end.
    fired: Vec<usize>,
    /// Whether it was cut short.
    cut: bool,
    /// The booked part of the step and the state shown, at the end of the last tick.
    shown: Option<Shown>,
}

/// The part of a trial step that the method can evaluate.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Known {
    /// No part: each part is a separate step, so that an event has the order of the method.
    Nothing,
    /// Its end.
    WholeStep,
    /// Any state inside, whose error is about that which the step is allowed.
    Inside,
}

#[derive(Clone, Debug, Serialize, Deserialize)]
struct Shown {
    state: Vec<f64>,
    change: Vec<f64>,
}

/// Working memory.
#[derive(Clone, Default, Serialize, Deserialize)]
struct Work {
    rates: Vec<f64>,
    change: Vec<f64>,
    trial: Vec<f64>,
    indicators: Vec<Indicator>,
    from: Vec<(DVec2, f64)>,
}

impl EventStepper {
    /// A method; `located`: events are located inside ticks. A method without an estimate of its error makes one step
    /// per tick if the pace follows errors.
    pub fn new(method: Box<dyn OneStep>, located: bool, pace: StepPace, detail: Detail) -> Self {
        let method = if detail.parts > 1 { Box::new(Divided::new(method, detail.parts)) } else { method };
        let estimates = method.order_of_error() > 0;
        let (parts, control) = match pace {
            StepPace::Even(parts) => (parts, None),
            StepPace::Allowed(allowance) => (1, estimates.then(|| Control::new(allowance))),
        };
        let (state, rest, work) = (Vec::new(), Vec::new(), Work::default());
        let overload = match control {
            Some(_) => EventOverload::shared(EVENTS_PER_FRAME, detail.looks),
            None => EventOverload::shared(1, 1),
        };
        Self {
            method,
            located,
            parts,
            control,
            swing: detail.swing,
            state,
            rest,
            under_way: None,
            steps: 0,
            looked: 0.0,
            work,
            overload,
            whole: None,
        }
    }

    /// The same, but ticks without events are made by another form of the method, which goes from tick to tick.
    pub fn with_whole_ticks(mut self, method: Box<dyn Integrator>) -> Self {
        self.whole = (self.located && self.parts == 1 && self.control.is_none()).then(|| EventFreeTicks::new(method));
        self
    }

    /// Makes a step with frozen modes from `from` towards `until` seconds, no further than to the first event. The state at
    /// its end is the present one, and evaluated. `None`: too many indicators vanish, or the run is to end. Then the state is the one of
    /// the beginning.
    fn make(&mut self, flow: &mut WorldFlow, from: f64, until: f64) -> Option<Made> {
        self.begin(flow);
        let mut until = until.min(from + longest_under_loads(flow, &self.work.indicators, from));
        if let Some(control) = &mut self.control {
            control.look(flow);
            let start = (from, self.state.as_slice(), self.work.rates.as_slice());
            let near = longest_among_many(flow) / control.shorter();
            let length = control.length(flow, self.method.order_of_error(), start, near.min(until - from));
            until = if length < until - from { from + length } else { until };
            flow.write(&self.state);
        } else {
            let fastest = self.work.indicators.iter().map(|indicator| indicator.swings).fold(0.0, f64::max);
            let short = from + self.swing / fastest;
            if short < until {
                until = short;
                flow.tick.steps().shortened += 1;
            }
        }
        let mut reach_of_lists = 1.5;
        if flow.tick.reserve(from, until - from, reach_of_lists) {
            self.begin(flow);
        }
        let mut made = self.attempt(flow, from, until);
        for _ in 0..MOST_OVERFLOWS {
            let shorter = from + AFTER_OVERFLOW * (until - from);
            let overflows = !is_finite(&self.work.trial) && is_finite(&self.state);
            if made.is_none() || shorter <= from || !overflows {
                break;
            }
            // The modes may end long before: forces of frozen modes need not stay bounded behind their end.
            until = shorter;
            flow.write(&self.state);
            if flow.tick.is_stopped(from) {
                return None;
            }
            flow.tick.recall_bounds();
            flow.tick.renew_lists(from);
            flow.tick.reserve(from, until - from, reach_of_lists);
            self.begin(flow);
            made = self.attempt(flow, from, until);
        }
        for _ in 0..MOST_RENEWALS {
            if !flow.tick.outgrown() {
                break;
            }
            // Forces grew inside the step: from its beginning once more, with lists that reach farther.
            reach_of_lists *= 4.0;
            flow.write(&self.state);
            if flow.tick.is_stopped(from) {
                return None;
            }
            flow.tick.renew_lists(from);
            flow.tick.reserve(from, until - from, reach_of_lists);
            self.begin(flow);
            made = self.attempt(flow, from, until);
        }
        if made.is_none() {
            flow.write(&self.state);
            flow.tick.evaluate_stage(from);
        }
        made
    }

    /// Notes the rates and indicators of the present state, which is evaluated.
    fn begin(&mut self, flow: &mut WorldFlow) {
        let Work { rates, change, indicators, .. } = &mut self.work;
        rates.resize(flow.dimension(), 0.0);
        change.resize(flow.dimension(), 0.0);
        flow.read_rates(rates);
        indicators.clear();
        if self.located {
            flow.tick.tell(indicators);
        }
    }

    fn attempt(&mut self, flow: &mut WorldFlow, from: f64, mut until: f64) -> Option<Made> {
        let locate = self.located;
        flow.ends_at(until);
        let Work { rates, change, trial, indicators, .. } = &mut self.work;
        let start = Start { time: from, state: &self.state, rates };
        let (method, rest) = (&mut self.method, &self.rest);
        let sampled = indicators.iter().any(Indicator::is_sampled);
        let mut stages = Vec::new();
        let mut rejected = 0_u64;
        if let Some(control) = &mut self.control {
            let (reach, order) = (flow.reach(), method.order_of_error());
            loop {
                let length = until - from;
                flow.record_stages(sampled);
                method.step(flow, start, length, change);
                stages = flow.recorded_stages();
                let mut error = control.error(&**method, flow, (reach, length, change.as_slice())).unwrap_or_default();
                if error > 1.0 && flow.tick.changes_with_time() {
                    error = control.error_beside(&**method, &rounding_of_time(flow, start, length)).unwrap_or_default();
                }
                let next = control.adapt(length, error, order);
                if error <= 1.0 || from + next <= from || rejected == MOST_REJECTIONS {
                    break;
                }
                rejected += 1;
                until = from + next;
                // Bodies may go far astray in the stages of a step that is too long. Lists need not reach there.
                flow.tick.recall_bounds();
            }
        }
        let length = until - from;
        let controlled = self.control.is_some();
        let mut known = if controlled { Known::WholeStep } else { Known::Nothing };
        let noted = flow.tick.noted();
        let mut reach = |flow: &mut WorldFlow, share: f64, told: &mut Vec<Indicator>| {
            flow.tick.forget_trial(noted);
            match known {
                Known::WholeStep if share == 1.0 => {}
                Known::WholeStep | Known::Inside => {
                    if known == Known::WholeStep {
                        method.make_dense(flow, start, length);
                        known = Known::Inside;
                    }
                    method.dense(share, change);
                }
                Known::Nothing => method.step(flow, start, share * length, change),
            }
            add(start.state, rest, change, trial);
            flow.write(trial);
            // The end of a tick is the beginning of the next to the last bit.
            let time = if share == 1.0 { until } else { from + share * length };
            if flow.hold(time, change, trial) {
                add(start.state, rest, change, trial);
                flow.write(trial);
            }
            flow.tick.evaluate_stage(time);
            if locate {
                flow.tick.tell_in_step(indicators.len(), told);
            }
        };
        let (mut told, mut share, mut fired) = (Vec::new(), 1.0, Vec::new());
        flow.record_stages(sampled && !controlled);
        reach(flow, share, &mut told);
        if !controlled {
            stages = flow.recorded_stages();
        }
        if !self.overload.bears(told.iter().filter(|indicator| vanished(indicator)).count()) {
            return None;
        }
        let share_of = |(time, values)| StageValues { share: (time - from) / length, values };
        let mut inside = Inside::of(indicators, &told, stages.into_iter().map(share_of).collect(), length);
        while let Some(next) = inside.next() {
            if flow.tick.is_asked_to_end(from) {
                return None;
            }
            share = next;
            reach(flow, next, &mut told);
            inside.see(IndicatorSample { share: next, indicators: told.clone() });
        }
        let (low, high) = inside.last_two();
        let ends_at = high.share;
        let bracket = Bracket::between(indicators, low, high, length);
        if bracket.is_none() && share != ends_at {
            share = ends_at;
            reach(flow, share, &mut told);
        }
        if let Some(mut bracket) = bracket {
            let mut last = share;
            while let Some(next) = bracket.next() {
                if flow.tick.is_asked_to_end(from) {
                    return None;
                }
                last = next;
                reach(flow, next, &mut told);
                bracket.narrow(IndicatorSample { share: next, indicators: told.clone() });
            }
            share = bracket.share();
            if share != last {
                reach(flow, share, &mut told);
            }
            fired = bracket.fired(&told);
        }
        let dense = known == Known::Inside;
        let count = flow.tick.steps();
        count.accepted += 1;
        count.rejected += rejected;
        if let Some(control) = &self.control {
            control.count(count);
        }
        count.longest = count.longest.max(share * length);
        let cut = share < 1.0 || !fired.is_empty();
        let until = if share == 1.0 { until } else { from + share * length };
        Some(Made { from, until, length, dense, fired, cut, shown: None })
    }

    /// The motion that comes does not follow smoothly from the one before.
    fn forget(&mut self) {
        if let Some(control) = &mut self.control {
            control.forget();
        }
    }

    /// The end of the next step from `now`, and whether an edge of a force ends it. The `part` is the index of a whole
    /// part of the tick.
    fn target(&mut self, tick: &Tick, now: f64, part: u32) -> (f64, bool) {
        let edge = tick.next_edge(now);
        // A prescribed motion is given from tick to tick.
        let by_ticks = !tick.state().bodies.prescribed.motions.is_empty();
        let end = match &mut self.control {
            Some(control) if by_ticks => tick.end.min(now + control.longest(now, edge.min(tick.end))),
            Some(control) => now + control.longest(now, edge),
            None if part + 1 >= self.parts => tick.end,
            None => tick.begin + (tick.end - tick.begin) * (f64::from(part + 1) / f64::from(self.parts)),
        };
        if edge < end { (edge, true) } else { (end, false) }
    }

    /// Goes to the end of the step that was made. Returns whether contacts and limits have found their modes there.
    fn finish(&mut self, tick: &mut Tick, made: Made) -> bool {
        let mut flow = WorldFlow::new(tick);
        if let Some(shown) = &made.shown {
            add(&self.state, &self.rest, &self.work.change, &mut self.work.trial);
            flow.write(&self.work.trial);
            flow.tick.evaluate_stage(made.until);
            self.accept();
            let accounts = flow.indices_of_accounts();
            let left = self.work.change[accounts.clone()].iter_mut().zip(&shown.change[accounts]);
            left.for_each(|(change, booked)| *change -= booked);
        } else {
            self.accept();
        }
        flow.book(&self.work.change);
        if !made.fired.is_empty() {
            self.forget();
        }
        let velocity_error = self.control.as_ref().map_or(0.0, Control::velocity_error);
        tick.end_step(&made.fired, velocity_error)
    }

    /// Shows the state at the end of the tick, inside a step that extends beyond it.
    fn show(&mut self, tick: &mut Tick, mut made: Made) {
        let end = tick.end;
        let mut flow = WorldFlow::new(tick);
        self.make_dense(&mut flow, &mut made);
        let (mut change, mut state) = (vec![0.0; flow.dimension()], Vec::new());
        self.method.dense((end - made.from) / made.length, &mut change);
        add(&self.state, &self.rest, &change, &mut state);
        flow.write(&state);
        flow.hold(end, &mut change, &mut state);
        flow.tick.show(end);
        flow.read(&mut state);
        flow.count_unbooked(&mut change);
        let mut booked = change.clone();
        if let Some(before) = &made.shown {
            booked.iter_mut().zip(&before.change).for_each(|(change, before)| *change -= before);
        }
        flow.book(&booked);
        made.shown = Some(Shown { state, change });
        self.under_way = Some(made);
    }

    /// The unfinished step, if the state is still the one in which it was left.
    fn resume(&mut self, tick: &mut Tick) -> Option<Made> {
        let made = self.under_way.take()?;
        let fresh = tick.is_fresh();
        let mut flow = WorldFlow::new(tick);
        let mut now = Vec::new();
        flow.read(&mut now);
        let accounts = flow.indices_of_accounts().start;
        let whole = |shown: &&Shown| shown.state.len() == now.len();
        let same = made.shown.as_ref().filter(whole).is_some_and(|shown| shown.state[..accounts] == now[..accounts]);
        if same && !fresh {
            return Some(made);
        }
        self.forget();
        if tick.state().evaluation.stale {
            tick.evaluate_stage(tick.begin);
        }
        None
    }
}

/// `state + (change + rest)`.
fn add(state: &[f64], rest: &[f64], change: &[f64], sum: &mut Vec<f64>) {
    sum.clear();
    sum.extend(state.iter().zip(rest).zip(change).map(|((state, rest), change)| state + (change + rest)));
}

impl Integrator for EventStepper {
    fn save(&self) -> Memory {
        let method = match self.method.save() {
            Memory::Untold => return Memory::Untold,
            Memory::Nothing => None,
            Memory::Bytes(bytes) => Some(bytes),
        };
        Memory::of(&Remembered {
            state: self.state.clone(),
            rest: self.rest.clone(),
            under_way: self.under_way.clone(),
            steps: self.steps,
            looked: self.looked,
            work: self.work.clone(),
            overload: self.overload.clone(),
            control: self.control.clone(),
            whole: self.whole.as_ref().map(EventFreeTicks::memory),
            method,
        })
    }

    fn load(&mut self, bytes: &[u8]) -> Result<(), UnfitSnapshot> {
        let Remembered { state, rest, under_way, steps, looked, work, overload, control, whole, method } =
            recall(bytes)?;
        if control.is_some() != self.control.is_some() || whole.is_some() != self.whole.is_some() {
            return Err(UnfitSnapshot("the integrator was another one".to_owned()));
        }
        let paces = self.control.as_ref().zip(control.as_ref()).is_none_or(|(own, saved)| own.paces_as(saved));
        demand(paces && self.overload.is_as_patient_as(&overload), "the lengths of steps")?;
        if let (Some(own), Some(saved)) = (&mut self.whole, whole) {
            own.recall(saved);
        }
        (self.state, self.rest, self.under_way, self.steps, self.looked) = (state, rest, under_way, steps, looked);
        (self.work, self.overload, self.control) = (work, overload, control);
        method.map_or(Ok(()), |bytes| self.method.load(&bytes))
    }

    fn fits(&self, state: &State) -> Result<(), UnfitSnapshot> {
        self.demand_fit(state)
    }

    fn mode(&self) -> EvaluationMode {
        match self.located {
            true if self.overload.lasts() => EvaluationMode::Following,
            true => EvaluationMode::Frozen,
            false => EvaluationMode::Instant,
        }
    }

    fn advance(&mut self, tick: &mut Tick) {
        if !self.overload.follows() && self.whole.as_mut().is_some_and(|whole| whole.advance(tick)) {
            return self.overload.stays_away(0);
        }
        let bodies = tick.bodies();
        self.work.from.clear();
        self.work.from.extend(bodies.position.iter().copied().zip(bodies.angle.iter().copied()));
        let (mut now, end) = (tick.begin, tick.end);
        let (mut events, mut part) = (0, 0);
        if self.overload.follows() && self.overload.ends(tick) {
            self.overload.end();
            if !tick.begin_stages(EvaluationMode::Frozen) {
                self.exclude(tick, now);
            }
        }
        let mut under_way = self.resume(tick);
        while now < end && !self.overload.follows() {
            let mut made = match under_way.take() {
                Some(made) => made,
                None => {
                    if self.located && self.overload.comes(tick, events) {
                        self.overload.begin(tick, now);
                        break;
                    }
                    let (until, at_edge) = self.target(tick, now, part);
                    tick.choose_modes(now, until);
                    let mut flow = WorldFlow::new(tick);
                    self.take_up(&mut flow);
                    let Some(made) = self.make(&mut flow, now, until) else {
                        if !tick.is_stopped(now) {
                            self.overload.begin(tick, now);
                        }
                        break;
                    };
                    // A step cut short counts, whatever it was for: so a tick comes to its end.
                    events += u32::from(made.cut);
                    part += u32::from(made.until == until && !at_edge);
                    made
                }
            };
            if tick.looks_inside() {
                self.look_inside(tick, &mut made, now);
            }
            now = made.until.min(end);
            let step = made.until - made.from;
            if self.leads_nowhere(now, end) {
                tick.give_up(step);
                break;
            }
            if tick.is_stopped(now) {
                break;
            }
            if made.until > end {
                self.show(tick, made);
            } else if !self.finish(tick, made) {
                self.exclude(tick, now);
            }
        }
        let overloaded = self.overload.follows();
        if overloaded {
            self.overload.advance(tick, now);
            self.forget();
        } else {
            self.overload.stays_away(events);
        }
        let from = std::mem::take(&mut self.work.from);
        tick.book_travel(&from);
        self.work.from = from;
        let located = tick.located();
        located.count += u64::from(events);
        located.given_up += u64::from(overloaded);
    }
}
