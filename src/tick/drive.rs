//! Driving the schedules: a batch of ticks.

use bevy_ecs::prelude::*;
use bevy_ecs::schedule::{ScheduleLabel, Schedules};
use glam::DVec2;

use super::balance::Totals;
use super::direct::{Direct, held, held_mut, stands_for_all};
use super::failure::{Failure, Wrong};
use super::flight;
use super::guard::EnergyGuard;
use super::inside::Tick;
use super::registered::Registered;
use super::stopwatch;
use super::travel::FarTravel;
use super::{Balance, Census, Clock, Evaluate, EvaluateStage, Evaluation, Ledger, Modes, SimTick, Stage};
use crate::tick::Method;
use crate::tick::bounds::update_bounding_boxes;
use crate::world::{Bodies, Force, Name, Torque, finite, packed};

/// What is taken out of the world while a batch of ticks runs.
struct Running {
    method: Method,
    evaluate: Schedule,
    modes: Schedule,
    has_modes: bool,
    velocity_dependent: bool,
}

/// State of the drive between ticks.
#[derive(Resource, Default)]
pub(super) struct Drive {
    running: Option<Box<Running>>,
    pub(super) method: Option<Method>,
    /// Ordinary systems live in the tick: components are kept up to date around it.
    ordinary_tick: bool,
    /// Ordinary systems live in the evaluation: components are kept up to date around it.
    ordinary_evaluate: bool,
    /// Systems in the tick look at all bodies.
    pub(super) looked_at: bool,
    /// Ticks at whose ends systems look at all bodies that look at no others, in order.
    pub(super) looks: Vec<u64>,
    /// When the packed state had changed last as these saw it.
    pub(super) shown_at: Option<bevy_ecs::change_detection::Tick>,
    /// Some stage has been given a condition.
    conditional: bool,
    /// Forces are those of the present state.
    current: bool,
    /// Ticks were run since the components were last brought up to date.
    stepped: bool,
    /// Greatest travel of any point of a body in one tick, in metres.
    pub(super) travel: f64,
    /// See [`Travel::sum`], of the last tick: not finite as soon as the way of somebody is not.
    pub(super) travelled: f64,
    /// Greatest travel in the last tick, in metres.
    pub(super) farthest: f64,
    /// The first body that travelled farther than the smallest radius in one tick.
    pub(super) far: Option<FarTravel>,
    pub(super) energy: EnergyGuard,
    pub(super) failure: Option<Failure>,
    /// How many indicators each model that is watched told last, in order.
    pub(super) told: Vec<usize>,
}

/// Runs `ticks` ticks. State that changed in components since the last call is taken up; afterwards the components
/// hold the new state.
///
/// # Errors
/// When a position, angle, velocity or spin stops being finite, or energy comes out of nowhere. The state stays as it was found then.
pub fn step(world: &mut World, ticks: u64) -> Result<(), Failure> {
    let mut sim = take(world, SimTick);
    let evaluate = take(world, Evaluate);
    let modes = take(world, Modes);
    let method = world.resource_mut::<Drive>().method.take().expect("the plugin of integrators sets a method");
    let has_modes = !modes.graph().systems.is_empty();
    let velocity_dependent = world.resource::<Census>().velocity_dependent;
    let mut running = Box::new(Running { method, evaluate, modes, has_modes, velocity_dependent });
    keep_components_current(world, &mut sim, &mut running.evaluate);
    flight::allow(world, running.method.0.flies(), &sim, [&running.evaluate, &running.modes]);
    let all_direct = stands_for_all(world, [&sim, &running.evaluate, &running.modes]);
    let may_be_direct = all_direct && {
        // Where others have put conditions on stages. The schedules hand them on when they are made ready.
        let conditional = [&sim, &running.evaluate, &running.modes].into_iter().any(has_conditions);
        let mut drive = world.resource_mut::<Drive>();
        drive.conditional |= conditional;
        !drive.conditional && running.method.0.is_direct()
    };
    // Where bodies may fly the first tick sees whether others wrote into the state.
    let begins_direct = !running.method.0.flies();
    for schedule in [&mut sim, &mut running.evaluate, &mut running.modes] {
        apply_only_what_is_deferred(world, schedule);
    }
    let mut drive = world.resource_mut::<Drive>();
    drive.stepped = false;
    drive.running = Some(running);
    let mut left = ticks;
    while left > 0 && world.resource::<Drive>().failure.is_none() {
        if may_be_direct && (left < ticks || begins_direct) {
            let mut direct = std::mem::take(&mut *world.resource_mut::<Direct>());
            direct.hold(world, |world, direct| left = run_direct(world, direct, left));
            *world.resource_mut::<Direct>() = direct;
        } else {
            sim.run(world);
            left -= 1;
        }
    }
    if world.resource::<Evaluation>().stale {
        refresh(world);
    }
    if world.resource::<Drive>().looked_at {
        flight::see_writers(world);
    }
    // The last kick of the batch is seen by no drift any more.
    if world.resource::<Drive>().failure.is_none() {
        note_failure(world);
    }
    flight::land(world, None);
    run_once(world, packed::store_state);
    let mut drive = world.resource_mut::<Drive>();
    let running = drive.running.take().expect("put there above");
    drive.method = Some(running.method);
    let failure = drive.failure.clone();
    let mut schedules = world.resource_mut::<Schedules>();
    for schedule in [sim, running.evaluate, running.modes] {
        schedules.insert(schedule);
    }
    failure.map_or(Ok(()), Err)
}

/// Before bodies are spawned: sees whether systems that work on components are there already, so that bodies are
/// spawned with all that those need.
pub(crate) fn foresee_components(world: &mut World) {
    let (registered, schedules) = (world.resource::<Registered>(), world.resource::<Schedules>());
    let ordinary = schedules.get(SimTick).is_some_and(|schedule| !registered.all_packed(SimTick, schedule))
        || schedules.get(Evaluate).is_some_and(|schedule| !registered.all_packed(Evaluate, schedule));
    world.resource_mut::<Bodies>().pushed |= ordinary;
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

/// Where no system has anything to be applied later, nobody looks for it after each run.
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
    if (ordinary.0 || ordinary.1) && !world.resource::<Bodies>().pushed {
        packed::make_pushable(world);
    }
    let mut drive = world.resource_mut::<Drive>();
    if ordinary.0 && !drive.ordinary_tick {
        drive.ordinary_tick = true;
        sim.add_systems(packed::store_state.after(Stage::Integrate).before(Stage::Observe));
    }
    if ordinary.1 && !drive.ordinary_evaluate {
        drive.ordinary_evaluate = true;
        let current = (packed::store_state, packed::clear_forces).chain().in_set(EvaluateStage::Bounds);
        evaluate.add_systems(current.after(update_bounding_boxes));
        evaluate.add_systems(collect_forces.after(EvaluateStage::Forces).before(EvaluateStage::Contacts));
    }
}

/// Adds what ordinary force systems wrote into `Force` and `Torque`, and books it as coming from outside.
fn collect_forces(
    mut bodies: ResMut<Bodies>,
    mut balance: ResMut<Balance>,
    forces: Query<(Entity, &Force, &Torque)>,
    mut found: Local<Vec<(u32, DVec2, f64)>>,
) {
    found.clear();
    let place = |entity| bodies.place(entity).map(|place| place as u32);
    found.extend(forces.iter().filter_map(|(entity, force, torque)| Some((place(entity)?, force.0, torque.0))));
    // Query order depends on archetypes; the order of sums must not.
    found.sort_unstable_by_key(|(place, ..)| *place);
    for &(place, force, torque) in &*found {
        let body = place as usize;
        if bodies.dynamic[body] && (force != DVec2::ZERO || torque != 0.0) {
            bodies.force[body] += force;
            bodies.torque[body] += torque;
            balance.outside(bodies.position[body], force, torque);
            balance.work += force.dot(bodies.velocity[body]) + torque * bodies.spin[body];
        }
    }
}

/// Runs ticks without schedules, as many as are left or until one fails. Returns how many are left then.
fn run_direct(world: &mut World, direct: &mut Direct, mut left: u64) -> u64 {
    while left > 0 && direct.state.drive.failure.is_none() {
        direct.state.turn_to(stopwatch::Part::Integrate);
        advance(world, Some(direct));
        direct.observe(world);
        left -= 1;
    }
    left
}

/// The system of [`Stage::Integrate`].
pub(super) fn integrate(world: &mut World) {
    advance(world, None);
}

/// A tick, without what goes before and after it. The state is in the world, unless it is held.
fn advance(world: &mut World, mut direct: Option<&mut Direct>) {
    let drive: &mut Drive = held_mut(world, direct.as_deref_mut());
    if drive.looked_at && direct.is_none() {
        flight::see_writers(world);
    }
    let drive: &mut Drive = held_mut(world, direct.as_deref_mut());
    let mut running = drive.running.take().expect("ticks run inside `step`");
    let (first_of_batch, ordinary) = (!drive.stepped, drive.ordinary_tick);
    let current = drive.current;
    let before = if first_of_batch || ordinary {
        see_all(world, direct.as_deref_mut(), |world| take_up_changes(world, first_of_batch))
    } else {
        None
    };
    let clock: Clock = *held(world, direct.as_deref());
    let Running { method, evaluate, modes, has_modes, velocity_dependent } = &mut *running;
    let style = method.0.style();
    let mut tick = Tick {
        world,
        direct: direct.as_deref_mut(),
        evaluate,
        modes,
        has_modes: *has_modes,
        velocity_dependent: *velocity_dependent,
        style,
        fresh: !current || before.is_some(),
        looked_at: ordinary,
        dt: clock.dt,
        begin: clock.time(),
        end: clock.time_of(clock.ticks + 1),
        alert: false,
    };
    if tick.fresh {
        tick.packed().wake_all();
    }
    if tick.fresh && style.is_staged() {
        tick.begin_anew();
    } else if tick.fresh {
        tick.evaluate(0.0);
    }
    if let Some(before) = before {
        see_all(tick.world, tick.direct.as_deref_mut(), |world| Ledger::book_exchange(world, before));
    }
    // Where all bodies are asleep the end of the tick is its beginning.
    if !tick.packed().all_asleep() {
        if !style.is_staged() {
            tick.choose_modes(tick.begin, tick.end);
        }
        method.0.advance(&mut tick);
    }
    let alert = tick.alert;
    held_mut::<Clock>(world, direct.as_deref_mut()).ticks += 1;
    let drive: &mut Drive = held_mut(world, direct.as_deref_mut());
    drive.running = Some(running);
    drive.current = true;
    drive.stepped = true;
    drive.energy.alert |= alert;
    let (travel, travelled, energy) = (drive.travel, drive.travelled, drive.energy);
    if drive.looked_at || drive.looks.binary_search(&(clock.ticks + 1)).is_ok() {
        flight::land(world, direct.as_deref_mut());
        if direct.is_none() {
            flight::note_looks(world);
        }
    }
    if !travelled.is_finite() {
        see_all(world, direct, note_failure);
    } else if energy.is_due(clock.ticks + 1, travel) {
        see_all(world, direct, |world| look_closer(world, energy, travel));
    }
}

/// Shows the world with all state in its place.
#[cold]
fn see_all<U>(world: &mut World, direct: Option<&mut Direct>, see: impl FnOnce(&mut World) -> U) -> U {
    match direct {
        Some(direct) => direct.show(world, see),
        None => see(world),
    }
}

/// After a batch of ticks whoever looks finds the forces of the present state.
fn refresh(world: &mut World) {
    let mut running = world.resource_mut::<Drive>().running.take().expect("put there by `step`");
    let clock = *world.resource::<Clock>();
    let Running { method, evaluate, modes, has_modes, velocity_dependent } = &mut *running;
    let (style, now) = (method.0.style(), clock.time());
    let (has_modes, velocity_dependent) = (*has_modes, *velocity_dependent);
    let mut tick = Tick {
        world,
        direct: None,
        evaluate,
        modes,
        has_modes,
        velocity_dependent,
        style,
        fresh: false,
        looked_at: true,
        dt: clock.dt,
        begin: now,
        end: now,
        alert: false,
    };
    tick.evaluate_stage(now);
    world.resource_mut::<Drive>().running = Some(running);
}

/// Looks at the energy.
#[cold]
fn look_closer(world: &mut World, mut energy: EnergyGuard, travel: f64) {
    flight::land(world, None);
    let created = energy.look(world, travel);
    let clock = *world.resource::<Clock>();
    let bodies = world.resource::<Bodies>();
    let failure = created.map(|(body, created)| Failure {
        body: world.get::<Name>(bodies.entity[body]).map(Name::to_string).unwrap_or_default(),
        wrong: if created.energy.is_finite() { Wrong::Energy(created) } else { Wrong::NotFinite("energy") },
        tick: clock.ticks,
        time: clock.time(),
    });
    let mut drive = world.resource_mut::<Drive>();
    drive.energy = energy;
    drive.failure = failure;
}

/// Takes up what others changed: new or lost bodies, or new values in components. Returns the totals of before if
/// anything changed.
fn take_up_changes(world: &mut World, first_of_batch: bool) -> Option<Totals> {
    let mut bodies = world.resource_mut::<Bodies>();
    let (changed, touched) = (bodies.changed, std::mem::take(&mut bodies.touched));
    let beginning = world.resource::<Ledger>().start.is_none();
    let differs =
        changed || touched || beginning || world.run_system_cached(packed::components_differ).unwrap_or(false);
    if !differs {
        return None;
    }
    world.resource_mut::<Bodies>().end_flights();
    let before = Totals::of(world);
    if changed {
        let stale = !first_of_batch && !world.resource::<Drive>().ordinary_tick;
        if stale {
            run_once(world, packed::store_state);
        }
        packed::rebuild(world);
    } else {
        run_once(world, packed::load_state);
    }
    Some(before)
}

fn note_failure(world: &mut World) {
    flight::land(world, None);
    let bodies = world.resource::<Bodies>();
    let Some((body, quantity)) = finite::first_not_finite(bodies) else { return };
    let name = world.get::<Name>(bodies.entity[body]).map(Name::to_string).unwrap_or_default();
    let clock = world.resource::<Clock>();
    let failure = Failure { body: name, wrong: Wrong::NotFinite(quantity), tick: clock.ticks, time: clock.time() };
    world.resource_mut::<Drive>().failure = Some(failure);
}

/// Sets the integrator.
pub fn set_method(world: &mut World, method: Method) {
    world.get_resource_or_init::<Drive>().method = Some(method);
}

/// The greatest energy that was seen to go round so far, in J, looked for every few hundred ticks: of motion and springs, and
/// what fields released.
pub fn energy_seen(world: &World) -> f64 {
    world.get_resource::<Drive>().map_or(0.0, |drive| drive.energy.seen())
}
