//! Permission of flights ([`crate::world::Bodies::flying`]), and the readers of positions.

use bevy_ecs::change_detection::{DetectChanges, DetectChangesMut, Tick};
use bevy_ecs::prelude::*;
use bevy_ecs::schedule::IntoScheduleConfigs;
use bevy_ecs::system::ScheduleSystem;

use super::registered::{Registered, SystemKind, register};
use super::{Evaluate, Modes, SimTick, Stage, State};

/// Called before a batch of ticks. It checks whether all forces are right while bodies fly, and whether others read the
/// bodies at each tick. `flies`: the method allows flights.
pub(super) fn allow(world: &mut World, flies: bool, sim: &Schedule, [evaluate, modes]: [&Schedule; 2]) {
    let registered = world.resource::<Registered>();
    let as_registered = registered.is_as_registered(Evaluate, evaluate) && registered.is_as_registered(Modes, modes);
    let flies = flies && as_registered && world.resource::<State>().flies();
    let looked_at = flies && !registered.all_fly(SimTick, sim);
    let mut state = world.resource_mut::<State>();
    state.bodies.allow_flights(flies);
    state.progress.looked_at = looked_at;
}

/// Notes that systems in the tick read the bodies; see [`State::see_writers`].
pub(super) fn note_looks(world: &mut World) {
    let mut state = world.resource_mut::<State>();
    // Noting it is a change too.
    state.set_changed();
    let changed = state.last_changed();
    state.note_looks(changed);
}

impl State {
    pub(super) fn note_looks(&mut self, changed: Tick) {
        self.progress.shown_at = Some(changed);
    }

    /// Called before a tick and after the last. If a system in the tick wrote into the state, its values replace those
    /// of flights.
    pub(super) fn see_writers(&mut self, changed: Tick) {
        if self.progress.looked_at && self.progress.shown_at.is_some_and(|shown| shown != changed) {
            self.bodies.forget_flights();
        }
    }

    /// All bodies are looked at, those that fly too.
    pub(super) fn land(&mut self) {
        let travel = self.bodies.land();
        self.progress.travel = self.progress.travel.max(travel);
    }
}

/// Adds a system to [`Stage::Observe`](super::Stage::Observe) that changes nothing of bodies and models. It reads bodies at the
/// ends of those ticks only that [`look_at_ticks`] receives.
pub(crate) fn add_observer<M>(world: &mut World, system: impl IntoScheduleConfigs<ScheduleSystem, M>) {
    register(world, SimTick, SystemKind::Flies, |schedule| {
        schedule.add_systems(system.in_set(Stage::Observe));
    });
}

/// The state is looked at at the ends of these ticks.
pub(crate) fn look_at_ticks(world: &mut World, ticks: &[u64]) {
    let mut state = world.resource_mut::<State>();
    state.progress.looks.extend(ticks);
    state.progress.looks.sort_unstable();
}
