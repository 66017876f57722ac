//! Runs of the other kind beside a run whose contacts carried loads that change. Velocity Verlet from tick to tick and
//! methods that locate events share neither steps nor laws of switching. Finer runs of the same kind repeat a fault,
//! and runs of the other kind show it.
//!
//! Every run from tick to tick has a twin with located events (`twins.rs`).
//!
//! A run with located events is far more exact than velocity Verlet, whose error must not become its own. Two runs
//! from tick to tick tell that error by their difference. Only a larger distance counts. Ever finer ticks confirm it, or show one
//! that the error hid.

use jostle_engine::Simulation;
use jostle_engine::integrate::{ChosenMethod, Detail, EventTiming, StepPace};
use jostle_engine::scene::SceneErrors;
use jostle_engine::simulation::Plan;
use jostle_engine::simulation::accuracy::trajectory::Trajectory;
use jostle_engine::tick::{EvaluationMode, Model, State};
use jostle_language::numbers::{number, rough};

use super::twins::{self, Finer};
use super::work::{self, Patience};
use super::{Effort, EstimatedError, Repeated, moments, touches};

/// Ticks of velocity Verlet in half a period of the stiffest contact, as by default.
const TICKS_PER_HALF_PERIOD: f64 = 40.0;
/// Runs with a tick and with half of it may meet events at like phases. Their difference is then too small, seldom by
/// more than this factor.
const LIKE_PHASES: f64 = 10.0;
/// Beyond this share of the motion the runs from tick to tick are no measure. The same holds for the share of an impulse that edges
/// between ticks cost.
const USELESS: f64 = 0.1;
/// Each finer run has so many times the ticks of the one before. An error that falls with the tick then falls below the bound in two
/// such steps.
const FINER: u32 = 4;
/// Runs of so many ticks in one of the coarsest may take any time, if the user wants all runs.
const FINE: u32 = 2 * FINER;
/// The finest run, if little work suffices. The first pair may hide a departure, and two more are to show it.
const FINEST: u32 = 2 * FINER * FINER * FINER;
/// Distances of less than this share of the motion are rounding that contacts magnify.
const ROUNDING: f64 = 1e-9;

/// The departure of runs of the other kind.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Elsewhere {
    /// The first moment in s at which they are farther away than both errors explain.
    pub since: f64,
    /// The greatest distance of places in m.
    pub distance: f64,
    /// The same as a share of how far bodies go.
    pub share: f64,
    /// The time in s until which the runs were compared, if not to the end.
    pub until: Option<f64>,
    /// The tick of velocity Verlet in s.
    pub tick: f64,
}

/// Whether loads on contacts, limits or frictions change by the clock, or bodies rest on things that move. Loads on contacts also
/// change as limits, frictions and motors of joints switch.
pub(super) fn loads_change(simulation: &Simulation) -> bool {
    let state = simulation.resource::<State>();
    let holds = |model: &dyn Model| model.contact_law().is_some() || model.has_modes();
    let changes = |model: &dyn Model| model.contact_law().is_none() && (model.has_edges() || model.rhythm().is_some());
    let bodies = state.bodies();
    let supports = !bodies.prescribed.motions.is_empty() || bodies.belts.iter().any(|belt| belt.length() > 0.0);
    let contacts = state.models().any(|model| model.contact_law().is_some());
    let switches = |model: &dyn Model| model.contact_law().is_none() && model.has_rows() && model.has_modes();
    let changing = supports || state.models().any(changes) || contacts && state.models().any(switches);
    state.models().any(holds) && changing
}

/// Whether contacts, limits or frictions carried such loads in a run.
pub(super) fn carried(simulation: &Simulation) -> bool {
    let state = simulation.resource::<State>();
    let other_modes = || state.models().any(|model| model.contact_law().is_none() && model.has_modes());
    loads_change(simulation) && (touches(simulation) || other_modes())
}

/// Runs by velocity Verlet beside a run with located events.
struct ByTicks<'a> {
    simulation: &'a Simulation,
    scene: &'a Repeated<'a>,
    /// Evaluations of a run with one tick in one of the first, over those of the first.
    work: f64,
    /// The share of the first run that they repeat. 1 takes any time.
    part: f64,
    /// The tick of the first run that ends it.
    until: u64,
    /// Ticks of the coarsest in one of the first.
    coarse: u32,
}

impl ByTicks<'_> {
    /// Whether so many ticks in one of the first run need little work, or any work is allowed.
    fn affords(&self, ticks: u32, patient: bool) -> bool {
        let any = patient && ticks <= FINE * self.coarse;
        any || work::affordable(self.simulation, self.work * f64::from(ticks)) >= self.part
    }

    /// A run with so many ticks in one of the first. `None`: some laws cannot go from tick to tick, it takes long, or it fails.
    fn run(&self, ticks: u32, patient: bool) -> Result<Option<Trajectory>, SceneErrors> {
        let Some(plan) = self.simulation.plan().cloned() else { return Ok(None) };
        let finer = Finer { ticks, ..Finer::SAME };
        let tick = plan.tick / f64::from(ticks);
        let (method, events) = ("VelocityVerlet".to_owned(), EventTiming::PerTick);
        let (pace, detail, error, warning) = (StepPace::Even(1), Detail::default(), None, None);
        let plan = Plan { method, tick, pace, detail, events, error, warning, ..plan };
        let what = format!("by velocity Verlet with a tick of {} s, for its error", number(tick));
        let Ok(mut other) = self.scene.again(self.simulation, plan, 1.0, &what) else { return Ok(None) };
        twins::watch_beside(&mut other, self.simulation, finer, self.until);
        let work = self.work * f64::from(ticks);
        let patience = (!patient).then(|| Patience::of(self.simulation, self.part, work));
        let ran = work::run_to_tick(&mut other, finer.tick(self.until), patience, |_| self.scene.is_interrupted());
        // A run from tick to tick misses a force between two ticks, which tells nothing of the first run.
        let tells = matches!(ran, Ok(None)) && !departs(&other);
        Ok(tells.then(|| Trajectory::watched(&mut other, None)))
    }
}

/// Looks at a run with located events beside two from tick to tick, as far as little work allows.
pub(super) fn check(
    simulation: &Simulation,
    run: &Trajectory,
    effort: Effort,
    scene: &Repeated,
    found: &mut EstimatedError,
) -> Result<(), SceneErrors> {
    let ticks = simulation.clock().ticks;
    if effort == Effort::None || ticks == 0 || !ChosenMethod::locates(simulation.unpublished_world()) {
        return Ok(());
    }
    let state = simulation.resource::<State>();
    let Some(fastest) = state.stability().fastest_foreseen().filter(|_| carried(simulation)) else { return Ok(()) };
    let tick = std::f64::consts::PI / (TICKS_PER_HALF_PERIOD * fastest.angular_frequency);
    let coarse = (simulation.clock().dt / tick).ceil().clamp(1.0, f64::from(u32::MAX / (2 * FINEST))) as u32;
    let mut times = 2 * coarse;
    let work = ticks as f64 / (state.evaluation().count.max(1) as f64);
    let patient = effort == Effort::Full;
    let part = if patient { 1.0 } else { work::affordable(simulation, f64::from(coarse + times) * work) };
    let until = (part * ticks as f64) as u64;
    if !moments(simulation).iter().any(|tick| *tick <= until) {
        return Ok(());
    }
    let by_ticks = ByTicks { simulation, scene, work, part, until, coarse };
    let Some(first) = by_ticks.run(coarse, patient)? else { return Ok(()) };
    let Some(second) = by_ticks.run(times, patient)? else { return Ok(()) };
    let mut runs = vec![first, second];
    let stated = found.estimate.and_then(|error| error.position.discretisation).unwrap_or_default();
    let mut seen = departure(run, &runs, stated);
    // A fault of ticks that are too coarse falls away with finer ones. A departure that only finer ticks show is to be seen twice.
    let mut is_confirmed = false;
    while !is_confirmed && times < FINEST * coarse && by_ticks.affords(FINER * times, patient) {
        let Some(finer) = by_ticks.run(FINER * times, patient)? else { break };
        runs.push(finer);
        times *= FINER;
        let before = std::mem::replace(&mut seen, departure(run, &runs, stated));
        is_confirmed = before.is_some() && seen.is_some();
    }
    let seen = seen.filter(|_| is_confirmed || runs.len() == 2);
    let Some(Departure { since, distance, speed }) = seen else { return Ok(()) };
    let tick = simulation.clock().dt / f64::from(times);
    found.notes.push(format!(
        "velocity Verlet with a tick of {} s goes elsewhere from t = {} s on, by up to {} m: more than the errors of both",
        number(tick),
        number(since),
        rough(distance)
    ));
    let compared = (until < ticks).then(|| until as f64 * simulation.clock().dt);
    found.elsewhere = Some(Elsewhere { since, distance, share: distance / run.sizes().0, until: compared, tick });
    found.raise((distance, speed), run.sizes().0, || {
        format!("Velocity Verlet with a tick of {} s goes elsewhere by as much", number(tick))
    });
    Ok(())
}

/// Whether a run from tick to tick did otherwise than its scene asks, by more than its error tells. Edges between ticks cost a share
/// of an impulse that falls with the tick, as other errors do.
fn departs(simulation: &Simulation) -> bool {
    let state = simulation.resource::<State>();
    let all = |model: &dyn Model| model.departures(state, EvaluationMode::Following);
    state.models().flat_map(all).any(|departure| departure.share > USELESS)
}

/// How far two runs are from each other.
#[derive(Clone, Copy)]
struct Departure {
    /// In s.
    since: f64,
    /// The greatest distance of places in m, and difference of velocities in m/s.
    distance: f64,
    speed: f64,
}

/// The departure of the finest of some runs from tick to tick. Each has more ticks than the one before. `None`: it goes no farther than
/// errors explain.
fn departure(run: &Trajectory, by_ticks: &[Trajectory], stated: f64) -> Option<Departure> {
    let finest = by_ticks.last()?;
    let motion = run.sizes().0.max(finest.sizes().0);
    let mut errors = vec![0.0_f64; run.errors(finest).count()];
    // One difference may be small by chance. Those before were larger by the factor of ticks.
    for (number, pair) in by_ticks.windows(2).rev().enumerate() {
        let scale = f64::from(FINER).powi(number as i32);
        for (error, (_, other, _)) in errors.iter_mut().zip(pair[0].errors(&pair[1])) {
            *error = if other.is_nan() { f64::INFINITY } else { error.max(other / scale) };
        }
    }
    let (mut own, mut found) = (0.0_f64, None::<Departure>);
    for ((since, far, fast), error) in run.errors(finest).zip(errors) {
        own = own.max(error);
        if own > USELESS * motion {
            break;
        }
        match &mut found {
            Some(known) => (known.distance, known.speed) = (known.distance.max(far), known.speed.max(fast)),
            None if far > LIKE_PHASES * own + stated + ROUNDING * motion => {
                found = Some(Departure { since, distance: far, speed: fast });
            }
            None => {}
        }
    }
    found
}
