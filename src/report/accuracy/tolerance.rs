//! `tolerance`: the coarsest steps with which the error of a whole run stays below what is allowed.
//!
//! Two coarse runs differ by the error of the coarser one. With the power by which the error falls, that says how fine the
//! steps have to be; where they would have to be much finer than those tried, a trial nearer to them comes between. Errors
//! are those of the whole run, not of a step: what a scene makes of the error of a step is measured, not guessed.

use super::fineness::{Ladder, Trials};
use super::trajectory::{Apart, Trajectory};
use crate::report::card::{ErrorEstimate, ErrorParts, number, rough};
use crate::scene::SceneErrors;
use crate::simulation::Plan;

/// The estimated error aims at this share of the tolerance.
const SAFETY: f64 = 0.3;
/// The first run allows steps this many times the tolerance: errors of steps add up, so that the final one needs less.
const COARSER: f64 = 3.0;
/// Trials at the most, where the error does not fall as it should.
const MOST_TRIALS: u32 = 9;

/// Observed powers beyond these are chance.
const LEAST_POWER: f64 = 0.5;
const MOST_POWER: f64 = 9.0;

/// How a ladder is climbed.
struct Climb {
    /// The fineness of the first trial, and by how much the second one is finer.
    first: f64,
    finer: f64,
    /// The power of the fineness by which the error falls, until it is seen.
    power: f64,
    /// Whether the power has to be seen before it is relied on.
    wary: bool,
    /// The coarsest and the finest that are chosen.
    coarsest: f64,
    finest: f64,
    /// How much finer than the last trial the final run may be.
    trusted: f64,
}

impl Climb {
    fn of(trials: &Trials, tolerance: f64) -> Self {
        let steps = 1.0 / f64::from(trials.steps);
        let even = Self {
            first: steps,
            finer: 0.5,
            power: 1.0,
            wary: true,
            coarsest: steps,
            finest: steps / 4096.0,
            trusted: 0.25,
        };
        match trials.ladder {
            Ladder::Allowed => {
                let first = (COARSER * tolerance).clamp(1e-6, 1e-3);
                Self { first, finer: 0.03, power: 1.0, wary: false, coarsest: tolerance, finest: 1e-14, trusted: 0.1 }
            }
            Ladder::Steps => Self { power: f64::from(trials.order), wary: false, ..even },
            Ladder::Ticks => even,
        }
    }
}

/// Finds the plan.
pub(super) fn find(tolerance: f64, trials: &mut Trials) -> Result<Plan, SceneErrors> {
    let mut climb = Climb::of(trials, tolerance);
    let mut coarse = trials.run(climb.first, "a coarse run", |_| {})?;
    if coarse.crowded && trials.ladder == Ladder::Allowed {
        trials.go_by_ticks();
        climb = Climb::of(trials, tolerance);
        coarse = trials.run(climb.first, "a coarse run by whole ticks", |_| {})?;
    }
    let mut fineness = climb.first;
    let mut next = (fineness * climb.finer).max(climb.finest);
    let mut before: Option<(f64, f64)> = None;
    loop {
        let fine = trials.run(next, "a finer run", |_| {})?;
        let apart = coarse.apart(&fine);
        let difference = apart.share;
        if trials.ladder != Ladder::Allowed
            && let Some((coarser, larger)) = before
        {
            let seen = (larger / difference).ln() / (coarser / fineness).ln();
            climb.power = if seen.is_finite() { seen.clamp(LEAST_POWER, MOST_POWER) } else { climb.power };
        }
        // The finer run's own error is in the difference too.
        let left = 1.0 - (next / fineness).powf(climb.power);
        let error_at = |then: f64| {
            let share = (then / fineness).powf(climb.power) / left;
            Apart { share: apart.share * share, distance: apart.distance * share, speed: apart.speed * share }
        };
        let wanted = fineness * (SAFETY * tolerance * left / difference).powf(1.0 / climb.power);
        let sure = !climb.wary || before.is_some();
        if sure && !fine.bounded && wanted >= (next * climb.trusted).max(climb.finest) {
            let chosen = wanted.min(climb.coarsest);
            return Ok(reached(trials, chosen, tolerance, error_at(chosen)));
        }
        if fine.bounded || next <= climb.finest || trials.count >= MOST_TRIALS {
            return Ok(missed(trials, next, tolerance, (&coarse, &fine), error_at(next)));
        }
        (before, fineness, coarse) = (Some((fineness, difference)), next, fine);
        let middle = if wanted > 0.0 { (next * wanted).sqrt() } else { 0.0 };
        next = middle.clamp(next * climb.finer * climb.finer, next * climb.finer).max(climb.finest);
    }
}

/// The error of a run as the card shows it.
pub(super) fn estimate(apart: Apart) -> ErrorEstimate {
    let part = |value: f64| ErrorParts { discretisation: value.is_finite().then_some(value), ..Default::default() };
    ErrorEstimate { position: part(apart.distance), velocity: part(apart.speed), ..Default::default() }
}

fn reached(trials: &Trials, fineness: f64, tolerance: f64, error: Apart) -> Plan {
    let mut plan = trials.planned(fineness);
    let (distance, speed) = trials.sizes();
    plan.notes.push(format!(
        "tolerance {}: {}; bodies go as far as {} m and are as fast as {} m/s, and the run is expected to be within {} m of \
         the exact places and within {} m/s of the exact velocities",
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

/// No run was fine enough: the finest is taken, and the card says from when on it is wrong.
fn missed(
    trials: &Trials,
    fineness: f64,
    tolerance: f64,
    (coarse, fine): (&Trajectory, &Trajectory),
    error: Apart,
) -> Plan {
    let mut plan = trials.planned(fineness);
    let lost = coarse.parts(fine, tolerance * trials.sizes().0);
    let why = match lost {
        _ if fine.bounded => format!(
            "rounding of places {} m from the origin leaves no smaller steps for bodies that go {} m; move the scene to the origin",
            number(fine.farthest()),
            number(trials.sizes().0)
        ),
        Some(time) => format!("the two finest runs part at t = {} s, by rounding or chaos", number(time)),
        None => "the two finest runs differ in their velocities by more".to_owned(),
    };
    plan.warning = Some(format!("the tolerance of {} is not reached: {why}", number(tolerance)));
    plan.notes.push(format!("{}; {}", trials.words(&plan), trials.cost()));
    let mut known = estimate(error);
    known.position.rounding = Some(f64::EPSILON * fine.farthest());
    plan.error = Some(known);
    plan
}
