//! The report of speed against error: problems whose answer is known, run by each method at a ladder of ticks.
//!
//! Errors and times come from runs of their own. The error is the greatest at the samples of a [`Problem`], against its exact
//! answer and in its unit; where it depends on where in a tick an event falls, the greatest of several such phases. The
//! time is the least of several runs, without reading the scene. A setting that does not run is kept, with its reason.

mod diagram;
mod html;
mod markdown;

use std::time::Instant;

pub use diagram::diagram;
pub use html::page as html;
pub use markdown::page as markdown;

use crate::problems::{Problem, Setting, methods};
use crate::scene::sections::ClockSection;
use crate::scene::sections::clock::EventTiming;

/// Ticks of the ladder over that of the problem.
const LADDER: [f64; 7] = [8.0, 4.0, 2.0, 1.0, 0.5, 0.25, 0.125];
const QUICK_LADDER: [f64; 3] = [4.0, 1.0, 0.25];
/// Methods where it has to be quick.
const QUICK: [&str; 4] = [ClockSection::AUTO, "VelocityVerlet", "RungeKutta4", "Dop853"];
/// Ticks of a run, at most.
const MOST_TICKS: f64 = 1e6;
const QUICK_MOST_TICKS: f64 = 3e4;
/// Where in a tick events fall, as shares of it.
const PHASES: [f64; 3] = [0.0, 0.37, 0.71];
/// Timed runs, at least and at most, and seconds after which there are no more.
const RUNS: [u32; 2] = [2, 9];
const PATIENCE: f64 = 0.2;

/// Errors that grades are given for, with their names.
pub const GRADES: [(&str, f64); 3] = [("bronze", 1e-2), ("silver", 1e-4), ("gold", 1e-8)];

/// What is to be measured.
#[derive(Clone, Copy, Debug, Default)]
pub struct Order {
    /// Fewer methods and ticks: a first look.
    pub quick: bool,
}

/// A method, and how it goes through events.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Course {
    /// Name of the method; `Auto`: the engine chooses.
    pub method: &'static str,
    /// When jumps of the forces take place.
    pub events: EventTiming,
}

impl Course {
    /// In words: `located` where events are, else they happen at the ends of ticks. `Auto` is what the engine chooses.
    pub fn name(&self) -> String {
        match self.events {
            EventTiming::Auto | EventTiming::PerTick => self.method.to_owned(),
            EventTiming::Located => format!("{}, located", self.method),
        }
    }
}

/// What came of a setting that ran.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reached {
    /// The greatest error, in the unit of the problem.
    pub error: f64,
    /// Seconds of computing for each second of physics.
    pub cost: f64,
}

/// A setting.
#[derive(Clone, Debug)]
pub struct Cell {
    /// The method.
    pub course: Course,
    /// Length of a tick in seconds.
    pub tick: f64,
    /// What came of it, or why nothing did.
    pub outcome: Result<Reached, String>,
}

/// What was measured of a problem.
#[derive(Clone)]
pub struct Sheet {
    /// The problem.
    pub problem: Problem,
    /// All settings, course by course, from long ticks to short ones.
    pub cells: Vec<Cell>,
    /// State hash of the run that the engine chooses at the tick of the problem.
    pub hash: Option<String>,
}

impl Order {
    /// The ways in which a problem is run.
    pub fn courses(&self, problem: &Problem) -> Vec<Course> {
        let auto = Course { method: ClockSection::AUTO, events: EventTiming::Auto };
        let wanted = |name: &str| !self.quick || QUICK.contains(&name);
        let methods = methods().into_iter().filter(|method| wanted(method.name));
        let all = methods.flat_map(|method| {
            let timings = problem.timings(&method);
            timings.into_iter().map(move |events| Course { method: method.name, events })
        });
        std::iter::once(auto).chain(all).collect()
    }

    /// Measures a problem. `step` is told each time a course is done.
    pub fn measure(&self, problem: &Problem, mut step: impl FnMut()) -> Sheet {
        let (ladder, most) = if self.quick { (&QUICK_LADDER[..], QUICK_MOST_TICKS) } else { (&LADDER[..], MOST_TICKS) };
        let mut cells = Vec::new();
        for course in self.courses(problem) {
            let ticks = ladder.iter().map(|share| share * problem.tick);
            for tick in ticks.filter(|tick| problem.duration() / tick <= most) {
                cells.push(Cell { course, tick, outcome: self.outcome(problem, course, tick) });
            }
            step();
        }
        let hash =
            problem.load(&Setting { tick: problem.tick, ..Setting::default() }).ok().and_then(|mut simulation| {
                simulation.run_to_end().ok()?;
                Some(simulation.card().hash)
            });
        Sheet { problem: *problem, cells, hash }
    }

    fn outcome(&self, problem: &Problem, Course { method, events }: Course, tick: f64) -> Result<Reached, String> {
        let phases = if problem.class.depends_on_phase() && !self.quick { &PHASES[..] } else { &PHASES[..1] };
        let mut error = 0.0_f64;
        for phase in phases {
            let setting = Setting { method, tick, shift: phase * tick, events };
            let found = problem.measure(&setting).map_err(|error| first_line(&error.to_string()))?;
            if !found.is_finite() {
                return Err("the error is no number".to_owned());
            }
            error = error.max(found);
        }
        let setting = Setting { method, tick, shift: 0.0, events };
        Ok(Reached { error, cost: cost(problem, &setting).map_err(|error| first_line(&error))? })
    }
}

/// Seconds of computing for each second of physics: the least of several runs.
fn cost(problem: &Problem, setting: &Setting) -> Result<f64, String> {
    let (mut least, mut spent, mut runs) = (f64::INFINITY, 0.0, 0);
    while runs < RUNS[0] || runs < RUNS[1] && spent < PATIENCE {
        let mut simulation = problem.load(setting).map_err(|error| error.to_string())?;
        let begin = Instant::now();
        simulation.run_to_end().map_err(|failure| failure.to_string())?;
        let seconds = begin.elapsed().as_secs_f64();
        least = least.min(seconds);
        spent += seconds;
        runs += 1;
    }
    Ok(least / problem.duration())
}

fn first_line(text: &str) -> String {
    let text = text.lines().find(|line| !line.trim().is_empty()).unwrap_or("it does not run");
    text.trim_start_matches("error: ").to_owned()
}

impl Sheet {
    /// The settings of a course.
    pub fn of(&self, course: Course) -> impl Iterator<Item = &Cell> {
        self.cells.iter().filter(move |cell| cell.course == course)
    }

    /// All courses, in order.
    pub fn courses(&self) -> Vec<Course> {
        let mut courses: Vec<Course> = Vec::new();
        for cell in &self.cells {
            if courses.last() != Some(&cell.course) {
                courses.push(cell.course);
            }
        }
        courses
    }

    /// The cheapest setting whose error is at most `error`.
    pub fn cheapest(&self, error: f64) -> Option<(&Cell, Reached)> {
        let good = self.cells.iter().filter_map(|cell| Some((cell, cell.outcome.as_ref().ok().copied()?)));
        let good = good.filter(|(_, reached)| reached.error <= error);
        good.min_by(|(_, a), (_, b)| a.cost.total_cmp(&b.cost))
    }

    /// The least error of a course.
    pub fn least(&self, course: Course) -> Option<f64> {
        let errors = self.of(course).filter_map(|cell| cell.outcome.as_ref().ok().map(|reached| reached.error));
        errors.min_by(f64::total_cmp)
    }

    /// What rounding alone may do, at the shortest tick that was run.
    pub fn floor(&self) -> f64 {
        let shortest = self.cells.iter().map(|cell| cell.tick).fold(self.problem.tick, f64::min);
        (self.problem.rounding)(shortest)
    }

    /// The grade for an error: `reference` where it is rounding.
    pub fn grade(&self, error: f64) -> Option<&'static str> {
        if error <= self.floor() {
            return Some("reference");
        }
        GRADES.iter().rev().find(|(_, bound)| error <= *bound).map(|(name, _)| *name)
    }

    /// The cells as comma-separated values.
    pub fn csv(&self) -> String {
        let mut text = "method,events,tick,error,cost,failure\n".to_owned();
        for Cell { course: Course { method, events }, tick, outcome } in &self.cells {
            let row = match outcome {
                Ok(Reached { error, cost }) => format!("{method},{events:?},{tick:e},{error:e},{cost:e},\n"),
                Err(reason) => format!("{method},{events:?},{tick:e},,,\"{}\"\n", reason.replace('"', "\"\"")),
            };
            text.push_str(&row);
        }
        text
    }
}

/// What the report was made with: version, processor, cores, vector instructions.
pub fn machine() -> String {
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let (version, level) = (env!("CARGO_PKG_VERSION"), crate::simd::Level::best());
    format!("jostle {version}, {}, one of {cores} cores, {level}", std::env::consts::ARCH)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::problems::{elastic_bounce, spring_mass};

    fn sheet() -> Sheet {
        let course = |method| Course { method, events: EventTiming::Auto };
        let cell =
            |method, tick, error, cost| Cell { course: course(method), tick, outcome: Ok(Reached { error, cost }) };
        let failed = Cell { course: course("B"), tick: 1.0, outcome: Err("a \"b\"".to_owned()) };
        let cells = vec![cell("A", 0.1, 5e-3, 1e-4), cell("A", 0.01, 5e-5, 1e-3), failed, cell("B", 0.1, 1e-9, 5e-4)];
        Sheet { problem: spring_mass::PROBLEM, cells, hash: None }
    }

    #[test]
    fn the_cheapest_that_is_good_enough_is_found() {
        let sheet = sheet();
        let cheapest = |error| sheet.cheapest(error).map(|(cell, _)| (cell.course.method, cell.tick));
        assert_eq!(cheapest(1e-2), Some(("A", 0.1)));
        assert_eq!(cheapest(1e-4), Some(("B", 0.1)));
        assert_eq!(cheapest(1e-10), None);
        assert_eq!(sheet.courses().len(), 2);
        assert_eq!(sheet.least(sheet.cells[0].course), Some(5e-5));
    }

    #[test]
    fn grades_follow_errors_and_failures_stay() {
        let sheet = sheet();
        assert_eq!(
            [1.0, 1e-2, 1e-5, 1e-9].map(|e| sheet.grade(e)),
            [None, Some("bronze"), Some("silver"), Some("gold")]
        );
        assert_eq!(sheet.grade(0.0), Some("reference"));
        assert!(sheet.csv().contains("B,Auto,1e0,,,\"a \"\"b\"\"\"\n"), "{}", sheet.csv());
    }

    #[test]
    fn errors_of_a_sheet_are_those_of_the_problem() {
        let problem = elastic_bounce::PROBLEM;
        let sheet = Order { quick: true }.measure(&problem, || ());
        assert!(sheet.hash.is_some());
        let [verlet] = &sheet
            .cells
            .iter()
            .filter(|cell| {
                cell.course == Course { method: "VelocityVerlet", events: EventTiming::PerTick }
                    && cell.tick == problem.tick
            })
            .collect::<Vec<_>>()[..]
        else {
            panic!("there is one such cell")
        };
        let setting =
            Setting { method: "VelocityVerlet", tick: problem.tick, shift: 0.0, events: EventTiming::PerTick };
        assert_eq!(verlet.outcome.as_ref().unwrap().error, problem.measure(&setting).unwrap());
    }
}
