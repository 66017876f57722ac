//! A batch of ticks.

use bevy_ecs::change_detection::{DetectChanges, DetectChangesMut, Tick as ChangeTick};
use bevy_ecs::prelude::*;
use bevy_ecs::schedule::{ScheduleCleanupPolicy, ScheduleLabel, Schedules};

use super::components::{
    clear_forces, collect_forces, components_differ, load_state, make_pushable, publish_components,
};
use super::failure::{Failure, FailureKind, Trouble};
use super::flight_permission;
use super::ledger::Totals;
use super::looks::Lookers;
use super::progress::Progress;
use super::registered::{Registered, SystemKind};
use super::stages::schedule_stages;
use super::step::{integrate, integrate_among_systems, refresh};
use super::stopwatch::TickPart;
use super::{Evaluate, EvaluateStage, Method, Modes, SimTick, Stage, State};
use crate::world::{Bodies, Roster, incomplete, packed};

/// The schedules and the method that run during a batch.
pub(super) struct Running {
    pub method: Method,
    /// Evaluations and modes as schedules, if they contain systems of users.
    pub schedules: Option<[Schedule; 2]>,
    /// No system beside the integrator changes anything of the state in the tick.
    pub alone: bool,
    /// Others look at it.
    pub looked_at: bool,
}

/// Knowledge of the systems of users.
#[derive(Resource, Default)]
pub(super) struct Others {
    /// Some live in the tick: components are kept up to date around it.
    pub in_tick: bool,
    /// Some live in the evaluation: components are kept up to date around it.
    in_evaluation: bool,
    /// Some stage has been given a condition.
    conditional: bool,
    /// The integrator runs the schedules of evaluations and modes.
    scheduled: bool,
    /// The integrator has the world.
    has_world: bool,
    /// No system beside the integrator changes anything of the state in the tick.
    alone: bool,
    /// Others look at it.
    looked_at: bool,
    /// The last change of the schedules, and the models, at the time of this knowledge.
    known_at: Option<(ChangeTick, u64)>,
}

/// Runs `ticks` ticks. State that changed in components since the last call is taken up; afterwards the components
/// hold the new state.
///
/// # Errors
/// When a position, angle, velocity or spin stops being finite, or energy comes out of nowhere. The state stays as it was found then.
pub fn step(world: &mut World, ticks: u64) -> Result<(), Failure> {
    let result = advance(world, ticks);
    open(world);
    result
}

/// Runs `ticks` ticks. If no other code sees the world between batches, the running parts are kept. [`open`] precedes
/// all code that changes the world or reads components.
pub(crate) fn advance(world: &mut World, ticks: u64) -> Result<(), Failure> {
    let Some(State { progress, .. }) = world.get_resource() else { return Err(Failure::gone(STATE)) };
    // Others may have written to the lists if the world was open. Lists that were never filled will be.
    if progress.sim.is_none() {
        demand_all(world, progress)?;
        let awaited = world.resource::<Roster>().changed;
        let mut state = world.resource_mut::<State>();
        if state.bodies.counts.is_some() || !awaited {
            state.heal();
        }
    }
    let mut state = world.resource_mut::<State>();
    let watched = state.stopwatch.is_some();
    let kept = state.progress.sim.take();
    let mut sim = kept.unwrap_or_else(|| begin(world));
    // The work between two batches is no change by others.
    if world.resource::<State>().progress.looked_at {
        flight_permission::note_looks(world);
    }
    let (mut stale, mut troubled) = (false, world.resource::<State>().progress.trouble.is_some());
    for _ in 0..ticks {
        if troubled {
            break;
        }
        if watched {
            world.resource_mut::<State>().bypass_change_detection().turn_to(TickPart::Begin);
        }
        sim.run(world);
        let Some(state) = world.get_resource::<State>() else { return Err(Failure::gone(STATE)) };
        (stale, troubled) = (state.evaluation.stale, state.progress.trouble.is_some());
    }
    if stale && !troubled {
        refresh(world);
    }
    let mut state = world.resource_mut::<State>();
    // Systems of users may have written to the lists. To look at them is no change.
    if !state.progress.running.as_ref().is_some_and(|running| running.alone) {
        state.bypass_change_detection().heal();
    }
    let changed = state.last_changed();
    state.see_writers(changed);
    state.complete();
    if world.resource::<Others>().in_tick && world.resource::<State>().progress.trouble.is_none() {
        take_up_last(world);
    }
    let trouble = mend(world);
    let state = world.resource::<State>();
    let shown = state.progress.shown;
    let stays = trouble.is_none() && state.progress.running.as_ref().is_some_and(|running| running.stays());
    world.resource_mut::<State>().progress.sim = Some(sim);
    if !stays {
        open(world);
    } else if shown {
        show_components(world);
    }
    match trouble {
        Some(trouble) => Err(trouble.named(world)),
        None => Ok(()),
    }
}

const STATE: &str = "the resource `State`";

/// Others may have taken out what ticks need.
fn demand_all(world: &World, progress: &Progress) -> Result<(), Failure> {
    if progress.method.is_none() {
        return Err(Failure::gone("the method of integration that belongs to the resource `State`"));
    }
    let Some(schedules) = world.get_resource::<Schedules>() else {
        return Err(Failure::gone("the resource `Schedules`"));
    };
    let there = [
        (schedules.contains(SimTick), "the schedule `SimTick`"),
        (schedules.contains(Evaluate), "the schedule `Evaluate`"),
        (schedules.contains(Modes), "the schedule `Modes`"),
        (world.contains_resource::<Registered>(), "the list of registered systems"),
        (world.contains_resource::<Roster>(), "the roster of bodies"),
    ];
    there.into_iter().find(|(there, _)| !there).map_or(Ok(()), |(_, name)| Err(Failure::gone(name)))
}

/// The failure so far. If the lists of bodies do not fit each other, they are filled again from the components. So the
/// world can be inspected, and the run can continue.
fn mend(world: &mut World) -> Option<Trouble> {
    let progress = &mut world.resource_mut::<State>().into_inner().progress;
    let trouble = progress.trouble?;
    if trouble.wrong.can_be_mended() {
        progress.trouble = None;
    }
    if matches!(trouble.wrong, FailureKind::Torn(_)) {
        progress.behind = false;
        let previous = std::mem::take(&mut world.resource_mut::<State>().bodies);
        let Bodies { generation, level, threads, field, .. } = previous;
        world.resource_mut::<State>().bodies = Bodies { generation, level, threads, field, ..Bodies::default() };
        rebuild(world);
        world.resource_mut::<State>().bodies.touched = true;
    }
    Some(trouble)
}

impl State {
    /// Lists of bodies that do not fit each other are made to, and the run ends. Says whether there was one.
    pub(super) fn heal(&mut self) -> bool {
        let Some(list) = self.bodies.make_fit() else { return false };
        self.progress.trouble.get_or_insert(Trouble::at(&self.clock, None, FailureKind::Torn(list)));
        true
    }
}

/// Takes up what systems of users wrote into components after the last tick: components are as new as the state.
fn take_up_last(world: &mut World) {
    world.resource_mut::<State>().progress.behind = false;
    take_up(world);
    world.resource_mut::<State>().progress.behind = true;
}

/// Takes up the changes between batches, and takes the running parts out of the world.
fn begin(world: &mut World) -> Box<Schedule> {
    let sim = Box::new(prepare(world));
    let others = world.resource::<Others>();
    let (in_tick, scheduled, alone, looked_at) = (others.in_tick, others.scheduled, others.alone, others.looked_at);
    let schedules = scheduled.then(|| [take(world, Evaluate), take(world, Modes)]);
    let mut state = world.resource_mut::<State>();
    let method = state.progress.method.take().expect("the plugin of integrators sets a method");
    state.progress.running = Some(Box::new(Running { method, schedules, alone, looked_at }));
    if !in_tick {
        take_up(world);
    }
    sim
}

/// Opens the world to others: components show the state, and schedules and method are in their resources.
pub(crate) fn open(world: &mut World) {
    if !world.contains_resource::<State>() {
        return;
    }
    show_components(world);
    let mut state = world.resource_mut::<State>();
    let Some(sim) = state.progress.sim.take() else { return };
    let Running { method, schedules, .. } = *state.progress.running.take().expect("it is there with the schedule");
    state.progress.method = Some(method);
    let models = state.progress.version;
    let mut there = world.resource_mut::<Schedules>();
    there.insert(*sim);
    for schedule in schedules.into_iter().flatten() {
        there.insert(schedule);
    }
    let changed = there.last_changed();
    world.resource_mut::<Others>().known_at = Some((changed, models));
    // Later changes get a later tick of change detection.
    world.increment_change_tick();
}

/// Updates the components, if they are out of date.
fn show_components(world: &mut World) {
    if std::mem::take(&mut world.resource_mut::<State>().progress.behind) {
        run_once(world, publish_components);
    }
}

impl Running {
    /// Whether no system of a user may change the schedules or the components.
    fn stays(&self) -> bool {
        self.alone && self.schedules.is_none()
    }
}

impl State {
    /// After a batch forces belong to the current positions, and all bodies have landed.
    fn complete(&mut self) {
        self.bodies.catch_up();
        self.land();
        // The last kick of the batch is seen by no drift any more.
        if self.progress.trouble.is_none() {
            self.note_failure();
        }
        self.progress.behind = true;
        self.turn_to(TickPart::Between);
    }

    /// Asks for components that are up to date after each batch, for systems that read them between ticks.
    pub(crate) fn show_components(&mut self) {
        self.progress.shown = true;
    }
}

/// The schedule of the tick, ready to run. It looks for systems again if schedules, models or the method have changed.
fn prepare(world: &mut World) -> Schedule {
    let now = (world.resource_ref::<Schedules>().last_changed(), world.resource::<State>().progress.version);
    if world.get_resource_or_init::<Others>().known_at == Some(now) {
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
    flight_permission::allow(world, flies, &sim, [&evaluate, &modes]);
    let forces_read = Lookers::some_read_forces(world);
    world.resource_mut::<State>().progress.forces_read = forces_read;
    let alone = world.resource::<Registered>().none_writes(SimTick, &sim);
    let looked_at = sim.graph().systems.len() > 1;
    let mut others = world.resource_mut::<Others>();
    (others.alone, others.looked_at) = (alone, looked_at);
    let mut schedules = world.resource_mut::<Schedules>();
    schedules.insert(evaluate);
    schedules.insert(modes);
    sim
}

/// Before bodies are spawned: checks for systems that work on components. Bodies are then spawned with all components
/// that those need.
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

/// If no system has deferred work, the schedule omits the search for it after each run.
fn apply_only_what_is_deferred(world: &mut World, schedule: &mut Schedule) {
    // A schedule with a mistake reports it when it runs.
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

/// Checks whether systems of users are part of evaluations or of the tick. If so, the integrator runs the schedules
/// with the whole world. It also has the world if sensors look inside ticks.
fn choose_way(world: &mut World, sim: &mut Schedule, [evaluate, modes]: [&Schedule; 2]) {
    let registered = world.resource::<Registered>();
    let as_registered = registered.is_as_registered(Evaluate, evaluate) && registered.is_as_registered(Modes, modes);
    // Schedules hand conditions on when they are made ready.
    let conditional = [evaluate, modes].into_iter().any(has_conditions);
    let looks = Lookers::some_inside(world);
    let mut others = world.resource_mut::<Others>();
    others.conditional |= conditional;
    others.scheduled |= !as_registered || others.conditional || others.in_tick;
    if (others.scheduled || looks) && !others.has_world {
        others.has_world = true;
        // If a user has removed the integrator, it stays removed.
        let gone = sim.remove_systems_in_set(integrate, world, ScheduleCleanupPolicy::RemoveSystemsOnly);
        if gone.is_ok_and(|gone| gone > 0) {
            Registered::add(world, SimTick, sim, SystemKind::Flies, |sim| {
                sim.add_systems(integrate_among_systems.in_set(Stage::Integrate));
            });
        }
    }
}

/// Takes up changes by other code, and remembers the totals before them.
pub(super) fn take_up(world: &mut World) {
    let before = take_up_changes(world);
    let mut state = world.resource_mut::<State>();
    // A change of models is noted when it is made.
    state.progress.before = state.progress.before.or(before);
}

/// Takes up changes by other code: new or lost bodies, or new values in components. Returns the totals before them, if
/// there were any.
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
        if !rebuild(world) {
            return None;
        }
    } else {
        run_once(world, load_state);
    }
    Some(before)
}

/// Fills the packed arrays again, unless a body has lost one of its components. Returns whether they were filled.
pub(crate) fn rebuild(world: &mut World) -> bool {
    if let Some((entity, component)) = incomplete(world) {
        let mut state = world.resource_mut::<State>();
        let trouble = Trouble { entity: Some(entity), ..Trouble::at(&state.clock, None, FailureKind::Lost(component)) };
        state.progress.trouble.get_or_insert(trouble);
        return false;
    }
    if Roster::pushes(world) {
        make_pushable(world);
    }
    let previous = std::mem::take(&mut world.resource_mut::<State>().bodies);
    let bodies = packed::rebuild(world, previous);
    world.resource_mut::<State>().bodies = bodies;
    world.resource_mut::<Roster>().changed = false;
    true
}
