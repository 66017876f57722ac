//! What a run of a scene costs and how wrong it is, method by method and tick by tick, on this very scene.
//!
//! A run whose error is far smaller is the truth (`reference.rs`); every method climbs a ladder of ticks from coarse to fine
//! (`ladder.rs`); its runs are timed apart from those that are compared (`timing.rs`); of what came out, the settings that nothing
//! else beats are marked and the cheapest for each wanted error named (`advice.rs`). `diagram.rs` draws it.

mod advice;
mod diagram;
mod ladder;
mod reference;
mod timing;

use std::time::{Duration, Instant};

pub use advice::{Advice, TARGETS, is_best};
pub use diagram::diagram;
pub use ladder::{Outcome, Setting};
pub use reference::{NoReference, Reference};

use crate::integrate::{Methods, Pace};
use crate::scene::SceneErrors;
use crate::scene::sections::clock::EventTiming;
use crate::simulation::{Plan, Simulation};
use crate::tick::Stability;

/// How errors are measured, in words.
pub const NORM: &str = "the greater of two shares: how far any point of a body is from the reference, at the worst of all moments, \
     over how far the body goes; and how much its velocity differs, as a root mean square over the moments, over how fast it is";

/// What is to be measured.
#[derive(Clone, Debug)]
pub struct Order {
    /// Seconds that it may take in all, about.
    pub budget: f64,
    /// Ticks that each method tries at the most.
    pub rungs: usize,
    /// Methods; none: all.
    pub methods: Vec<String>,
    /// What counts as cost.
    pub cost: Cost,
}

/// What a setting costs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Cost {
    /// Seconds of this computer.
    #[default]
    Time,
    /// Evaluations of all forces: the same on every computer.
    Evaluations,
}

/// How a scene is to be loaded for one of many runs.
#[derive(Clone, Copy, Debug)]
pub enum Way<'a> {
    /// By a plan.
    Plan(&'a Plan),
    /// As with `--method` and `--tick`.
    Flags(&'a str, f64),
}

/// Makes the scene at its beginning.
pub type Load<'a> = &'a dyn Fn(Way) -> Result<Simulation, SceneErrors>;

/// What was measured of a scene.
#[derive(Clone, Debug)]
pub struct Measured {
    /// Seconds of physics.
    pub duration: f64,
    /// The reference run; or why there is none: then settings tell only whether they reach the end.
    pub reference: Result<Reference, NoReference>,
    /// All settings, method by method, from coarse to fine.
    pub settings: Vec<Setting>,
    /// Why methods did not go on to finer ticks.
    pub ends: Vec<(&'static str, String)>,
    /// What counts as cost.
    pub cost: Cost,
    /// Seconds that it took.
    pub spent: f64,
}

impl Measured {
    /// Whether no setting came to its end.
    pub fn all_fail(&self) -> bool {
        let ended = |setting: &Setting| matches!(setting.outcome, Outcome::Measured(_) | Outcome::Unknown);
        !self.settings.iter().any(ended)
    }
}

/// The budget, and how much of it is used.
pub(super) struct Budget<'a> {
    start: Instant,
    whole: f64,
    tell: &'a dyn Fn(f64),
}

impl Budget<'_> {
    /// Seconds used.
    fn used(&self) -> f64 {
        self.start.elapsed().as_secs_f64()
    }

    /// Seconds left.
    fn left(&self) -> f64 {
        self.whole - self.used()
    }

    /// Whether less than a share of it is used; says so.
    fn within(&self, share: f64) -> bool {
        (self.tell)((self.used() / self.whole).min(1.0));
        self.used() < share * self.whole
    }
}

/// What is known of the scene before anything runs.
struct Scene {
    duration: f64,
    /// The fastest of contacts and springs in rad/s, if there are any.
    fastest: Option<f64>,
    /// Moments at which runs are compared.
    moments: u64,
    methods: Methods,
}

/// Beyond so many bodies fewer moments are kept.
const MANY_BODIES: usize = 6000;

impl Scene {
    /// Looks at the scene. Its own tick does not matter, so one that divides whatever run it has is tried.
    fn look(load: Load) -> Result<Self, SceneErrors> {
        let probe = |tick| load(Way::Plan(&reference::located(tick, 1.0, tick)));
        let simulation = probe(1e-3).or_else(|wrong| probe(1e-9).or_else(|_| probe(1e3)).map_err(|_| wrong))?;
        let world = simulation.world();
        Ok(Self {
            duration: simulation.duration(),
            fastest: world.resource::<Stability>().fastest_foreseen().map(|fastest| fastest.angular_frequency),
            moments: if simulation.bodies().len() > MANY_BODIES { 10 } else { 100 },
            methods: Methods(world.resource::<Methods>().0.clone()),
        })
    }
}

/// A plan with equal ticks, or steps as long as their error allows.
fn plan(method: &str, tick: f64, pace: Pace, events: EventTiming) -> Plan {
    // What is known of its error, nothing, keeps others from looking for it.
    let error = Some(crate::report::card::ErrorEstimate::default());
    Plan { method: method.to_owned(), tick, pace, events, notes: Vec::new(), error, warning: None }
}

/// Measures a scene. `tell` hears from time to time which share of the budget is used.
///
/// # Errors
/// When the scene is wrong, nothing in it moves, or the budget is too short to know the truth.
pub fn measure(load: Load, order: &Order, tell: &dyn Fn(f64)) -> Result<Measured, NoReference> {
    let budget = Budget { start: Instant::now(), whole: order.budget, tell };
    let scene = Scene::look(load)?;
    let truth = match reference::find(load, &scene, &budget) {
        Ok(truth) => Ok(truth),
        Err(failed @ NoReference::Failed(_)) => Err(failed),
        Err(other) => return Err(other),
    };
    let (settings, ends) = ladder::climb(load, &scene, order, truth.as_ref().ok(), &budget)?;
    Ok(Measured {
        duration: scene.duration,
        reference: truth.map(|truth| truth.about),
        settings,
        ends,
        cost: order.cost,
        spent: budget.used(),
    })
}

/// How long something takes.
fn timed<T>(work: impl FnOnce() -> T) -> (Duration, T) {
    let start = Instant::now();
    let done = work();
    (start.elapsed(), done)
}
