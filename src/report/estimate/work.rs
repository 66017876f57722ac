//! The work of an estimate, as a count that does not depend on the computer or on its load. The unit is that of
//! [`work_of_an_evaluation`].

use std::time::{Duration, Instant};

use jostle_engine::Simulation;
use jostle_engine::tick::{Failure, FailureKind, State, work_of_an_evaluation};

/// The share of the run's work that an estimate may take by default.
pub(super) const SHARE: f64 = 0.03;
/// ... or this much, if that is more. It is about half a second...
const FREE: f64 = 1e6;
/// ... or two and a half times as much, if that suffices for the whole run.
const WHOLE: f64 = 2.5e6;

/// The work of reading a scene: for each atom, each body, and each force or other model. Scenes with 48 000 bodies were measured.
const READING: [f64; 3] = [14.0, 20.0, 46.0];

/// A finer run may take so many times the expected evaluations. Runs that locate events take as many, unless events crowd. Few of
/// these are then located, and the run is of no use.
const EXCESS: f64 = 1.5;
/// ... and this much work more: short runs vary. It is about a tenth of a second.
const SLACK: f64 = 2e5;
/// A finer run may take so many seconds, and this share of the time of the first run. That holds if systems of users give forces,
/// whose work has no count.
const SECONDS: f64 = 5.0;
const SHARE_OF_TIME: f64 = 0.5;
/// Parts of a run between which it is seen whether it takes too long.
const CHUNKS: u64 = 64;
/// The share of a finer run after which the count of its evaluations foretells the whole. A run whose beginning is
/// dearer than its end does not exceed that by the excess that is allowed.
const TELLS: f64 = 0.25;

/// Evaluations of forces so far.
fn evaluations(simulation: &Simulation) -> f64 {
    simulation.resource::<State>().evaluation().count as f64
}

/// The work of an evaluation of a finished run, from what is there at its end.
fn per_evaluation(simulation: &Simulation) -> f64 {
    work_of_an_evaluation(simulation.resource())
}

/// The part of a run that finer runs can repeat for little work, if they take `times` its work.
pub(super) fn affordable(simulation: &Simulation, times: f64) -> f64 {
    let work = evaluations(simulation) * per_evaluation(simulation);
    part(work, reading(simulation), times)
}

fn reading(simulation: &Simulation) -> f64 {
    let bodies = simulation.bodies();
    let counts = [bodies.atom_count(), bodies.len(), simulation.state().models().count()];
    counts.into_iter().zip(READING).map(|(count, each)| count as f64 * each).sum()
}

/// The same for a run of so much work.
fn part(work: f64, reading: f64, times: f64) -> f64 {
    let whole = times * work;
    let least = if whole + reading <= WHOLE { WHOLE } else { FREE };
    ((least.max(SHARE * work) - reading) / whole).clamp(0.0, 1.0)
}

/// How long a finer run may take.
#[derive(Clone, Copy, Debug)]
pub(super) struct Patience {
    evaluations: f64,
    /// The same as work. Bodies that the first run kept apart may have many neighbours in a finer one.
    work: f64,
    /// The expected evaluations.
    expected: f64,
    time: Option<Duration>,
}

impl Patience {
    /// For a run that repeats a part of the first, with steps shorter by the factor `finer`.
    pub fn of(first: &Simulation, part: f64, finer: f64) -> Self {
        let seconds = SECONDS + SHARE_OF_TIME * first.seconds_spent();
        let time = first.state().has_force_systems().then(|| Duration::from_secs_f64(seconds));
        let expected = finer * part * evaluations(first);
        let evaluations = EXCESS * expected + SLACK / per_evaluation(first);
        let work = evaluations * per_evaluation(first);
        Self { evaluations, work, expected, time }
    }

    /// Whether a run, of which the share `done` is over, will take more than `times` the expected evaluations.
    pub fn exceeds(&self, times: f64, run: &Simulation, done: f64) -> bool {
        evaluations(run) > times * self.expected * done.max(TELLS)
    }
}

/// A finer run took too long.
#[derive(Clone, Copy, Debug)]
pub(super) struct TooLong;

/// Runs until the end of a tick, or until a failure, which is returned. A run that is `useless` goes no farther. A run may end inside
/// a tick of many steps.
pub(super) fn run_to_tick(
    simulation: &mut Simulation,
    until: u64,
    patience: Option<Patience>,
    useless: impl Fn(&Simulation) -> bool,
) -> Result<Option<Failure>, TooLong> {
    let (begin, chunk) = (Instant::now(), (until / CHUNKS).max(1));
    let mut failure: Option<Failure> = None;
    if let Some(most) = patience {
        simulation.end_after(most.work);
    }
    while failure.is_none() && simulation.clock().ticks < until {
        let done = simulation.clock().ticks as f64 / until as f64;
        let foretold = evaluations(simulation) / if done > TELLS { done } else { 1.0 };
        let is_over =
            |most: Patience| foretold > most.evaluations || most.time.is_some_and(|time| begin.elapsed() > time);
        if patience.is_some_and(is_over) || useless(simulation) {
            return Err(TooLong);
        }
        failure = simulation.run_to_tick((simulation.clock().ticks + chunk).min(until)).err();
    }
    let stopped = failure.as_ref().is_some_and(|failure| failure.wrong == FailureKind::Stopped);
    if stopped { Err(TooLong) } else { Ok(failure) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use jostle_engine::scene::Source;

    #[test]
    fn short_runs_are_repeated_whole_and_long_ones_in_part() {
        assert_eq!(part(0.3 * WHOLE, 0.0, 3.0), 1.0);
        assert_eq!(part(WHOLE, 0.0, 3.0), FREE / (3.0 * WHOLE));
        let long = 1e3 * FREE;
        assert_eq!(part(long, 0.0, 3.0), SHARE / 3.0);
        assert_eq!(part(WHOLE, 2.0 * FREE, 3.0), 0.0, "reading alone is too dear");
    }

    /// One tick lasts the whole run, with thousands of evaluations.
    #[test]
    fn a_finer_run_that_takes_long_ends_inside_a_tick() {
        const SCENE: &str = "Scene(format: 1, clock: (duration: 20, tick: 20, method: Reference),
            bodies: [(name: \"sun\", at: (0, 0), mass: 1e6, atoms: Disc(radius: 0.1)),
                     (name: \"planet\", at: (1, 0), velocity: (0, 1), mass: 1, atoms: Disc(radius: 0.01))],
            forces: [Spring(a: \"sun\", b: \"planet\", stiffness: 3)])";
        let mut run = Simulation::load(&Source::new("orbit.ron", SCENE)).expect("a good scene");
        let patience = Patience { evaluations: 100.0, work: 100.0, expected: 100.0, time: None };
        assert!(run_to_tick(&mut run, 1, Some(patience), |_| false).is_err());
        assert!(evaluations(&run) < 200.0, "{} evaluations", evaluations(&run));
    }
}
