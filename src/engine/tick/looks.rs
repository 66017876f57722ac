//! Looks inside ticks: sensors that count from look to look see the motion within each step.
//!
//! If steps follow from their errors, a tick is a frame of the film, and may hold many swings. The integrator then shows states within
//! each step to these sensors. The looks change no bit of the run.
//!
//! Such a step resolves the motion. So does a fixed number of looks in it. `Dop853` spans half a swing in a step at a tolerance of 1e-3, and less
//! at smaller ones. Sixteen looks then are 0.2 rad apart. The root of a cubic polynomial through four of them is off by `0.2^3/40` of
//! their distance (remainder of interpolation). That is 6e-6 of a period, and falls with the fourth power of the step. A body that
//! turns uniformly bounds no step by its error, and neither does a drive. Looks are at most as many radians of these apart.

use bevy_ecs::prelude::*;
use glam::DVec2;

use super::{State, Tick, add_looker};
use crate::world::Bodies;
use crate::world::between::{MotionSample, angle_between, position_between};

/// Looks in a step, at least.
const FEWEST: f64 = 16.0;
/// The angle in rad of a turn or of a drive from look to look, at most.
const ANGLE: f64 = 0.2;

/// A look at the world.
type Look = Box<dyn Fn(&mut World) + Send + Sync>;

/// The sensors that look inside ticks.
#[derive(Resource, Default)]
pub(crate) struct Lookers {
    /// Whether they do: in runs whose ticks are frames, and not in their trials.
    inside: bool,
    looks: Vec<Look>,
    /// Whether others read forces at the ends of ticks.
    at_ends: bool,
}

/// Adds a looker that also looks inside ticks, if ticks are frames.
pub(crate) fn add_inner_looker(world: &mut World, look: impl Fn(&mut World) + Copy + Send + Sync + 'static) {
    add_looker(world, look);
    world.get_resource_or_init::<Lookers>().looks.push(Box::new(look));
}

/// Some system reads forces at the ends of ticks, also in the middle of a batch.
pub(crate) fn read_forces_at_ends(world: &mut World) {
    world.get_resource_or_init::<Lookers>().at_ends = true;
}

/// Sets whether ticks are frames, inside which sensors look.
pub(crate) fn look_inside(world: &mut World, inside: bool) {
    if let Some(mut lookers) = world.get_resource_mut::<Lookers>() {
        lookers.inside = inside;
    }
}

impl Lookers {
    /// Whether some look inside ticks.
    pub fn some_inside(world: &World) -> bool {
        world.get_resource::<Self>().is_some_and(|lookers| lookers.inside && !lookers.looks.is_empty())
    }

    /// Whether forces have to be those of the state shown at the end of each tick.
    pub fn some_read_forces(world: &World) -> bool {
        world
            .get_resource::<Self>()
            .is_some_and(|lookers| lookers.inside && (lookers.at_ends || !lookers.looks.is_empty()))
    }

    /// All of them look.
    fn look(world: &mut World) {
        world.resource_scope(|world, lookers: Mut<Self>| lookers.looks.iter().for_each(|look| look(world)));
    }
}

impl Tick<'_> {
    /// Whether sensors look at states inside the tick.
    pub fn looks_inside(&self) -> bool {
        self.lookers.is_some() || self.users.as_ref().is_some_and(|users| users.looks)
    }

    /// The number of looks in a step of so many seconds.
    pub fn looks_in(&self, length: f64) -> f64 {
        let turns = self.state.bodies.spin.iter().map(|spin| spin.abs());
        (length * turns.fold(self.state.fastest_rhythm(), f64::max) / ANGLE).ceil().max(FEWEST)
    }

    /// The bodies at the beginning of a tick that velocity Verlet makes exactly, because no acceleration changes. `None` if no sensor
    /// looks inside.
    pub(super) fn exact_beginning(&self) -> Option<Vec<MotionSample>> {
        let state = &*self.state;
        let exact = !self.mode.is_staged() && state.contact_law().is_none() && !state.changing_forces();
        (self.looks_inside() && exact).then(|| samples(&state.bodies, self.begin))
    }

    /// After such a tick: sensors look at states inside it, which are parabolas between its ends. Forces are those of its end.
    pub(super) fn look_between(&mut self, before: &[MotionSample]) {
        let after = samples(&self.state.bodies, self.end);
        let looks = self.looks_in(self.dt);
        let (force, torque) = (self.state.bodies.force.clone(), self.state.bodies.torque.clone());
        for number in 1..looks as u64 {
            let (share, time) = (number as f64 / looks, self.begin + self.dt * (number as f64 / looks));
            let between = |(before, after): (&MotionSample, &MotionSample)| MotionSample {
                time,
                position: position_between(before, after, time),
                velocity: before.velocity.lerp(after.velocity, share),
                angle: angle_between(before, after, time),
                spin: before.spin + (after.spin - before.spin) * share,
            };
            let there: Vec<MotionSample> = before.iter().zip(&after).map(between).collect();
            place(&mut self.state.bodies, &there, (&force, &torque));
            self.look(time);
        }
        place(&mut self.state.bodies, &after, (&force, &torque));
    }

    /// Sensors look at the present state, which is evaluated, at `time` seconds inside the tick.
    pub fn look(&mut self, time: f64) {
        let users = self.users.as_mut().filter(|users| users.looks).map(|users| &mut *users.world);
        let Some(world) = users.or(self.lookers.as_deref_mut()) else { return };
        self.state.clock.now = Some(time);
        std::mem::swap(self.state, &mut *world.resource_mut::<State>());
        Lookers::look(world);
        std::mem::swap(self.state, &mut *world.resource_mut::<State>());
        self.state.clock.now = None;
    }
}

fn samples(bodies: &Bodies, time: f64) -> Vec<MotionSample> {
    (0..bodies.len()).map(|body| MotionSample::of(bodies, body, time)).collect()
}

/// Puts all bodies there, with these forces and torques.
fn place(bodies: &mut Bodies, there: &[MotionSample], (force, torque): (&[DVec2], &[f64])) {
    for (body, sample) in there.iter().enumerate() {
        (bodies.position[body], bodies.velocity[body]) = (sample.position, sample.velocity);
        (bodies.angle[body], bodies.spin[body]) = (sample.angle, sample.spin);
    }
    bodies.posed = false;
    bodies.pose();
    bodies.force.copy_from_slice(force);
    bodies.torque.copy_from_slice(torque);
}
