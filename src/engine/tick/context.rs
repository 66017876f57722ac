//! The operations of an integrator inside a tick.

use bevy_ecs::prelude::*;

use super::failure::{FailureKind, Trouble};
use super::model::Indicator;
use super::progress::{LocatedEvents, Progress, StepCount};
use super::stopwatch::TickPart;
use super::{Clock, Evaluation, EvaluationMode, Ledger, Rates, Span, State};
use crate::tick::bounds::Bounds;
use crate::world::Bodies;
use crate::world::motion::Travel;

/// Rounds in which models correct their modes after an event. Each takes back at least one choice, so more are needed only
/// where choices contradict each other.
const MOST_CORRECTIONS: usize = 32;

/// The operations of an integrator inside a tick.
pub struct Tick<'a> {
    pub(super) state: &'a mut State,
    /// The schedules, if they contain systems of users.
    pub(super) users: Option<Users<'a>>,
    /// The world for sensors that look inside ticks, if no systems of users have it.
    pub(super) lookers: Option<&'a mut World>,
    pub(super) velocity_dependent: bool,
    pub(super) mode: EvaluationMode,
    /// Whether the state was changed by others since the last tick, or is the first of all.
    pub(super) fresh: bool,
    /// Whether systems in the tick may look at forces.
    pub(super) looked_at: bool,
    /// Whether the last kick may wait for the next tick.
    pub(super) may_wait: bool,
    /// Length of the tick in seconds.
    pub dt: f64,
    /// Time at its beginning in seconds.
    pub begin: f64,
    /// Time at its end in seconds: the beginning of the next to the last bit.
    pub end: f64,
    pub(super) alert: bool,
}

/// The world with the schedules of evaluations and modes.
pub(super) struct Users<'a> {
    pub world: &'a mut World,
    pub evaluate: &'a mut Schedule,
    pub modes: &'a mut Schedule,
    /// Whether sensors look inside ticks.
    pub looks: bool,
}

impl Users<'_> {
    /// Runs a schedule with the state in its place in the world.
    fn run(&mut self, state: &mut State, schedule: fn(&mut Self)) {
        std::mem::swap(state, &mut *self.world.resource_mut::<State>());
        schedule(self);
        std::mem::swap(state, &mut *self.world.resource_mut::<State>());
    }
}

impl Tick<'_> {
    /// The state of the run.
    pub fn state(&self) -> &State {
        self.state
    }

    /// The number of steps so far, for methods that make their own.
    pub fn steps(&mut self) -> &mut StepCount {
        &mut self.state.steps
    }

    /// The number of located events so far.
    pub fn located(&mut self) -> &mut LocatedEvents {
        &mut self.state.located
    }

    /// Whether some force depends on velocities.
    pub fn velocity_dependent(&self) -> bool {
        self.velocity_dependent
    }

    /// Whether some force other than those of contacts depends on velocities.
    pub fn has_velocity_forces(&self) -> bool {
        self.state.has_velocity_forces()
    }

    /// The time in seconds of the first known jump of forces or their rates after `now`; infinite without one.
    pub fn next_edge(&self, now: f64) -> f64 {
        self.state.next_edge(now).min(self.state.bodies.prescribed.next_point(now))
    }

    /// Whether forces may change with time in a state that does not.
    pub fn changes_with_time(&self) -> bool {
        self.state.has_edges() || !self.state.bodies.prescribed.motions.is_empty()
    }

    /// The packed state, for changes by a method. Its contents are up to date, and derived data is computed again.
    pub fn bodies(&mut self) -> &mut Bodies {
        let bodies = self.packed();
        bodies.catch_up();
        bodies.recorded = false;
        bodies
    }

    /// The packed state for the tick itself.
    #[inline(always)]
    pub(super) fn packed(&mut self) -> &mut Bodies {
        &mut self.state.bodies
    }

    /// Evaluates the forces of the current state, `elapsed` seconds after the beginning of the tick.
    pub fn evaluate(&mut self, elapsed: f64) {
        // The end of a tick equals the beginning of the next to the last bit. So schedules see one edge once.
        let time = if elapsed == self.dt { self.end } else { self.begin + elapsed };
        let begin = self.begin;
        let bodies = self.packed();
        if elapsed == 0.0 {
            bodies.accept();
        }
        let driven = (!bodies.prescribed.motions.is_empty()).then(|| bodies.prescribe(begin, time));
        if elapsed != 0.0 && !bodies.jointed.is_empty() {
            self.state.hold_after_drift(elapsed, time);
        }
        let bodies = self.packed();
        bodies.swap_estimate();
        bodies.pose();
        if let Some(driven) = driven {
            let smallest = bodies.smallest_radius;
            let Progress { farthest, travelled, .. } = self.state.progress;
            self.note_travel(Travel { greatest: driven.greatest.max(farthest), sum: travelled + driven.sum }, smallest);
        }
        self.run_evaluation(Evaluation { time, elapsed, ..Evaluation::default() });
        let bodies = self.packed();
        if !std::mem::take(&mut bodies.disturbed) {
            return bodies.swap_estimate();
        }
        bodies.wake_all();
        bodies.pose();
        // No time has passed since: histories stay as they are.
        let state = Evaluation { time, again: true, ..Evaluation::default() };
        self.run_evaluation(state);
        self.packed().swap_estimate();
    }

    /// Bodies are posed.
    fn run_evaluation(&mut self, state: Evaluation) {
        self.state.rates = Rates::default();
        let mode = self.mode;
        let evaluation = &mut self.state.evaluation;
        *evaluation = Evaluation { mode, count: evaluation.count + 1, ..state };
        match &mut self.users {
            Some(users) => users.run(self.state, |users| users.evaluate.run(users.world)),
            None => {
                self.state.update_bounding_boxes();
                self.state.apply_forces();
                self.state.solve_constraints();
                self.state.settle();
            }
        }
        self.state.turn_to(TickPart::Integrate);
    }

    /// Whether the state is the first of all, or was changed by others since the last tick.
    pub fn is_fresh(&self) -> bool {
        self.fresh
    }

    /// Lets forces and contacts choose their modes from `begin` to `end`.
    pub fn choose_modes(&mut self, begin: f64, end: f64) {
        let bodies = self.packed();
        let mut jumped = false;
        if !bodies.prescribed.motions.is_empty() {
            let middle = 0.5 * (begin + end);
            let before = std::mem::replace(&mut bodies.prescribed.middle, middle);
            // On another piece of a path what rides on it has other forces from its first moment on.
            let passed = bodies.prescribed.next_point(before) < middle;
            jumped = passed && self.mode.is_staged();
            if jumped {
                self.evaluate_stage(begin);
            }
        }
        if self.users.is_some() || self.state.stages().modes {
            let whole = begin == self.begin && end == self.end;
            let length = if whole { self.dt } else { end - begin };
            self.state.span = Span { begin, end, length };
            match &mut self.users {
                Some(users) => users.run(self.state, |users| users.modes.run(users.world)),
                None => self.state.begin_step(),
            }
            self.state.take_blows(begin);
            // Forces of held contacts depend on all other forces.
            let stale = self.state.evaluation.stale && self.mode.is_staged();
            if stale {
                self.evaluate_stage(begin);
            }
            if stale || jumped {
                // Modes that cannot last under the new forces end here: a step finds only those that end within it.
                self.settle();
                self.tidy(begin);
            } else if self.state.evaluation.other_rows {
                // No time has passed since: histories stay as they are.
                self.packed().pose();
                self.run_evaluation(Evaluation { time: begin, again: true, ..Evaluation::default() });
            }
        }
    }

    /// Evaluates the forces of the current state at `time` seconds, as a stage of a step. Only the rates change.
    pub fn evaluate_stage(&mut self, time: f64) {
        self.evaluate_as(Evaluation { time, ..Evaluation::default() });
    }

    /// The same for a kick.
    pub(super) fn evaluate_kick(&mut self, time: f64) {
        self.evaluate_as(Evaluation { time, kick: true, ..Evaluation::default() });
    }

    fn evaluate_as(&mut self, evaluation: Evaluation) {
        let begin = self.begin;
        let bodies = self.packed();
        bodies.wake_all();
        if !bodies.prescribed.motions.is_empty() {
            bodies.prescribe(begin, evaluation.time);
        }
        bodies.pose();
        self.run_evaluation(evaluation);
    }

    /// A state that others have made: candidate lists are renewed, and models choose the modes in which it begins.
    pub(super) fn begin_anew(&mut self) {
        self.evaluate_stage(self.begin);
        self.state.each_with_events(|model, state| model.take_stock(state));
        self.evaluate_stage(self.begin);
        self.settle();
        let is_start = self.state.clock.ticks == 0;
        if let Some(touches) = self.state.touches.as_mut().filter(|_| is_start) {
            touches.begin_all();
        }
    }

    /// Adds all indicators of the state just evaluated to a list.
    pub fn tell(&mut self, told: &mut Vec<Indicator>) {
        let mut counts = std::mem::take(&mut self.state.progress.told);
        counts.clear();
        self.state.each_with_events(|model, state| {
            let first = told.len();
            model.tell(state, told);
            counts.push(told.len() - first);
        });
        self.state.progress.told = counts;
    }

    /// The indicators of a state in or at the end of a step that began with `count` of them. Candidate pairs that were renewed within the
    /// step may have more or fewer. Those that came wait for the next step, and those that went last.
    pub fn tell_in_step(&mut self, count: usize, told: &mut Vec<Indicator>) {
        told.clear();
        self.tell(told);
        told.resize(count, Indicator::lasting(1.0));
    }

    /// Called after a step was accepted and its last state evaluated. Modes whose indicators vanished change, and the
    /// state is ready for the next step. Returns whether all rows that only push do so. If not, no choice of modes was found.
    pub fn end_step(&mut self, fired: &[usize], velocity_error: f64) -> bool {
        let time = self.state.evaluation.time;
        self.state.evaluation.velocity_error = velocity_error;
        if !fired.is_empty() {
            let told = std::mem::take(&mut self.state.progress.told);
            let (mut first, mut counts) = (0, told.iter());
            let mut tries = false;
            self.state.each_with_events(|model, state| {
                let end = first + counts.next().copied().unwrap_or_default();
                let own = |index: &&usize| (first..end).contains(*index);
                let own: Vec<usize> = fired.iter().filter(own).map(|index| index - first).collect();
                if own.is_empty() {
                    tries |= model.look_again();
                } else {
                    model.switch(state, &own);
                }
                first = end;
            });
            if tries {
                self.state.each_with_events(|model, _| {
                    model.look_again();
                });
            }
            self.state.progress.told = told;
            self.evaluate_stage(time);
            self.settle();
        }
        self.tidy(time);
        !self.state.rows.would_pull()
    }

    /// Lets models book their modes that have changed, and stop the bodies that these hold.
    fn tidy(&mut self, time: f64) {
        let mut changed = false;
        self.state.each_with_events(|model, state| changed |= model.tidy(state));
        if changed {
            self.evaluate_stage(time);
        }
    }

    /// Called before a step of `length` seconds from the current state, that of `time` seconds. Candidate lists get a reach of `times`
    /// the way that the current velocities and accelerations predict. Returns whether the state was evaluated for that. Another state
    /// may have been evaluated last: prescribed bodies stand where that one had them.
    pub fn reserve(&mut self, time: f64, length: f64, times: f64) -> bool {
        let reserve =
            |bounds: &mut Bounds, bodies: &Bodies| bounds.reserve(bodies, times * farthest_in(bodies, length));
        let State { bounds, bodies, .. } = &mut *self.state;
        let renew = bounds.as_mut().is_some_and(|bounds| reserve(bounds, bodies));
        if renew {
            self.evaluate_stage(time);
        }
        renew
    }

    /// Puts the accounts back to what they were before a look at a state inside a step.
    pub fn restore_ledger(&mut self, ledger: Ledger) {
        self.state.ledger = ledger;
    }

    /// Shows the current state at `time` seconds, between the states of the motion. Forces are evaluated only for a
    /// reader.
    pub fn show(&mut self, time: f64) {
        if self.looked_at || self.state.progress.forces_read || self.state.has_events() {
            return self.evaluate_stage(time);
        }
        self.packed().pose();
        let evaluation = &mut self.state.evaluation;
        (evaluation.time, evaluation.stale) = (time, true);
    }

    /// Renews the candidate lists for the current state.
    pub fn renew_lists(&mut self, time: f64) {
        if let Some(bounds) = self.bounds_mut() {
            bounds.outdate();
            self.evaluate_stage(time);
        }
    }

    /// Whether a body moved farther than the reach of the candidate lists since they were made.
    pub fn outgrown(&self) -> bool {
        self.bounds().is_some_and(|bounds| bounds.outgrown)
    }

    /// Discards the step in which a body moved farther than the reach of the candidate lists.
    pub fn recall_bounds(&mut self) {
        if let Some(bounds) = self.bounds_mut() {
            bounds.outgrown = false;
        }
    }

    /// Lets models correct the modes of a state just evaluated, until no model changes any.
    fn settle(&mut self) {
        let time = self.state.evaluation.time;
        for _ in 0..MOST_CORRECTIONS {
            let mut corrected = false;
            self.state.each_with_events(|model, state| corrected |= model.settle(state));
            if !corrected {
                break;
            }
            self.evaluate_stage(time);
        }
    }

    /// Ends the run at the end of this tick. Its error would require steps of `step` seconds, which are too many.
    pub fn give_up(&mut self, step: f64) {
        let bodies = &self.state.bodies;
        let acceleration = |body: &usize| bodies.force[*body].length() * bodies.inverse_mass(*body);
        let worst = (0..bodies.len()).max_by(|a, b| acceleration(a).total_cmp(&acceleration(b)));
        let Clock { ticks, .. } = self.state.clock;
        let time = self.state.evaluation.time;
        // If jumps end the steps, the next one is a step away, or less by rounding and a cut. Otherwise their error ends them.
        let edge = self.next_edge(time);
        let model = self.state.model_of_edge(time, edge);
        let progress = &mut self.state.progress;
        let wrong =
            if edge - time <= 2.0 * step { FailureKind::Jumps { step, model } } else { FailureKind::Steps(step) };
        progress.trouble.get_or_insert(Trouble { body: worst, entity: None, wrong, tick: ticks + 1, time });
    }

    /// Velocities change by the present forces over `dt` seconds, and the ledger books it.
    pub fn kick(&mut self, dt: f64) {
        self.book(dt);
        self.bodies().kick(dt);
    }

    /// The same at the end of the tick. Without a reader it is done with the next step.
    pub fn kick_at_end(&mut self, dt: f64) {
        self.book(dt);
        if self.has_joints() {
            self.bodies().kick(dt);
            return self.state.hold_at_end();
        }
        if self.may_wait && !self.mode.is_staged() { self.packed().kick_later(dt) } else { self.bodies().kick(dt) }
    }

    /// Velocities change by the current forces over `kick` seconds, which the ledger books. Then positions change by
    /// those velocities over `drift` seconds. A tick has one drift, which is stored as the displacement since the last
    /// accepted state. With `ahead` the velocities so many seconds later are estimated from the same forces. The
    /// following evaluations use the estimates in place of the velocities, which do not change.
    pub fn advance(&mut self, kick: f64, drift: f64, ahead: Option<f64>) {
        self.book(kick);
        let bodies = self.packed();
        let (travelled, smallest) = (bodies.advance(kick, drift, ahead), bodies.smallest_radius);
        self.note_travel(travelled, smallest);
    }

    fn book(&mut self, dt: f64) {
        let rates: Rates = self.state.rates;
        self.alert |= rates.alert;
        self.state.ledger.book(&rates, dt);
        self.state.book_losses(dt);
    }

    /// Whether a model holds more than can be resolved exactly in steps from event to event.
    pub(crate) fn is_overloaded(&mut self) -> bool {
        let mut overloaded = false;
        self.state.each_with_events(|model, _| overloaded |= model.is_overloaded());
        overloaded
    }

    /// The change of models when states become stages of steps, or begin to follow one another.
    pub(super) fn hand_over(&mut self, mode: EvaluationMode) {
        self.state.each_with_events(|model, state| model.hand_over(state, mode));
    }

    /// Bounding boxes, if there are any.
    pub(crate) fn bounds(&self) -> Option<&Bounds> {
        self.state.bounds.as_ref()
    }

    /// Mutable bounding boxes, if there are any.
    pub(crate) fn bounds_mut(&mut self) -> Option<&mut Bounds> {
        self.state.bounds.as_mut()
    }
}

/// The way in metres of the fastest point of a body within `length` seconds, by its present velocity and acceleration.
fn farthest_in(bodies: &Bodies, length: f64) -> f64 {
    let travel = |body: usize| {
        let (velocity, force) = (bodies.velocity[body].length(), bodies.force[body].length());
        let (spin, torque) = (bodies.spin[body].abs(), bodies.torque[body].abs());
        let way = velocity + 0.5 * length * force * bodies.inverse_mass(body);
        let turn = spin + 0.5 * length * torque * bodies.inverse_inertia(body);
        (way + turn * bodies.extent(body)) * length
    };
    (0..bodies.len()).filter(|&body| bodies.moves[body]).map(travel).fold(0.0, f64::max)
}
