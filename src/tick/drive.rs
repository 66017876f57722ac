//! Driving the schedules: a batch of ticks, and what an integrator may do inside one.

use bevy_ecs::prelude::*;
use bevy_ecs::schedule::{ScheduleLabel, Schedules};
use glam::DVec2;

use super::balance::Totals;
use super::failure::{Failure, Wrong};
use super::guard::EnergyGuard;
use super::travel::FarTravel;
use super::{
    Balance, Census, Clock, Evaluate, EvaluateStage, Evaluation, Indicator, Ledger, Models, Modes, SimTick, Span,
    Stage, Style, Watch,
};
use crate::bounds::Bounds;
use crate::integrate::Method;
use crate::world::motion::Travel;
use crate::world::{Bodies, Force, Name, Torque, finite, lend, packed};

/// Rounds in which models correct their modes after an event. Each takes back at least one choice, so more are needed only
/// where choices contradict each other.
const MOST_CORRECTIONS: usize = 32;

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
    pub(super) travel: f64,
    /// See [`Travel::sum`], of the last tick: not finite as soon as the way of somebody is not.
    pub(super) travelled: f64,
    /// Greatest travel in the last tick, in metres.
    pub(super) farthest: f64,
    /// The first body that travelled farther than the smallest radius in one tick.
    pub(super) far: Option<FarTravel>,
    pub(super) energy: EnergyGuard,
    failure: Option<Failure>,
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
    for schedule in [&mut sim, &mut running.evaluate, &mut running.modes] {
        apply_only_what_is_deferred(world, schedule);
    }
    let mut drive = world.resource_mut::<Drive>();
    drive.stepped = false;
    drive.running = Some(running);
    for _ in 0..ticks {
        sim.run(world);
        if world.resource::<Drive>().failure.is_some() {
            break;
        }
    }
    if world.resource::<Evaluation>().stale {
        refresh(world);
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

/// Before bodies are spawned: sees whether systems that work on components are there already, so that bodies are
/// spawned with all that those need.
pub(crate) fn foresee_components(world: &mut World) {
    let (census, schedules) = (world.resource::<Census>(), world.resource::<Schedules>());
    let count = |schedule: Option<&Schedule>| schedule.map_or(0, |schedule| schedule.graph().systems.len());
    let ordinary = count(schedules.get(SimTick)) > census.packed_in_tick
        || count(schedules.get(Evaluate)) > census.packed_in_evaluate;
    world.resource_mut::<Bodies>().pushed |= ordinary;
}

fn take(world: &mut World, label: impl ScheduleLabel) -> Schedule {
    let missing = "the tick was added with `TickAppExt::add_tick`";
    world.resource_mut::<Schedules>().remove(label).expect(missing)
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
    let counted = (sim.graph().systems.len(), evaluate.graph().systems.len());
    let census = world.resource::<Census>();
    let ordinary = (counted.0 > census.packed_in_tick, counted.1 > census.packed_in_evaluate);
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
        evaluate.add_systems((packed::store_state, packed::clear_forces).chain().in_set(EvaluateStage::Bounds));
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

/// The system of [`Stage::Integrate`].
pub(super) fn integrate(world: &mut World) {
    let mut drive = world.resource_mut::<Drive>();
    let mut running = drive.running.take().expect("ticks run inside `step`");
    let (first_of_batch, ordinary) = (!drive.stepped, drive.ordinary_tick);
    let current = drive.current;
    let before = if first_of_batch || ordinary { take_up_changes(world, first_of_batch) } else { None };
    let clock = *world.resource::<Clock>();
    let Running { method, evaluate, modes, has_modes } = &mut *running;
    let style = method.0.style();
    let mut tick = Tick {
        world,
        evaluate,
        modes,
        has_modes: *has_modes,
        style,
        fresh: !current || before.is_some(),
        looked_at: ordinary,
        dt: clock.dt,
        begin: clock.time(),
        end: clock.time_of(clock.ticks + 1),
        alert: false,
    };
    if tick.fresh {
        tick.bodies().wake_all();
    }
    if tick.fresh && style.is_staged() {
        tick.begin_anew();
    } else if tick.fresh {
        tick.evaluate(0.0);
    }
    if let Some(before) = before {
        Ledger::book_exchange(tick.world, before);
    }
    // Where all bodies are asleep the end of the tick is its beginning.
    if !tick.world.resource::<Bodies>().all_asleep() {
        if !style.is_staged() {
            tick.choose_modes(tick.begin, tick.end);
        }
        method.0.advance(&mut tick);
    }
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

/// After a batch of ticks whoever looks finds the forces of the present state.
fn refresh(world: &mut World) {
    let mut running = world.resource_mut::<Drive>().running.take().expect("put there by `step`");
    let clock = *world.resource::<Clock>();
    let Running { method, evaluate, modes, has_modes } = &mut *running;
    let (style, now) = (method.0.style(), clock.time());
    let (looked_at, has_modes) = (true, *has_modes);
    let (fresh, alert) = (false, false);
    let mut tick =
        Tick { world, evaluate, modes, has_modes, style, fresh, looked_at, dt: clock.dt, begin: now, end: now, alert };
    tick.evaluate_stage(now);
    world.resource_mut::<Drive>().running = Some(running);
}

/// Looks at the energy.
#[cold]
fn look_closer(world: &mut World, mut energy: EnergyGuard, travel: f64) {
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
    let name = world.get::<Name>(bodies.entity[body]).map(Name::to_string).unwrap_or_default();
    let clock = world.resource::<Clock>();
    let failure = Failure { body: name, wrong: Wrong::NotFinite(quantity), tick: clock.ticks, time: clock.time() };
    world.resource_mut::<Drive>().failure = Some(failure);
}

/// Sets the integrator.
pub fn set_method(world: &mut World, method: Method) {
    world.resource_mut::<Drive>().method = Some(method);
}

/// The greatest energy that was seen to go round so far, in J, looked for every few hundred ticks: of motion and springs, and
/// what fields released.
pub fn energy_seen(world: &World) -> f64 {
    world.get_resource::<Drive>().map_or(0.0, |drive| drive.energy.seen())
}

/// What an integrator may do inside a tick.
pub struct Tick<'a> {
    /// The world, for state of the integrator's own.
    pub world: &'a mut World,
    evaluate: &'a mut Schedule,
    modes: &'a mut Schedule,
    has_modes: bool,
    pub(super) style: Style,
    /// Whether the state was changed by others since the last tick, or is the first of all.
    pub(super) fresh: bool,
    /// Whether systems in the tick may look at forces.
    looked_at: bool,
    /// Length of the tick in seconds.
    pub dt: f64,
    /// Time at its beginning in seconds.
    pub begin: f64,
    /// Time at its end in seconds: the beginning of the next to the last bit.
    pub end: f64,
    pub(super) alert: bool,
}

impl Tick<'_> {
    /// Whether some force depends on velocities.
    pub fn velocity_dependent(&self) -> bool {
        self.world.resource::<Census>().velocity_dependent
    }

    /// Whether some force other than those of contacts depends on velocities.
    pub fn has_velocity_forces(&self) -> bool {
        self.world.resource::<Census>().velocity_forces
    }

    /// The first time after `now` at which forces or their rates are known to jump, in seconds; infinite if there is none.
    pub fn next_edge(&self, now: f64) -> f64 {
        let edges = &self.world.resource::<Models>().edges;
        let paths = self.world.resource::<Bodies>().prescribed.next_point(now);
        edges.iter().map(|edge| edge(self.world, now)).fold(paths, f64::min)
    }

    /// Whether forces may change with time in a state that does not.
    pub fn changes_with_time(&self) -> bool {
        !self.world.resource::<Models>().edges.is_empty()
            || !self.world.resource::<Bodies>().prescribed.motions.is_empty()
    }

    /// The packed state.
    pub fn bodies(&mut self) -> Mut<'_, Bodies> {
        self.world.resource_mut::<Bodies>()
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
        bodies.swap_estimate();
        bodies.pose();
        if let Some(driven) = driven {
            let smallest = bodies.smallest_radius;
            let Drive { farthest, travelled, .. } = *self.world.resource::<Drive>();
            self.note_travel(Travel { greatest: driven.greatest.max(farthest), sum: travelled + driven.sum }, smallest);
        }
        self.run_evaluation(time, elapsed);
        let mut bodies = self.world.resource_mut::<Bodies>();
        if std::mem::take(&mut bodies.disturbed) {
            bodies.wake_all();
            bodies.pose();
            // No time has passed since: histories stay as they are.
            self.run_evaluation(time, 0.0);
            bodies = self.world.resource_mut::<Bodies>();
        }
        bodies.swap_estimate();
    }

    /// Bodies are posed.
    fn run_evaluation(&mut self, time: f64, elapsed: f64) {
        *self.world.resource_mut::<Balance>() = Balance::default();
        self.announce(time, elapsed, self.style);
        self.evaluate.run(self.world);
    }

    fn announce(&mut self, time: f64, elapsed: f64, style: Style) {
        let mut evaluation = self.world.resource_mut::<Evaluation>();
        *evaluation = Evaluation { time, elapsed, style, count: evaluation.count + 1, stale: false };
    }

    /// Whether the state is the first of all, or was changed by others since the last tick.
    pub fn is_fresh(&self) -> bool {
        self.fresh
    }

    /// Lets forces and contacts choose their modes from `begin` to `end`.
    pub fn choose_modes(&mut self, begin: f64, end: f64) {
        if !self.world.resource::<Bodies>().prescribed.motions.is_empty() {
            let mut bodies = self.bodies();
            let middle = 0.5 * (begin + end);
            let before = std::mem::replace(&mut bodies.prescribed.middle, middle);
            // On another piece of a path what rides on it has other forces from its first moment on.
            let passed = bodies.prescribed.next_point(before) < middle;
            if passed && self.style.is_staged() {
                self.evaluate_stage(begin);
            }
        }
        if self.has_modes {
            let whole = begin == self.begin && end == self.end;
            let length = if whole { self.dt } else { end - begin };
            *self.world.resource_mut::<Span>() = Span { begin, end, length };
            self.modes.run(self.world);
            // What is held by contacts depends on all other forces.
            if self.style.is_staged() && self.world.resource::<Evaluation>().stale {
                self.evaluate_stage(begin);
                self.settle();
            }
        }
    }

    /// Evaluates the forces of the state as it stands, at `time` seconds, as one of many of a step: nothing goes on by
    /// it but the rates.
    pub fn evaluate_stage(&mut self, time: f64) {
        let mut bodies = self.world.resource_mut::<Bodies>();
        bodies.wake_all();
        if !bodies.prescribed.motions.is_empty() {
            bodies.prescribe(self.begin, time);
        }
        bodies.pose();
        self.run_evaluation(time, 0.0);
    }

    /// A state that others have made: candidate lists are renewed, and models choose the modes in which it begins.
    pub(super) fn begin_anew(&mut self) {
        self.evaluate_stage(self.begin);
        self.each_watch(|world, watch| (watch.take_stock)(world));
        self.evaluate_stage(self.begin);
        self.settle();
    }

    /// Adds all indicators of the state just evaluated to a list.
    pub fn tell(&mut self, told: &mut Vec<Indicator>) {
        let mut place = 0;
        self.each_watch(|world, watch| {
            let first = told.len();
            (watch.tell)(world, told);
            if told.len() - first != watch.told {
                world.resource_mut::<Models>().watches[place].told = told.len() - first;
            }
            place += 1;
        });
    }

    fn each_watch(&mut self, mut see: impl FnMut(&mut World, Watch)) {
        let mut place = 0;
        while let Some(&watch) = self.world.resource::<Models>().watches.get(place) {
            see(self.world, watch);
            place += 1;
        }
    }

    /// After a step was accepted and its last state evaluated: modes whose indicators vanished change, and the state is
    /// ready for the next step.
    pub fn end_step(&mut self, fired: &[usize]) {
        let time = self.world.resource::<Evaluation>().time;
        if !fired.is_empty() {
            let mut first = 0;
            self.each_watch(|world, watch| {
                let own = |place: &&usize| (first..first + watch.told).contains(*place);
                let own: Vec<usize> = fired.iter().filter(own).map(|place| place - first).collect();
                if !own.is_empty() {
                    (watch.switch)(world, &own);
                }
                first += watch.told;
            });
            self.evaluate_stage(time);
            self.settle();
        }
        let mut changed = false;
        self.each_watch(|world, watch| changed |= (watch.tidy)(world));
        if changed {
            self.evaluate_stage(time);
        }
    }

    /// Before a step of `length` seconds from the state just evaluated: candidate lists reach as far as bodies may travel in
    /// it, `times` as far as their present velocities and accelerations say. Says whether the state was evaluated for that.
    pub fn reserve(&mut self, length: f64, times: f64) -> bool {
        if !self.world.contains_resource::<Bounds>() {
            return false;
        }
        let renew = lend(self.world, |world, bounds: &mut Bounds| {
            let bodies = world.resource::<Bodies>();
            let travel = |body: usize| {
                let (velocity, force) = (bodies.velocity[body].length(), bodies.force[body].length());
                let (spin, torque) = (bodies.spin[body].abs(), bodies.torque[body].abs());
                let way = velocity + 0.5 * length * force * bodies.inverse_mass(body);
                let turn = spin + 0.5 * length * torque * bodies.inverse_inertia(body);
                (way + turn * bodies.extent(body)) * length
            };
            let farthest = (0..bodies.len()).filter(|&body| bodies.moves[body]).map(travel).fold(0.0, f64::max);
            bounds.reserve(bodies, times * farthest)
        });
        if renew {
            let time = self.world.resource::<Evaluation>().time;
            self.evaluate_stage(time);
        }
        renew
    }

    /// Shows the state as it stands at `time` seconds, between states that the motion goes by: forces are evaluated only if
    /// somebody looks at them.
    pub fn show(&mut self, time: f64) {
        if self.looked_at || !self.world.resource::<Models>().watches.is_empty() {
            return self.evaluate_stage(time);
        }
        self.world.resource_mut::<Bodies>().pose();
        let mut evaluation = self.world.resource_mut::<Evaluation>();
        (evaluation.time, evaluation.stale) = (time, true);
    }

    /// Candidate lists are made anew for the state as it stands.
    pub fn renew_lists(&mut self, time: f64) {
        if let Some(mut bounds) = self.world.get_resource_mut::<Bounds>() {
            bounds.outdate();
            self.evaluate_stage(time);
        }
    }

    /// Whether somebody moved farther than candidate lists reach since they were made.
    pub fn outgrown(&self) -> bool {
        self.world.get_resource::<Bounds>().is_some_and(|bounds| bounds.outgrown)
    }

    /// The step in which somebody moved farther than candidate lists reach is not taken.
    pub fn recall_bounds(&mut self) {
        if let Some(mut bounds) = self.world.get_resource_mut::<Bounds>() {
            bounds.outgrown = false;
        }
    }

    /// Lets models correct the modes of a state just evaluated, until none wants to.
    fn settle(&mut self) {
        let time = self.world.resource::<Evaluation>().time;
        for _ in 0..MOST_CORRECTIONS {
            let mut corrected = false;
            self.each_watch(|world, watch| corrected |= (watch.settle)(world));
            if !corrected {
                break;
            }
            self.evaluate_stage(time);
        }
    }

    /// Velocities change by the present forces over `dt` seconds, and the ledger books it.
    pub fn kick(&mut self, dt: f64) {
        self.book(dt);
        self.world.resource_mut::<Bodies>().kick(dt);
    }

    /// Velocities change by the present forces over `kick` seconds, which the ledger books, then positions by those velocities
    /// over `drift` seconds. One drift per tick: it is remembered as the displacement since the last accepted state. With
    /// `ahead` the velocities so many seconds later are estimated from the same forces: the following evaluations see them in
    /// place of the velocities, which stay as they are.
    pub fn advance(&mut self, kick: f64, drift: f64, ahead: Option<f64>) {
        self.book(kick);
        let mut bodies = self.world.resource_mut::<Bodies>();
        let (travelled, smallest) = (bodies.advance(kick, drift, ahead), bodies.smallest_radius);
        self.note_travel(travelled, smallest);
    }

    fn book(&mut self, dt: f64) {
        let balance = *self.world.resource::<Balance>();
        self.alert |= balance.alert;
        self.world.resource_mut::<Ledger>().book(&balance, dt);
    }
}
