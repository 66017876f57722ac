//! The state of a run: all data that a step changes, and the models that change it. The data are packed arrays in
//! canonical order.

use std::ops::Range;

use bevy_ecs::prelude::*;
use glam::DVec2;

use super::blows::Blow;
use super::bounds::Bounds;
use super::failure::{FailureKind, Trouble};
use super::ledger::Totals;
use super::model::{Energies, Model};
use super::outside::OutsideLaws;
use super::pairs::CandidatePairs;
use super::progress::{LocatedEvents, Progress, StepCount};
use super::roles::{Roles, belongs_to_contacts};
use super::stabilisation::JointDrift;
use super::stopwatch::{Stopwatch, TickPart};
use super::touch::{ContactForces, ContactPoint, DeepestOverlap, Touches};
use super::{Clock, Evaluation, Ledger, Rates, Span, Stability, SteadySprings, TimeScales};
use crate::constraints::{Cancelled, DeadPoints, Projection, Rows};
use crate::world::Bodies;
use serde::{Deserialize, Serialize};

/// The state of a run.
///
/// Systems of users take it as `Res<State>` or `ResMut<State>`, models as an argument. Bodies, atoms and walls are in
/// canonical order, the order in which the scene names them.
#[derive(Resource, Default, Serialize, Deserialize)]
pub struct State {
    pub(crate) bodies: Bodies,
    pub(crate) rates: Rates,
    pub(crate) ledger: Ledger,
    /// The constraints of models in the current evaluation.
    pub(crate) rows: Rows,
    /// Working memory for projections onto joints: the rows of a state that a step has reached, and of trial positions.
    #[serde(skip)]
    pub(super) projected: Rows,
    #[serde(skip)]
    pub(super) projection: Projection,
    /// Blows that come before the next step, each with the index of its model.
    #[serde(skip)]
    pub(super) blows: Vec<(usize, Blow)>,
    /// The place in `roles.begin_step` of the model that begins its step.
    #[serde(skip)]
    pub(super) acting: usize,
    pub(super) joint_drift: JointDrift,
    pub(super) dead_points: DeadPoints,
    pub(crate) evaluation: Evaluation,
    pub(crate) span: Span,
    pub(crate) clock: Clock,
    /// The bounding boxes of the search for pairs.
    pub(crate) bounds: Option<Bounds>,
    pub(crate) pairs: Option<CandidatePairs>,
    pub(crate) deepest: DeepestOverlap,
    pub(crate) contact_forces: Option<ContactForces>,
    pub(crate) touches: Option<Touches>,
    pub(crate) stability: Stability,
    pub(crate) springs: SteadySprings,
    pub(crate) steps: StepCount,
    pub(crate) located: LocatedEvents,
    /// The number of systems of users that make forces.
    pub(crate) force_systems: usize,
    pub(super) progress: Progress,
    #[serde(skip)]
    pub(crate) stopwatch: Option<Stopwatch>,
    #[serde(skip)]
    pub(super) models: Vec<Box<dyn Model>>,
    #[serde(skip)]
    pub(super) roles: Roles,
    #[serde(skip)]
    pub(super) outside: OutsideLaws,
}

/// Lets some models act on the state that holds them.
macro_rules! each {
    ($state:ident, $indices:ident, $model:ident => $act:expr) => {
        if !$state.roles.$indices.is_empty() {
            let mut models = std::mem::take(&mut $state.models);
            for number in 0..$state.roles.$indices.len() {
                let $model = &mut models[$state.roles.$indices[number]];
                $act;
            }
            $state.models = models;
        }
    };
}

/// The stages of a step.
impl State {
    /// Stages Bounds and Pairs: checks boxes against the current positions of bodies, and finds candidate pairs.
    pub(super) fn update_bounding_boxes(&mut self) {
        self.turn_to(TickPart::Bounds);
        let Self { bounds, bodies, evaluation, .. } = self;
        if let Some(bounds) = bounds {
            bounds.update(bodies, evaluation);
        }
        self.turn_to(TickPart::Pairs);
        each!(self, find_pairs, model => model.find_pairs(self));
    }

    /// Stage Forces: all models add to the sums.
    pub(super) fn apply_forces(&mut self) {
        self.turn_to(TickPart::Forces);
        self.rows.clear();
        let mut models = std::mem::take(&mut self.models);
        let (forces, contacts) = models.split_at_mut(self.roles.others);
        forces.iter_mut().for_each(|model| model.apply_forces(self));
        if !contacts.is_empty() {
            self.turn_to(TickPart::Contacts);
            contacts.iter_mut().for_each(|model| model.apply_forces(self));
        }
        self.models = models;
    }

    /// Stage Constraints: the rows of all models are solved together, and each model takes its answers.
    #[inline]
    pub(super) fn solve_constraints(&mut self) {
        if !self.roles.rows.is_empty() {
            self.add_joint_rows();
            if self.evaluation.kick {
                self.rows.leave_out_turning();
            }
        }
        if self.rows.is_empty() {
            return;
        }
        self.turn_to(TickPart::Constraints);
        self.rows.solve(&self.bodies);
        if self.evaluation.mode.is_staged() {
            self.rows.stay_in_bounds(&self.bodies);
        } else {
            self.rows.give_way(&self.bodies);
        }
        each!(self, rows, model => model.take_rows(self));
        let Self { rows, bodies, rates, .. } = self;
        rows.cancel(bodies, |bodies, Cancelled { body, force, torque }| {
            rates.outside(bodies.position[body], force, torque);
        });
    }

    /// Stage Settle: the work that depends on all forces.
    pub(super) fn settle(&mut self) {
        self.turn_to(TickPart::Settle);
        each!(self, settle, model => model.settle(self));
    }

    /// Models with rows hear that velocities have jumped.
    pub(super) fn tell_of_blow(&mut self) {
        each!(self, rows, model => model.after_blow(self));
    }

    /// Models choose the modes that stay frozen during the step.
    pub(super) fn begin_step(&mut self) {
        self.turn_to(TickPart::Modes);
        let mut turns = 0..;
        each!(self, begin_step, model => {
            self.acting = turns.next().unwrap_or_default();
            if self.stopwatch.is_some() {
                let is_law = self.outside.law_of(&**model).is_some();
                self.turn_to(if is_law { TickPart::Rest } else { TickPart::Modes });
            }
            if model.begins_with_velocities() {
                self.bodies.catch_up();
            }
            model.begin_step(self);
        });
        self.turn_to(TickPart::Integrate);
    }

    /// Shows the models that have state of their own and events, in order.
    pub(super) fn each_with_events(&mut self, mut see: impl FnMut(&mut dyn super::model::Events, &mut Self)) {
        each!(self, events, model => if let Some(events) = model.events() { see(events, self) });
    }

    /// The run ends with this tick, because of a body.
    pub(crate) fn end_run(&mut self, body: usize, wrong: FailureKind) {
        let tick = self.clock.ticks + 1;
        let trouble = Trouble { body: Some(body), entity: None, wrong, tick, time: self.evaluation.time };
        self.progress.trouble.get_or_insert(trouble);
    }

    /// Whether nothing but the engine's own stages sees the state between the evaluations of a tick and between ticks.
    pub(crate) fn is_alone(&self) -> bool {
        self.progress.alone
    }

    /// The stages of the tick.
    pub(super) fn stages(&self) -> Stages {
        let Roles { find_pairs, rows, settle, begin_step, .. } = &self.roles;
        Stages {
            bounds: self.bounds.is_some() || !find_pairs.is_empty(),
            forces: !self.models.is_empty(),
            constraints: !rows.is_empty(),
            settle: !settle.is_empty(),
            modes: !begin_step.is_empty(),
        }
    }

    /// Counts the time from here on for another part of the tick, if it is measured.
    #[inline]
    pub(super) fn turn_to(&mut self, part: TickPart) {
        if let Some(stopwatch) = &mut self.stopwatch {
            stopwatch.turn_to(part);
        }
    }
}

/// The stages that a scene needs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Stages {
    pub bounds: bool,
    pub forces: bool,
    pub constraints: bool,
    pub settle: bool,
    pub modes: bool,
}

/// Models, and their common properties.
impl State {
    /// Adds a model behind the others. Contact laws are behind all other models.
    ///
    /// # Panics
    /// While models act: a model cannot add another one. A system in [`Stage::Begin`](super::Stage::Begin) can.
    pub fn add_model(&mut self, model: impl Model) {
        let index = if belongs_to_contacts(&model, &self.outside) { self.models.len() } else { self.roles.others };
        self.insert_model(index, model);
    }

    /// Adds a model before all others.
    pub(crate) fn add_first_model(&mut self, model: impl Model) {
        self.insert_model(0, model);
    }

    fn insert_model(&mut self, index: usize, model: impl Model) {
        assert!(
            index <= self.models.len() && !self.outside.acting,
            "a model cannot add another one while it acts: a system in `Stage::Begin` can"
        );
        self.note_change();
        self.roles.others += usize::from(!belongs_to_contacts(&model, &self.outside));
        self.models.insert(index, Box::new(model));
        self.progress.version += 1;
    }

    /// Keeps the models for which `keep` is true. Returns the number of removed models. While models act it removes none.
    pub fn retain_models(&mut self, keep: impl FnMut(&mut Box<dyn Model>) -> bool) -> usize {
        if self.outside.acting {
            return 0;
        }
        self.note_change();
        let before = self.models.len();
        self.models.retain_mut(keep);
        self.progress.version += 1;
        self.find_roles();
        before - self.models.len()
    }

    /// Announces a change. Forces are evaluated again before the next tick, and the change of energy counts as work.
    fn note_change(&mut self) {
        self.bodies.touched = true;
        self.springs.look_again();
        if self.ledger.start.is_some() && self.progress.before.is_none() {
            self.progress.before = Some(self.totals());
        }
    }

    /// Finds the roles of the models, if these have changed.
    pub(super) fn find_roles(&mut self) {
        if self.roles.version != Some(self.progress.version) {
            self.roles = Roles { version: Some(self.progress.version), ..Roles::of(&mut self.models, &self.outside) };
            let Self { models, ledger, roles, .. } = self;
            let losses = models.iter().enumerate().filter_map(|(index, model)| Some((index, model.loss()?.account)));
            roles.accounts.extend(losses.map(|(index, account)| (index, ledger.account(account))));
        }
    }

    /// All models in the order in which they act.
    pub fn models(&self) -> impl Iterator<Item = &dyn Model> {
        self.models.iter().map(|model| &**model)
    }

    /// All models of a type, in order.
    pub fn models_of<T: 'static>(&self) -> impl Iterator<Item = &T> {
        self.models().filter_map(of_type)
    }

    /// The number of all models.
    pub(crate) fn model_count(&self) -> usize {
        self.models.len()
    }

    /// The model at a place among all models, if it is of a type.
    pub(crate) fn model_at<T: 'static>(&self, place: usize) -> Option<&T> {
        self.models.get(place).and_then(|model| of_type(&**model))
    }

    /// The first model of a type.
    pub fn model<T: 'static>(&self) -> Option<&T> {
        self.models_of().next()
    }

    /// The first model of a type, mutable. Forces are evaluated again before the next tick, and a change of energy
    /// counts as work.
    pub fn model_mut<T: 'static>(&mut self) -> Option<&mut T> {
        let has = |model: &dyn Model| {
            let own: &dyn std::any::Any = model;
            own.is::<T>() || model.inner().is_some_and(|inner| inner.is::<T>())
        };
        let index = self.models.iter().position(|model| has(&**model))?;
        self.note_change();
        self.progress.version += 1;
        let model = &mut *self.models[index];
        if (model as &dyn std::any::Any).is::<T>() {
            return (model as &mut dyn std::any::Any).downcast_mut();
        }
        model.inner_mut()?.downcast_mut()
    }

    /// Lets each model do something once, while the world is there without this state's models.
    pub(crate) fn start_models(world: &mut World) {
        let mut models = std::mem::take(&mut world.resource_mut::<Self>().models);
        models.iter_mut().for_each(|model| model.start(world));
        let mut state = world.resource_mut::<Self>();
        state.models = models;
        state.progress.version += 1;
        state.find_roles();
    }

    /// Whether some force depends on velocities, without those of joints.
    pub(super) fn depends_on_velocity_beside_joints(&self) -> bool {
        self.force_systems > 0 || self.roles.velocity_beside_joints
    }

    /// Whether systems of users add forces, whose course in time is unknown.
    pub fn has_force_systems(&self) -> bool {
        self.force_systems > 0
    }

    /// Whether some force depends on velocities.
    pub fn velocity_dependent(&self) -> bool {
        self.force_systems > 0 || self.roles.velocity_dependent
    }

    /// Whether some force other than those of contacts depends on velocities.
    pub fn has_velocity_forces(&self) -> bool {
        self.force_systems > 0 || self.roles.velocity_forces
    }

    /// Whether some force other than those of contacts may change with time in a state that does not.
    pub fn changing_forces(&self) -> bool {
        self.force_systems > 0 || self.roles.changing_forces
    }

    /// Whether bodies may fly as far as models go.
    pub(super) fn flies(&self) -> bool {
        self.force_systems == 0 && self.roles.flies
    }

    /// Whether forces have times at which they or their rates jump.
    pub(crate) fn has_edges(&self) -> bool {
        !self.roles.edges.is_empty()
    }

    /// The fastest angular frequency in rad/s at which a force oscillates in time; zero if none does.
    pub(crate) fn fastest_rhythm(&self) -> f64 {
        self.roles.rhythm
    }

    /// Whether models have state of their own or events.
    pub(super) fn has_events(&self) -> bool {
        !self.roles.events.is_empty()
    }

    /// The first of them after a time in seconds, or infinity.
    pub(crate) fn next_edge(&self, now: f64) -> f64 {
        self.roles.edges.iter().map(|index| self.models[*index].next_edge(now)).fold(f64::INFINITY, f64::min)
    }

    /// The index of the first model whose forces or their rates jump at `edge`. None of its jumps lies between `now` and then.
    pub(super) fn model_of_edge(&self, now: f64, edge: f64) -> Option<usize> {
        self.roles.edges.iter().copied().find(|index| self.models[*index].next_edge(now) == edge)
    }

    /// The name of the contact law, if there is one.
    pub fn contact_law(&self) -> Option<&'static str> {
        self.models().find_map(|model| self.law_of(model))
    }

    /// All contacts of the current state in canonical order; `None` without a contact law that provides them.
    pub fn contact_points(&self) -> Option<Vec<ContactPoint>> {
        self.models.iter().find_map(|model| model.contact_points(self))
    }

    /// Books what models with accounts of their own took, at the power of the last evaluation, over `dt` seconds.
    #[inline]
    pub(super) fn book_losses(&mut self, dt: f64) {
        let Self { models, ledger, roles, .. } = self;
        for &(model, account) in &roles.accounts {
            let power = models[model].loss().map_or(0.0, |loss| loss.power);
            ledger.accounts[account].1.add(power * dt);
        }
    }

    /// Adds the powers of models with accounts of their own, one number for each account of the ledger.
    pub(super) fn add_losses(&self, powers: &mut [f64]) {
        for &(model, account) in &self.roles.accounts {
            powers[account] += self.models[model].loss().map_or(0.0, |loss| loss.power);
        }
    }

    /// Energies of all models together.
    pub fn energies(&self) -> Energies {
        self.models.iter().map(|model| model.energies(self)).fold(Energies::default(), |sum, of| Energies {
            potential: sum.potential + of.potential,
            elastic: sum.elastic + of.elastic,
        })
    }

    /// Energies and momenta.
    pub fn totals(&self) -> Totals {
        let Energies { potential, elastic } = self.energies();
        Totals::with(&self.bodies, potential, elastic)
    }

    /// The measured responses of all models.
    pub fn time_scales(&self) -> TimeScales {
        let models = self.models.iter().map(|model| model.time_scales());
        TimeScales::of_all(models.chain([self.springs.found()]))
    }
}

/// The part of the state for systems and models of users.
impl State {
    /// All bodies, atoms and walls.
    pub fn bodies(&self) -> &Bodies {
        &self.bodies
    }

    /// All bodies, atoms and walls, to be changed.
    pub fn bodies_mut(&mut self) -> &mut Bodies {
        &mut self.bodies
    }

    /// The rows of the present evaluation.
    pub fn rows(&self) -> &Rows {
        &self.rows
    }

    /// The rows of the present evaluation, to be added to.
    pub fn rows_mut(&mut self) -> &mut Rows {
        &mut self.rows
    }

    /// Applies the forces of some rows to their bodies, with the external part. A model calls it in
    /// [`Model::take_rows`] with the indices of its rows.
    pub fn apply_rows(&mut self, indices: Range<usize>) {
        let Self { rows, bodies, rates, .. } = self;
        for index in indices {
            let (row, amount) = (rows.row(index), rows.force(index));
            rates.work += amount * row.powers(bodies)[2];
            let inside = row.is_inside(bodies);
            for side in row.sides.iter().flatten() {
                let (force, torque) = (side.force * amount, side.torque * amount);
                bodies.force[side.body] += force;
                bodies.torque[side.body] += torque;
                if !inside && bodies.dynamic[side.body] {
                    rates.outside(bodies.position[side.body], force, torque);
                }
            }
        }
    }

    /// Bodies and the rates of energy and momentum at once: forces add to both.
    pub fn bodies_and_rates(&mut self) -> (&mut Bodies, &mut Rates) {
        (&mut self.bodies, &mut self.rates)
    }

    /// The same with the candidate pairs: contact laws go by them.
    pub fn bodies_rates_and_pairs(&mut self) -> (&mut Bodies, &mut Rates, Option<&CandidatePairs>) {
        (&mut self.bodies, &mut self.rates, self.pairs.as_ref())
    }

    /// Rates of energy and momentum of the present evaluation.
    pub fn rates(&self) -> &Rates {
        &self.rates
    }

    /// The sums since the beginning.
    pub fn ledger(&self) -> &Ledger {
        &self.ledger
    }

    /// The clock of ticks.
    pub fn clock(&self) -> Clock {
        self.clock
    }

    /// Time in seconds at the beginning of the present tick, and between ticks.
    pub fn time(&self) -> f64 {
        self.clock.time()
    }

    /// The moment at which forces are being evaluated.
    pub fn evaluation(&self) -> Evaluation {
        self.evaluation
    }

    /// The stretch of time for which modes are being chosen.
    pub fn span(&self) -> Span {
        self.span
    }

    /// Pairs that may touch; `None` without a search.
    pub fn pairs(&self) -> Option<&CandidatePairs> {
        self.pairs.as_ref()
    }

    /// The deepest overlap so far.
    pub fn deepest_overlap(&self) -> &DeepestOverlap {
        &self.deepest
    }

    /// The pairs that touch, where something asks for contact events.
    pub fn touches(&self) -> Option<&Touches> {
        self.touches.as_ref()
    }

    /// The number of located events inside ticks so far.
    pub fn located(&self) -> LocatedEvents {
        self.located
    }

    /// The numbers of accepted and of rejected steps so far.
    pub fn steps(&self) -> StepCount {
        self.steps
    }

    /// The limit of the longest stable tick.
    pub fn stability(&self) -> &Stability {
        &self.stability
    }

    /// The durations of the parts of ticks, if they are measured.
    pub fn stopwatch(&self) -> Option<&Stopwatch> {
        self.stopwatch.as_ref()
    }

    /// The forces of contacts on each body and wall, if a sensor asks for them.
    pub fn contact_forces(&self) -> Option<&ContactForces> {
        self.contact_forces.as_ref()
    }

    /// The acceleration of free fall in m/s2.
    pub fn gravity(&self) -> DVec2 {
        self.bodies.field.unwrap_or_default()
    }

    /// The section `gravity`: from here on the sums of forces begin with the weight.
    pub(crate) fn begin_field(&mut self, gravity: DVec2) {
        self.bodies.field = Some(gravity);
        self.bodies.posed = false;
    }

    /// Another acceleration of free fall in m/s2. The energy that bodies have more by it counts as work. Says whether it was done: a
    /// scene without the section `gravity` has no weight that could change.
    #[must_use]
    pub fn set_gravity(&mut self, gravity: DVec2) -> bool {
        let Some(field) = self.bodies.field else { return false };
        if field != gravity {
            self.note_change();
            self.bodies.field = Some(gravity);
            self.bodies.posed = false;
        }
        true
    }
}

/// The model, or the one inside it, if it is of a type.
fn of_type<T: 'static>(model: &dyn Model) -> Option<&T> {
    let own: &dyn std::any::Any = model;
    own.downcast_ref().or_else(|| model.inner()?.downcast_ref())
}
