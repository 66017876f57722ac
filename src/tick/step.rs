//! A batch of ticks.

use bevy_ecs::change_detection::{DetectChanges, Tick as ChangeTick};
use bevy_ecs::prelude::*;
use bevy_ecs::schedule::{ScheduleCleanupPolicy, ScheduleLabel, Schedules};

use super::balance::Totals;
use super::components::{
    clear_forces, collect_forces, components_differ, load_state, make_pushable, publish_components,
};
use super::context::{Tick, Users};
use super::failure::{Failure, Trouble, Wrong};
use super::flight;
use super::registered::{Kind, Registered};
use super::stages::schedule_stages;
use super::stopwatch::Part;
use super::{Evaluate, EvaluateStage, Method, Modes, SimTick, Stage, State};
use crate::world::{Name, Roster, finite, packed};

/// What runs while a batch of ticks does.
pub(super) struct Running {
    pub method: Method,
    /// Evaluations and modes as schedules, where systems of users stand in them.
    schedules: Option<[Schedule; 2]>,
    /// No system beside the integrator changes anything of the state in the tick.
    alone: bool,
    /// Others look at it.
    looked_at: bool,
}

/// What is known of the systems of users.
#[derive(Resource, Default)]
struct Others {
    /// Some live in the tick: components are kept up to date around it.
    in_tick: bool,
    /// Some live in the evaluation: components are kept up to date around it.
    in_evaluation: bool,
    /// Some stage has been given a condition.
    conditional: bool,
    /// The integrator runs the schedules of evaluations and modes.
    scheduled: bool,
    /// No system beside the integrator changes anything of the state in the tick.
    alone: bool,
    /// Others look at it.
    looked_at: bool,
    /// When the schedules had changed last, and which models there were, as this was found out.
    known_at: Option<(ChangeTick, u64)>,
}

/// Runs `ticks` ticks. State that changed in components since the last call is taken up; afterwards the components
/// hold the new state.
///
/// # Errors
/// When a position, angle, velocity or spin stops being finite, or energy comes out of nowhere. The state stays as it was found then.
pub fn step(world: &mut World, ticks: u64) -> Result<(), Failure> {
    world.resource_mut::<State>().expect_changes();
    let result = advance(world, ticks);
    show_components(world);
    result
}

/// Runs `ticks` ticks. Components are read if the state was told to expect changes, and written if something reads them.
pub(crate) fn advance(world: &mut World, ticks: u64) -> Result<(), Failure> {
    let mut sim = prepare(world);
    let others = world.resource::<Others>();
    let (in_tick, scheduled, alone, looked_at) = (others.in_tick, others.scheduled, others.alone, others.looked_at);
    let schedules = scheduled.then(|| [take(world, Evaluate), take(world, Modes)]);
    let mut state = world.resource_mut::<State>();
    let method = state.progress.method.take().expect("the plugin of integrators sets a method");
    let expects_changes = !std::mem::replace(&mut state.progress.components.closed, true);
    state.progress.running = Some(Box::new(Running { method, schedules, alone, looked_at }));
    let watched = state.stopwatch.is_some();
    if !in_tick && (expects_changes || world.resource::<Roster>().changed) {
        take_up(world);
    }
    for _ in 0..ticks {
        if watched {
            world.resource_mut::<State>().turn_to(Part::Begin);
        }
        sim.run(world);
        if world.resource::<State>().progress.trouble.is_some() {
            break;
        }
    }
    if watched {
        world.resource_mut::<State>().turn_to(Part::Between);
    }
    end_batch(world);
    let mut state = world.resource_mut::<State>();
    let Running { method, schedules, .. } = *state.progress.running.take().expect("put there above");
    state.progress.method = Some(method);
    let (trouble, models) = (state.progress.trouble, state.progress.version);
    let mut there = world.resource_mut::<Schedules>();
    there.insert(sim);
    for schedule in schedules.into_iter().flatten() {
        there.insert(schedule);
    }
    let changed = there.last_changed();
    world.resource_mut::<Others>().known_at = Some((changed, models));
    // What others change from now on is changed later.
    world.increment_change_tick();
    match trouble {
        Some(trouble) => Err(trouble.named(world)),
        None => Ok(()),
    }
}

/// The schedule of the tick, ready to run. What systems there are is found out anew where schedules, models or the method were
/// changed.
fn prepare(world: &mut World) -> Schedule {
    let now = (world.resource_ref::<Schedules>().last_changed(), world.resource::<State>().progress.version);
    if world.get_resource_or_init::<Others>().known_at == Some(now) {
        if world.resource::<State>().progress.looked_at {
            flight::note_looks(world);
        }
        return take(world, SimTick);
    }
    world.resource_mut::<State>().find_roles();
    schedule_stages(world);
    let mut sim = take(world, SimTick);
    let (mut evaluate, mut modes) = (take(world, Evaluate), take(world, Modes));
    keep_components_current(world, &mut sim, &mut evaluate);
    choose_way(world, &mut sim, [&evaluate, &modes]);
    for schedule in [&mut sim, &mut evaluate, &mut modes] {
        apply_only_what_is_deferred(world, schedule);
    }
    let flies = world.resource::<State>().progress.method.as_ref().is_some_and(|method| method.0.flies());
    flight::allow(world, flies, &sim, [&evaluate, &modes]);
    let alone = world.resource::<Registered>().none_writes(SimTick, &sim);
    let looked_at = sim.graph().systems.len() > 1;
    let mut others = world.resource_mut::<Others>();
    (others.alone, others.looked_at) = (alone, looked_at);
    let mut schedules = world.resource_mut::<Schedules>();
    schedules.insert(evaluate);
    schedules.insert(modes);
    sim
}

/// The state is complete again: forces are those of where bodies stand, all of them have landed, and components show it.
fn end_batch(world: &mut World) {
    if world.resource::<State>().evaluation.stale {
        refresh(world);
    }
    flight::see_writers(world);
    let mut state = world.resource_mut::<State>();
    state.bodies.catch_up();
    state.land();
    // The last kick of the batch is seen by no drift any more.
    if state.progress.trouble.is_none() {
        state.note_failure();
    }
    let components = &mut state.progress.components;
    components.behind = true;
    if components.shown || world.resource::<Others>().in_tick {
        show_components(world);
    }
}

/// Brings the components up to date, if they are not.
pub(crate) fn show_components(world: &mut World) {
    let mut state = world.resource_mut::<State>();
    if std::mem::take(&mut state.progress.components.behind) {
        run_once(world, publish_components);
    }
}

impl State {
    /// Something reads components between ticks: they are brought up to date after each batch.
    pub(crate) fn show_components(&mut self) {
        self.progress.components.shown = true;
    }

    /// Components may be changed before the next tick.
    pub(crate) fn expect_changes(&mut self) {
        self.progress.components.closed = false;
    }
}

/// Before bodies are spawned: sees whether systems that work on components are there already, so that bodies are
/// spawned with all that those need.
pub(crate) fn foresee_components(world: &mut World) {
    let (registered, schedules) = (world.resource::<Registered>(), world.resource::<Schedules>());
    let ordinary = schedules.get(SimTick).is_some_and(|schedule| !registered.all_packed(SimTick, schedule))
        || schedules.get(Evaluate).is_some_and(|schedule| !registered.all_packed(Evaluate, schedule));
    world.get_resource_or_init::<Roster>().pushed |= ordinary;
}

fn take(world: &mut World, label: impl ScheduleLabel) -> Schedule {
    let missing = "the tick was added with `TickAppExt::add_tick`";
    world.resource_mut::<Schedules>().remove(label).expect(missing)
}

/// Whether stages have conditions that the schedule has not yet taken up.
fn has_conditions(schedule: &Schedule) -> bool {
    schedule.graph().system_sets.iter().any(|(.., conditions)| !conditions.is_empty())
}

fn run_once<M>(world: &mut World, system: impl IntoSystem<(), (), M> + 'static) {
    // The system has no parameters that could be missing.
    let _ = world.run_system_cached(system);
}

/// Where no system has anything to be applied later, nothing looks for it after each run.
fn apply_only_what_is_deferred(world: &mut World, schedule: &mut Schedule) {
    // What is wrong with a schedule is told when it runs.
    if schedule.initialize(world).is_ok() {
        let deferred = schedule.systems().is_ok_and(|mut systems| systems.any(|(_, system)| system.has_deferred()));
        schedule.set_apply_final_deferred(deferred);
    }
}

/// Sees whether systems were added that work on components, and puts the copying around them.
fn keep_components_current(world: &mut World, sim: &mut Schedule, evaluate: &mut Schedule) {
    let registered = world.resource::<Registered>();
    let ordinary = (!registered.all_packed(SimTick, sim), !registered.all_packed(Evaluate, evaluate));
    if (ordinary.0 || ordinary.1) && !Roster::pushes(world) {
        make_pushable(world);
    }
    let mut others = world.resource_mut::<Others>();
    if ordinary.0 && !others.in_tick {
        others.in_tick = true;
        sim.add_systems(publish_components.after(Stage::Integrate).before(Stage::Observe));
    }
    if ordinary.1 && !others.in_evaluation {
        others.in_evaluation = true;
        let current = (publish_components, clear_forces).chain();
        evaluate.add_systems(current.after(EvaluateStage::Bounds).before(EvaluateStage::Systems));
        evaluate.add_systems(collect_forces.after(EvaluateStage::Systems).before(EvaluateStage::Forces));
    }
}

/// Sees whether systems of users are part of evaluations or of the tick: the integrator then runs the schedules, with the whole
/// world at hand.
fn choose_way(world: &mut World, sim: &mut Schedule, [evaluate, modes]: [&Schedule; 2]) {
    let registered = world.resource::<Registered>();
    let as_registered = registered.is_as_registered(Evaluate, evaluate) && registered.is_as_registered(Modes, modes);
    // Schedules hand conditions on when they are made ready.
    let conditional = [evaluate, modes].into_iter().any(has_conditions);
    let mut others = world.resource_mut::<Others>();
    others.conditional |= conditional;
    let scheduled = !as_registered || others.conditional || others.in_tick;
    if scheduled && !others.scheduled {
        others.scheduled = true;
        // Where a user took the integrator out it stays out.
        let gone = sim.remove_systems_in_set(integrate, world, ScheduleCleanupPolicy::RemoveSystemsOnly);
        if gone.is_ok_and(|gone| gone > 0) {
            Registered::add(world, SimTick, sim, Kind::Flies, |sim| {
                sim.add_systems(integrate_among_systems.in_set(Stage::Integrate));
            });
        }
    }
}

/// The system of [`Stage::Integrate`].
pub(super) fn integrate(mut state: ResMut<State>) {
    let changed = state.last_changed();
    state.see_writers(changed);
    state.integrate(None);
    let changed = state.last_changed();
    state.note_looks(changed);
}

/// The system of [`Stage::Integrate`] in runs with systems of users in the tick or in evaluations.
fn integrate_among_systems(world: &mut World) {
    let changed = world.resource_ref::<State>().last_changed();
    world.resource_mut::<State>().see_writers(changed);
    if world.resource::<Others>().in_tick {
        take_up(world);
    }
    let mut state = std::mem::take(&mut *world.resource_mut::<State>());
    state.integrate(Some(world));
    *world.resource_mut::<State>() = state;
    flight::note_looks(world);
}

impl State {
    /// A tick. `world` is there if systems of users are part of it.
    fn integrate(&mut self, world: Option<&mut World>) {
        self.turn_to(Part::Integrate);
        let mut running = self.progress.running.take().expect("ticks run inside `step`");
        let Running { method, schedules, alone, looked_at: seen } = &mut *running;
        let (style, clock) = (method.0.style(), self.clock);
        let touched = std::mem::take(&mut self.bodies.touched);
        let before = self.progress.before.take();
        let fresh = !self.progress.current || touched || before.is_some();
        let velocity_dependent = self.velocity_dependent();
        let users = world.zip(schedules.as_mut()).map(|(world, [evaluate, modes])| Users { world, evaluate, modes });
        let looked_at = users.is_some();
        let (begin, end) = (clock.time(), clock.time_of(clock.ticks + 1));
        self.progress.alone = *alone && !looked_at;
        let may_wait = self.progress.alone && !*seen;
        let mut tick = Tick {
            state: self,
            users,
            velocity_dependent,
            style,
            fresh,
            looked_at,
            may_wait,
            dt: clock.dt,
            begin,
            end,
            alert: false,
        };
        if tick.fresh {
            tick.state.bodies.wake_all();
        }
        if tick.fresh && style.is_staged() {
            tick.begin_anew();
        } else if tick.fresh {
            tick.evaluate(0.0);
        }
        if let Some(before) = before {
            tick.state.book_exchange(before);
        }
        // Where all bodies are asleep the end of the tick is its beginning.
        if !tick.state.bodies.all_asleep() {
            if !style.is_staged() {
                tick.choose_modes(tick.begin, tick.end);
            }
            method.0.advance(&mut tick);
        }
        let alert = tick.alert;
        self.progress.running = Some(running);
        self.end_tick(alert);
        self.turn_to(Part::Observe);
    }

    fn end_tick(&mut self, alert: bool) {
        self.clock.ticks += 1;
        self.watch_springs();
        let progress = &mut self.progress;
        progress.current = true;
        progress.energy.alert |= alert | self.springs.alert();
        let ticks = self.clock.ticks;
        if progress.looked_at || progress.looks.binary_search(&ticks).is_ok() {
            self.bodies.catch_up();
            self.land();
        }
        self.show_to_models();
        if !self.progress.travelled.is_finite() {
            self.bodies.catch_up();
            self.land();
            self.note_failure();
        } else if self.progress.energy.is_due(ticks, self.progress.travel) {
            self.look_at_energy();
        }
    }

    /// Sees whether the energy of the present state can be.
    #[cold]
    fn look_at_energy(&mut self) {
        self.bodies.catch_up();
        self.land();
        let mut energy = self.progress.energy;
        let created = energy.look(self, self.progress.travel);
        self.progress.energy = energy;
        if let Some((body, created)) = created {
            let wrong = if created.energy.is_finite() { Wrong::Energy(created) } else { Wrong::NotFinite("energy") };
            self.progress.trouble = Some(Trouble::at(&self.clock, Some(body), wrong));
        }
    }

    /// Looks for a number that is not finite. All bodies have landed.
    fn note_failure(&mut self) {
        if let Some((body, quantity)) = finite::first_not_finite(&self.bodies) {
            self.progress.trouble = Some(Trouble::at(&self.clock, Some(body), Wrong::NotFinite(quantity)));
        }
    }
}

/// After a batch of ticks forces are those of the present state.
fn refresh(world: &mut World) {
    let mut state = std::mem::take(&mut *world.resource_mut::<State>());
    let mut running = state.progress.running.take().expect("put there by `step`");
    let Running { method, schedules, .. } = &mut *running;
    let (style, now, dt, velocity_dependent) =
        (method.0.style(), state.clock.time(), state.clock.dt, state.velocity_dependent());
    let users = schedules.as_mut().map(|[evaluate, modes]| Users { world, evaluate, modes });
    let mut tick = Tick {
        state: &mut state,
        users,
        velocity_dependent,
        style,
        fresh: false,
        looked_at: true,
        may_wait: false,
        dt,
        begin: now,
        end: now,
        alert: false,
    };
    tick.evaluate_stage(now);
    state.progress.running = Some(running);
    *world.resource_mut::<State>() = state;
}

/// Takes up what others changed, and remembers the totals of before if anything did.
fn take_up(world: &mut World) {
    let before = take_up_changes(world);
    let mut state = world.resource_mut::<State>();
    // A change of models is noted when it is made.
    state.progress.before = state.progress.before.or(before);
}

/// Takes up what others changed: new or lost bodies, or new values in components. Returns the totals of before if
/// anything changed.
fn take_up_changes(world: &mut World) -> Option<Totals> {
    let changed = world.resource::<Roster>().changed;
    let state = world.resource::<State>();
    let (touched, beginning) = (state.bodies.touched, state.ledger.start.is_none());
    let differs = changed || touched || beginning || world.run_system_cached(components_differ).unwrap_or(false);
    if !differs {
        return None;
    }
    let mut state = world.resource_mut::<State>();
    state.bodies.touched = false;
    state.bodies.end_flights();
    let before = state.totals();
    if changed {
        show_components(world);
        rebuild(world);
    } else {
        run_once(world, load_state);
    }
    Some(before)
}

/// Fills the packed arrays anew.
pub(crate) fn rebuild(world: &mut World) {
    if Roster::pushes(world) {
        make_pushable(world);
    }
    let previous = std::mem::take(&mut world.resource_mut::<State>().bodies);
    let bodies = packed::rebuild(world, previous);
    world.resource_mut::<State>().bodies = bodies;
    world.resource_mut::<Roster>().changed = false;
}

impl Trouble {
    /// With the name of the body.
    fn named(self, world: &World) -> Failure {
        let entity = self.body.and_then(|body| world.resource::<State>().bodies.entity.get(body).copied());
        let name = entity.and_then(|entity| world.get::<Name>(entity));
        let body = name.map(Name::to_string).unwrap_or_default();
        Failure { body, wrong: self.wrong, tick: self.tick, time: self.time }
    }
}

/// Sets the integrator.
pub fn set_method(world: &mut World, method: Method) {
    let mut state = world.get_resource_or_init::<State>();
    state.progress.method = Some(method);
    state.progress.version += 1;
}

/// The greatest energy that was seen to go round so far, in J, looked for every few hundred ticks: of motion and springs, and
/// what fields released.
pub fn energy_seen(state: &State) -> f64 {
    state.progress.energy.seen()
}
