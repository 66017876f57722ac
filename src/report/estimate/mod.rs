//! Error estimation by Richardson extrapolation: the run is repeated with finer steps (`twins.rs`). The difference
//! gives the distance of the first run from the exact solution. Sources: Richardson 1911; Hairer, Norsett, Wanner,
//! *Solving Ordinary Differential Equations I*, 1993, II.4. If that is expensive, only the beginning is repeated, and
//! the rest has no estimate.
//!
//! Rounding is estimated by runs with disturbed last bits. The error of soft contacts is estimated by a run with
//! stiffer ones.

mod growth;
mod model_error;
mod other_kind;
mod rounding;
mod twins;
pub mod validation;
mod wedged;
mod work;

use bevy_ecs::prelude::*;

use growth::{Growth, Seen};
use jostle_engine::Simulation;
use jostle_engine::integrate::ChosenMethod;
use jostle_engine::integrate::Methods;
use jostle_engine::scene::SceneErrors;
use jostle_engine::simulation::accuracy::trajectory::Trajectory;
use jostle_engine::simulation::error::{ErrorEstimate, ErrorParts, KnownError};
use jostle_engine::simulation::{Overrides, Plan};
use jostle_engine::tick::{STANDS, State, stands};
use jostle_language::numbers::{number, percent};
pub use other_kind::Elsewhere;
use twins::{Finer, Told};
use work::{Patience, SHARE};

/// Moments at which runs are compared, spread over the run, and numbers that are kept of them.
const EVEN: u64 = 4096;
const MOST_NUMBERS: u64 = 6_000_000;
/// Its multiples are spread evenly over whatever they are taken modulo.
const GOLDEN: f64 = 0.618_033_988_749_894_9;
/// Share of the motion from which positions count as wrong.
const PARTED: f64 = 1e-2;
/// Fewer moments show no growth.
const FEWEST_MOMENTS: usize = 4;

/// How much work an estimate may take.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Effort {
    /// None: no estimate.
    None,
    /// Three hundredths of the work of the run, or about half a second if that is more. A second is allowed if it
    /// suffices for the whole run.
    #[default]
    Little,
    /// All useful runs: with half and with a quarter of the tick, which show the order too.
    Full,
}

/// The requested estimate of a run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct EstimateRequest {
    /// Work for the error that the finite tick makes.
    pub effort: Effort,
    /// Whether the error of finite digits is wanted: three runs more.
    pub rounding: bool,
    /// Whether the error of soft contacts is wanted: a run more, with four times the stiffness.
    pub model: bool,
}

/// The estimated error of a run whose steps were chosen otherwise.
#[derive(Resource, Clone, Debug, Default)]
pub struct EstimatedError {
    /// The error; `None` if it could not be estimated.
    pub estimate: Option<ErrorEstimate>,
    /// The same as a share of how far bodies go.
    pub share: Option<f64>,
    /// The body whose places first differed by a hundredth of the motion, and when, in s.
    pub began: Option<(String, f64)>,
    /// Whether the error grew exponentially.
    pub chaotic: bool,
    /// The time in s until which the run was repeated, if not to its end. The rest is unknown.
    pub known_until: Option<f64>,
    /// The time in s from which stiffer contacts lead elsewhere. The error of the model holds until then.
    pub model_until: Option<f64>,
    /// The departure of runs of the other kind, if they go farther than both errors explain.
    pub elsewhere: Option<Elsewhere>,
    /// The way in metres, in a finer run, of bodies that rest in this one. `None`: their springs give as much.
    pub restless: Option<f64>,
    /// The greatest error that runs with other steps do not tell, if it is more than they do.
    pub raised: Option<RaisedError>,
    /// The failure of a run with finer steps.
    pub failed: Option<String>,
    /// Further notes on it.
    pub notes: Vec<String>,
}

/// An error that runs with other steps share, so that their difference does not tell it.
#[derive(Clone, Debug, PartialEq)]
pub struct RaisedError {
    /// In metres.
    pub distance: f64,
    /// As a share of how far bodies go; infinite if they stand.
    pub share: f64,
    /// Its reason: a sentence without its full stop.
    pub why: String,
}

/// An error, as a share of the ways of bodies, at which a tick with located events is good.
const SMALL: f64 = 1e-2;

impl EstimatedError {
    /// Raises the error of finite steps to at least `distance` metres and `speed` m/s, for the reason `why`. Bodies go as far as
    /// `motion` metres. Returns whether the error of places was smaller, and known.
    fn raise(&mut self, (distance, speed): (f64, f64), motion: f64, why: impl FnOnce() -> String) -> bool {
        let Some(error) = &mut self.estimate else { return false };
        let most = |part: &mut Option<f64>, value: f64| {
            let smaller = part.is_some_and(|old| old < value);
            *part = part.map(|old| old.max(value));
            smaller
        };
        most(&mut error.velocity.discretisation, speed);
        let raised = most(&mut error.position.discretisation, distance);
        if raised {
            let raised = distance / motion;
            if self.raised.as_ref().is_none_or(|old| old.share < raised) {
                self.raised = Some(RaisedError { distance, share: raised, why: why() });
            }
            self.share = self.share.map(|share| share.max(raised));
        }
        raised
    }

    /// The reason why a tolerance is not reached whose runs agree: they share an error that is larger. A run of the other kind that
    /// contradicts them tells its own.
    pub fn beyond_tolerance(world: &World) -> Option<String> {
        let found = world.get_resource::<Self>()?;
        let (tolerance, raised) = world.get_resource::<KnownError>()?.tolerance.zip(found.raised.as_ref())?;
        let RaisedError { distance, share, why } = raised;
        (*share > tolerance && found.elsewhere.is_none()).then(|| {
            let tolerance = number(tolerance);
            let size = match share.is_finite() {
                true => format!("{} of how far bodies go", percent(*share)),
                false => format!("{} m, and bodies stand", number(*distance)),
            };
            format!("the tolerance of {tolerance} is not reached: all runs share an error of {size}. {why}")
        })
    }

    /// Whether events are located and the error of the whole run is known to be small. Then no rule of thumb calls its
    /// tick too long.
    pub fn is_small(world: &World) -> bool {
        let located = world.get_resource::<ChosenMethod>().is_some_and(|method| method.located);
        let rests = |found: &Self| found.restless.is_none() && stands(world.resource());
        let is_small = |found: &Self| found.share.map_or_else(|| rests(found), |share| share < SMALL);
        let small = |found: &Self| found.known_until.is_none() && is_small(found);
        located && world.get_resource::<Self>().is_some_and(small)
    }
}

/// A scene that can be run again.
pub struct Repeated<'a> {
    /// The overrides of its first run.
    pub overrides: &'a Overrides,
    /// Gives it at its beginning.
    pub load: &'a dyn Fn(&Overrides) -> Result<Simulation, SceneErrors>,
    /// Told of each further run.
    pub tell: Option<fn(&str)>,
    /// Asked now and then whether the user wants no more of them.
    pub interrupted: Option<fn() -> bool>,
}

impl Repeated<'_> {
    /// Whether further runs are to end.
    fn is_interrupted(&self) -> bool {
        self.interrupted.is_some_and(|asked| asked())
    }

    /// The scene at its beginning, to be run by another plan for as long as `first`. Contacts are stiffer by the factor
    /// `stiffness`.
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
pub fn watch(simulation: &mut Simulation, wanted: EstimateRequest) {
    let known = simulation.contains_resource::<KnownError>();
    let told = known && !other_kind::loads_change(simulation);
    if wanted.rounding || wanted.model || (wanted.effort != Effort::None && !told) {
        let moments = moments(simulation);
        Trajectory::watch(simulation, moments);
    }
}

/// Ticks at which runs are compared. Half of them are spread over the whole run. A quarter are in the part for which a
/// share of the work suffices. A quarter are at equal ratios, of which the first are early. Their distances differ, so
/// that no swing looks the same at all of them.
fn moments(simulation: &Simulation) -> Vec<u64> {
    let cycles = twins::cycles_of(simulation).map(u64::from);
    moments_of(simulation.ticks(), simulation.bodies().len() as u64, cycles)
}

/// The same for a run of so many ticks of so many bodies, at multiples of either of the `cycles`.
fn moments_of(ticks: u64, bodies: u64, cycles: [u64; 2]) -> Vec<u64> {
    let most = (MOST_NUMBERS / (6 * bodies.max(1))).min(2 * EVEN);
    let (even, scales) = (most / 2, most / 4);
    let until = |part: f64, many: u64| {
        (1..=many).map(move |place| {
            let place = place as f64 - (place as f64 * GOLDEN).fract();
            (part * ticks as f64 * place / many as f64) as u64
        })
    };
    let evenly = until(1.0, even).chain(until(SHARE / 2.0, scales));
    let growing = (1..=scales).map(|place| libm::pow(ticks as f64, place as f64 / scales as f64) as u64);
    let whole = |tick: u64| cycles.map(|cycle| tick / cycle * cycle);
    let all = growing.chain(evenly).chain([ticks]).flat_map(whole);
    let mut all: Vec<u64> = all.filter(|tick| (1..=ticks).contains(tick)).collect();
    all.sort_unstable();
    all.dedup();
    all
}

/// Estimates the error of a run that was watched and is over; the card shows it from then on.
///
/// # Errors
/// Those of reading the scene again.
pub fn estimate(simulation: &mut Simulation, wanted: EstimateRequest, scene: &Repeated) -> Result<(), SceneErrors> {
    if wanted == (EstimateRequest { effort: Effort::None, ..EstimateRequest::default() }) {
        return Ok(());
    }
    let run = Trajectory::watched(simulation, None);
    let known = KnownError::of(simulation.unpublished_world()).and_then(|known| known.estimate);
    let mut found = EstimatedError { estimate: known, ..EstimatedError::default() };
    if known.is_none() && wanted.effort != Effort::None && simulation.clock().ticks > 0 {
        discretisation(simulation, &run, wanted.effort, scene, &mut found)?;
    }
    wedged::add(simulation, &run, &mut found);
    other_kind::check(simulation, &run, wanted.effort, scene, &mut found)?;
    if wanted.rounding {
        rounding::estimate(simulation, &run, scene, &mut found)?;
    }
    if wanted.model {
        model_error::estimate(simulation, &run, scene, &mut found)?;
    }
    simulation.world_mut().insert_resource(found);
    Ok(())
}

/// The order with which errors are expected to fall: jumps of forces that are not located leave one.
fn expected_order(simulation: &Simulation) -> f64 {
    let world = simulation.unpublished_world();
    let Some(chosen) = world.get_resource::<ChosenMethod>() else { return 1.0 };
    if touches(simulation) && !chosen.located {
        return 1.0;
    }
    let method = world.get_resource::<Methods>().and_then(|methods| methods.named(chosen.name));
    method.map_or(1.0, |method| f64::from(method.order))
}

/// Whether anything has touched in a run.
fn touches(simulation: &Simulation) -> bool {
    simulation.resource::<State>().deepest_overlap().in_meters.overlap > 0.0
}

/// The error that finite steps make.
fn discretisation(
    simulation: &Simulation,
    run: &Trajectory,
    effort: Effort,
    scene: &Repeated,
    found: &mut EstimatedError,
) -> Result<(), SceneErrors> {
    let ticks = simulation.clock().ticks;
    let twins = twins::of(simulation);
    let part = if effort == Effort::Full { 1.0 } else { work::affordable(simulation, twins::work(&twins)) };
    let until = (part * ticks as f64) as u64;
    let seen = moments(simulation).iter().filter(|tick| **tick <= until).count();
    if seen < FEWEST_MOMENTS.min(ticks as usize) {
        let part = SHARE * 100.0;
        found.notes.push(format!(
            "the error is not estimated: {part:.0} % of the work tell too little. --estimate takes more"
        ));
        return Ok(());
    }
    let patience = |finer: Finer| (effort != Effort::Full).then(|| Patience::of(simulation, part, finer.work()));
    let (mut told, mut order) = (Told::default(), expected_order(simulation));
    let (motion, mut observed) = (run.sizes().0, None);
    let (gives, at_rest) = (gives(simulation.resource()), stands(simulation.resource()));
    // Bodies that stand on springs go less far than these give. A share of that little way is no loss of their places.
    let ways = if at_rest { motion } else { motion.max(gives) };
    if effort == Effort::Full {
        observed = observed_order(simulation, run, until, scene)?;
        order = observed.unwrap_or(order).clamp(0.5, order.max(1.0));
    }
    let mut first_twin = None;
    for (number, &finer) in twins.iter().enumerate() {
        let (mut finer, mut made) = (finer, None);
        if finer.located {
            made = twins::run_located(simulation, (finer, until), patience(finer), scene);
            finer = if made.is_some() { finer } else { twins::second_by_ticks(simulation) };
        }
        if made.is_none() {
            made = twins::run(simulation, (finer, until), patience(finer), scene)?;
        }
        let Some((twin, second)) = made else {
            found.began = None;
            found.notes.push("the error is not estimated: that takes long. --estimate takes the time".to_owned());
            return Ok(());
        };
        if let Some(failure) = &twin.failure {
            found.notes.push(format!("the error is not estimated: with finer steps {failure}"));
            found.failed = Some(failure.to_string());
            return Ok(());
        }
        let run = &run.at(|time| finer.ends_with((time / simulation.clock().dt).round() as u64));
        if found.began.is_none() {
            let began = run.first_apart(&twin, PARTED * ways / finer.left(order));
            found.began = began.map(|(body, time)| (simulation.name(body).to_owned(), time));
        }
        if until < ticks && number == 0 {
            first_twin = Some(second);
        }
        told.add(finer, order, Seen::between(run, &twin), ways);
    }
    // Only if no twin took too long or failed: there is an estimate of the part then.
    if let Some(twin) = first_twin {
        tell_part(simulation, &twin, until, found);
    }
    if motion < gives {
        told.share = None;
    }
    if at_rest {
        // Bodies at rest go nowhere, so no difference is a share of their way. Springs that give make some of it.
        found.restless = Some(told.distance).filter(|distance| *distance > gives);
        (told.share, told.chaotic, told.horizon, found.began) = (None, false, None, None);
    }
    let known = |error: f64| ErrorParts {
        discretisation: told.horizon.is_none_or(|horizon| horizon > 0.0).then_some(error),
        ..Default::default()
    };
    (found.share, found.chaotic) = (told.share, told.chaotic);
    found.estimate = Some(ErrorEstimate {
        position: known(told.distance),
        velocity: known(told.speed),
        observed_order: observed,
        horizon: told.horizon.or(found.known_until),
    });
    Ok(())
}

/// The way in metres by which the springs of contacts give, at least that of rounding.
fn gives(state: &State) -> f64 {
    let rounding = STANDS * state.bodies().smallest_radius;
    state.deepest_overlap().in_meters.overlap.max(if rounding.is_finite() { rounding } else { 0.0 })
}

/// Notes of a run whose beginning alone was repeated, for its twin at its end.
fn tell_part(simulation: &Simulation, second: &Simulation, until: u64, found: &mut EstimatedError) {
    let last = moments(simulation).into_iter().rfind(|tick| *tick <= until).unwrap_or_default();
    let known = simulation.clock().time_of(last);
    let (told, all) = (number(known), number(simulation.clock().time()));
    let untouched = if touches(simulation) && !touches(second) { ", in which no bodies touch" } else { "" };
    found.known_until = Some(known);
    found.notes.push(format!(
        "the error is that of the first {told} s of {all} s. Finer runs cover only these{untouched}. With --estimate they \
         cover all"
    ));
}

/// The order with which the error falls, from a half and a quarter of the tick. `None` if it does not fall.
fn observed_order(
    simulation: &Simulation,
    run: &Trajectory,
    until: u64,
    scene: &Repeated,
) -> Result<Option<f64>, SceneErrors> {
    let quarter = Finer { ticks: 4, ..Finer::SAME };
    let Some((half, _)) = twins::run(simulation, (Finer::HALF, until), None, scene)? else { return Ok(None) };
    let Some((quarter, _)) = twins::run(simulation, (quarter, until), None, scene)? else { return Ok(None) };
    if half.failure.is_some() || quarter.failure.is_some() {
        return Ok(None);
    }
    let motion = run.sizes().0;
    let [coarse, fine] = [(run, &half), (&half, &quarter)].map(|(a, b)| Growth::of(Seen::between(a, b), motion));
    Ok(coarse.order_against(&fine))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runs_are_compared_at_their_end_and_at_all_scales_of_time() {
        let all = moments_of(20_000, 3, [1, 1]);
        assert_eq!(all.last(), Some(&20_000));
        assert!(all.windows(2).all(|pair| pair[0] < pair[1]));
        let early = |until: u64| all.iter().filter(|tick| **tick <= until).count();
        assert!(all[0] == 1 && early(200) > 30 && early(300) > 40 && all.len() as u64 <= 2 * EVEN, "{all:?}");
        assert!(moments_of(7, 1, [1, 1]).contains(&1) && moments_of(1, 1, [1, 1]) == [1]);
    }

    #[test]
    fn many_bodies_are_compared_less_often() {
        assert!(
            (5..=10).contains(&moments_of(20_000, 100_000, [1, 1]).len()),
            "{:?}",
            moments_of(20_000, 100_000, [1, 1])
        );
        assert_eq!(moments_of(20_000, 10_000_000, [1, 1]), [20_000]);
    }
}
