//! Runs of the other kind beside a run whose contacts carried loads that change. Velocity Verlet from tick to tick and
//! methods that locate events share neither steps nor laws of switching. Finer runs of the same kind repeat a fault,
//! and runs of the other kind show it.
//!
//! A run from tick to tick has one twin with located events in place of one with finer ticks. That twin is
//! of a higher order. So the whole difference is the error of the first run.
//!
//! A run with located events is far more exact than velocity Verlet, whose error must not become its own. Two runs
//! from tick to tick tell that error by their difference. Only a larger distance counts.

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
/// Beyond this share of the motion, the runs from tick to tick are no measure.
const USELESS: f64 = 0.1;
/// Distances of less than this share of the motion are rounding that contacts magnify.
const ROUNDING: f64 = 1e-9;

/// The departure of runs of the other kind.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Elsewhere {
    /// The first moment in s at which they are farther away than both errors explain.
    pub since: f64,
    /// The greatest distance of places in m.
    pub distance: f64,
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

/// The plan of velocity Verlet with so many ticks in one of the run.
fn by_ticks(simulation: &Simulation, ticks: u32) -> Option<Plan> {
    let plan = simulation.plan()?.clone();
    let tick = plan.tick / f64::from(ticks);
    let (method, events) = ("VelocityVerlet".to_owned(), EventTiming::PerTick);
    let (error, warning) = (None, None);
    Some(Plan { method, tick, pace: StepPace::Even(1), detail: Detail::default(), events, error, warning, ..plan })
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
    let times = (simulation.clock().dt / tick).ceil().clamp(1.0, f64::from(u32::MAX / 4)) as u32;
    let finer = [times, 2 * times].map(|ticks| Finer { ticks, ..Finer::SAME });
    let work = 3.0 * f64::from(times) * ticks as f64 / (state.evaluation().count.max(1) as f64);
    let part = if effort == Effort::Full { 1.0 } else { work::affordable(simulation, work) };
    let until = (part * ticks as f64) as u64;
    if !moments(simulation).iter().any(|tick| *tick <= until) {
        return Ok(());
    }
    let patience = (effort != Effort::Full).then(|| Patience::of(simulation, part, work));
    let mut runs = Vec::new();
    for finer in finer {
        let Some(plan) = by_ticks(simulation, finer.ticks) else { return Ok(()) };
        let what = format!("by velocity Verlet with a tick of {} s, for its error", number(plan.tick));
        // Some laws cannot go from tick to tick.
        let Ok(mut other) = scene.again(simulation, plan, 1.0, &what) else { return Ok(()) };
        twins::watch_beside(&mut other, simulation, finer, until);
        match work::run_to_tick(&mut other, finer.tick(until), patience) {
            // A run from tick to tick misses a force between two ticks, which tells nothing of the first run.
            Ok(None) if departs(&other) => return Ok(()),
            Ok(None) => runs.push(Trajectory::watched(&mut other, None)),
            _ => return Ok(()),
        }
    }
    let [coarse, fine] = &runs[..] else { return Ok(()) };
    let stated = found.estimate.and_then(|error| error.position.discretisation).unwrap_or_default();
    let tick = simulation.clock().dt / f64::from(2 * times);
    let Some((elsewhere, speed)) = elsewhere(run, coarse, fine, stated, tick) else { return Ok(()) };
    found.notes.push(format!(
        "velocity Verlet with a tick of {} s goes elsewhere from t = {} s on, by up to {} m: more than the errors of both",
        number(tick),
        number(elsewhere.since),
        rough(elsewhere.distance)
    ));
    found.elsewhere = Some(elsewhere);
    if let Some(error) = &mut found.estimate {
        let most = |part: &mut Option<f64>, value: f64| *part = Some(part.map_or(value, |old| old.max(value)));
        most(&mut error.position.discretisation, elsewhere.distance);
        most(&mut error.velocity.discretisation, speed);
    }
    Ok(())
}

/// Whether a run from tick to tick did otherwise than its scene asks.
fn departs(simulation: &Simulation) -> bool {
    let state = simulation.resource::<State>();
    state.models().any(|model| !model.departures(state, EvaluationMode::Following).is_empty())
}

/// The departure of the finer of two runs from tick to tick, and the greatest difference of velocities in m/s.
/// `None`: it goes no farther than errors explain.
fn elsewhere(
    run: &Trajectory,
    coarse: &Trajectory,
    fine: &Trajectory,
    stated: f64,
    tick: f64,
) -> Option<(Elsewhere, f64)> {
    let motion = run.sizes().0.max(fine.sizes().0);
    let (mut own, mut found) = (0.0_f64, None::<(Elsewhere, f64)>);
    for ((since, far, fast), (_, other, _)) in run.errors(fine).zip(coarse.errors(fine)) {
        own = own.max(other);
        if own.is_nan() || own > USELESS * motion {
            break;
        }
        match &mut found {
            Some((known, speed)) => (known.distance, *speed) = (known.distance.max(far), speed.max(fast)),
            None if far > LIKE_PHASES * own + stated + ROUNDING * motion => {
                found = Some((Elsewhere { since, distance: far, tick }, fast));
            }
            None => {}
        }
    }
    found
}
