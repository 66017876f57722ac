//! The ways of bodies in a tick, and bodies that may have passed through others unseen.

use bevy_ecs::prelude::*;
use glam::DVec2;

use super::{State, Tick};
use crate::world::motion::Travel;
use serde::{Deserialize, Serialize};

/// A body that travelled farther in one tick than the smallest radius: it may have passed through others unseen.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct FarTravel {
    /// The body.
    pub body: Entity,
    /// The distance that any of its points travelled, in metres.
    pub travel: f64,
    /// The end of that tick in seconds.
    pub time: f64,
}

/// Greatest distance that any point of a body travelled in one tick so far, in metres.
pub fn largest_travel(state: &State) -> f64 {
    state.progress.travel
}

/// A way in the whole run below this share of the smallest radius is no motion. Forces that cancel leave rounding.
pub const STANDS: f64 = 1e-9;

/// Whether all bodies have been at rest so far. Before the first tick that is unknown.
pub fn stands(state: &State) -> bool {
    let (ticks, smallest) = (state.clock.ticks, state.bodies.smallest_radius);
    ticks > 0 && smallest.is_finite() && state.progress.travel * ticks as f64 <= STANDS * smallest
}

/// The first body that travelled farther in one tick than the smallest radius.
pub fn far_travel(state: &State) -> Option<FarTravel> {
    state.progress.far
}

impl Tick<'_> {
    /// Books how far bodies have travelled in the tick: `from` are positions and angles at its beginning.
    pub fn book_travel(&mut self, from: &[(DVec2, f64)]) {
        let bodies = self.packed();
        bodies.list_displacements();
        let (mut greatest, mut sum) = (0.0_f64, 0.0);
        for (body, &(position, angle)) in from.iter().enumerate() {
            (bodies.drift[body], bodies.turn[body]) = (bodies.position[body] - position, bodies.angle[body] - angle);
            let travel = bodies.travel(body);
            greatest = greatest.max(travel);
            sum += travel;
        }
        let smallest = bodies.smallest_radius;
        let alert = self.state.rates.alert;
        self.alert |= alert;
        self.note_travel(Travel { greatest, sum }, smallest);
    }

    /// Notes the ways of bodies in the tick. When a check is due, it also notes the bodies that went too far.
    /// `smallest` is the smallest radius.
    #[inline]
    pub(super) fn note_travel(&mut self, Travel { greatest, sum }: Travel, smallest: f64) {
        let progress = &mut self.state.progress;
        progress.travel = progress.travel.max(greatest);
        progress.travelled = sum;
        progress.farthest = greatest;
        if greatest > smallest && progress.far.is_none() {
            self.look_for_far();
        }
    }

    #[cold]
    fn look_for_far(&mut self) {
        let State { bodies, clock, progress, .. } = &*self.state;
        if !progress.energy.is_due(clock.ticks + 1, progress.travel) {
            return;
        }
        let far = |body: &usize| {
            bodies.collides[*body] && bodies.moves[*body] && bodies.travel(*body) > bodies.smallest_radius
        };
        let far = (0..bodies.len()).find(far).map(|body| FarTravel {
            body: bodies.entity[body],
            travel: bodies.travel(body),
            time: clock.time_of(clock.ticks + 1),
        });
        self.state.progress.far = far;
    }

    /// The greatest way in metres that any point of a body made in the tick so far.
    pub fn farthest(&self) -> f64 {
        self.state.progress.farthest
    }
}
