//! A problem in a work-precision series: the comparison of a run with its exact answer.

use std::convert::Infallible;

use crate::problems::{Problem, ProblemSetting as Run};
use crate::work_precision::{Deviation, MethodChoice, Setting, SettingOutcome, Subject, timed};
use jostle_engine::integrate::ChosenMethod;
use jostle_engine::tick::State;
use jostle_language::numbers::number;

/// The phases of events in a tick, as shares of it.
const PHASES: [f64; 3] = [0.0, 0.37, 0.71];

/// A problem that is asked.
pub(super) struct Asked<'a> {
    pub problem: &'a Problem,
    /// Whether several phases are run where errors depend on them.
    pub phases: bool,
}

impl Subject for Asked<'_> {
    type Wrong = Infallible;

    fn run(&self, course: MethodChoice, tick: f64) -> Result<(Setting, f64), Infallible> {
        let problem = self.problem;
        let phases = if problem.class.depends_on_phase() && self.phases { &PHASES[..] } else { &PHASES[..1] };
        let mut setting = Setting::new(course, tick);
        let (mut error, mut spent) = (0.0_f64, 0.0);
        for phase in phases {
            let MethodChoice { method, events } = course;
            let run = Run { method, tick, shift: phase * tick, events };
            let mut simulation = match problem.load(&run) {
                Ok(simulation) => simulation,
                Err(wrong) => {
                    setting.outcome = SettingOutcome::Refused(first_line(&wrong.to_string()));
                    return Ok((setting, spent));
                }
            };
            let world = simulation.unpublished_world();
            setting.located = world.get_resource::<ChosenMethod>().is_some_and(|method| method.located);
            let (time, found) = timed(|| problem.run(&mut simulation, &run));
            let time = time.as_secs_f64();
            spent += time;
            let evaluations = simulation.resource::<State>().evaluation().count as f64;
            match found {
                Ok(found) => error = if found.is_finite() { error.max(found) } else { f64::INFINITY },
                Err(failure) => {
                    let reached = failure.time.max(tick);
                    (setting.evaluations, setting.seconds) = (evaluations / reached, Some(time / reached));
                    setting.outcome = SettingOutcome::Failed(failure);
                    return Ok((setting, spent));
                }
            }
            setting.evaluations = setting.evaluations.max(evaluations / problem.duration());
        }
        if error.is_finite() {
            setting.outcome = SettingOutcome::Measured(Deviation { error, apart: None });
        }
        Ok((setting, spent))
    }

    fn is_floor(&self, error: f64, tick: f64) -> Option<String> {
        let rounding = (self.problem.rounding)(tick);
        (error <= rounding)
            .then(|| format!("its error is what rounding or the answer leaves open, {}", number(short(rounding))))
    }
}

/// One digit.
fn short(value: f64) -> f64 {
    format!("{value:.0e}").parse().unwrap_or(value)
}

fn first_line(text: &str) -> String {
    let text = text.lines().find(|line| !line.trim().is_empty()).unwrap_or("it does not run");
    text.trim_start_matches("error: ").to_owned()
}
