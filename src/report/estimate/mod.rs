//! The error of a run, estimated by the engine itself: the run is made again with half the tick, and what the two differ by
//! tells how far the first is from the exact solution (Richardson 1911; Hairer, Norsett, Wanner, *Solving Ordinary Differential
//! Equations I*, 1993, II.4). Where that is dear only the beginning is made again, and nothing is said of the rest.
//!
//! Rounding is estimated by runs whose last bits are wrong, the error of soft contacts by a run with stiffer ones.

pub mod check;
mod growth;
mod model;
mod rounding;

use std::time::{Duration, Instant};

use bevy_ecs::prelude::*;

use super::accuracy::trajectory::Trajectory;
use super::card::{ErrorEstimate, ErrorParts, KnownError, number};
use crate::Simulation;
use crate::contacts::{ContactLaw, DeepestOverlap};
use crate::integrate::{Methods, Pace};
use crate::report::card::ChosenMethod;
use crate::scene::SceneErrors;
use crate::simulation::{Overrides, Plan};
use crate::tick::Evaluation;
use growth::{Growth, Seen};

/// Work that an estimate may take where nothing more is asked for: this share of that of the run.
const SHARE: f64 = 0.03;
/// ... or this many evaluations of the forces of a world without atoms, about a twentieth of a second, if that is more...
const FREE: f64 = 5e4;
/// ... or three times as many, where that suffices for the whole run.
const WHOLE: f64 = 1.5e5;
/// Work of an evaluation for each atom, over what each evaluation takes whatever there is, and of reading a scene.
const PER_ATOM: f64 = 0.04;
const READING: f64 = 8.0;
/// Moments at which runs are compared, spread evenly, and numbers that are kept of them.
const EVEN: u64 = 64;
const MOST_NUMBERS: u64 = 6_000_000;
/// Share of the motion from which on two runs have parted.
const PARTED: f64 = 1e-2;
/// Parts of a run between which it is seen whether it takes too long.
const CHUNKS: u64 = 64;
/// Fewer tell no growth.
const FEWEST_MOMENTS: usize = 4;

/// How much work an estimate may take.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Effort {
    /// None: nothing is estimated.
    None,
    /// A share of three in a hundred of the run; a twentieth of a second if that is more, and three times as much where that
    /// suffices for the whole run.
    #[default]
    Little,
    /// All that helps: runs with half and with a quarter of the tick, which tell the order too.
    Full,
}

/// What is to be estimated of a run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Wanted {
    /// Work for the error that the finite tick makes.
    pub effort: Effort,
    /// Whether the error of finite digits is wanted: three runs more.
    pub rounding: bool,
    /// Whether the error of soft contacts is wanted: a run more, with four times the stiffness.
    pub model: bool,
}

/// What the engine estimated of the error of a run whose steps were chosen otherwise.
#[derive(Resource, Clone, Debug, Default)]
pub struct EstimatedError {
    /// The error; nothing, if it could not be estimated.
    pub estimate: Option<ErrorEstimate>,
    /// The same as a share of how far bodies go.
    pub share: Option<f64>,
    /// The body whose places first differed by a hundredth of the motion, and when, in s.
    pub began: Option<(String, f64)>,
    /// Whether the error grew exponentially.
    pub chaotic: bool,
    /// Until when the run was made again, in s, if not to its end: nothing is known of the rest.
    pub known_until: Option<f64>,
    /// What else is to be known of it.
    pub notes: Vec<String>,
}

/// An error, as a share of how far bodies go, with which nothing is wrong with a tick whose events are located.
const SMALL: f64 = 1e-2;

impl EstimatedError {
    /// Whether events are located and the error of the whole run is known to be small: then no rule of thumb says that its tick is
    /// too long.
    pub fn is_small(world: &World) -> bool {
        let located = world.get_resource::<ChosenMethod>().is_some_and(|method| method.located);
        let small = |found: &Self| found.known_until.is_none() && found.share.is_some_and(|share| share < SMALL);
        located && world.get_resource::<Self>().is_some_and(small)
    }
}

/// A scene that can be run again.
pub struct Repeated<'a> {
    /// What was asked of its first run beside the scene.
    pub overrides: &'a Overrides,
    /// Gives it at its beginning.
    pub load: &'a dyn Fn(&Overrides) -> Result<Simulation, SceneErrors>,
    /// Told of each further run.
    pub tell: Option<fn(&str)>,
}

impl Repeated<'_> {
    /// The scene at its beginning, to be run by another plan for as long as `first`, with contacts so many times as stiff.
    fn again(&self, first: &Simulation, plan: Plan, stiffness: f64, what: &str) -> Result<Simulation, SceneErrors> {
        if let Some(tell) = self.tell {
            tell(what);
        }
        let duration = Some(first.duration());
        let plan = Some(Plan { notes: Vec::new(), ..plan });
        let stiffness = Some(stiffness * self.overrides.stiffness.unwrap_or(1.0));
        let overrides =
            Overrides { plan, duration, stiffness, layers: Some(Vec::new()), tell: None, ..self.overrides.clone() };
        (self.load)(&overrides)
    }
}

/// Makes ready to estimate the error of a run that is at its beginning: some of its states are kept.
pub fn watch(simulation: &mut Simulation, wanted: Wanted) {
    let known = simulation.world().contains_resource::<KnownError>();
    if wanted.rounding || wanted.model || (wanted.effort != Effort::None && !known) {
        let moments = moments(simulation.ticks(), simulation.bodies().len() as u64);
        Trajectory::watch(simulation, moments);
    }
}

/// Ticks at which runs are compared: evenly spread ones, half as many in the part that a share of the work suffices for, and as many
/// at equal ratios, of which the first are early.
fn moments(ticks: u64, bodies: u64) -> Vec<u64> {
    let most = (MOST_NUMBERS / (6 * bodies.max(1))).min(2 * EVEN);
    let (even, scales) = (most / 2, most / 4);
    let until =
        |part: f64, many: u64| (1..=many).map(move |place| (part * ticks as f64 * place as f64 / many as f64) as u64);
    let evenly = until(1.0, even).chain(until(SHARE / 2.0, scales));
    let growing = (1..=scales).map(|place| libm::pow(ticks as f64, place as f64 / scales as f64) as u64);
    let mut all: Vec<u64> = growing.chain(evenly).chain([ticks]).filter(|tick| (1..=ticks).contains(tick)).collect();
    all.sort_unstable();
    all.dedup();
    all
}

/// Estimates the error of a run that was watched and is over; the card shows it from then on.
///
/// # Errors
/// Those of reading the scene again.
pub fn estimate(simulation: &mut Simulation, wanted: Wanted, scene: &Repeated) -> Result<(), SceneErrors> {
    if wanted == (Wanted { effort: Effort::None, ..Wanted::default() }) {
        return Ok(());
    }
    let run = Trajectory::watched(simulation, None);
    let known = simulation.world().get_resource::<KnownError>().and_then(|known| known.estimate);
    let mut found = EstimatedError { estimate: known, ..EstimatedError::default() };
    if known.is_none() && wanted.effort != Effort::None && simulation.clock().ticks > 0 {
        discretisation(simulation, &run, wanted.effort, scene, &mut found)?;
    }
    if wanted.rounding {
        rounding::estimate(simulation, &run, scene, &mut found)?;
    }
    if wanted.model {
        model::estimate(simulation, &run, scene, &mut found)?;
    }
    simulation.world_mut().insert_resource(found);
    Ok(())
}

/// The work of a run so far, in evaluations of the forces of a world of one atom.
fn work(simulation: &Simulation) -> f64 {
    let evaluations = simulation.world().resource::<Evaluation>().count as f64;
    evaluations * (1.0 + PER_ATOM * simulation.bodies().atom_count() as f64)
}

/// The part of a run that can be run again with half the tick for little work.
fn affordable(simulation: &Simulation) -> f64 {
    let (work, reading) = (work(simulation), READING * simulation.bodies().atom_count() as f64);
    let whole = 2.0 * work;
    let least = if whole + reading <= WHOLE { WHOLE } else { FREE };
    ((least.max(SHARE * work) - reading) / whole).clamp(0.0, 1.0)
}

/// The plan of a run with its tick divided by `parts`.
fn finer(simulation: &Simulation, parts: u32) -> Option<Plan> {
    let plan = simulation.plan()?.clone();
    let tick = plan.tick / f64::from(parts);
    (plan.pace == Pace::Even(1)).then_some(Plan { tick, ..plan })
}

/// The order with which errors are expected to fall: jumps of forces that are not located leave one.
fn expected_order(simulation: &Simulation) -> f64 {
    let world = simulation.world();
    let chosen = world.resource::<ChosenMethod>();
    if world.contains_resource::<ContactLaw>() && !chosen.located {
        return 1.0;
    }
    world.resource::<Methods>().named(chosen.name).map_or(1.0, |method| f64::from(method.order))
}

/// Looks at another run at the moments of the first, until the end of its tick `until`; its ticks are divided by `parts`.
fn watch_beside(other: &mut Simulation, first: &Simulation, parts: u64, until: u64) {
    let all = moments(first.ticks(), first.bodies().len() as u64);
    Trajectory::watch(other, all.into_iter().filter(|tick| *tick <= until).map(|tick| tick * parts).collect());
}

/// Whether anything has touched in a run.
fn touches(simulation: &Simulation) -> bool {
    simulation.world().get_resource::<DeepestOverlap>().is_some_and(|deepest| deepest.overlap > 0.0)
}

/// Runs a twin with the tick divided by `parts` until the end of tick `until` of the first; nothing, if it has no such tick or takes
/// longer than there is patience.
fn twin(
    first: &Simulation,
    (parts, until): (u32, u64),
    patience: Option<Duration>,
    scene: &Repeated,
) -> Result<Option<(Trajectory, Simulation)>, SceneErrors> {
    let Some(plan) = finer(first, parts) else { return Ok(None) };
    let what = format!("once more with a tick of {} s, for its error", number(plan.tick));
    let mut twin = scene.again(first, plan, 1.0, &what)?;
    let parts = u64::from(parts);
    watch_beside(&mut twin, first, parts, until);
    let (begin, chunk) = (Instant::now(), (until * parts / CHUNKS).max(1));
    let mut failure = None;
    while failure.is_none() && twin.clock().ticks < until * parts {
        if patience.is_some_and(|patience| begin.elapsed() > patience) {
            return Ok(None);
        }
        failure = twin.run_to_tick((twin.clock().ticks + chunk).min(until * parts)).err();
    }
    Ok(Some((Trajectory::watched(&mut twin, failure), twin)))
}

/// The error that the finite tick makes.
fn discretisation(
    simulation: &Simulation,
    run: &Trajectory,
    effort: Effort,
    scene: &Repeated,
    found: &mut EstimatedError,
) -> Result<(), SceneErrors> {
    let ticks = simulation.clock().ticks;
    let part = if effort == Effort::Full { 1.0 } else { affordable(simulation) };
    let until = (part * ticks as f64) as u64;
    let bodies = simulation.bodies().len() as u64;
    let seen = moments(simulation.ticks(), bodies).iter().filter(|tick| **tick <= until).count();
    if seen < FEWEST_MOMENTS.min(ticks as usize) {
        let part = SHARE * 100.0;
        found.notes.push(format!(
            "the error is not estimated: {part:.0} % of the work tell too little; --estimate takes more"
        ));
        return Ok(());
    }
    let patience = (effort != Effort::Full).then(|| Duration::from_secs_f64(1.0 + 0.1 * simulation.seconds_spent()));
    let Some((half, second)) = twin(simulation, (2, until), patience, scene)? else {
        found.notes.push("the error is not estimated: that takes long; --estimate takes the time".to_owned());
        return Ok(());
    };
    if let Some(failure) = &half.failure {
        found.notes.push(format!("the error is not estimated: with half the tick {failure}"));
        return Ok(());
    }
    found.began =
        run.first_apart(&half, PARTED * run.sizes().0).map(|(body, time)| (simulation.name(body).to_owned(), time));
    let seen = Seen::between(run, &half);
    let growth = Growth::of(seen, run.sizes().0);
    if until < ticks {
        let (told, all) = (number(second.clock().time()), number(simulation.clock().time()));
        if touches(simulation) && !touches(&second) {
            found.notes.push(format!(
                "the error is not estimated: {:.0} % of the work tell of the first {told} s only, in which nothing touches; \
                 --estimate runs it all again",
                SHARE * 100.0
            ));
            return Ok(());
        }
        found.known_until = Some(second.clock().time());
        found.notes.push(format!(
            "the error is that of the first {told} s of {all} s, which were run again with half the tick; --estimate runs it all \
             again"
        ));
    }
    found.chaotic = growth.is_exponential();
    let mut order = expected_order(simulation);
    let mut observed = None;
    if effort == Effort::Full
        && let Some((quarter, _)) = twin(simulation, (4, until), None, scene)?
        && quarter.failure.is_none()
    {
        let finer = Growth::of(Seen::between(&half, &quarter), run.sizes().0);
        observed = growth.order_against(&finer);
        order = observed.unwrap_or(order).clamp(0.5, order.max(1.0));
    }
    let left = 1.0 / (1.0 - libm::exp2(-order));
    let part =
        |error: Option<f64>| ErrorParts { discretisation: error.map(|error| left * error), ..Default::default() };
    let useless = growth.horizon.is_some_and(|horizon| horizon <= 0.0);
    found.share = growth.share().map(|share| left * share);
    found.estimate = Some(ErrorEstimate {
        position: part(Some(growth.distance).filter(|_| !useless)),
        velocity: part(Some(growth.speed).filter(|_| !useless)),
        observed_order: observed,
        horizon: growth.horizon.or(found.known_until),
    });
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runs_are_compared_at_their_end_and_at_all_scales_of_time() {
        let all = moments(20_000, 3);
        assert_eq!(all.last(), Some(&20_000));
        assert!(all.windows(2).all(|pair| pair[0] < pair[1]));
        let early = |until: u64| all.iter().filter(|tick| **tick <= until).count();
        assert!(all[0] == 1 && early(200) > 30 && early(300) > 40 && all.len() as u64 <= 2 * EVEN, "{all:?}");
        assert!(moments(7, 1).contains(&1) && moments(1, 1) == [1]);
    }

    #[test]
    fn many_bodies_are_compared_less_often() {
        assert!((5..=10).contains(&moments(20_000, 100_000).len()), "{:?}", moments(20_000, 100_000));
        assert_eq!(moments(20_000, 10_000_000), [20_000]);
    }
}
