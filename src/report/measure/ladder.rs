//! The ladder: every method with ticks from coarse to fine, all methods by turns, until errors drown in that of the reference run
//! or time is up.

use super::reference::Truth;
use super::{Budget, Load, Order, Scene, Way, timed, timing};
use crate::integrate::{Description, LocatedEvents};
use crate::report::accuracy::trajectory::{Apart, Trajectory};
use crate::report::card::{ChosenMethod, number};
use crate::scene::SceneErrors;
use crate::tick::Failure;

/// The coarsest tick is so many times the critical one, where there is one: what lies beyond is seen to fail.
const BEYOND_CRITICAL: f64 = 2.0;
/// What stands for the limit of methods that have none, or are never stable without losses.
const USUAL_LIMIT: f64 = 2.0;
/// The run has at least so many ticks.
const FEWEST_TICKS: f64 = 5.0;
/// Parts of a hundred moments, each about twice as fine as the one before.
const COARSE: [u64; 6] = [1, 2, 5, 10, 20, 50];
/// Methods that fail so many times one after the other are left.
const MOST_FAILURES: u32 = 6;
/// Errors below this that fall no more are rounding.
const ROUNDING: f64 = 1e-7;
/// A method is left behind where another one has no more than its error for this share of its evaluations.
const BEHIND: f64 = 1.0 / 64.0;
/// ... but not before so many of its settings are measured.
const SEEN: usize = 4;

/// How a setting came out.
#[derive(Clone, Debug)]
pub enum Outcome {
    /// Its error.
    Measured(Deviation),
    /// It reaches its end, and nothing tells its error.
    Unknown,
    /// It went wrong.
    Failed(Failure),
    /// The method cannot run the scene, and why.
    Refused(String),
    /// Time was up when this share of it was done.
    Stopped(f64),
}

/// How far a run is from the reference.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Deviation {
    /// As a share of the motion: see [`super::NORM`].
    pub share: f64,
    /// Greatest distance of places in m.
    pub position: f64,
    /// Difference of velocities in m/s, a root mean square over the moments.
    pub velocity: f64,
}

impl From<Apart> for Deviation {
    fn from(apart: Apart) -> Self {
        Self { share: apart.share, position: apart.distance, velocity: apart.speed }
    }
}

/// A method with a tick, and what came out.
#[derive(Clone, Debug)]
pub struct Setting {
    /// Name of the method.
    pub method: &'static str,
    /// Seconds of a tick.
    pub tick: f64,
    /// Whether events are located inside ticks.
    pub located: bool,
    /// What came out.
    pub outcome: Outcome,
    /// Evaluations of all forces per second of physics.
    pub evaluations: f64,
    /// Seconds per second of physics.
    pub seconds: Option<f64>,
    /// What else is to be known.
    pub notes: Vec<String>,
}

impl Setting {
    /// Its error as a share of the motion, if it is known.
    pub fn error(&self) -> Option<f64> {
        if let Outcome::Measured(deviation) = self.outcome { Some(deviation.share) } else { None }
    }
}

/// A method on the ladder.
struct Climber {
    method: Description,
    /// Ticks of its next run.
    next: u64,
    settings: Vec<Setting>,
    /// Seconds and ticks of the last one.
    last: Option<(f64, u64)>,
    failures: u32,
    /// Why it goes no further.
    end: Option<String>,
}

/// Climbs; returns what came out, and why methods went no further.
#[expect(clippy::type_complexity, reason = "two lists")]
pub(super) fn climb(
    load: Load,
    scene: &Scene,
    order: &Order,
    truth: Option<&Truth>,
    budget: &Budget,
) -> Result<(Vec<Setting>, Vec<(&'static str, String)>), SceneErrors> {
    let wanted =
        |method: &&Description| order.methods.is_empty() || order.methods.iter().any(|name| name == method.name);
    let mut climbers: Vec<Climber> =
        scene.methods.0.iter().filter(wanted).map(|method| Climber::new(*method, scene, truth)).collect();
    while climbers.iter().any(|climber| climber.end.is_none()) {
        for climber in &mut climbers {
            // The others have used of the budget meanwhile.
            climber.end = climber.end.take().or_else(|| climber.reason_to_end(order, truth, budget));
            if climber.end.is_none() {
                climber.step(load, scene, truth, budget)?;
                climber.end = climber.reason_to_end(order, truth, budget);
            }
        }
        for place in 0..climbers.len() {
            if climbers[place].end.is_none() && behind(&climbers, place) {
                climbers[place].end =
                    Some("finer ticks were not tried: others have this error for a 64th of the evaluations".to_owned());
            }
        }
    }
    let ends = climbers.iter().map(|climber| (climber.method.name, climber.end.clone().unwrap_or_default())).collect();
    Ok((climbers.into_iter().flat_map(|climber| climber.settings).collect(), ends))
}

/// Whether another method is as good as the last setting of this one for far fewer evaluations.
fn behind(climbers: &[Climber], place: usize) -> bool {
    let own = &climbers[place].settings;
    let measured = own.iter().filter(|setting| setting.error().is_some()).count();
    let Some((last, error)) = own.last().and_then(|last| Some((last, last.error()?))) else { return false };
    let others = climbers.iter().flat_map(|climber| &climber.settings);
    let better = |other: &Setting| {
        other.error().is_some_and(|share| share <= error) && other.evaluations <= BEHIND * last.evaluations
    };
    measured >= SEEN && others.into_iter().any(better)
}

impl Climber {
    fn new(method: Description, scene: &Scene, truth: Option<&Truth>) -> Self {
        let limit = method.stability_limit;
        let limit = if limit.is_finite() && limit > 0.0 { limit } else { USUAL_LIMIT };
        let critical = scene.fastest.map_or(f64::INFINITY, |fastest| BEYOND_CRITICAL * limit / fastest);
        // A tick longer than the time that is compared would be seen nowhere.
        let until = truth.map_or(f64::INFINITY, |truth| truth.about.until);
        let fewest = (scene.duration / critical.min(until)).max(FEWEST_TICKS);
        let coarse = COARSE.into_iter().filter(|count| scene.moments.is_multiple_of(*count));
        let coarse = coarse.filter(|count| *count < scene.moments);
        let fine = (0..40).map(|power| scene.moments << power);
        let next = coarse.chain(fine).find(|count| *count as f64 >= fewest * (1.0 - 1e-9)).unwrap_or(scene.moments);
        Self { method, next, settings: Vec::new(), last: None, failures: 0, end: None }
    }

    /// Tries the next tick.
    fn step(&mut self, load: Load, scene: &Scene, truth: Option<&Truth>, budget: &Budget) -> Result<(), SceneErrors> {
        let (name, count) = (self.method.name, self.next);
        let tick = scene.duration / count as f64;
        let mut setting = Setting {
            method: name,
            tick,
            located: false,
            outcome: Outcome::Unknown,
            evaluations: 0.0,
            seconds: None,
            notes: Vec::new(),
        };
        let mut simulation = match load(Way::Flags(name, tick)) {
            Ok(simulation) => simulation,
            Err(errors) => {
                let why = errors.errors().first().map_or_else(String::new, |error| error.message.clone());
                setting.outcome = Outcome::Refused(why);
                self.settings.push(setting);
                return Ok(());
            }
        };
        setting.located = simulation.world().get_resource::<ChosenMethod>().is_some_and(|method| method.located);
        let stride = (count / scene.moments).max(1);
        let (spent, seen) = timed(|| Trajectory::while_it(&mut simulation, stride, &|| budget.within(1.0)));
        let spent = spent.as_secs_f64();
        self.last = Some((spent, count));
        self.next = next_after(count, scene.moments);
        let card = simulation.card();
        if let Some(critical) = card.critical_tick.filter(|critical| *critical < tick) {
            setting.notes.push(if critical > 0.0 {
                format!("tick beyond the critical one of {} s", number(critical))
            } else {
                "never stable without losses".to_owned()
            });
        }
        if let Some(given_up) = simulation.world().get_resource::<LocatedEvents>().map(|events| events.given_up)
            && given_up > 0
        {
            setting.notes.push(format!("{given_up} of {count} ticks with too many events to locate them"));
        }
        match seen {
            Err(share) => setting.outcome = Outcome::Stopped(share),
            Ok(Trajectory { failure: Some(failure), evaluations, .. }) => {
                setting.evaluations = evaluations as f64 / failure.time.max(tick);
                setting.seconds = Some(spent / failure.time.max(tick));
                setting.outcome = Outcome::Failed(failure);
                self.failures += 1;
            }
            Ok(run) => {
                self.failures = 0;
                setting.evaluations = run.evaluations as f64 / scene.duration;
                if let Some(truth) = truth {
                    let every = (scene.moments / count).max(1) as usize;
                    let apart = run
                        .part(truth.about.until, 1)
                        .apart_by(&truth.run.part(truth.about.until, every), &truth.measures);
                    setting.outcome = Outcome::Measured(apart.into());
                }
                let least = timing::least(load, (name, tick), budget, spent)?;
                if least.is_none() {
                    setting.notes.push("timed while it was compared".to_owned());
                }
                setting.seconds = Some(least.unwrap_or(spent) / scene.duration);
            }
        }
        self.settings.push(setting);
        Ok(())
    }

    /// Why it should go no further.
    fn reason_to_end(&self, order: &Order, truth: Option<&Truth>, budget: &Budget) -> Option<String> {
        let last = self.settings.last()?;
        let error = match &last.outcome {
            Outcome::Refused(_) => return Some("it cannot run this scene".to_owned()),
            Outcome::Stopped(_) => return Some("the budget is used up".to_owned()),
            Outcome::Failed(_) if self.failures >= MOST_FAILURES => return Some("all its runs go wrong".to_owned()),
            Outcome::Failed(_) => f64::INFINITY,
            Outcome::Unknown if self.settings.len() >= SEEN => return Some("there is no reference run".to_owned()),
            Outcome::Unknown => f64::INFINITY,
            Outcome::Measured(deviation) => deviation.share,
        };
        if let Some(truth) = truth.filter(|truth| error <= truth.about.claim()) {
            return Some(format!("its error is that of the reference run, {:.0e}, or less", truth.about.floor));
        }
        let before = self.settings.iter().rev().map_while(Setting::error).take(3).collect::<Vec<_>>();
        if let [now, once, twice] = before[..]
            && twice < ROUNDING
            && now > 0.5 * once
            && once > 0.5 * twice
        {
            return Some("its errors fall no more: rounding".to_owned());
        }
        if self.settings.len() >= order.rungs {
            return Some(format!("{} ticks were tried, as many as asked for", order.rungs));
        }
        let (spent, count) = self.last?;
        // It is run once to be compared, and timed.
        let runs = if last.seconds.is_some() && self.failures == 0 { 2.0 } else { 1.0 };
        let next = spent * self.next as f64 / count as f64;
        (next * runs > budget.left())
            .then(|| format!("the next finer tick would take {} s a run", number(rounded(next))))
    }
}

/// Two digits are enough of what is foretold.
fn rounded(value: f64) -> f64 {
    format!("{value:.1e}").parse().unwrap_or(value)
}

/// The number of ticks that comes after a number of them.
fn next_after(count: u64, moments: u64) -> u64 {
    let coarse = COARSE.into_iter().filter(|next| moments.is_multiple_of(*next) && *next < moments);
    coarse.chain([moments]).find(|next| *next > count).unwrap_or(2 * count)
}
