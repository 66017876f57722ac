//! `method: Reference`: the smallest error there is, how large it is, and for how long the motion can be told at all.
//!
//! Two runs with steps of very small errors differ by no less than what either is wrong by, if their errors are not alike by
//! chance. A third one begins beside the first, by a hair: how fast that grows says for how long digits last. Errors of chaotic
//! motion grow as `e^(lambda t)`, so that rounding alone, `2^-53`, is seen after `ln(seen / 2^-53) / lambda`.

use super::fineness::Trials;
use super::tolerance::estimate;
use super::trajectory::Trajectory;
use crate::Simulation;
use crate::report::card::{number, rough};
use crate::scene::SceneErrors;
use crate::simulation::Plan;
use crate::world::Position;

/// Error of a step of the finer run, as a share of the motion; the coarser one may err a hundred times as much.
const FINE: f64 = 1e-14;
const COARSE: f64 = 1e-12;
/// Share of the motion by which the third run begins beside the first.
const BESIDE: f64 = 1e-10;
/// Share of the motion at which an error is seen.
const SEEN: f64 = 1e-3;
/// A disturbance that grows by less is no chaos.
const CHAOS: f64 = 1e4;

/// Finds the plan.
pub(super) fn find(trials: &mut Trials) -> Result<Plan, SceneErrors> {
    let coarse = trials.run(COARSE, "a first run", |_| {})?;
    let fine = trials.run(FINE, "a finer run", |_| {})?;
    let (distance, _) = trials.sizes();
    let beside = trials.run(COARSE, "a run that begins beside it", |simulation| {
        disturb(simulation, BESIDE * distance);
    })?;
    let error = coarse.apart(&fine);
    let mut plan = trials.planned(FINE);
    let growth = coarse.apart_at_end(&beside) / (BESIDE * distance);
    let mut known = estimate(error);
    known.position.rounding = Some(growth.max(1.0) * f64::EPSILON * fine.farthest()).filter(|error| error.is_finite());
    known.horizon = horizon(&coarse, growth);
    plan.notes.push(format!(
        "reference run: {}; a run that allows a hundred times that error differs by {} m and {} m/s",
        trials.words(&plan),
        rough(error.distance),
        rough(error.speed),
    ));
    plan.notes.push(match known.horizon {
        Some(horizon) => format!(
            "chaos: a disturbance grows by a factor of {growth:.0e} within the run, so that rounding shows after about {} s: no \
             run of any engine tells places beyond that",
            number(horizon)
        ),
        None => format!("no chaos: a disturbance of the beginning grows by a factor of {} within the run", number(growth)),
    });
    if fine.bounded {
        plan.warning = Some(format!(
            "rounding of places {} m from the origin bounds the steps of bodies that go {} m: the two runs are alike, and what \
             they differ by is no error; move the scene to the origin",
            number(fine.farthest()),
            number(distance)
        ));
    }
    plan.notes.push(trials.cost());
    plan.error = Some(known);
    Ok(plan)
}

/// When rounding is seen, in s, if a disturbance grows by `growth` in the run.
fn horizon(run: &Trajectory, growth: f64) -> Option<f64> {
    let lambda = growth.ln() / run.end();
    (growth > CHAOS).then(|| (SEEN / f64::EPSILON).ln() / lambda).filter(|horizon| horizon.is_finite())
}

/// Moves each dynamic body by `distance` metres, in turns along x and y.
fn disturb(simulation: &mut Simulation, distance: f64) {
    let entities: Vec<_> = {
        let bodies = simulation.bodies();
        (0..bodies.len()).filter(|&body| bodies.dynamic[body]).map(|body| bodies.entity[body]).collect()
    };
    for (number, entity) in entities.into_iter().enumerate() {
        if let Some(mut position) = simulation.world_mut().get_mut::<Position>(entity) {
            if number % 2 == 0 { position.0.x += distance } else { position.0.y += distance }
        }
    }
}
