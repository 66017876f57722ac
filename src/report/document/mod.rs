//! The report of speed against error, by work-precision series. Each method runs problems with known answers at a
//! sequence of ticks, and hard cases.
//!
//! Errors and times come from separate runs. Errors come first, on all cores. Then come times, one after the other
//! without other work. The error is the greatest at the samples of a [`Problem`], against its exact answer and in its
//! unit. If it depends on the phase of an event in a tick, it is the greatest of several such phases. A setting that
//! fails is kept, with its reason, and so is a failed reading of a hard case.

mod html;
mod markdown;
mod page;
mod peers;
mod provenance;
mod subject;

use crate::SimulationExt;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};

pub use html::page as html;
pub use markdown::page as markdown;
pub use page::{Block, Cell, PagePicture, page};
pub use peers::Peers;
pub use provenance::Made;

use super::estimate::validation::{Checked, check};
use super::work_precision::{
    Budget, DiagramLegend, MethodChoice, Peer, Rules, Setting, SettingOutcome, Settings, TARGETS, climb, least,
};
use crate::problems::hard::{Case, Extent, Judgement, Reading, rounded};
use crate::problems::{self, Problem, methods};
use jostle_engine::integrate::ClockSection;
use jostle_film::raster::Diagram;
use subject::Asked;

/// Ticks of the sequence over that of the problem.
const LADDER: [f64; 8] = [8.0, 4.0, 2.0, 1.0, 0.5, 0.25, 0.125, 0.0625];
const QUICK_LADDER: [f64; 3] = [4.0, 1.0, 0.25];
/// Methods of a quick report.
const QUICK: [&str; 4] = [ClockSection::AUTO, "VelocityVerlet", "RungeKutta4", "Dop853"];
/// Ticks of a run, at most.
const MOST_TICKS: f64 = 1e6;
const QUICK_MOST_TICKS: f64 = 3e4;
/// Errors below this count as this: rounding, and exact zeros.
const LEAST_ERROR: f64 = 1e-16;

/// The order of a report.
#[derive(Clone, Copy, Debug, Default)]
pub struct DocumentRequest {
    /// Fewer methods, ticks and hard cases: a first look.
    pub quick: bool,
}

/// The measurement of a problem.
#[derive(Clone)]
pub struct Sheet {
    /// The problem.
    pub problem: Problem,
    /// All settings, course by course, from long ticks to short ones.
    pub settings: Settings,
    /// State hash of the run that the engine chooses at the tick of the problem.
    pub hash: Option<String>,
    /// The runs' estimates of their errors, beside the true ones.
    pub estimates: Vec<Checked>,
}

/// The measurement of a hard case.
#[derive(Clone)]
pub struct Judged {
    /// The case.
    pub case: Case,
    /// Its readings; nothing: it was left out.
    pub readings: Option<Vec<Reading>>,
}

impl Judged {
    /// The number of readings with this outcome.
    pub fn count(&self, verdict: Judgement) -> usize {
        self.readings.iter().flatten().filter(|reading| reading.verdict() == verdict).count()
    }
}

/// Work that one core does at a time.
enum Job {
    Case(Case),
    Problem(Problem),
}

/// Its result.
enum Done {
    Case(Judged),
    Problem(Box<Sheet>),
}

impl DocumentRequest {
    /// The extent to which a hard case runs, or `None` if it is left out.
    fn extent(&self, case: &Case) -> Option<Extent> {
        if self.quick { case.cheap.then_some(Extent::Short) } else { Some(Extent::Full) }
    }

    /// The ways in which a problem is run.
    pub fn courses(&self, problem: &Problem) -> Vec<MethodChoice> {
        let wanted = |name: &str| !self.quick || QUICK.contains(&name);
        let methods = methods().into_iter().filter(|method| wanted(method.name));
        let all = methods.flat_map(|method| {
            let timings = problem.timings(&method);
            timings.into_iter().map(move |events| MethodChoice { method: method.name, events })
        });
        std::iter::once(MethodChoice::of(ClockSection::AUTO)).chain(all).collect()
    }

    /// Errors of problems, and hard cases, on all cores; `step` is called after each. Costs are not known yet.
    pub fn errors(&self, problems: &[Problem], cases: &[Case], step: &(dyn Fn() + Sync)) -> (Vec<Sheet>, Vec<Judged>) {
        let jobs: Vec<Job> =
            cases.iter().copied().map(Job::Case).chain(problems.iter().copied().map(Job::Problem)).collect();
        let (next, done) = (AtomicUsize::new(0), Mutex::new(Vec::new()));
        let work = || {
            while let Some((index, job)) =
                Some(next.fetch_add(1, Ordering::Relaxed)).and_then(|index| Some((index, jobs.get(index)?)))
            {
                let found = match job {
                    Job::Case(case) => {
                        let readings = self.extent(case).map(|extent| case.measure(extent));
                        Done::Case(Judged { case: *case, readings })
                    }
                    Job::Problem(problem) => Done::Problem(Box::new(self.errors_of(problem))),
                };
                done.lock().unwrap_or_else(PoisonError::into_inner).push((index, found));
                step();
            }
        };
        let cores = std::thread::available_parallelism().map_or(1, usize::from).min(jobs.len());
        std::thread::scope(|scope| (0..cores).for_each(|_| drop(scope.spawn(work))));
        let mut done = done.into_inner().unwrap_or_else(PoisonError::into_inner);
        done.sort_by_key(|(index, _)| *index);
        let (mut sheets, mut judged) = (Vec::new(), Vec::new());
        for (_, found) in done {
            match found {
                Done::Case(case) => judged.push(case),
                Done::Problem(sheet) => sheets.push(*sheet),
            }
        }
        (sheets, judged)
    }

    fn errors_of(&self, problem: &Problem) -> Sheet {
        let (ladder, most) = if self.quick { (&QUICK_LADDER[..], QUICK_MOST_TICKS) } else { (&LADDER[..], MOST_TICKS) };
        let ticks: Vec<f64> =
            ladder.iter().map(|share| share * problem.tick).filter(|tick| problem.duration() / tick <= most).collect();
        let floor = ticks.iter().map(|tick| (problem.rounding)(*tick)).fold(f64::INFINITY, f64::min);
        let subject = Asked { problem, phases: !self.quick };
        let courses = self.courses(problem).into_iter().map(|course| (course, ticks.clone().into_iter().into()));
        let rules = Rules { rungs: usize::MAX, leaves_behind: !self.quick };
        let Ok((all, ends)) = climb(&subject, courses, &rules, &Budget::endless());
        let hash = problem.load(&problems::ProblemSetting { tick: problem.tick, ..Default::default() }).ok();
        let hash = hash.and_then(|mut simulation| {
            simulation.run_to_end().ok()?;
            Some(simulation.card().hash)
        });
        let settings = Settings { all, ends, cost: Default::default(), claim: Some(floor.max(LEAST_ERROR)) };
        let estimates = if self.quick { Vec::new() } else { check(problem).unwrap_or_default() };
        Sheet { problem: *problem, settings, hash, estimates }
    }
}

impl Sheet {
    /// Times the measured settings, one run after the other.
    pub fn time(&mut self) {
        let problem = self.problem;
        for setting in &mut self.settings.all {
            if let SettingOutcome::Measured(_) = setting.outcome {
                let MethodChoice { method, events } = setting.course;
                let run = problems::ProblemSetting { method, tick: setting.tick, shift: 0.0, events };
                let seconds = least(|| problem.load(&run), f64::INFINITY, 0.0);
                setting.seconds = seconds.ok().flatten().map(|seconds| seconds / problem.duration());
            }
        }
    }

    /// The uncertainty by rounding, or by the known answer, at the longest tick.
    pub fn floor(&self) -> f64 {
        self.settings.claim.unwrap_or(LEAST_ERROR)
    }

    /// The grade of a setting: `reference` where its error is what rounding or the answer leaves open at its tick.
    pub fn grade(&self, setting: &Setting) -> Option<&'static str> {
        let error = setting.error()?;
        if error <= (self.problem.rounding)(setting.tick) {
            return Some("reference");
        }
        TARGETS.iter().rev().find(|(_, bound)| error <= *bound).map(|(name, _)| *name)
    }

    /// The best grade of the settings of a method.
    fn best_grade(&self, method: &str) -> Option<&'static str> {
        let own = self.settings.all.iter().filter(|setting| setting.course.method == method);
        let rank = |grade: &&str| TARGETS.iter().position(|(name, _)| name == grade).unwrap_or(TARGETS.len());
        own.filter_map(|setting| self.grade(setting)).max_by_key(rank)
    }

    /// The work-precision diagram.
    pub fn diagram(&self, peers: &[Peer]) -> Diagram {
        let problem = &self.problem;
        let unit = if problem.unit == "1" { String::new() } else { format!(" in {}", problem.unit) };
        // If errors have a unit, the useless range depends on the scene. Then only failed settings are apart.
        let errors = self.settings.all.iter().filter_map(Setting::error);
        let errors = errors.chain(peers.iter().flat_map(|peer| peer.points.iter().map(|(error, _)| *error)));
        let greatest = errors.filter(|error| error.is_finite()).fold(1.0, f64::max);
        let useless = match problem.unit {
            "1" => (1.0, "failed, or useless".to_owned()),
            _ => (libm::exp10(libm::ceil(libm::log10(greatest))), "failed".to_owned()),
        };
        let legend = DiagramLegend {
            title: format!("{}: cost against error", problem.name),
            error: format!("error{unit}"),
            floor: format!("what rounding or the answer leaves open, {:.0e}", self.floor()),
            useless,
        };
        super::work_precision::diagram(&self.settings, legend, peers)
    }

    /// The settings as comma-separated values.
    pub fn csv(&self) -> String {
        let mut text =
            "method,events,tick [s],error,seconds_per_second,evaluations_per_second [1/s],failure\n".to_owned();
        let or_empty = |value: Option<f64>| value.map_or_else(String::new, |value| format!("{value:e}"));
        for setting in &self.settings.all {
            let MethodChoice { method, events } = setting.course;
            let failure = failure(setting).map_or_else(String::new, |why| format!("\"{}\"", why.replace('"', "\"\"")));
            text.push_str(&format!(
                "{method},{events:?},{:e},{},{},{:e},{failure}\n",
                setting.tick,
                or_empty(setting.error()),
                or_empty(setting.seconds),
                setting.evaluations
            ));
        }
        text
    }
}

/// The reason for which a setting has no error.
fn failure(setting: &Setting) -> Option<String> {
    match &setting.outcome {
        SettingOutcome::Measured(_) => None,
        SettingOutcome::Failed(failure) => Some(failure.to_string()),
        SettingOutcome::Refused(why) => Some(why.clone()),
        SettingOutcome::Unknown | SettingOutcome::Stopped(_) => Some("the error is infinite or NaN".to_owned()),
    }
}

/// The readings of hard cases as comma-separated values.
pub fn cases_csv(cases: &[Judged]) -> String {
    let mut text = "case,quantity,value,threshold,verdict,why,told\n".to_owned();
    let quoted = |text: &str| format!("\"{}\"", text.replace('"', "\"\""));
    for judged in cases {
        for reading in judged.readings.iter().flatten() {
            text.push_str(&format!(
                "{},{},{:e},{},{},{},{}\n",
                judged.case.name,
                quoted(&reading.what),
                reading.value,
                quoted(&reading.threshold.to_string()),
                word(reading.verdict()),
                quoted(reading.why),
                quoted(reading.told.as_deref().unwrap_or_default())
            ));
        }
    }
    text
}

/// A verdict in a word.
fn word(verdict: Judgement) -> &'static str {
    match verdict {
        Judgement::Passed => "passed",
        Judgement::Told => "told",
        Judgement::Failed => "FAILED",
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::problems::{EventTiming, elastic_bounce};

    #[test]
    fn errors_of_a_sheet_are_those_of_the_problem() {
        let problem = elastic_bounce::PROBLEM;
        let (mut sheets, cases) = DocumentRequest { quick: true }.errors(&[problem], &[], &|| ());
        assert!(cases.is_empty() && sheets[0].hash.is_some());
        let course = MethodChoice { method: "VelocityVerlet", events: EventTiming::PerTick };
        let at =
            |sheet: &Sheet| sheet.settings.of(course).find(|setting| setting.tick == problem.tick).cloned().unwrap();
        let run =
            problems::ProblemSetting { method: course.method, tick: problem.tick, shift: 0.0, events: course.events };
        assert_eq!(at(&sheets[0]).error().unwrap(), problem.measure(&run).unwrap());
        assert_eq!(at(&sheets[0]).seconds, None);
        sheets[0].time();
        assert!(at(&sheets[0]).seconds.unwrap() > 0.0);
    }

    #[test]
    fn grades_follow_errors() {
        let mut sheet = Sheet {
            problem: elastic_bounce::PROBLEM,
            settings: Settings { all: Vec::new(), ends: Vec::new(), cost: Default::default(), claim: Some(1e-16) },
            hash: None,
            estimates: Vec::new(),
        };
        let tick = 1e-3;
        let rounding = (elastic_bounce::PROBLEM.rounding)(tick);
        for (error, grade) in [
            (1.0, None),
            (1e-2, Some("bronze")),
            (1e-5, Some("silver")),
            (1e-9, Some("gold")),
            (rounding, Some("reference")),
        ] {
            let outcome = SettingOutcome::Measured(crate::work_precision::Deviation { error, apart: None });
            let setting = Setting { outcome, ..Setting::new(MethodChoice::of("A"), tick) };
            assert_eq!(sheet.grade(&setting), grade);
            // Each is better than all before.
            sheet.settings.all.push(setting);
            assert_eq!(sheet.best_grade("A"), grade);
        }
        assert_eq!(sheet.best_grade("B"), None);
    }
}
