//! Validation of Richardson extrapolation against reference solutions. Each problem runs with an
//! estimate of its error, and a run of far smaller error gives the true one.

use crate::SimulationExt;
use std::error::Error;

use super::{Effort, EstimateRequest, Repeated, estimate, watch};
use crate::problems::{EventTiming, Problem, ProblemSetting};
use jostle_engine::Simulation;
use jostle_engine::integrate::ClockSection;
use jostle_engine::scene::Source;
use jostle_engine::simulation::Overrides;
use jostle_engine::simulation::accuracy::trajectory::Trajectory;

/// Methods whose estimates are compared.
pub const METHODS: [&str; 3] = ["VelocityVerlet", "RungeKutta4", "Dop853"];
/// Tried ticks, over that of the problem.
const LADDER: [f64; 10] = [64.0, 32.0, 16.0, 8.0, 4.0, 2.0, 1.0, 0.5, 0.25, 0.125];
/// At most this many of them count for each problem and method, the longest first...
const STEPS: usize = 3;
/// ... if their errors, as shares of the motion, are neither useless, nor rounding, nor the reference's own error.
const USEFUL: (f64, f64) = (1e-10, 3e-2);
/// The least factor by which the error falls when the tick is halved. With less the tick is too coarse.
const FALLS: f64 = 1.4;
/// Moments at which runs are compared.
const MOMENTS: u64 = 64;

/// An estimate and the truth, both the greatest error of a place in metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Checked {
    /// Name of the problem.
    pub problem: &'static str,
    /// Name of the method.
    pub method: &'static str,
    /// Seconds of a tick.
    pub tick: f64,
    /// The estimate of the run.
    pub estimated: f64,
    /// Its distance from the reference run.
    pub truth: f64,
}

impl Checked {
    /// The estimate over the truth.
    pub fn ratio(&self) -> f64 {
        self.estimated / self.truth
    }
}

/// The estimate of a run: the error of positions in m, and the time in s until which it holds.
struct Told {
    error: f64,
    until: f64,
}

/// A run of a problem: its trajectory, and the estimate of its error.
fn run(
    problem: &Problem,
    (setting, stride): (&ProblemSetting, u64),
    overrides: &Overrides,
) -> Result<(Trajectory, Option<Told>), Box<dyn Error>> {
    let source = Source::new(problem.name, (problem.scene)(setting, problem.duration()));
    let load = |overrides: &Overrides| Simulation::load_with(&source, overrides, |_| {});
    let (mut seen, mut told) = (load(overrides)?, load(overrides)?);
    let ticks = seen.ticks();
    Trajectory::watch(&mut seen, (1..=ticks / stride).map(|moment| moment * stride).collect());
    seen.run_to_end()?;
    let trajectory = Trajectory::watched(&mut seen, None);
    let wanted = EstimateRequest { effort: Effort::Little, ..EstimateRequest::default() };
    watch(&mut told, wanted);
    told.run_to_end()?;
    estimate(&mut told, wanted, &Repeated { overrides, load: &load, tell: None, interrupted: None })?;
    let error = told.card().error;
    let error = error.and_then(|error| {
        let until = error.horizon.unwrap_or(f64::INFINITY);
        error.position.discretisation.map(|error| Told { error, until })
    });
    Ok((trajectory, error))
}

/// Compares estimates of a problem with the reference, for each of [`METHODS`]. It takes the three longest ticks at
/// which errors are useful and fall with the tick. Exact methods have none.
///
/// # Errors
/// When the reference run of the problem does not run.
pub fn check(problem: &Problem) -> Result<Vec<Checked>, Box<dyn Error>> {
    let most = problem.duration() / MOMENTS as f64;
    let Some(coarsest) = LADDER.map(|share| share * problem.tick).into_iter().find(|tick| *tick <= most) else {
        return Ok(Vec::new());
    };
    // All runs are compared at the same moments: ends of ticks of the coarsest, and so of all others.
    let stride = (most / coarsest) as u64;
    let setting = ProblemSetting { tick: coarsest, events: EventTiming::Located, ..ProblemSetting::default() };
    let method = Some(ClockSection::REFERENCE.to_owned());
    let overrides = Overrides { method, tick: Some(coarsest), ..Overrides::default() };
    let (truth, _) = run(problem, (&setting, stride), &overrides)?;
    let mut checked = Vec::new();
    for method in METHODS {
        let (mut coarser, mut found): (Option<(Checked, f64)>, usize) = (None, 0);
        for tick in LADDER.map(|share| share * problem.tick) {
            let setting = ProblemSetting { method, tick, ..ProblemSetting::default() };
            if tick > coarsest || found == STEPS {
                continue;
            }
            let stride = stride * (coarsest / tick).round() as u64;
            let Ok((own, Some(told))) = run(problem, (&setting, stride), &Overrides::default()) else {
                continue;
            };
            let seen = own.differences(&truth).filter(|(time, _)| *time <= told.until);
            let apart = seen.map(|(_, far)| far).fold(0.0, f64::max);
            let this = (
                Checked { problem: problem.name, method, tick, estimated: told.error, truth: apart },
                apart / truth.sizes().0,
            );
            let rounding = this.1 < USEFUL.0;
            if let Some((before, share)) = coarser.replace(this)
                && (USEFUL.0..USEFUL.1).contains(&share)
                && share > FALLS * this.1
            {
                checked.push(before);
                found += 1;
            }
            if rounding {
                break;
            }
        }
    }
    Ok(checked)
}
