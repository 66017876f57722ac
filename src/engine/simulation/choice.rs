//! The choice of method, tick and pace of a run, from the requests of the scene and the command line.

use std::f64::consts::PI;

use bevy_ecs::prelude::*;

use super::Overrides;
use crate::integrate::ChosenMethod;
use crate::integrate::ClockSection;
use crate::integrate::clock_section::EventTiming;
use crate::integrate::{Allowance, Description, Detail, Methods, StepPace};
use crate::joints::Joint;
use crate::record::sections::FilmSection;
use crate::scene::{SceneError, exact};
use crate::simulation::error::{ErrorEstimate, ErrorParts, KnownError};
use crate::tick::Notes;
use crate::tick::{Clock, Dependence, FEWEST_TICKS_OF_CONTACT, Holder, State};
use jostle_language::numbers::number;

/// Ticks per half period of the fastest contact or spring if the engine chooses the tick. Errors of impacts are then
/// some thousandths.
const TICKS_PER_HALF_PERIOD: f64 = 40.0;
/// The same for contacts among many bodies. No tick can predict such paths, because they diverge exponentially. Their
/// statistics tolerate the errors of impacts that are only just resolved.
///
/// The ticks are stable with the many contacts of a packed body. Each of the bodies of mass `m` may have `n` contacts of stiffness `k`.
/// Then `omega^2` is at most `2 n k/m` (Gershgorin), and `2 k/m` for a pair. Velocity Verlet is stable up to `omega dt = 2`, so for `n`
/// up to `(2 * 7/pi)^2 = 19`. Equal discs have six, each with a spring of friction beside it.
const TICKS_PER_CONTACT_IN_A_CROWD: f64 = FEWEST_TICKS_OF_CONTACT;
/// The same where forces of contacts depend on velocities. Velocity Verlet takes these with the velocity before the kick. Its error
/// in what they take up is of the first order in the tick.
const TICKS_PER_DAMPED_CONTACT: f64 = 20.0;
/// Bodies that move by forces from which on they are a crowd.
const CROWD: usize = 100;
/// First digits of chosen ticks. Those for many bodies are finer steps, and still divide the frames of common films.
const DIGITS: [f64; 3] = [5.0, 2.0, 1.0];
const DIGITS_IN_A_CROWD: [f64; 6] = [8.0, 5.0, 4.0, 2.5, 2.0, 1.0];
/// The tick in seconds when nothing in the scene asks for a finer one.
const COARSEST_TICK: f64 = 1e-3;
/// With more ticks of that length, each tick is a frame. A film or a table shows no more.
const MANY_TICKS: f64 = 1e5;
/// The error that a step may make as a share of the motion, where the engine chooses method and steps. Some ten
/// thousand swings then stay right to a millionth. Steps are a third shorter than with ten times that error.
const CHOSEN_SHARE: f64 = 1e-10;
/// The same for many bodies on joints, whose paths no method predicts for long. Steps are three times as long.
const CHOSEN_SHARE_IN_A_CROWD: f64 = 1e-6;
/// More ticks than a user can wait for, and still counted exactly.
const MOST_TICKS: f64 = 1e15;
/// Ticks per frame where frames do not fall on ticks: states between ticks are interpolated.
const TICKS_PER_ODD_FRAME: f64 = 8.0;

/// The goal of a run in place of a tick.
#[derive(Resource, Clone, Copy, Debug, PartialEq)]
pub enum Goal {
    /// An error no larger than this share of the scene's motion.
    Tolerance(f64),
    /// The smallest error there is, and a statement of it.
    Reference,
}

/// Seconds of physics that a run is asked for, whatever its tick.
#[derive(Resource, Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Duration(pub f64);

/// How a scene is run.
#[derive(Resource, Clone, Debug, PartialEq)]
pub struct Plan {
    /// Name of the method.
    pub method: String,
    /// Length of a tick in seconds.
    pub tick: f64,
    /// Steps of a tick.
    pub pace: StepPace,
    /// The fineness of steps beside that.
    pub detail: Detail,
    /// When forces jump.
    pub events: EventTiming,
    /// The reasons for it.
    pub notes: Vec<String>,
    /// The error it is known to have.
    pub error: Option<ErrorEstimate>,
    /// The reason why it misses the goal.
    pub warning: Option<String>,
}

impl Plan {
    /// The error that a step may make as a share of the motion, if steps follow their error. Ticks are then
    /// only the moments at which the run is read.
    pub fn allowed(&self) -> Option<f64> {
        match self.pace {
            StepPace::Allowed(allowance) => Some(allowance.share),
            StepPace::Even(_) => None,
        }
    }
}

type Wrong = Box<SceneError>;

/// Makes the choice and prepares the world for it. Returns the number of ticks of the run.
pub(super) fn set_clock(world: &mut World, overrides: &Overrides) -> Result<u64, Wrong> {
    let clock = world
        .remove_resource::<ClockSection>()
        .ok_or_else(|| Box::new(SceneError::new("clock", "`clock` is missing")))?;
    let mut notes = Vec::new();
    let duration = match overrides.duration {
        Some(duration) => {
            notes.push(format!("duration {duration:?} s from the command line"));
            positive("--duration", duration)?
        }
        None => clock.duration.si(),
    };
    world.insert_resource(Duration(duration));
    let goal = goal(&clock, overrides, &mut notes)?;
    let plan = match (&overrides.plan, goal) {
        (Some(plan), _) => Plan { tick: positive("plan.tick", plan.tick)?, ..plan.clone() },
        (None, Some(goal)) => plan_for(goal, world, &clock, overrides, duration)?,
        (None, None) => plain(world, &clock, overrides, duration)?,
    };
    notes.extend(plan.notes.iter().cloned());
    let ticks = count(&plan, duration, &clock, overrides, &mut notes)?;
    install(world, &plan, &mut notes)?;
    if let Some(goal) = goal {
        let tolerance = match goal {
            Goal::Tolerance(tolerance) => Some(tolerance),
            Goal::Reference => None,
        };
        world.insert_resource(KnownError { estimate: plan.error, warning: plan.warning.clone(), tolerance });
        world.insert_resource(goal);
    }
    world.insert_resource(plan);
    world.resource_mut::<Notes>().0.extend(notes);
    Ok(ticks)
}

/// The goal in place of a tick. A tick on the command line replaces a tolerance in the scene, and a tolerance there
/// replaces a tick.
fn goal(clock: &ClockSection, overrides: &Overrides, notes: &mut Vec<String>) -> Result<Option<Goal>, Wrong> {
    let reference = overrides.method.as_ref().unwrap_or(&clock.method.0) == ClockSection::REFERENCE;
    if let Some(tolerance) = overrides.tolerance {
        let tolerance = positive("--tolerance", tolerance)?;
        if reference {
            let error = SceneError::new("--tolerance", ClockSection::REFERENCE_HAS_NONE);
            return Err(Box::new(error.with_help("leave out the tolerance, or give `--method Auto`")));
        }
        let instead = clock.tick.map_or("", |_| ", in place of the tick of the scene");
        notes.push(format!("tolerance {tolerance:?} from the command line{instead}"));
        if overrides.method.is_none() && clock.tolerance.is_none() && clock.method.0 != ClockSection::AUTO {
            notes.push(format!("the scene's method {} belongs to its tick; --method keeps it", clock.method.0));
        }
        return Ok(Some(Goal::Tolerance(tolerance)));
    }
    let left_out = match (reference, overrides.tick) {
        (true, _) => ClockSection::REFERENCE_HAS_NONE,
        (false, Some(_)) => "the command line gives a tick in its place",
        (false, None) => return Ok(clock.tolerance.map(|tolerance| Goal::Tolerance(tolerance.si()))),
    };
    if let Some(tolerance) = clock.tolerance {
        notes.push(format!("the run leaves out the tolerance {:?} of the scene: {left_out}", tolerance.si()));
    }
    Ok(reference.then_some(Goal::Reference))
}

/// The method that was asked for.
fn described(world: &World, name: &str) -> Result<Description, Wrong> {
    let methods = world.get_resource::<Methods>().map_or(&[][..], |methods| &methods.0);
    methods.iter().find(|method| method.name == name).copied().ok_or_else(|| {
        let known: Vec<&str> = methods.iter().map(|method| method.name).collect();
        let error = SceneError::new("--method", format!("`{name}` is not a method"));
        Box::new(error.with_help(format!("known methods: Auto, Reference, {}", known.join(", "))))
    })
}

/// Order of accuracy of the method of a plan.
pub(super) fn order(world: &World, plan: &Plan) -> u32 {
    let method = world.get_resource::<Methods>().and_then(|methods| methods.named(&plan.method));
    method.map_or(1, |method| method.order)
}

/// The number of steps of a tick that suits the fastest contact or spring.
pub(super) fn steps_per_tick(world: &World, plan: &Plan) -> u32 {
    let wanted = chosen_tick(world).map_or(plan.tick, |(tick, _)| tick);
    (plan.tick / wanted).ceil().clamp(1.0, f64::from(u32::MAX)) as u32
}

/// A plan with a tick.
fn plain(world: &World, clock: &ClockSection, overrides: &Overrides, duration: f64) -> Result<Plan, Wrong> {
    let mut notes = Vec::new();
    let given = overrides.tick.or(clock.tick.map(|tick| tick.si()));
    let tick = match (overrides.tick, given) {
        (Some(tick), _) => {
            notes.push(format!("tick {tick:?} s from the command line"));
            positive("--tick", tick)?
        }
        (None, Some(tick)) => tick,
        (None, None) => {
            let (tick, why) = tick_of_the_run(world, overrides, duration)?;
            notes.push(format!("tick {} s chosen: {why}", exact(tick)));
            tick
        }
    };
    let mut method = clock.method.0.clone();
    if let Some(name) = &overrides.method {
        notes.push(format!("method {name} from the command line"));
        method.clone_from(name);
    }
    let mut pace = StepPace::Even(1);
    if method == ClockSection::AUTO {
        let free = given.is_none() && clock.events != EventTiming::PerTick && is_smooth(world);
        let (name, why) = match free {
            true => ("Dop853", of_smooth_motion(world)),
            false => chosen_method(world),
        };
        notes.push(format!("method {name} chosen: {why}"));
        method = name.to_owned();
        if free {
            pace = StepPace::Allowed(Allowance::new(chosen_share(world), duration));
        }
    }
    let (detail, events) = (Detail::default(), clock.events);
    Ok(Plan { method, tick, pace, detail, events, notes, error: None, warning: None })
}

/// The tick of a run without a request, and the reason.
fn tick_of_the_run(world: &World, overrides: &Overrides, duration: f64) -> Result<(f64, &'static str), Wrong> {
    let (tick, why) = chosen_tick(world)?;
    let frame = frame_tick(world, duration, overrides.rate)?;
    if is_smooth(world) && tick == COARSEST_TICK && duration > MANY_TICKS * tick && frame > tick {
        return Ok((frame, "a frame of the film, as nothing asks for a finer one and the run is long"));
    }
    Ok((tick.min(duration), why))
}

/// The error that a step may make as a share of the motion, where motion is smooth.
fn chosen_share(world: &World) -> f64 {
    if is_crowd(world.resource()) { CHOSEN_SHARE_IN_A_CROWD } else { CHOSEN_SHARE }
}

/// The reason for the method where motion is smooth.
fn of_smooth_motion(world: &World) -> String {
    format!(
        "order 8 with steps as long as an error of {} of the motion allows, because no bodies touch and no force changes with time",
        number(chosen_share(world))
    )
}

/// Whether forces change as smoothly as poses do. Then long steps of high order need the fewest evaluations for any
/// error. Bodies that may touch, drives, controllers and prescribed motions ask for ticks. In a crowd without joints the nearest
/// two bodies would determine the steps of all. Joints make all bodies of a chain move in one time scale.
fn is_smooth(world: &World) -> bool {
    let state = world.resource::<State>();
    let touch = state.contact_law().is_some();
    let driven = state.has_edges() || state.fastest_rhythm() > 0.0 || !state.bodies().prescribed.motions.is_empty();
    let joined = state.models_of::<Joint>().next().is_some();
    !touch && !driven && state.force_systems == 0 && state.changing_forces() && (joined || !is_crowd(state))
}

/// Whether so many bodies move by forces that no tick can predict their paths.
pub(super) fn is_crowd(state: &State) -> bool {
    state.bodies().dynamic.iter().filter(|dynamic| **dynamic).count() >= CROWD
}

/// Ticks per contact among many bodies, and the reason.
fn of_a_crowd(state: &State) -> (f64, &'static str) {
    let mut laws = state.models().filter(|model| state.law_of(*model).is_some());
    if laws.any(|law| law.dependence() == Dependence::Velocity) {
        let why = "the stiffest contact lasts at least 20 of them, because its force depends on velocities. That suits the statistics of \
                   many bodies. A shorter `--tick` foretells paths for longer";
        return (TICKS_PER_DAMPED_CONTACT, why);
    }
    let why = "the stiffest contact lasts at least 7 of them, which suits the statistics of many bodies. A shorter `--tick` foretells \
               paths for longer and loses less energy";
    (TICKS_PER_CONTACT_IN_A_CROWD, why)
}

/// The method that suits the scene, and the reason.
fn chosen_method(world: &World) -> (&'static str, String) {
    let state = world.resource::<State>();
    let (name, why) = if state.contact_law().is_some() {
        ("VelocityVerlet", "order 2 at one evaluation per tick, and contacts take many ticks")
    } else if !state.changing_forces() {
        ("VelocityVerlet", "accelerations do not change, so that it is exact")
    } else if state.velocity_dependent() {
        ("RungeKutta4", "order 4, and some force depends on velocities or time")
    } else {
        ("Symplectic4", "order 4 and symplectic, and all forces follow from positions alone")
    };
    (name, why.to_owned())
}

/// The first plan for a goal: trials make it better.
fn plan_for(
    goal: Goal,
    world: &World,
    clock: &ClockSection,
    overrides: &Overrides,
    duration: f64,
) -> Result<Plan, Wrong> {
    // A method that a scene names beside a tick was chosen for that tick.
    let by_tick = matches!(goal, Goal::Tolerance(_)) && clock.tolerance.is_none();
    let named = if by_tick { ClockSection::AUTO } else { &clock.method.0 };
    let mut method = overrides.method.clone().unwrap_or_else(|| named.to_owned());
    let free = method == ClockSection::AUTO || method == ClockSection::REFERENCE;
    let given = overrides.tick.or(clock.tick.map(|tick| tick.si()).filter(|_| goal == Goal::Reference));
    let tick = given.map_or_else(|| frame_tick(world, duration, overrides.rate), |tick| positive("--tick", tick))?;
    let state = world.resource::<State>();
    let varies = state.contact_law().is_some() || state.changing_forces();
    let mut plan = Plan {
        method: String::new(),
        tick,
        pace: StepPace::Even(1),
        detail: Detail::default(),
        events: clock.events,
        notes: Vec::new(),
        error: None,
        warning: None,
    };
    if free && !varies && goal != Goal::Reference {
        let exact = ErrorParts { discretisation: Some(0.0), ..Default::default() };
        plan.error = Some(ErrorEstimate { position: exact, velocity: exact, ..Default::default() });
        plan.notes.push("method VelocityVerlet chosen: accelerations do not change, so that it is exact".to_owned());
        plan.method = "VelocityVerlet".to_owned();
        return Ok(plan);
    }
    if free {
        method = "Dop853".to_owned();
        plan.events = if clock.events == EventTiming::Auto { EventTiming::Located } else { clock.events };
    }
    let description = described(world, &method)?;
    plan.method = method;
    let estimates = description.one_step.is_some_and(|make| make().order_of_error() > 0);
    plan.pace = if estimates {
        // Trials determine the allowed error of a step.
        StepPace::Allowed(Allowance::new(1e-3, duration))
    } else {
        StepPace::Even(steps_per_tick(world, &plan))
    };
    Ok(plan)
}

/// The time from frame to frame, or that of a `rate`, if the run is a whole number of these. Otherwise a part of this time, such
/// that the run is a whole number of parts.
fn frame_tick(world: &World, duration: f64, rate: Option<f64>) -> Result<f64, Wrong> {
    let film = world.get_resource::<FilmSection>();
    let frame = film.map_or(1.0 / 30.0, |film| film.speed().abs() / film.frames_per_second());
    let frame = rate.map_or(frame, f64::recip);
    let frames = duration / frame;
    let whole = frames >= 1.0 && (frames - frames.round()).abs() < 1e-9 * frames;
    let parts = if whole { frames.round() } else { (TICKS_PER_ODD_FRAME * frames).ceil().max(1.0) };
    Ok(duration / parts)
}

/// The number of ticks of a run.
fn count(
    plan: &Plan,
    duration: f64,
    clock: &ClockSection,
    overrides: &Overrides,
    notes: &mut Vec<String>,
) -> Result<u64, Wrong> {
    let dt = plan.tick;
    if dt > duration {
        let message = format!("the tick of {dt:?} s is longer than the whole run of {duration:?} s");
        return Err(Box::new(SceneError::new(if overrides.tick.is_some() { "--tick" } else { "--duration" }, message)));
    }
    let exact = duration / dt;
    if exact > MOST_TICKS {
        // A quotient beyond the largest number cannot be shown.
        let many = if exact.is_finite() { format!("{exact:.1e} ticks") } else { "infinitely many".to_owned() };
        let path = match (overrides.duration, overrides.tick) {
            (Some(_), _) => "--duration",
            (None, Some(_)) => "--tick",
            (None, None) if clock.tick.is_some() => "clock.tick",
            (None, None) => "clock.duration",
        };
        let error = SceneError::new(path, format!("{duration:?} s in ticks of {dt:?} s are {many}"));
        return Err(Box::new(
            error.with_help("a run takes at most 1e15 ticks; choose a longer tick or a shorter duration"),
        ));
    }
    // A quotient that is whole up to rounding counts as whole.
    let ticks =
        if (exact - exact.round()).abs() < 1e-9 * exact.max(1.0) { exact.round() } else { exact.ceil() }.max(1.0);
    if (ticks * dt - duration).abs() > 1e-9 * duration {
        notes.push(format!("{duration} s are not a whole number of ticks: the run ends at {} s", ticks * dt));
    }
    Ok(ticks as u64)
}

/// Makes the world ready for a plan.
fn install(world: &mut World, plan: &Plan, notes: &mut Vec<String>) -> Result<(), Wrong> {
    let method = described(world, &plan.method)?;
    let mut state = world.resource_mut::<State>();
    state.clock = Clock { dt: plan.tick, ..Clock::default() };
    let stability = &mut state.stability;
    (stability.limit, stability.damping_limit) = (method.stability_limit, method.damping_limit);
    let Some((made, located)) = method.make(plan.events, plan.pace, plan.detail) else {
        let message = format!("`{}` goes from tick to tick: it cannot locate events inside one", method.name);
        return Err(Box::new(
            SceneError::new("clock.events", message).with_help("write `events: Auto`, or leave it out"),
        ));
    };
    let mode = made.0.mode();
    let state = world.resource::<State>();
    if let Some(objection) = state.models().find_map(|model| model.objection(mode)) {
        let error = SceneError::new(objection.path, objection.message);
        return Err(Box::new(error.with_help(objection.help)));
    }
    if located && state.contact_law().is_some() {
        notes.push("events located: forces jump at the moment itself, inside ticks".to_owned());
    }
    let moved = !state.bodies().prescribed.motions.is_empty();
    let follows = method.drifts && (!moved || (!located && method.whole_ticks.is_some()));
    if method.symplectic && !follows && state.models_of::<Joint>().next().is_some() {
        let name = method.name;
        notes.push(format!(
            "{name} puts states back onto the joints after each step. It keeps its order, but is not symplectic here"
        ));
    }
    world.insert_resource(ChosenMethod { name: method.name, located, mode });
    crate::tick::set_method(world, made);
    Ok(())
}

fn positive(flag: &str, value: f64) -> Result<f64, Wrong> {
    if value.is_finite() && value > 0.0 {
        Ok(value)
    } else {
        Err(Box::new(SceneError::new(flag, format!("must be a finite number above zero, got {value:?}"))))
    }
}

/// Forty ticks per half period of the fastest response, or fewer for contacts among many bodies. The tick is rounded
/// down to few digits.
fn chosen_tick(world: &World) -> Result<(f64, &'static str), Box<SceneError>> {
    let coarsest = (COARSEST_TICK, "the scene has no contacts, springs or drives that ask for a finer one");
    let state = world.resource::<State>();
    let (in_contact, digits, contact) = if is_crowd(state) {
        let (ticks, why) = of_a_crowd(state);
        (ticks, &DIGITS_IN_A_CROWD[..], why)
    } else {
        (TICKS_PER_HALF_PERIOD, &DIGITS[..], "the stiffest contact lasts at least 40 of them")
    };
    // Angular frequency, ticks per half period, of what, and why a tick is short enough.
    let known = state.stability.foreseen.iter().filter(|foreseen| foreseen.angular_frequency > 0.0);
    let foreseen = known.map(|foreseen| match foreseen.holder {
        Holder::Contacts => (foreseen.angular_frequency, in_contact, "contact", contact),
        Holder::Springs => {
            let why = "half a swing of the fastest springs lasts at least 40 of them";
            (foreseen.angular_frequency, TICKS_PER_HALF_PERIOD, "spring", why)
        }
    });
    let rhythms = state.models().filter_map(|model| model.rhythm());
    let driven = rhythms.filter(|rhythm| rhythm.angular_frequency > 0.0).map(|rhythm| {
        let why = "half a swing of the fastest drive lasts at least 40 of them";
        (rhythm.angular_frequency, TICKS_PER_HALF_PERIOD, "drive", why)
    });
    let moved = state.bodies().prescribed.fastest_swing().map(|(_, swing)| {
        let why = "the fastest path takes at least 40 of them from stop to stop";
        (PI / swing, TICKS_PER_HALF_PERIOD, "path", why)
    });
    let all = foreseen.chain(driven).chain(moved);
    let Some((omega, ticks, what, why)) = all.max_by(|(a, m, ..), (b, n, ..)| (a * m).total_cmp(&(b * n))) else {
        return Ok(coarsest);
    };
    let wanted = PI / (ticks * omega);
    if wanted >= COARSEST_TICK {
        return Ok(coarsest);
    }
    if !wanted.is_normal() {
        let fast = if omega.is_finite() { format!("at {omega:?} rad/s") } else { "infinitely fast".to_owned() };
        let message = format!("no tick is short enough for the fastest {what}, which vibrates {fast}");
        let error = SceneError::new("clock", message);
        return Err(Box::new(error.with_help("give the bodies less `stiffness` or more mass, or give a `tick`")));
    }
    let exponent = wanted.log10().floor() as i32;
    let decade = libm::exp10(f64::from(exponent));
    let step = digits.iter().copied().find(|step| step * decade <= wanted).unwrap_or(1.0);
    // Read back from decimal digits, so that 2e-4 is the same number as in a scene.
    Ok((format!("{step}e{exponent}").parse().unwrap_or(step * decade), why))
}
