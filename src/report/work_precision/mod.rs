//! The work-precision series: methods with ticks from coarse to fine, and the cost and error of each. `jostle measure`
//! makes it with a scene and a reference run (`report/measure`). `jostle report` makes it with problems of known
//! answers (`report/document`).
//!
//! `climb.rs` chooses the next run and decides the end. `timing.rs` times the settings in separate runs. `advice.rs` finds the
//! settings that no other dominates, and the cheapest for a wanted error. `diagram.rs` draws it.

mod climb;
mod diagram;
mod pareto_front;
mod timing;

use std::time::{Duration, Instant};

pub(super) use climb::{Rules, Rungs, Subject, climb};
pub use diagram::{DiagramLegend, Peer, diagram};
pub(super) use pareto_front::USELESS;
pub use pareto_front::{Advice, TARGETS};
pub(super) use timing::least;

use jostle_engine::integrate::clock_section::EventTiming;
use jostle_engine::tick::Failure;

/// A method, and its treatment of events.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MethodChoice {
    /// Name of the method; `Auto`: the engine chooses.
    pub method: &'static str,
    /// The moments at which forces jump.
    pub events: EventTiming,
}

impl MethodChoice {
    /// A method with events as the scene has them.
    pub fn of(method: &'static str) -> Self {
        Self { method, events: EventTiming::Auto }
    }

    /// In words: `located` for located events. Otherwise they happen at the ends of ticks, or as the scene or the
    /// engine chooses.
    pub fn name(&self) -> String {
        match self.events {
            EventTiming::Auto | EventTiming::PerTick => self.method.to_owned(),
            EventTiming::Located => format!("{}, located", self.method),
        }
    }
}

/// The kind of cost of a setting.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Cost {
    /// Seconds of this computer.
    #[default]
    Time,
    /// Evaluations of all forces: the same on every computer.
    Evaluations,
}

/// How a setting came out.
#[derive(Clone, Debug)]
pub enum SettingOutcome {
    /// Its error.
    Measured(Deviation),
    /// It reaches its end, and its error is unknown.
    Unknown,
    /// It failed.
    Failed(Failure),
    /// The method cannot run the scene, and why.
    Refused(String),
    /// Time was up when this share of it was done.
    Stopped(f64),
}

/// The error of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Deviation {
    /// The error, in the norm of the scene or problem.
    pub error: f64,
    /// The distance at the compared moments: greatest distance of positions in m, and difference of velocities in m/s.
    /// It is the root mean square over the moments.
    pub apart: Option<(f64, f64)>,
}

/// A method with a tick, and what came out.
#[derive(Clone, Debug)]
pub struct Setting {
    /// The method.
    pub course: MethodChoice,
    /// Seconds of a tick.
    pub tick: f64,
    /// Whether events are located inside ticks.
    pub located: bool,
    /// The result.
    pub outcome: SettingOutcome,
    /// Evaluations of all forces per second of physics.
    pub evaluations: f64,
    /// Seconds per second of physics.
    pub seconds: Option<f64>,
    /// Further notes.
    pub notes: Vec<String>,
}

impl Setting {
    /// One of which nothing is known yet.
    pub fn new(course: MethodChoice, tick: f64) -> Self {
        let (outcome, notes) = (SettingOutcome::Unknown, Vec::new());
        Self { course, tick, located: false, outcome, evaluations: 0.0, seconds: None, notes }
    }

    /// Its error, if it is known.
    pub fn error(&self) -> Option<f64> {
        if let SettingOutcome::Measured(deviation) = self.outcome { Some(deviation.error) } else { None }
    }

    /// Its cost per second of physics.
    pub fn cost(&self, cost: Cost) -> Option<f64> {
        match cost {
            Cost::Time => self.seconds,
            Cost::Evaluations => Some(self.evaluations),
        }
    }
}

/// All settings, course by course, from coarse to fine.
#[derive(Clone, Debug)]
pub struct Settings {
    /// The settings.
    pub all: Vec<Setting>,
    /// The reasons for which courses did not go on to finer ticks.
    pub ends: Vec<(MethodChoice, String)>,
    /// The kind of cost.
    pub cost: Cost,
    /// No error below it is claimed; nothing: nothing is known of errors.
    pub claim: Option<f64>,
}

impl Settings {
    /// All courses, in order.
    pub fn courses(&self) -> Vec<MethodChoice> {
        let mut courses: Vec<MethodChoice> = Vec::new();
        for setting in &self.all {
            if !courses.contains(&setting.course) {
                courses.push(setting.course);
            }
        }
        courses
    }

    /// The settings of a course.
    pub fn of(&self, course: MethodChoice) -> impl Iterator<Item = &Setting> {
        self.all.iter().filter(move |setting| setting.course == course)
    }

    /// The error that can be claimed of a setting, which is at least the floor.
    pub fn claimed(&self, setting: &Setting) -> Option<f64> {
        Some(setting.error()?.max(self.claim?))
    }
}

/// The budget, and how much of it is used.
pub(super) struct Budget<'a> {
    pub start: Instant,
    pub whole: f64,
    pub tell: &'a dyn Fn(f64),
}

impl Budget<'_> {
    /// One that never ends.
    pub fn endless() -> Self {
        Self { start: Instant::now(), whole: f64::INFINITY, tell: &|_| {} }
    }

    /// Seconds used.
    pub fn used(&self) -> f64 {
        self.start.elapsed().as_secs_f64()
    }

    /// Seconds left.
    pub fn left(&self) -> f64 {
        self.whole - self.used()
    }

    /// Whether less than a share of it is used. Reports the used share.
    pub fn within(&self, share: f64) -> bool {
        (self.tell)((self.used() / self.whole).min(1.0));
        self.used() < share * self.whole
    }
}

/// The time that a closure takes.
pub(super) fn timed<T>(work: impl FnOnce() -> T) -> (Duration, T) {
    let start = Instant::now();
    let done = work();
    (start.elapsed(), done)
}
