//! Time reversal test: a run to its end, with all velocities reversed there, and the same number of ticks back. Motion
//! without losses returns to its beginning. Methods that are symmetric in time return up to rounding. Others err by
//! about twice the error of the run (Hairer, Lubich, Wanner, *Geometric Numerical Integration*, 2nd ed. 2006, V.1).

use crate::SimulationExt;
use serde::Serialize;

use jostle_engine::Simulation;
use jostle_engine::tick::Failure;
use jostle_engine::world::{Spin, Velocity};

/// How closely a scene comes back to its beginning.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Reversal {
    /// Greatest distance of a centre of mass from its beginning, in m.
    pub position: f64,
    /// Greatest difference of a velocity from the opposite of that at the beginning, in m/s.
    pub velocity: f64,
    /// Greatest difference of an angle from that at the beginning, in radians.
    pub angle: f64,
    /// The reason why it cannot return, if some part of it has a direction of time.
    pub because: Option<String>,
}

impl Reversal {
    /// Runs a scene from its beginning to its end and back.
    ///
    /// # Errors
    /// When a number stops being finite, or energy comes out of nowhere.
    pub fn of(simulation: &mut Simulation) -> Result<Self, Failure> {
        let bodies = simulation.bodies();
        let moving: Vec<usize> = (0..bodies.len()).filter(|&body| bodies.dynamic[body]).collect();
        let begin: Vec<_> =
            moving.iter().map(|&body| (bodies.position[body], bodies.velocity[body], bodies.angle[body])).collect();
        simulation.run_to_end()?;
        let because = direction_of_time(simulation);
        let entities: Vec<_> = moving.iter().map(|&body| simulation.bodies().entity[body]).collect();
        for entity in entities {
            let world = simulation.world_mut();
            if let Some(mut velocity) = world.get_mut::<Velocity>(entity) {
                velocity.0 = -velocity.0;
            }
            if let Some(mut spin) = world.get_mut::<Spin>(entity) {
                spin.0 = -spin.0;
            }
        }
        simulation.run_to_tick(2 * simulation.ticks())?;
        let bodies = simulation.bodies();
        let mut back = Self { position: 0.0, velocity: 0.0, angle: 0.0, because };
        for (&body, (position, velocity, angle)) in moving.iter().zip(begin) {
            back.position = back.position.max((bodies.position[body] - position).length());
            back.velocity = back.velocity.max((bodies.velocity[body] + velocity).length());
            back.angle = back.angle.max((bodies.angle[body] - angle).abs());
        }
        Ok(back)
    }
}

/// The parts of a run with a direction of time, in words.
fn direction_of_time(simulation: &Simulation) -> Option<String> {
    let energy = simulation.card().energy;
    let lost = energy.losses().filter(|(_, lost)| *lost != 0.0).map(|(name, _)| name).collect::<Vec<_>>().join(", ");
    let prescribed = !simulation.bodies().prescribed.motions.is_empty();
    if !lost.is_empty() {
        Some(format!("energy was lost on the way ({lost}), and does not come back"))
    } else if prescribed || energy.work != 0.0 {
        Some("drives and prescribed motions go by the clock, which does not run back".to_owned())
    } else {
        None
    }
}
