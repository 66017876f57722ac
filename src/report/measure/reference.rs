//! The reference for settings: a run with a known small error, and the time until which it holds.
//!
//! Two runs of Dop853 with located events may err by 1e-12 and 1e-14 of the motion per step. They differ by about the
//! error of the coarser one. That is the floor, a bound of the error of the finer one. A third run begins very near to
//! them, and its growing distance shows chaos. If locating contacts one by one takes too long, runs of velocity Verlet
//! with finer and finer ticks replace them.

use super::beyond::{Beyond, MeanDeviation};
use super::measured_scene::Scene;
use super::{Budget, Load, Way, plan, timed};
use jostle_engine::Simulation;
use jostle_engine::integrate::clock_section::EventTiming;
use jostle_engine::integrate::{Allowance, StepPace};
use jostle_engine::scene::SceneErrors;
use jostle_engine::simulation::Plan;
use jostle_engine::simulation::accuracy::reference::{BESIDE, COARSE, FINE, TELLS_NOTHING, disturb, horizon};
use jostle_engine::simulation::accuracy::trajectory::Trajectory;
use jostle_engine::tick::Failure;
use jostle_language::numbers::number;

/// The share of the budget for the located runs, and that for the runs by ticks that may replace them.
const LOCATED_BY: f64 = 0.4;
const TICKS_BY: f64 = 0.6;
/// Runs are compared for this share of the time until rounding becomes visible. By then rounding has grown to less than
/// a millionth.
const BEFORE_HORIZON: f64 = 0.7;
/// If two reference runs differ by this share of the motion, they are not a reference.
const PARTED: f64 = 1e-2;
/// No error below so many times the floor is claimed.
const CLAIMED: f64 = 3.0;
/// Ticks of a radian of the fastest contact in the coarsest reference run by ticks, and the most refinements.
const TICKS_PER_RADIAN: f64 = 4.0;
const MOST_DOUBLINGS: u32 = 12;

/// The properties of the reference run.
#[derive(Clone, Debug)]
pub struct Reference {
    /// The way in which it was made.
    pub words: String,
    /// Its own error is no larger, in the norm of the settings.
    pub floor: f64,
    /// The time in s at which rounding alone becomes visible, if the motion is chaotic.
    pub horizon: Option<f64>,
    /// Until when settings are compared with it, in s.
    pub until: f64,
    /// The reason for which that is not the whole run.
    pub why_until: Option<String>,
    /// The difference of means over the rest of the run between reference runs, if there is a rest.
    pub scatter: Option<MeanDeviation>,
    /// A weakness of the reference.
    pub warning: Option<String>,
}

impl Reference {
    /// The smallest error that may be claimed of a setting.
    pub fn claim(&self) -> f64 {
        CLAIMED * self.floor
    }
}

/// Why there is no reference run.
#[derive(Clone, Debug)]
pub enum NoReference {
    /// The scene is wrong.
    Scene(SceneErrors),
    /// The budget is too short; about so many seconds are needed.
    Short(f64),
    /// It failed.
    Failed(Failure),
    /// No body moves.
    Still,
    /// Reference runs part at once.
    Parts,
}

impl From<SceneErrors> for NoReference {
    fn from(errors: SceneErrors) -> Self {
        Self::Scene(errors)
    }
}

/// The reference run and its properties.
pub(super) struct Truth {
    pub run: Trajectory,
    /// The greatest distance and speed of each body in it.
    pub measures: Vec<(f64, f64)>,
    pub about: Reference,
    /// The statistics of the time after it.
    pub beyond: Option<Beyond>,
}

/// The plan of a run of `duration` seconds with located events, whose steps may err by `share` of the motion.
pub(super) fn located(tick: f64, share: f64, duration: f64) -> Plan {
    plan("Dop853", tick, StepPace::Allowed(Allowance::new(COARSE, duration).with_share(share)), EventTiming::Located)
}

/// Why runs with located events are no reference.
enum Unfit {
    Overloaded,
    /// Seconds that they would have taken, about.
    Slow(f64),
    Failed(Failure),
}

/// Finds the truth.
pub(super) fn find(load: Load, scene: &Scene, budget: &Budget) -> Result<Truth, NoReference> {
    let unfit = match by_located(load, scene, budget)? {
        Ok(truth) => return truth,
        Err(unfit) => unfit,
    };
    let why = match &unfit {
        Unfit::Overloaded => "contacts are too many to be located one by one",
        Unfit::Slow(_) => "locating each event takes too long for the budget",
        Unfit::Failed(_) => "the run with located events goes wrong",
    };
    match by_ticks(load, scene, budget, why) {
        Err(NoReference::Short(needed)) => match unfit {
            Unfit::Slow(located) => Err(NoReference::Short(needed.min(located))),
            Unfit::Overloaded | Unfit::Failed(_) => Err(NoReference::Short(needed)),
        },
        // The scene may not allow a method by whole ticks.
        Err(NoReference::Scene(errors)) => Err(match unfit {
            Unfit::Slow(needed) => NoReference::Short(needed),
            Unfit::Failed(failure) => NoReference::Failed(failure),
            Unfit::Overloaded => NoReference::Scene(errors),
        }),
        // The first of two failures is the one of the finer run.
        Err(NoReference::Failed(other)) => match unfit {
            Unfit::Failed(failure) => Err(NoReference::Failed(failure)),
            Unfit::Overloaded | Unfit::Slow(_) => Err(NoReference::Failed(other)),
        },
        other => other,
    }
}

type Attempt = Result<Result<Truth, NoReference>, Unfit>;

fn by_located(load: Load, scene: &Scene, budget: &Budget) -> Result<Attempt, SceneErrors> {
    let tick = scene.duration / scene.seen as f64;
    let mut done = 0.0;
    let mut run = |share: f64, change: &dyn Fn(&mut Simulation)| -> Result<Result<Trajectory, Unfit>, SceneErrors> {
        let mut simulation = load(Way::Plan(&located(tick, share, scene.duration)))?;
        change(&mut simulation);
        Ok(match Trajectory::while_it(&mut simulation, 1, &|| budget.within(LOCATED_BY)) {
            Ok(Trajectory { overloaded: true, .. }) => Err(Unfit::Overloaded),
            Ok(Trajectory { failure: Some(failure), .. }) => Err(Unfit::Failed(failure)),
            Ok(trajectory) => {
                done += 1.0;
                Ok(trajectory)
            }
            // Three runs; the two that are left are at most twice as fine.
            Err(share) => Err(Unfit::Slow(budget.used() * 4.0 / (done + share).max(1e-3) / LOCATED_BY)),
        })
    };
    let coarse = match run(COARSE, &|_| {})? {
        Ok(coarse) => coarse,
        Err(unfit) => return Ok(Err(unfit)),
    };
    let (distance, speed) = coarse.sizes();
    if distance <= 0.0 && speed <= 0.0 {
        return Ok(Ok(Err(NoReference::Still)));
    }
    let fine = match run(FINE, &|_| {})? {
        Ok(fine) => fine,
        Err(unfit) => return Ok(Err(unfit)),
    };
    let hair = BESIDE * if distance > 0.0 { distance } else { 1.0 };
    let beside = match run(COARSE, &|simulation| disturb(simulation, hair))? {
        Ok(beside) => beside,
        Err(unfit) => return Ok(Err(unfit)),
    };
    let growths: Vec<(f64, f64)> = coarse.differences(&beside).map(|(time, far)| (time, far / hair)).collect();
    let horizon = horizon(&growths);
    let before = horizon.map_or(f64::INFINITY, |horizon| BEFORE_HORIZON * horizon);
    let words = "Dop853 with located events, steps that err by 1e-14 of the motion".to_owned();
    let mut warning = None;
    if coarse.bounded && fine.bounded {
        warning = Some("rounding bounds its steps: the floor is that of rounding alone".to_owned());
    }
    let about = Reference { words, floor: 0.0, horizon, until: before, why_until: None, scatter: None, warning };
    let most = |until: f64| {
        let before = growths.iter().filter(|(time, _)| *time <= until);
        before.fold(1.0, |most: f64, (_, growth)| most.max(*growth))
    };
    Ok(Ok(compared((&coarse, Some(&beside)), fine, about, scene.duration, &most)))
}

fn by_ticks(load: Load, scene: &Scene, budget: &Budget, why: &str) -> Result<Truth, NoReference> {
    let mut count = scene.seen;
    let wanted = scene.fastest.map_or(0.0, |fastest| TICKS_PER_RADIAN * fastest * scene.duration);
    while (count as f64) < wanted {
        count *= 2;
    }
    let mut runs: Vec<Trajectory> = Vec::new();
    let mut ticks = count;
    let started = budget.used();
    let mut begun = started;
    for _ in 0..MOST_DOUBLINGS {
        let plan = plan("VelocityVerlet", scene.duration / count as f64, StepPace::Even(1), EventTiming::PerTick);
        let mut simulation = load(Way::Plan(&plan))?;
        let within = || budget.within(TICKS_BY);
        let (spent, seen) = timed(|| Trajectory::while_it(&mut simulation, count / scene.seen, &within));
        let run = match seen {
            Ok(run) => run,
            Err(_) if runs.len() >= 2 => break,
            Err(share) => {
                // The runs so far, this one, and one that is twice as fine if it is the first.
                let rest = if runs.is_empty() { 3.0 } else { 1.0 };
                let needed = begun - started + rest * spent.as_secs_f64() / share.max(1e-3);
                let slow = started >= LOCATED_BY * budget.whole;
                return Err(NoReference::Short(needed / if slow { TICKS_BY - LOCATED_BY } else { TICKS_BY }));
            }
        };
        if let Some(failure) = run.failure {
            return Err(NoReference::Failed(failure));
        }
        if run.sizes() == (0.0, 0.0) {
            return Err(NoReference::Still);
        }
        if runs.len() == 2 {
            runs.remove(0);
        }
        runs.push(run);
        ticks = count;
        count *= 2;
        begun = budget.used();
        let next = 2.0 * spent.as_secs_f64();
        if runs.len() == 2 && begun + next > TICKS_BY * budget.whole {
            break;
        }
    }
    let (Some(fine), Some(coarse)) = (runs.pop(), runs.pop()) else { return Err(NoReference::Parts) };
    let tick = scene.duration / ticks as f64;
    let about = Reference {
        words: format!("VelocityVerlet by whole ticks of {} s", number(tick)),
        floor: 0.0,
        horizon: None,
        until: f64::INFINITY,
        why_until: None,
        scatter: None,
        warning: Some(format!(
            "{why}. The reference is a run of velocity Verlet with fine ticks. Its error is its difference from a run with \
             twice the tick"
        )),
    };
    compared((&coarse, None), fine, about, scene.duration, &|_| 1.0)
}

/// Compares two reference runs, and one that begins beside them, as long as they agree. `growth` gives the growth of a
/// disturbance until a time.
fn compared(
    (coarse, beside): (&Trajectory, Option<&Trajectory>),
    fine: Trajectory,
    mut about: Reference,
    duration: f64,
    growth: &dyn Fn(f64) -> f64,
) -> Result<Truth, NoReference> {
    let (distance, _) = fine.sizes();
    let distance = if distance > 0.0 { distance } else { 1.0 };
    let parted = coarse.parts(&fine, PARTED * distance);
    // The last moment before they part.
    let before = parted.map(|parted| {
        let times = coarse.differences(&fine).map(|(time, _)| time).take_while(|time| *time < parted);
        times.fold(0.0, f64::max)
    });
    let mut until = about.until;
    if let Some(horizon) = about.horizon.filter(|_| until < duration) {
        about.why_until = Some(format!(
            "the motion is chaotic: rounding alone shows after about {} s, and no run tells places beyond that",
            number(horizon)
        ));
    }
    if let (Some(before), Some(parted)) = (before, parted)
        && before < until
    {
        until = before;
        about.why_until = Some(format!(
            "two reference runs are more than {} % of the motion apart at t = {} s: from then on they tell nothing",
            number(100.0 * PARTED),
            number(parted)
        ));
    }
    about.until = until.min(duration);
    let (own, other) = (fine.part(about.until, 1), coarse.part(about.until, 1));
    if own.moments() == 0 {
        return Err(NoReference::Parts);
    }
    let rounding = growth(about.until) * f64::EPSILON * own.farthest().max(distance) / distance;
    about.floor = other.apart(&own).share.max(rounding);
    if about.floor > TELLS_NOTHING {
        return Err(NoReference::Parts);
    }
    let runs: Vec<&Trajectory> = [&fine, coarse].into_iter().chain(beside).collect();
    let beyond = (about.until < duration).then(|| Beyond::of(&runs, about.until)).flatten();
    about.scatter = beyond.as_ref().map(|beyond| beyond.scatter);
    Ok(Truth { measures: own.measures(), run: own, about, beyond })
}
