//! `method: Reference`: the smallest possible error, its size, and the time for which the motion is predictable
//! (Lyapunov horizon).
//!
//! Two runs with very small errors of steps differ by at least the error of either, except by chance. A third run
//! begins very near to the first. The growth of their distance gives the time for which digits last. Errors of chaotic
//! motion grow as `e^(lambda t)`. So rounding alone, `2^-53`, becomes visible after `ln(seen / 2^-53) / lambda`.

use super::alike_by_events;
use super::fineness::Trials;
use super::tolerance::estimate;
use crate::Simulation;
use crate::scene::SceneErrors;
use crate::simulation::Plan;
use crate::world::Position;
use jostle_language::numbers::{number, rough};

/// Error of a step of the finer run, as a share of the motion.
pub const FINE: f64 = 1e-14;
/// That of the coarser one, a hundred times as much.
pub const COARSE: f64 = 1e-12;
/// Share of the motion by which the third run begins beside the first.
pub const BESIDE: f64 = 1e-10;
/// Share of the motion at which an error is seen.
const SEEN: f64 = 1e-3;
/// A disturbance that grows by less is no chaos.
const CHAOS: f64 = 1e4;
/// A disturbance that grows as `e^(lambda t)` needs twice the time for the square of a factor. One that grows as `t^p`
/// needs the `1/p`-th power of that factor as a multiple. For `p` up to 2 that is more than this.
const TWICE: f64 = 5.0;
/// If runs differ by more than this share of the motion, their positions are meaningless.
pub const TELLS_NOTHING: f64 = 0.1;

/// Runs that differ by less than this share of the distance from the origin are alike. Only a few roundings of
/// positions separate them.
const ALIKE: f64 = 8.0 * f64::EPSILON;

/// Finds the plan.
pub(super) fn find(trials: &mut Trials) -> Result<Plan, SceneErrors> {
    let coarse = trials.run(COARSE, "a first run", |_| {})?;
    let fine = trials.run(FINE, "a finer run", |_| {})?;
    let (distance, _) = trials.sizes();
    let beside = trials.run(COARSE, "a run that begins beside it", |simulation| {
        disturb(simulation, BESIDE * distance);
    })?;
    let (error, parted) = coarse.apart_until(&fine, TELLS_NOTHING * distance);
    let mut plan = trials.planned(FINE);
    let growths: Vec<(f64, f64)> = coarse.differences(&beside).map(|(t, far)| (t, far / (BESIDE * distance))).collect();
    let growth = growths.iter().fold(0.0, |most, (_, growth)| growth.max(most));
    let mut known = estimate(error);
    let rounding = growth.max(1.0) * f64::EPSILON * fine.farthest();
    // Greater errors make positions meaningless. The cause is chaos, or an impact that happens in one run and not in
    // the other.
    known.position.rounding = Some(rounding).filter(|error| *error <= TELLS_NOTHING * distance);
    let lost =
        growths.iter().position(|(_, growth)| growth * f64::EPSILON * fine.farthest() > TELLS_NOTHING * distance);
    let told = lost.map(|index| index.checked_sub(1).map_or(0.0, |before| growths[before].0));
    known.horizon = [horizon(&growths), told, parted].into_iter().flatten().reduce(f64::min);
    plan.notes.push(format!(
        "reference run: {}. A run that allows a hundred times that error differs by {} m and {} m/s",
        trials.words(&plan),
        rough(error.distance),
        rough(error.speed),
    ));
    plan.notes.push(match known.horizon {
        Some(horizon) => format!(
            "chaos: a disturbance grows by a factor of {growth:.0e} within the run, so that rounding shows after about {} s. \
             No run of any engine tells places beyond that",
            number(horizon)
        ),
        None => format!("no chaos: a disturbance of the beginning grows by a factor of {} within the run", number(growth)),
    });
    if coarse.overloaded || fine.overloaded {
        // Stretches of whole ticks are alike in both runs.
        (known.position.discretisation, known.velocity.discretisation) = (None, None);
        plan.warning = Some(alike_by_events());
    } else if parted.is_none() && error.share > TELLS_NOTHING {
        (known.position.discretisation, known.velocity.discretisation) = (None, None);
    } else if coarse.bounded && fine.bounded && error.distance < ALIKE * fine.farthest() {
        plan.warning = Some(format!(
            "rounding of places {} m from the origin bounds the steps of bodies that go {} m. The two runs are alike, and \
             their difference is no error. Move the scene to the origin",
            number(fine.farthest()),
            number(distance)
        ));
    }
    plan.notes.push(trials.cost());
    plan.error = Some(known);
    Ok(plan)
}

/// The time in s at which rounding becomes visible, if a disturbance grows exponentially. It has grown by these factors
/// at these times.
pub fn horizon(growths: &[(f64, f64)]) -> Option<f64> {
    // Once it is seen it can grow no more.
    let most = growths.iter().fold(0.0, |most, (_, growth)| growth.max(most)).min(SEEN / BESIDE);
    let reaches = |factor: f64| growths.iter().find(|(_, growth)| *growth >= factor).map(|(time, _)| *time);
    let (half, whole) = (reaches(most.sqrt())?, reaches(most)?);
    (most > CHAOS && whole < TWICE * half).then(|| (SEEN / f64::EPSILON).ln() / most.ln() * whole)
}

/// Moves each dynamic body by `distance` metres, in turns along x and y.
pub fn disturb(simulation: &mut Simulation, distance: f64) {
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

#[cfg(test)]
mod tests {
    use super::*;

    fn grown(law: impl Fn(f64) -> f64) -> Option<f64> {
        horizon(&(0..=100).map(|time| (f64::from(time), law(f64::from(time)))).collect::<Vec<_>>())
    }

    /// `e^(t/4)` reaches `SEEN` of the motion from a share of 2^-52 after `4 ln(SEEN 2^52)` = 117 s. A motion that
    /// saturates or comes to rest afterwards is equally chaotic. Tolerance: 1 s, the distance of the moments at which
    /// it is read.
    #[test]
    fn exponential_growth_is_chaos_and_powers_are_not() {
        let exact = 4.0 * (SEEN / f64::EPSILON).ln();
        let until = |end: f64| move |time: f64| (time.min(end) / 4.0).exp();
        for horizon in
            [grown(until(90.0)), grown(until(60.0)), grown(|time| if time < 70.0 { until(90.0)(time) } else { 0.0 })]
        {
            assert!((horizon.expect("chaos") - exact).abs() < exact / 60.0, "{horizon:?} {exact}");
        }
        for power in [1, 2] {
            assert_eq!(grown(|time| 1.0 + (100.0 * time).powi(power)), None, "power {power}");
        }
        assert_eq!(grown(until(20.0)), None);
    }
}
