//! Measurement of a scene: the cost and error of a run, method by method and tick by tick.
//!
//! A run of far smaller error is the reference (`reference.rs`). Every method runs a sequence of ticks from coarse to
//! fine (`report/work_precision`). `scene.rs` chooses the ticks and compares. `refine.rs` tries ticks between the advised ones
//! and the next coarser.

mod beyond;
mod measured_scene;
mod reference;
mod refine;

use std::time::Instant;

pub use beyond::MeanDeviation;
pub use reference::{NoReference, Reference};

use super::work_precision::{
    Budget, Cost, DiagramLegend, MethodChoice, Rules, Setting, SettingOutcome, Settings, USELESS, climb, timed,
};
use jostle_engine::integrate::clock_section::EventTiming;
use jostle_engine::integrate::{Detail, StepPace};
use jostle_engine::scene::SceneErrors;
use jostle_engine::simulation::{Plan, Simulation};
use jostle_film::raster::Diagram;
use measured_scene::{Compared, Scene};

/// The measure of errors, in words.
pub const NORM: &str = "the greater of two shares. One is the greatest distance of any point of a body from the reference, \
over how far the body goes. The other is the root mean square over time of the difference of its velocity, over how fast it is";

/// The order of a measurement.
#[derive(Clone, Debug)]
pub struct MeasureRequest {
    /// Seconds that it may take in all, about.
    pub budget: f64,
    /// Ticks that each method tries at the most.
    pub rungs: usize,
    /// Methods; empty: all.
    pub methods: Vec<String>,
    /// The kind of cost.
    pub cost: Cost,
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

/// The measurement of a scene.
#[derive(Clone, Debug)]
pub struct Measured {
    /// Seconds of physics.
    pub duration: f64,
    /// The reference run, or the reason for its absence. Without it settings only show whether they reach the end.
    pub reference: Result<Reference, NoReference>,
    /// All settings, method by method, from coarse to fine.
    pub settings: Settings,
    /// Seconds that it took.
    pub spent: f64,
}

impl Measured {
    /// Whether no setting came to its end.
    pub fn all_fail(&self) -> bool {
        let ended =
            |setting: &Setting| matches!(setting.outcome, SettingOutcome::Measured(_) | SettingOutcome::Unknown);
        !self.settings.all.iter().any(ended)
    }

    /// The work-precision diagram of a scene called `name`.
    pub fn diagram(&self, name: &str) -> Diagram {
        let reference = self.reference.as_ref().ok();
        let until = reference.filter(|reference| reference.until < self.duration);
        let until = until.map_or_else(String::new, |reference| format!(", until t = {:.3} s", reference.until));
        let claim = self.settings.claim.unwrap_or_default();
        let legend = DiagramLegend {
            title: format!("{name}: cost against error"),
            error: format!("error as a share of the motion{until}"),
            floor: format!("what the reference leaves unknown, {claim:.0e}"),
            useless: (USELESS, "failed, or useless".to_owned()),
        };
        super::work_precision::diagram(&self.settings, legend, &[])
    }
}

/// A plan with equal ticks, or steps as long as their error allows.
fn plan(method: &str, tick: f64, pace: StepPace, events: EventTiming) -> Plan {
    // An empty estimate, which keeps others from estimating.
    let error = Some(jostle_engine::simulation::error::ErrorEstimate::default());
    Plan {
        method: method.to_owned(),
        tick,
        pace,
        detail: Detail::default(),
        events,
        notes: Vec::new(),
        error,
        warning: None,
    }
}

/// Measures a scene. `tell` receives the used share of the budget from time to time.
///
/// # Errors
/// When the scene is wrong, no body moves, or the budget is too short for a reference.
pub fn measure(load: Load, order: &MeasureRequest, tell: &dyn Fn(f64)) -> Result<Measured, NoReference> {
    let budget = Budget { start: Instant::now(), whole: order.budget, tell };
    let scene = Scene::look(load)?;
    let truth = match reference::find(load, &scene, &budget) {
        Ok(truth) => Ok(truth),
        Err(failed @ NoReference::Failed(_)) => Err(failed),
        Err(other) => return Err(other),
    };
    let known = truth.as_ref().ok();
    let wanted = |name: &str| order.methods.is_empty() || order.methods.iter().any(|wanted| wanted == name);
    let methods = scene.methods.0.iter().filter(|method| wanted(method.name));
    let courses = methods.map(|method| (MethodChoice::of(method.name), scene.rungs(method, known)));
    let rules = Rules { rungs: order.rungs, leaves_behind: true };
    let subject = Compared { load, scene: &scene, truth: known, budget: &budget };
    let (all, ends) = climb(&subject, courses, &rules, &budget)?;
    let claim = known.map(|truth| truth.about.claim());
    let mut settings = Settings { all, ends, cost: order.cost, claim };
    if order.rungs == usize::MAX {
        refine::refine(&mut settings, &subject)?;
    }
    Ok(Measured { duration: scene.duration, settings, reference: truth.map(|truth| truth.about), spent: budget.used() })
}
