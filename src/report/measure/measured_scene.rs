//! A scene in a work-precision series: its properties before any run, its ticks, and the comparison with the reference.

use crate::SimulationExt;
use std::f64::consts::PI;

use super::reference::{self, Truth};
use super::{Load, Way};
use crate::work_precision::{Budget, Deviation, MethodChoice, Rungs, Setting, SettingOutcome, Subject, least, timed};
use jostle_engine::integrate::ChosenMethod;
use jostle_engine::integrate::{Description, Methods};
use jostle_engine::scene::SceneErrors;
use jostle_engine::simulation::accuracy::trajectory::Trajectory;
use jostle_engine::tick::State;
use jostle_language::numbers::number;

/// The sequence of ticks begins at this multiple of the critical tick, if there is one. Longer ticks are expected to fail. If they
/// do not, because contacts are brief or their forces hardly change, longer ones are tried.
const BEYOND_CRITICAL: f64 = 2.0;
/// The replacement for the limit of methods that have none, or are never stable without losses.
const USUAL_LIMIT: f64 = 2.0;
/// The run has at least so many ticks.
const FEWEST_TICKS: f64 = 5.0;
/// Parts of a hundred moments, each about twice as fine as the one before.
const COARSE: [u64; 6] = [1, 2, 5, 10, 20, 50];
/// The number of times that ticks are halved at the most.
const HALVINGS: u32 = 40;
/// Bounds of the exponent: a run has the compared moments times two to this power.
const FEWEST_MOMENTS: u32 = 4;
const MOST_MOMENTS: u32 = 8;
/// Moments in half a swing of the fastest contact, spring or drive.
const MOMENTS_A_SWING: f64 = 8.0;
/// Numbers that are kept of a run.
const MOST_NUMBERS: u64 = 4_000_000;
/// Beyond so many bodies fewer moments are kept.
const MANY_BODIES: usize = 6000;

/// The properties of the scene before any run.
pub(super) struct Scene {
    pub duration: f64,
    /// The fastest frequency of contacts and springs in rad/s, if there are any.
    pub fastest: Option<f64>,
    /// Ticks of the coarsest sequence that runs have in common.
    pub moments: u64,
    /// Moments at which runs are compared, as far as they have them. Each of the others has a power of two of them, so
    /// that no swing looks like rest.
    pub seen: u64,
    pub methods: Methods,
}

impl Scene {
    /// Looks at the scene. Its own tick does not matter, so one that divides whatever run it has is tried.
    pub fn look(load: Load) -> Result<Self, SceneErrors> {
        let probe = |tick| load(Way::Plan(&reference::located(tick, 1.0, tick)));
        let simulation = probe(1e-3).or_else(|wrong| probe(1e-9).or_else(|_| probe(1e3)).map_err(|_| wrong))?;
        let world = simulation.unpublished_world();
        let (duration, bodies) = (simulation.duration(), simulation.bodies().len());
        let fastest = world.resource::<State>().stability().fastest_foreseen().map(|fastest| fastest.angular_frequency);
        let rhythms = world.resource::<State>().models().filter_map(|model| model.rhythm());
        let rhythms = rhythms.map(|rhythm| rhythm.angular_frequency);
        let swings = rhythms.chain(fastest).fold(0.0, f64::max) * duration / PI;
        let moments = if bodies > MANY_BODIES { 10 } else { 100 };
        let fine = |power: &u32| (moments << power) as f64 >= MOMENTS_A_SWING * swings;
        let power = (FEWEST_MOMENTS..MOST_MOMENTS).find(fine).unwrap_or(MOST_MOMENTS);
        let kept = (0..=power).rev().find(|power| (moments << power) * 6 * bodies as u64 <= MOST_NUMBERS);
        Ok(Self {
            duration,
            fastest,
            moments,
            seen: moments << kept.unwrap_or(0),
            methods: Methods(world.resource::<Methods>().0.clone()),
        })
    }

    /// The ticks of a method: the run over the moments times or divided by a power of two.
    pub fn rungs(&self, method: &Description, truth: Option<&Truth>) -> Rungs<impl Iterator<Item = f64> + use<>> {
        let limit = method.stability_limit;
        let limit = if limit.is_finite() && limit > 0.0 { limit } else { USUAL_LIMIT };
        let critical = self.fastest.map_or(f64::INFINITY, |fastest| BEYOND_CRITICAL * limit / fastest);
        // A tick longer than the time that is compared would be seen nowhere.
        let until = truth.map_or(f64::INFINITY, |truth| truth.about.until);
        let (moments, duration) = (self.moments, self.duration);
        let coarse = COARSE.into_iter().filter(move |count| moments.is_multiple_of(*count) && *count < moments);
        let fine = (0..HALVINGS).map(move |power| moments << power);
        let least = |longest: f64| (duration / longest).max(FEWEST_TICKS) * (1.0 - 1e-9);
        let (fewest, stable) = (least(until), least(critical.min(until)));
        let tick = move |count: u64| duration / count as f64;
        let counts = coarse.chain(fine);
        let trials =
            counts.clone().filter(|count| *count as f64 >= fewest).take_while(|count| (*count as f64) < stable);
        // Without a reference their use cannot be decided.
        let mut trials: Vec<f64> = trials.filter(|_| truth.is_some()).map(tick).collect();
        trials.reverse();
        Rungs { ticks: counts.skip_while(move |count| (*count as f64) < stable).map(tick), trials }
    }
}

impl Scene {
    /// A count of ticks that is not less, and has enough moments in common with the reference.
    pub fn comparable(&self, count: u64) -> u64 {
        let common = if count >= self.moments { self.moments / 4 } else { self.moments / 20 };
        count.next_multiple_of(common.max(1))
    }

    /// The numbers of ticks of a run of `count`, and of moments, between two that both have.
    fn strides(&self, count: u64) -> (u64, u64) {
        let (mut common, mut rest) = (count, self.seen);
        while rest > 0 {
            (common, rest) = (rest, common % rest);
        }
        (count / common, self.seen / common)
    }
}

/// A scene with its reference run, if there is one.
pub(super) struct Compared<'a> {
    pub load: Load<'a>,
    pub scene: &'a Scene,
    pub truth: Option<&'a Truth>,
    pub budget: &'a Budget<'a>,
}

impl Subject for Compared<'_> {
    type Wrong = SceneErrors;

    fn run(&self, course: MethodChoice, tick: f64) -> Result<(Setting, f64), SceneErrors> {
        let Self { load, scene, truth, budget } = self;
        let count = (scene.duration / tick).round() as u64;
        let mut setting = Setting::new(course, tick);
        let mut simulation = match load(Way::Flags(course.method, tick)) {
            Ok(simulation) => simulation,
            Err(errors) => {
                let why = errors.errors().first().map_or_else(String::new, |error| error.message.clone());
                setting.outcome = SettingOutcome::Refused(why);
                return Ok((setting, 0.0));
            }
        };
        setting.located = simulation.get_resource::<ChosenMethod>().is_some_and(|method| method.located);
        let (stride, every) = scene.strides(count);
        let (spent, seen) = timed(|| Trajectory::while_it(&mut simulation, stride, &|| budget.within(1.0)));
        let spent = spent.as_secs_f64();
        let card = simulation.card();
        if let Some(critical) = card.critical_tick.filter(|critical| *critical < tick) {
            setting.notes.push(if critical > 0.0 {
                format!("tick beyond the critical one of {} s", number(critical))
            } else {
                "never stable without losses".to_owned()
            });
        }
        let given_up = simulation.resource::<State>().located().given_up;
        if given_up > 0 {
            setting.notes.push(format!("{given_up} of {count} ticks with too many events to locate them"));
        }
        match seen {
            Err(share) => setting.outcome = SettingOutcome::Stopped(share),
            Ok(Trajectory { failure: Some(failure), evaluations, .. }) => {
                setting.evaluations = evaluations as f64 / failure.time.max(tick);
                setting.seconds = Some(spent / failure.time.max(tick));
                setting.outcome = SettingOutcome::Failed(failure);
            }
            Ok(run) => {
                setting.evaluations = run.evaluations as f64 / scene.duration;
                if let Some(truth) = truth {
                    let apart = run
                        .part(truth.about.until, 1)
                        .apart_by(&truth.run.part(truth.about.until, every as usize), &truth.measures);
                    let deviation = Deviation { error: apart.share, apart: Some((apart.distance, apart.speed)) };
                    setting.outcome = SettingOutcome::Measured(deviation);
                    let beyond = truth.beyond.as_ref().and_then(|beyond| beyond.compare(&run));
                    setting.notes.extend(beyond.map(|apart| format!("beyond: {}", apart.words())));
                }
                let least = least(|| load(Way::Flags(course.method, tick)), budget.left(), spent)?;
                if least.is_none() {
                    setting.notes.push("timed while it was compared".to_owned());
                }
                setting.seconds = Some(least.unwrap_or(spent) / scene.duration);
            }
        }
        Ok((setting, spent))
    }

    fn is_floor(&self, error: f64, _: f64) -> Option<String> {
        let truth = self.truth.filter(|truth| error <= truth.about.claim())?;
        Some(format!("its error is that of the reference run, {:.0e}, or less", truth.about.floor))
    }
}
