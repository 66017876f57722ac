//! `tolerance`: the coarsest steps with which the error of a whole run stays below the allowed one.
//!
//! Two runs differ by the error of the coarser one, unless their errors are equal. So a fineness is accepted only after
//! a finer trial has differed by no more than the allowed error. Otherwise the power by which errors fall determines
//! the fineness of the next trial. Errors are those of the whole run, not of a step. The growth of the error of a step
//! in a scene is measured, not guessed.
//!
//! Errors of equal steps follow the power law of their method, once three trials have shown it. Then a fineness that it
//! foretells is accepted too. Errors of steps whose length follows from their error obey no such law. They add up with
//! changing signs, so that the sum for one allowance says little of the sum for another. They are measured only.

use super::alike_by_events;
use super::fineness::{Ladder, Trials};
use super::reference::TELLS_NOTHING;
use super::trajectory::{Trajectory, TrajectoryDistance};
use crate::integrate::ORDER;
use crate::scene::SceneErrors;
use crate::simulation::Plan;
use crate::simulation::error::{ErrorEstimate, ErrorParts};
use jostle_language::numbers::{number, rough};

/// A trial is good if a finer one differs from it by at most this share of the tolerance. If errors follow a law, the
/// finer one is good if they differ by at most `BETWEEN` tolerances. Its error exceeds that only if both errors are equally
/// large and alike.
const MEASURED: f64 = 0.7;
const BETWEEN: f64 = 2.5;
/// The same as `MEASURED`, where the finer one allows a tenth of the error and so errs by a tenth.
const OF_A_TENTH: f64 = 0.9;
/// The ratio of the fineness of a trial with other steps to that of the finer one. Its steps are not parts of those of
/// the others.
const OTHER_STEPS: f64 = 1.0 / 1.37;
/// Two runs with events may agree by chance, because events give errors either sign. They may also take the steps that springs and
/// loads ask for, and so decide alike between sticking and slipping. A run with this share of the fineness has to agree too. Its
/// steps of order eight are less than half as long.
const OWN_STEPS: f64 = 1e-3;
/// A predicted error aims at this share of the tolerance.
const FORETOLD: f64 = 0.3;
/// A prediction is confirmed if the result exceeds it by at most this factor, because errors of located events scatter.
const SCATTER: f64 = 3.0;
/// The first run allows its steps this share of the tolerance: errors of steps add up.
const FIRST: f64 = 0.1;
/// The greatest number of trials if the error does not fall as expected.
const MOST_TRIALS: u32 = 9;
/// The work of all trials, in evaluations of the forces of the smallest scene: about half a minute. A trial that would
/// exceed it is not begun.
const MOST_WORK: f64 = 6e7;

/// Trials with located events after one with too many, before all go by whole ticks.
const MORE_LOCATED: usize = 2;

/// A scene loses digits if its distance from the origin exceeds the ways of its bodies by this factor.
const FAR: f64 = 10.0;

/// Errors of steps add up. If that of the run exceeds the error of a step by more than this factor, the motion magnifies them.
const MAGNIFIED: f64 = 1e6;

/// Observed powers beyond these are chance.
const LEAST_POWER: f64 = 0.5;
const MOST_POWER: f64 = 9.0;

/// How a ladder is climbed.
struct Climb {
    /// The fineness of the first trial, and by how much the next one is finer at least, and at most.
    first: f64,
    finer: f64,
    finest_step: f64,
    /// The power of the fineness by which the error falls, until it is seen.
    power: f64,
    /// Whether the power has to be observed before it determines the fineness of the next trial.
    wary: bool,
    /// The finest that is tried.
    finest: f64,
    /// The greatest factor by which the final run is finer than the last trial.
    trusted: f64,
    /// A trial is good if a finer one differs by at most this share of the tolerance.
    measured: f64,
    /// Whether errors follow a power law, so that those of a fineness without a finer trial are known.
    lawful: bool,
    /// The work rises with this power of one over the fineness.
    cost: f64,
}

impl Climb {
    fn of(trials: &Trials, tolerance: f64) -> Self {
        let steps = 1.0 / f64::from(trials.steps);
        let even = Self {
            first: steps,
            finer: 0.5,
            finest_step: 1.0 / 16.0,
            power: 1.0,
            wary: true,
            finest: steps / 4096.0,
            trusted: 0.25,
            measured: MEASURED,
            lawful: true,
            cost: 1.0,
        };
        match trials.ladder {
            Ladder::Allowed => Self {
                first: (FIRST * tolerance).clamp(1e-13, 1e-3),
                finer: 0.1,
                finest_step: 1e-3,
                power: 1.0,
                wary: false,
                finest: 1e-14,
                trusted: 1.0,
                measured: OF_A_TENTH,
                lawful: false,
                cost: 1.0 / ORDER,
            },
            Ladder::Steps => Self { power: f64::from(trials.order), wary: false, ..even },
            Ladder::Ticks => even,
        }
    }
}

impl Climb {
    /// The fineness of the next trial. It is at least `least` times that of the last one, which had `next` and took the
    /// work `taken`. The error asks for `wanted`, and `sure` says that two pairs of trials agree in that. `None` if no
    /// finer trial fits into the work that is left.
    fn then(&self, (next, least): (f64, f64), (wanted, sure): (f64, bool), (taken, left): (f64, f64)) -> Option<f64> {
        let affordable = next * (taken / left.max(f64::MIN_POSITIVE)).powf(1.0 / self.cost);
        let (finer, needed) = (next * self.finer, wanted.max(self.finest).min(next * self.finer));
        let fits = affordable <= if sure { needed } else { finer };
        fits.then(|| self.down_to(wanted.clamp(next * least, finer).max(affordable)))
    }

    /// The fineness of a trial. Two trials that are finest to rounding would not differ, so one near the finest is that.
    fn down_to(&self, fineness: f64) -> f64 {
        if fineness < 2.0 * self.finest { self.finest } else { fineness }
    }
}

/// Finds the plan with hasty trials, or with patient ones if hasty ones ended without a result.
pub(super) fn find(tolerance: f64, trials: &mut Trials) -> Result<Plan, SceneErrors> {
    trials.hasty = true;
    let plan = climb(tolerance, trials)?;
    if plan.warning.is_none() || !trials.cut || trials.work > MOST_WORK {
        return Ok(plan);
    }
    (trials.hasty, trials.count) = (false, 0);
    climb(tolerance, trials)
}

fn climb(tolerance: f64, trials: &mut Trials) -> Result<Plan, SceneErrors> {
    let mut climb = Climb::of(trials, tolerance);
    let mut coarse = trials.run(climb.first, "a coarse run", |_| {})?;
    for _ in 0..MORE_LOCATED {
        // Rounding may decide whether events crowd in one tick. Then they do not with other steps.
        if coarse.overloaded && trials.ladder == Ladder::Allowed {
            climb.first *= climb.finer;
            coarse = trials.run(climb.first, "a coarse run with other steps", |_| {})?;
        }
    }
    // Whole ticks and located events share no law of switching. So the last trial with events tells what whole ticks cannot.
    let mut by_events = None;
    if coarse.overloaded && trials.ladder == Ladder::Allowed && trials.go_by_ticks() {
        climb = Climb::of(trials, tolerance);
        let by_ticks = trials.run(climb.first, "a coarse run by whole ticks", |_| {})?;
        by_events = Some(std::mem::replace(&mut coarse, by_ticks));
    }
    if coarse.bounded {
        // Two runs that rounding bounds are alike, and their difference is not an error.
        climb.first /= climb.finer;
        coarse = trials.run(climb.first, "a coarser run", |_| {})?;
    }
    let mut fineness = climb.first;
    let mut next = climb.down_to(fineness * climb.finer);
    // Fineness and difference of the last pair of trials, and the predicted error.
    let mut before: Option<(f64, f64, f64)> = None;
    loop {
        let fine = trials.run(next, "a finer run", |_| {})?;
        let mut apart = coarse.apart(&fine);
        let mut confirming = None;
        if trials.ladder == Ladder::Steps && fine.jumped && apart.share <= BETWEEN * tolerance {
            // The steps of one run are halves of those of the other. Events at the same phase of both have equal
            // errors.
            let other = trials.run(next * OTHER_STEPS, "a run with other steps", |_| {})?;
            apart = apart.max(coarse.apart(&other));
        }
        if trials.ladder == Ladder::Allowed
            && fine.jumped
            && apart.share <= climb.measured * tolerance
            && next > climb.finest
        {
            let other = trials.run(climb.down_to(next * OWN_STEPS), "a run with steps of its own", |_| {})?;
            apart = apart.max(coarse.apart(&other));
            confirming = Some(other);
        }
        let difference = apart.share;
        let confirmed = before.is_some_and(|(.., error)| error.is_finite() && difference <= SCATTER * error);
        if trials.ladder != Ladder::Allowed
            && let Some((coarser, larger, _)) = before
        {
            let seen = (larger / difference).ln() / (coarser / fineness).ln();
            climb.power = if seen.is_finite() { seen.clamp(LEAST_POWER, MOST_POWER) } else { climb.power };
        }
        // The finer run's own error is in the difference too.
        let left = 1.0 - (next / fineness).powf(climb.power);
        let foretold_at = |then: f64| (then / fineness).powf(climb.power) / left;
        // An error that rounding bounds does not fall with fineness.
        let share_at = |then: f64| match () {
            () if fine.bounded || !climb.lawful && then < fineness => foretold_at(then).max(1.0),
            () => foretold_at(then),
        };
        let wanted = fineness * (FORETOLD * tolerance * left / difference).powf(1.0 / climb.power);
        let alike = coarse.bounded && fine.bounded;
        let chosen = match difference {
            _ if alike => None,
            // Ticks with too many events continued by another method, and two runs of it make the same errors.
            _ if coarse.overloaded || fine.overloaded => None,
            _ if difference <= climb.measured * tolerance => Some(fineness),
            // Without a law only a finer trial tells the error of the next one, and two trials show no law.
            _ if !climb.lawful || before.is_none() => None,
            _ if difference <= BETWEEN * tolerance => Some(next),
            _ if confirmed && wanted >= (next * climb.trusted).max(climb.finest) => Some(wanted.min(next)),
            _ => None,
        };
        if let Some(chosen) = chosen {
            let error = apart.times(share_at(chosen));
            let elsewhere = by_events.as_ref().map(|by_events| at_moments_of(&fine, by_events).apart(&fine));
            let elsewhere = elsewhere.filter(|other| other.distance.is_finite());
            let mut plan = reached(trials, chosen, tolerance, elsewhere.map_or(error, |other| error.max(other)));
            if let Some(other) = elsewhere.filter(|other| other.share > tolerance) {
                plan.warning = Some(beyond_by_events(tolerance, other));
            }
            return Ok(plan);
        }
        let least = if climb.wary && before.is_none() { climb.finer } else { climb.finest_step };
        let (sure, left) = (before.is_some(), MOST_WORK - trials.work);
        let then = climb.then((next, least), (wanted, sure), (fine.work, left));
        let ended = alike || next <= climb.finest || trials.count >= MOST_TRIALS;
        let Some(then) = then.filter(|_| !ended) else {
            let ends = Ends { fineness: next, finest: next <= climb.finest, dear: then.is_none() };
            let (confirming, by_events) = (confirming.as_ref(), by_events.as_ref());
            let runs = Runs { coarse: &coarse, fine: &fine, confirming, by_events };
            return Ok(missed(trials, ends, tolerance, runs, apart.times(share_at(next))));
        };
        before = Some((fineness, difference, difference * share_at(next)));
        (fineness, coarse, next) = (next, fine, then);
    }
}

/// The error of a run as the card shows it.
pub(super) fn estimate(apart: TrajectoryDistance) -> ErrorEstimate {
    let part = |value: f64| ErrorParts { discretisation: value.is_finite().then_some(value), ..Default::default() };
    ErrorEstimate { position: part(apart.distance), velocity: part(apart.speed), ..Default::default() }
}

fn reached(trials: &Trials, fineness: f64, tolerance: f64, error: TrajectoryDistance) -> Plan {
    let mut plan = trials.planned(fineness);
    let (distance, speed) = trials.sizes();
    plan.notes.push(format!(
        "tolerance {}: {}. Bodies go as far as {} m and are as fast as {} m/s. The expected error of places is {} m, that of \
         velocities {} m/s",
        number(tolerance),
        trials.words(&plan),
        number(distance),
        number(speed),
        rough(error.distance),
        rough(error.speed),
    ));
    plan.notes.push(trials.cost());
    plan.error = Some(estimate(error));
    plan
}

/// A run that was looked at more often than `other`, at the moments of that one.
fn at_moments_of(other: &Trajectory, run: &Trajectory) -> Trajectory {
    run.part(f64::INFINITY, (run.moments() / other.moments().max(1)).max(1))
}

/// Whole ticks agree with each other, and not with the run that located most of its events.
fn beyond_by_events(tolerance: f64, other: TrajectoryDistance) -> String {
    format!(
        "the tolerance of {} is not reached: some ticks had too many events to locate them all. Whole ticks of velocity Verlet agree \
         with each other, and lead up to {} m away from the run that located the other events",
        number(tolerance),
        rough(other.distance)
    )
}

/// The reason for which steps cannot be smaller, if bodies come `farthest` metres from the origin and go `distance`.
fn bounded(farthest: f64, distance: f64) -> String {
    if farthest > FAR * distance {
        let (farthest, distance) = (number(farthest), number(distance));
        format!(
            "rounding of places {farthest} m from the origin leaves no smaller steps for bodies that go {distance} m. Move \
             the scene to the origin"
        )
    } else {
        "rounding leaves no smaller steps, and the motion magnifies it".to_owned()
    }
}

/// How a ladder ended that leads to no plan.
#[derive(Clone, Copy)]
struct Ends {
    fineness: f64,
    /// Whether the engine takes no finer steps.
    finest: bool,
    /// Whether a finer trial would take too many evaluations.
    dear: bool,
}

/// The runs that tell the error of a ladder without a plan.
#[derive(Clone, Copy)]
struct Runs<'a> {
    /// The two finest.
    coarse: &'a Trajectory,
    fine: &'a Trajectory,
    /// A much finer one that did not agree, though these two did.
    confirming: Option<&'a Trajectory>,
    /// The last one with located events, if these two go by whole ticks.
    by_events: Option<&'a Trajectory>,
}

/// No run was fine enough. The finest is taken, and the card gives the time from which it is wrong.
fn missed(
    trials: &Trials,
    ends: Ends,
    tolerance: f64,
    Runs { coarse, fine, confirming, by_events }: Runs,
    mut error: TrajectoryDistance,
) -> Plan {
    let mut plan = trials.planned(ends.fineness);
    let finer = || std::iter::once(fine).chain(confirming);
    let lost = finer().filter_map(|finer| coarse.parts(finer, tolerance * trials.sizes().0)).reduce(f64::min);
    let magnified = trials.ladder == Ladder::Allowed && error.share > MAGNIFIED * ends.fineness;
    let why = match lost {
        _ if coarse.bounded && fine.bounded => bounded(fine.farthest(), trials.sizes().0),
        _ if ends.dear && !ends.finest => {
            format!("trials ended after {} evaluations of all forces, as further ones take long", trials.evaluations)
        }
        _ if coarse.overloaded || fine.overloaded => alike_by_events(),
        Some(time) => {
            let why = match ends.finest {
                true if magnified => ": the motion magnifies errors of the finest steps, as chaos does",
                true => ": the engine takes no finer steps",
                false => ", by rounding or chaos",
            };
            format!("the finest runs part at t = {} s{why}", number(time))
        }
        None => "the finest runs differ in their velocities by more".to_owned(),
    };
    plan.warning = Some(format!("the tolerance of {} is not reached: {why}", number(tolerance)));
    plan.notes.push(format!("{}; {}", trials.words(&plan), trials.cost()));
    // Errors that the motion magnifies do not fall in proportion to the error of a step.
    let useless = TELLS_NOTHING * trials.sizes().0;
    let mut horizon = finer().filter_map(|finer| coarse.apart_until(finer, useless).1).reduce(f64::min);
    if magnified || horizon.is_some() {
        let until = horizon.unwrap_or(f64::INFINITY);
        let apart = finer().map(|finer| coarse.part(until, 1).apart(&finer.part(until, 1)));
        error = apart.reduce(TrajectoryDistance::max).unwrap_or(error);
    }
    let elsewhere = by_events.map(|by_events| at_moments_of(fine, by_events).apart_until(fine, useless));
    if let Some((other, parted)) = elsewhere.filter(|(other, _)| other.distance.is_finite()) {
        error = error.max(other);
        horizon = [horizon, parted].into_iter().flatten().reduce(f64::min);
    }
    let mut known = estimate(error);
    known.horizon = horizon;
    if coarse.overloaded || fine.overloaded {
        (known.position.discretisation, known.velocity.discretisation) = (None, None);
    }
    known.position.rounding = Some(f64::EPSILON * fine.farthest());
    plan.error = Some(known);
    plan
}
