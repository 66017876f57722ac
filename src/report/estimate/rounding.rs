//! The effect of rounding: runs with disturbed last bits at every tick, some up, some down.
//!
//! Each tick rounds positions and velocities by up to half a unit in the last place. Here they are moved by a whole
//! one. The result shows how the motion magnifies rounding. True rounding errors are not random numbers (Higham,
//! *Accuracy and Stability of Numerical Algorithms*, 2nd ed. 2002, 1.18).

use bevy_ecs::prelude::*;
use glam::DVec2;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::growth::{Growth, Seen};
use super::twins::{Finer, watch_beside};
use super::{EstimatedError, Repeated, work};
use jostle_engine::Simulation;
use jostle_engine::scene::SceneErrors;
use jostle_engine::simulation::accuracy::trajectory::Trajectory;
use jostle_engine::simulation::error::ErrorEstimate;
use jostle_engine::tick::{State, add_packed_observer};

/// Runs with disturbed last bits.
const SAMPLES: u64 = 3;

/// The source of the disturbed bits.
#[derive(Resource)]
struct LastBits(ChaCha8Rng);

/// Moves all numbers of bodies in motion by a unit in the last place.
fn disturb(mut state: ResMut<State>, mut bits: ResMut<LastBits>) {
    let bodies = state.bodies_mut();
    for body in 0..bodies.len() {
        // Bodies at rest do not move by a bit.
        let still = bodies.velocity[body] == DVec2::ZERO && bodies.spin[body] == 0.0;
        if still || !bodies.dynamic[body] {
            continue;
        }
        let mut random = bits.0.next_u32();
        let mut moved = |value: f64| {
            let up = random & 1 == 0;
            random >>= 1;
            match value {
                0.0 => value,
                _ if up => value.next_up(),
                _ => value.next_down(),
            }
        };
        let (position, velocity) = (bodies.position[body], bodies.velocity[body]);
        bodies.position[body] = [moved(position.x), moved(position.y)].into();
        bodies.velocity[body] = [moved(velocity.x), moved(velocity.y)].into();
        bodies.angle[body] = moved(bodies.angle[body]);
        bodies.spin[body] = moved(bodies.spin[body]);
    }
}

/// Estimates the error of finite digits.
pub(super) fn estimate(
    simulation: &Simulation,
    run: &Trajectory,
    scene: &Repeated,
    found: &mut EstimatedError,
) -> Result<(), SceneErrors> {
    let Some(plan) = simulation.plan() else { return Ok(()) };
    let (mut distance, mut speed) = (0.0_f64, 0.0_f64);
    let estimate = found.estimate.get_or_insert_with(ErrorEstimate::default);
    for sample in 0..SAMPLES {
        let what = format!("with wrong last bits, {} of {SAMPLES}", sample + 1);
        let mut other = scene.again(simulation, plan.clone(), 1.0, &what)?;
        let ticks = simulation.clock().ticks;
        watch_beside(&mut other, simulation, Finer::SAME, ticks);
        other.world_mut().insert_resource(LastBits(ChaCha8Rng::seed_from_u64(sample)));
        add_packed_observer(other.world_mut(), disturb);
        let Ok(failure) = work::run_to_tick(&mut other, ticks, None, |_| scene.is_interrupted()) else { return Ok(()) };
        if let Some(failure) = failure {
            found.notes.push(format!("with wrong last bits the run goes wrong: {failure}"));
            return Ok(());
        }
        let growth = Growth::of(Seen::between(run, &Trajectory::watched(&mut other, None)), run.sizes().0);
        (distance, speed) = (distance.max(growth.distance), speed.max(growth.speed));
        estimate.horizon = [estimate.horizon, growth.horizon].into_iter().flatten().reduce(f64::min);
    }
    (estimate.position.rounding, estimate.velocity.rounding) = (Some(distance), Some(speed));
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use jostle_engine::scene::Source;

    /// Promise: disturbed bits are those of bodies in motion. A ball at rest is not disturbed, whatever other bodies
    /// there are.
    #[test]
    fn who_rests_is_not_disturbed() {
        let text = "Scene(format: 1, clock: (duration: 2, tick: 0.001, method: VelocityVerlet), gravity: (0, -9.81),
            materials: { \"stone\": (stiffness: 50000, friction: 0.5, restitution: 0.3, density: 10) },
            walls: [(name: \"floor\", left: (4, 0), right: (0, 0), material: \"stone\")],
            bodies: [(name: \"ball\", at: (1, 0.11), material: \"stone\", atoms: Disc(radius: 0.1))],
            fill: [(name: \"rain\", atoms: Disc(radius: 0.01), material: \"stone\", count: 30, within: ((5, 0), (9, 9)))])";
        let mut simulation = Simulation::load(&Source::new("rest.ron", text)).unwrap_or_else(|wrong| panic!("{wrong}"));
        simulation.run_to_tick(1000).unwrap();
        let ball = |simulation: &Simulation| simulation.bodies().position[0];
        let before = simulation.bodies().position.clone();
        simulation.world_mut().insert_resource(LastBits(ChaCha8Rng::seed_from_u64(1)));
        add_packed_observer(simulation.world_mut(), disturb);
        simulation.run_to_tick(1500).unwrap();
        assert_eq!(ball(&simulation), before[0]);
        let fallen = simulation.bodies().position.iter().zip(&before).filter(|(now, before)| now != before).count();
        assert_eq!(fallen, 30);
    }
}
