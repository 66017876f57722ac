//! Driving the schedules: a batch of ticks, and what an integrator may do inside one.

use bevy_ecs::prelude::*;
use bevy_ecs::schedule::{ScheduleLabel, Schedules};
use glam::DVec2;

use super::balance::Totals;
use super::failure::{Failure, Wrong};
use super::guard::EnergyGuard;
use super::{Balance, Census, Clock, Evaluate, EvaluateStage, Evaluation, Ledger, Modes, SimTick, Stage};
use crate::integrate::Method;
use crate::world::{Bodies, Force, Name, Slot, Torque, finite, packed};

/// What is taken out of the world while a batch of ticks runs.
struct Running {
    method: Method,
    evaluate: Schedule,
    modes: Schedule,
    has_modes: bool,
}

/// State of the drive between ticks.
#[derive(Resource, Default)]
pub(super) struct Drive {
    running: Option<Box<Running>>,
    method: Option<Method>,
    /// Ordinary systems live in the tick: components are kept up to date around it.
    ordinary_tick: bool,
    /// Ordinary systems live in the evaluation: components are kept up to date around it.
    ordinary_evaluate: bool,
    /// Forces are those of the present state.
    current: bool,
    /// Ticks were run since the components were last brought up to date.
    stepped: bool,
    /// Greatest travel of any point of a body in one tick, in metres.
    travel: f64,
    /// Sum over all bodies of the travel in the last tick: not finite as soon as one of them is.
    travelled: f64,
    /// The first body that travelled farther than the smallest radius in one tick.
    far: Option<FarTravel>,
    energy: EnergyGuard,
    failure: Option<Failure>,
}

/// A body that travelled farther in one tick than the smallest radius: it may have passed through others unseen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FarTravel {
    /// The body.
    pub body: Entity,
    /// How far any of its points travelled, in metres.
    pub travel: f64,
    /// The end of that tick in seconds.
    pub time: f64,
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
    let method = world.resource_mut::<Drive>().method.take().unwrap_or_default();
    let has_modes = !modes.graph().systems.is_empty();
    let mut running = Box::new(Running { method, evaluate, modes, has_modes });
    keep_components_current(world, &mut sim, &mut running.evaluate);
    let mut drive = world.resource_mut::<Drive>();
    drive.stepped = false;
    drive.running = Some(running);
    for _ in 0..ticks {
        sim.run(world);
        if world.resource::<Drive>().failure.is_some() {
            break;
        }
    }
    // The last kick of the batch is seen by no drift any more.
    if world.resource::<Drive>().failure.is_none() {
        note_failure(world);
    }
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

fn take(world: &mut World, label: impl ScheduleLabel) -> Schedule {
    let missing = "the tick was added with `TickAppExt::add_tick`";
    world.resource_mut::<Schedules>().remove(label).expect(missing)
}

fn run_once<M>(world: &mut World, system: impl IntoSystem<(), (), M> + 'static) {
    // The system has no parameters that could be missing.
    let _ = world.run_system_cached(system);
}

/// Sees whether systems were added that work on components, and puts the copying around them.
fn keep_components_current(world: &mut World, sim: &mut Schedule, evaluate: &mut Schedule) {
    let counted = (sim.graph().systems.len(), evaluate.graph().systems.len());
    let census = world.resource::<Census>();
    let ordinary = (counted.0 > census.packed_in_tick, counted.1 > census.packed_in_evaluate);
    let mut drive = world.resource_mut::<Drive>();
    if ordinary.0 && !drive.ordinary_tick {
        drive.ordinary_tick = true;
        sim.add_systems(packed::store_state.after(Stage::Integrate).before(Stage::Observe));
    }
    if ordinary.1 && !drive.ordinary_evaluate {
        drive.ordinary_evaluate = true;
        evaluate.add_systems((packed::store_state, packed::clear_forces).chain().in_set(EvaluateStage::Bounds));
        evaluate.add_systems(collect_forces.after(EvaluateStage::Forces).before(EvaluateStage::Contacts));
    }
}

/// Adds what ordinary force systems wrote into `Force` and `Torque`, and books it as coming from outside.
fn collect_forces(
    mut bodies: ResMut<Bodies>,
    mut balance: ResMut<Balance>,
    forces: Query<(&Slot, &Force, &Torque)>,
    mut found: Local<Vec<(u32, DVec2, f64)>>,
) {
    found.clear();
    found.extend(forces.iter().map(|(slot, force, torque)| (slot.0, force.0, torque.0)));
    // Query order depends on archetypes; the order of sums must not.
    found.sort_unstable_by_key(|(slot, ..)| *slot);
    for &(slot, force, torque) in &*found {
        let body = slot as usize;
        if bodies.dynamic[body] && (force != DVec2::ZERO || torque != 0.0) {
            bodies.force[body] += force;
            bodies.torque[body] += torque;
            balance.outside(bodies.position[body], force, torque);
            balance.work += force.dot(bodies.velocity[body]) + torque * bodies.spin[body];
        }
    }
}

/// The system of [`Stage::Integrate`].
pub(super) fn integrate(world: &mut World) {
    let mut drive = world.resource_mut::<Drive>();
    let mut running = drive.running.take().expect("ticks run inside `step`");
    let (first_of_batch, ordinary) = (!drive.stepped, drive.ordinary_tick);
    let current = drive.current;
    let before = if first_of_batch || ordinary { take_up_changes(world, first_of_batch) } else { None };
    let clock = *world.resource::<Clock>();
    let Running { method, evaluate, modes, has_modes } = &mut *running;
    let mut tick = Tick {
        world,
        evaluate,
        modes,
        dt: clock.dt,
        begin: clock.time(),
        end: clock.time_of(clock.ticks + 1),
        alert: false,
    };
    if !current || before.is_some() {
        tick.evaluate(0.0);
    }
    if let Some(before) = before {
        Ledger::book_exchange(tick.world, before);
    }
    if *has_modes {
        tick.modes.run(tick.world);
    }
    method.0.advance(&mut tick);
    let alert = tick.alert;
    world.resource_mut::<Clock>().ticks += 1;
    let mut drive = world.resource_mut::<Drive>();
    drive.running = Some(running);
    drive.current = true;
    drive.stepped = true;
    drive.energy.alert |= alert;
    let (travel, travelled, energy) = (drive.travel, drive.travelled, drive.energy);
    if !travelled.is_finite() {
        note_failure(world);
    } else if energy.is_due(clock.ticks + 1, travel) {
        look_closer(world, energy, travel);
    }
}

/// Looks for a body that travelled too far, and at the energy.
#[cold]
fn look_closer(world: &mut World, mut energy: EnergyGuard, travel: f64) {
    let created = energy.look(world, travel);
    let clock = *world.resource::<Clock>();
    let bodies = world.resource::<Bodies>();
    let far = |body: usize| {
        let travel = bodies.drift[body].length() + bodies.turn[body].abs() * bodies.extent[body];
        let far = bodies.collides[body] && bodies.moves[body] && travel > bodies.smallest_radius;
        far.then(|| FarTravel { body: bodies.entity[body], travel, time: clock.time() })
    };
    let far = (0..bodies.len()).find_map(far);
    let failure = created.map(|(body, created)| Failure {
        body: world.get::<Name>(bodies.entity[body]).map(|name| name.0.clone()).unwrap_or_default(),
        wrong: if created.energy.is_finite() { Wrong::Energy(created) } else { Wrong::NotFinite("energy") },
        tick: clock.ticks,
        time: clock.time(),
    });
    let mut drive = world.resource_mut::<Drive>();
    drive.energy = energy;
    drive.far = drive.far.or(far);
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
    let bodies = world.resource::<Bodies>();
    let Some((body, quantity)) = finite::first_not_finite(bodies) else { return };
    let name = world.get::<Name>(bodies.entity[body]).map(|name| name.0.clone()).unwrap_or_default();
    let clock = world.resource::<Clock>();
    let failure = Failure { body: name, wrong: Wrong::NotFinite(quantity), tick: clock.ticks, time: clock.time() };
    world.resource_mut::<Drive>().failure = Some(failure);
}

/// Sets the integrator.
pub fn set_method(world: &mut World, method: Method) {
    world.resource_mut::<Drive>().method = Some(method);
}

/// Greatest distance that any point of a body travelled in one tick so far, in metres.
pub fn largest_travel(world: &World) -> f64 {
    world.get_resource::<Drive>().map_or(0.0, |drive| drive.travel)
}

/// The first body that travelled farther in one tick than the smallest radius.
pub fn far_travel(world: &World) -> Option<FarTravel> {
    world.get_resource::<Drive>().and_then(|drive| drive.far)
}

/// What an integrator may do inside a tick.
pub struct Tick<'a> {
    /// The world, for state of the integrator's own.
    pub world: &'a mut World,
    evaluate: &'a mut Schedule,
    modes: &'a mut Schedule,
    /// Length of the tick in seconds.
    pub dt: f64,
    /// Time at its beginning in seconds.
    pub begin: f64,
    end: f64,
    alert: bool,
}

impl Tick<'_> {
    /// Whether some force depends on velocities.
    pub fn velocity_dependent(&self) -> bool {
        self.world.resource::<Census>().velocity_dependent
    }

    /// The packed state.
    pub fn bodies(&mut self) -> Mut<'_, Bodies> {
        self.world.resource_mut::<Bodies>()
    }

    /// Estimates the velocities `dt` seconds ahead from the present forces: the following evaluations see them in place
    /// of the velocities, which stay as they are.
    pub fn estimate_velocities(&mut self, dt: f64) {
        self.world.resource_mut::<Bodies>().estimate_velocities(dt);
    }

    /// Evaluates the forces of the state as it stands, `elapsed` seconds after the beginning of the tick.
    pub fn evaluate(&mut self, elapsed: f64) {
        let mut bodies = self.world.resource_mut::<Bodies>();
        if elapsed == 0.0 {
            bodies.accept();
        }
        // The end of a tick is the beginning of the next to the last bit, so that schedules see one edge once.
        let time = if elapsed == self.dt { self.end } else { self.begin + elapsed };
        let driven = (!bodies.prescribed.motions.is_empty()).then(|| bodies.prescribe(self.begin, time));
        bodies.pose();
        bodies.swap_estimate();
        if let Some((greatest, sum)) = driven {
            let mut drive = self.world.resource_mut::<Drive>();
            drive.travel = drive.travel.max(greatest);
            drive.travelled += sum;
        }
        *self.world.resource_mut::<Balance>() = Balance::default();
        *self.world.resource_mut::<Evaluation>() = Evaluation { time, elapsed };
        self.evaluate.run(self.world);
        self.world.resource_mut::<Bodies>().swap_estimate();
    }

    /// Velocities change by the present forces over `dt` seconds, and the ledger books it.
    pub fn kick(&mut self, dt: f64) {
        let balance = *self.world.resource::<Balance>();
        self.alert |= balance.alert;
        self.world.resource_mut::<Ledger>().book(&balance, dt);
        self.world.resource_mut::<Bodies>().kick(dt);
    }

    /// Positions change by the present velocities over `dt` seconds. One drift per tick: it is remembered as the
    /// displacement since the last accepted state.
    pub fn drift(&mut self, dt: f64) {
        let travelled = self.world.resource_mut::<Bodies>().drift(dt);
        let mut drive = self.world.resource_mut::<Drive>();
        drive.travel = drive.travel.max(travelled.0);
        drive.travelled = travelled.1;
    }
}
