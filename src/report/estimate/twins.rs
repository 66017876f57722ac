//! Finer runs of the same scene, for Richardson extrapolation. A *twin* is a finer run that shares no step with the
//! first run.
//!
//! Two runs differ by the error of the coarser one, unless their errors are equal. If motion is smooth, one twin with
//! half the tick gives it. If forces jump, the error depends on the phase of the jumps in ticks or steps. Two runs may
//! meet the jumps at the same phase by chance. So two twins are made, and the larger difference counts. A twin with
//! half the tick meets every second jump at the same end of tick as the first run. So ticks of twins end elsewhere,
//! except for one in ten of the first run.
//!
//! The second twin of a run from tick to tick locates events, where that is possible. Finer runs of the same kind may repeat a
//! fault of the first. A spring that a coarse tick stops in one go is an example. `other_kind.rs` does the same for runs with
//! located events.

use super::growth::{Growth, Seen};
use super::work::{self, Patience, TooLong};
use super::{Repeated, moments, touches};
use jostle_engine::Simulation;
use jostle_engine::integrate::ChosenMethod;
use jostle_engine::integrate::{Detail, EventTiming, ORDER, StepPace};
use jostle_engine::scene::SceneErrors;
use jostle_engine::simulation::Plan;
use jostle_engine::simulation::accuracy::trajectory::Trajectory;
use jostle_engine::tick::{Model, State};
use jostle_language::numbers::number;

/// Upper bound of the first run's ticks between two ends that its twins share. Then the least number of shared ends.
const LONGEST_CYCLE: u64 = 10;
const FEWEST_CYCLES: u64 = 10;

/// How much finer a twin is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Finer {
    /// This many of its ticks...
    pub ticks: u32,
    /// ... are as long as so many of the first run. They have no factor in common.
    pub of: u32,
    /// Equal parts of each step, and parts of the angle over which contacts swing in one.
    pub parts: u32,
    /// Whether a method with located events makes it, unlike the first run.
    pub located: bool,
    /// The share of the allowed error, where the length of steps follows from it.
    pub allowed: f64,
}

/// The method of twins with located events in place of velocity Verlet. A step takes so many evaluations: four stages,
/// and a look for events.
const LOCATED: &str = "RungeKutta4";
const EVALUATIONS: f64 = 5.0;

impl Finer {
    /// The same run once more.
    pub const SAME: Self = Self { ticks: 1, of: 1, parts: 1, located: false, allowed: 1.0 };
    /// With half the tick.
    pub const HALF: Self = Self { ticks: 2, ..Self::SAME };
    /// By a method with located events. Its order is so much higher that ticks twice as long suffice.
    const LOCATED: Self = Self { of: 2, located: true, ..Self::SAME };
    /// The same for a run of so few ticks that half of them are no fair sample.
    const LOCATED_AT_EACH: Self = Self { of: 1, ..Self::LOCATED };
    /// With a tenth of the error allowed to a step.
    const TENTH: Self = Self { allowed: 0.1, ..Self::SAME };

    /// The factor by which its steps are shorter.
    pub fn steps(self) -> f64 {
        f64::from(self.ticks * self.parts) / f64::from(self.of) * libm::pow(self.allowed, -1.0 / ORDER)
    }

    /// Its work over that of the first run.
    pub fn work(self) -> f64 {
        self.steps() * if self.located { EVALUATIONS } else { 1.0 }
    }

    /// Whether a tick of the twin ends with tick `tick` of the first run.
    pub fn ends_with(self, tick: u64) -> bool {
        tick.is_multiple_of(u64::from(self.of))
    }

    /// The tick of the twin that ends with tick `tick` of the first run, a multiple of [`Finer::of`].
    pub fn tick(self, tick: u64) -> u64 {
        tick / u64::from(self.of) * u64::from(self.ticks)
    }

    /// The remaining error, as a multiple of the difference, if errors fall with the power `order` of the step. That of
    /// a twin with located events is of a higher order.
    pub fn left(self, order: f64) -> f64 {
        if self.located {
            return 1.0;
        }
        if self.allowed < 1.0 { 1.0 / (1.0 - self.allowed) } else { 1.0 / (1.0 - libm::pow(self.steps(), -order)) }
    }

    /// The plan of such a run; nothing, if it would be no finer than the first.
    pub fn plan(self, simulation: &Simulation) -> Option<Plan> {
        let plan = simulation.plan()?.clone();
        if let StepPace::Allowed(allowance) = plan.pace {
            let pace = StepPace::Allowed(allowance.with_share(self.allowed * allowance.share));
            return (self.allowed < 1.0).then_some(Plan { pace, ..plan });
        }
        let tick = plan.tick * f64::from(self.of) / f64::from(self.ticks);
        let detail = Detail {
            parts: plan.detail.parts * self.parts,
            looks: plan.detail.looks,
            swing: plan.detail.swing / f64::from(if self.ticks > 1 { self.parts } else { 1 }),
        };
        let (method, events) = match self.located {
            true => (LOCATED.to_owned(), EventTiming::Located),
            false => (plan.method.clone(), plan.events),
        };
        (plan.pace == StepPace::Even(1)).then_some(Plan { tick, detail, method, events, ..plan })
    }
}

/// The ticks between common ends of a twin and a run of `ticks` ticks. Forces jump at the ends of ticks.
fn cycle(ticks: u64) -> u32 {
    let longest = (ticks / FEWEST_CYCLES).clamp(1, LONGEST_CYCLE);
    let divides = (longest.div_ceil(2)..=longest).rev().find(|cycle| ticks.is_multiple_of(*cycle));
    divides.unwrap_or(longest) as u32
}

/// The ticks between common ends of a run and of the twins that it may need. The two numbers have no common factor, so
/// that few ticks of the run end with one of both.
pub(super) fn cycles_of(simulation: &Simulation) -> [u32; 2] {
    let world = simulation.unpublished_world();
    let touches = world.resource::<State>().contact_law().is_some() && !ChosenMethod::locates(world);
    let per_tick = touches || switches_at_ticks(simulation);
    match if per_tick { cycle(simulation.ticks()) } else { 1 } {
        1 => [1, 1],
        few @ 2..4 => [few, few + 1],
        many => [many, many - 1],
    }
}

/// Whether another event than a contact may occur at the end of a tick. Examples are a limit that is hit, a rope that
/// becomes taut, a joint that breaks, and friction that sticks.
fn switches_at_ticks(simulation: &Simulation) -> bool {
    let world = simulation.unpublished_world();
    let state = world.resource::<State>();
    let switches = |model: &dyn Model| model.has_modes() && state.law_of(model).is_none();
    !ChosenMethod::locates(world) && state.models().any(switches)
}

/// The twins that give the error of a finished run.
pub(super) fn of(simulation: &Simulation) -> Vec<Finer> {
    let world = simulation.unpublished_world();
    if simulation.plan().and_then(Plan::allowed).is_some() {
        return vec![Finer::TENTH];
    }
    let located = ChosenMethod::locates(world);
    let jumped = if located {
        world.resource::<State>().located().count > 0
    } else {
        touches(simulation) || switches_at_ticks(simulation)
    };
    match (jumped, located) {
        (false, _) => vec![Finer::HALF],
        // The same ticks, and so the same steps from event to event, in halves; and others.
        (true, true) => [Finer::SAME, Finer::HALF].map(|ticks| Finer { parts: 2, ..ticks }).to_vec(),
        (true, false) => {
            let few = simulation.ticks() < 2 * FEWEST_CYCLES;
            let located = if few { Finer::LOCATED_AT_EACH } else { Finer::LOCATED };
            vec![by_ticks(2, cycles_of(simulation)[0]), located]
        }
    }
}

/// A twin with ticks more than `times` as short, which end elsewhere except for one in `of`.
fn by_ticks(times: u32, of: u32) -> Finer {
    Finer { ticks: times * of + u32::from(of > 1), of, ..Finer::SAME }
}

/// The second twin of a run from tick to tick.
pub(super) fn second_by_ticks(simulation: &Simulation) -> Finer {
    by_ticks(3, cycles_of(simulation)[1])
}

/// The work of twins, over that of the first run.
pub(super) fn work(twins: &[Finer]) -> f64 {
    twins.iter().map(|twin| twin.work()).sum()
}

/// Looks at another run, so much finer, at the moments of the first, until the end of its tick `until`.
pub(super) fn watch_beside(other: &mut Simulation, first: &Simulation, finer: Finer, until: u64) {
    let common = moments(first).into_iter().filter(|tick| *tick <= until && finer.ends_with(*tick));
    Trajectory::watch(other, common.map(|tick| finer.tick(tick)).collect());
}

/// Runs a twin until the end of tick `until` of the first. `None` if it has no such tick or takes too long.
pub(super) fn run(
    first: &Simulation,
    (finer, until): (Finer, u64),
    patience: Option<Patience>,
    scene: &Repeated,
) -> Result<Option<(Trajectory, Simulation)>, SceneErrors> {
    let Some(plan) = finer.plan(first) else { return Ok(None) };
    let steps = if finer.parts > 1 { format!(" and steps in {} parts", finer.parts) } else { String::new() };
    let what = match finer.allowed {
        1.0 => format!("once more with a tick of {} s{steps}, for its error", number(plan.tick)),
        share => format!("once more with {share} of the error allowed to a step, for its error"),
    };
    let mut twin = scene.again(first, plan, 1.0, &what)?;
    watch_beside(&mut twin, first, finer, until);
    let end = finer.tick(until);
    let useless = |twin: &Simulation| finer.located && locates_little(twin, patience, end) || scene.is_interrupted();
    Ok(match work::run_to_tick(&mut twin, end, patience, useless) {
        Ok(failure) => Some((Trajectory::watched(&mut twin, failure), twin)),
        Err(TooLong) => None,
    })
}

/// A twin with ticks of too many events may take so many times the expected evaluations. Located ticks are several times as dear as
/// others, so more of them exceed the time of an estimate.
const EXCESS_OF_CROWDED: f64 = 2.0;

/// Whether a run held too many events to locate in most of its ticks. A run with fewer such ticks is useless too if the others take
/// long, until the end of tick `end`.
fn locates_little(twin: &Simulation, patience: Option<Patience>, end: u64) -> bool {
    let crowded = twin.resource::<State>().located().given_up;
    let done = twin.clock().ticks as f64 / end as f64;
    crowded > 0 && (2 * crowded >= end || patience.is_some_and(|most| most.exceeds(EXCESS_OF_CROWDED, twin, done)))
}

/// The same by located events. `None` also if the scene does not permit that or the twin fails. The same holds if most ticks held too
/// many events to locate.
pub(super) fn run_located(
    first: &Simulation,
    (finer, until): (Finer, u64),
    patience: Option<Patience>,
    scene: &Repeated,
) -> Option<(Trajectory, Simulation)> {
    let made = run(first, (finer, until), patience, scene).ok().flatten();
    let end = finer.tick(until);
    made.filter(|(run, twin)| run.failure.is_none() && !locates_little(twin, patience, end))
}

/// The results of twins on the error of a run.
#[derive(Clone, Debug, Default)]
pub(super) struct Told {
    /// Greatest error of a place in m, and of velocities in m/s.
    pub distance: f64,
    pub speed: f64,
    /// The greatest error as a share of how far bodies go.
    pub share: Option<f64>,
    /// The last moment in s at which the positions of a twin are meaningful.
    pub horizon: Option<f64>,
    /// Whether that came of exponential growth.
    pub chaotic: bool,
}

impl Told {
    /// Adds the result of a twin, if errors fall with the power `order` of the step.
    pub fn add(&mut self, finer: Finer, order: f64, seen: Seen, motion: f64) {
        let (growth, left) = (Growth::of(seen, motion), finer.left(order));
        self.distance = self.distance.max(left * growth.distance);
        self.speed = self.speed.max(left * growth.speed);
        self.share = [self.share, growth.share().map(|share| left * share)].into_iter().flatten().reduce(f64::max);
        self.horizon = [self.horizon, growth.horizon].into_iter().flatten().reduce(f64::min);
        self.chaotic |= growth.is_exponential();
    }
}
