//! The model error of soft contacts. The run is repeated with contacts four times as stiff and half the tick, because
//! these are twice as fast.
//!
//! The deviation of a spring from a hard surface falls with one over the stiffness for resting bodies. For impacts the overlap
//! `v sqrt(m/k)` and the duration of a contact fall with one over its root. The slower fall counts, because it leaves the larger
//! error: twice the difference of the two runs.

use super::growth::{Growth, Seen};
use super::twins::{Finer, watch_beside};
use super::{EstimatedError, Repeated, touches, work};
use jostle_engine::Simulation;
use jostle_engine::scene::SceneErrors;
use jostle_engine::simulation::accuracy::trajectory::Trajectory;
use jostle_engine::simulation::error::ErrorEstimate;
use jostle_engine::tick::State;

/// The factor of the stiffness.
const STIFFER: f64 = 4.0;
/// Its error over the difference: `1/(1 - 1/sqrt(STIFFER))`.
const LEFT: f64 = 2.0;

/// Estimates the error of soft contacts.
pub(super) fn estimate(
    simulation: &Simulation,
    run: &Trajectory,
    scene: &Repeated,
    found: &mut EstimatedError,
) -> Result<(), SceneErrors> {
    let estimate = found.estimate.get_or_insert_with(ErrorEstimate::default);
    if simulation.resource::<State>().contact_law().is_none() || !touches(simulation) {
        (estimate.position.model, estimate.velocity.model) = (Some(0.0), Some(0.0));
        return Ok(());
    }
    let Some(plan) = simulation.plan() else { return Ok(()) };
    let half = Finer::HALF.plan(simulation).map(|plan| (plan, Finer::HALF));
    let (plan, finer) = half.unwrap_or_else(|| (plan.clone(), Finer::SAME));
    let mut stiffer = scene.again(simulation, plan, STIFFER, "with contacts four times as stiff")?;
    let ticks = simulation.clock().ticks;
    watch_beside(&mut stiffer, simulation, finer, ticks);
    let ran = work::run_to_tick(&mut stiffer, finer.tick(ticks), None, |_| scene.is_interrupted());
    let Ok(failure) = ran else { return Ok(()) };
    if let Some(failure) = failure {
        found.notes.push(format!("with contacts four times as stiff the run goes wrong: {failure}"));
        return Ok(());
    }
    let other = Trajectory::watched(&mut stiffer, None);
    let growth = Growth::of(Seen::between(run, &other), run.sizes().0);
    if let Some(horizon) = growth.horizon {
        found.notes.push(format!(
            "contacts four times as stiff lead elsewhere after t = {horizon:.3} s. The error of the model holds until then"
        ));
    }
    found.model_until = growth.horizon;
    estimate.horizon = [estimate.horizon, growth.horizon].into_iter().flatten().reduce(f64::min);
    (estimate.position.model, estimate.velocity.model) = (Some(LEFT * growth.distance), Some(LEFT * growth.speed));
    Ok(())
}
