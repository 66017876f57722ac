//! Whether bodies may fly ([`crate::world::Bodies::flying`]), and what looks at where they are.

use bevy_ecs::change_detection::{DetectChanges, DetectChangesMut, Tick};
use bevy_ecs::prelude::*;
use bevy_ecs::schedule::IntoScheduleConfigs;
use bevy_ecs::system::ScheduleSystem;

use super::registered::{Kind, Registered, register};
use super::{Evaluate, Modes, SimTick, Stage, State};

/// Before a batch of ticks: sees whether all that makes forces is right while bodies fly, and whether others look at the bodies at
/// each tick. `flies`: the method is one under which they may.
pub(super) fn allow(world: &mut World, flies: bool, sim: &Schedule, [evaluate, modes]: [&Schedule; 2]) {
    let registered = world.resource::<Registered>();
    let as_registered = registered.is_as_registered(Evaluate, evaluate) && registered.is_as_registered(Modes, modes);
    let flies = flies && as_registered && world.resource::<State>().flies();
    let looked_at = flies && !registered.all_fly(SimTick, sim);
    let mut state = world.resource_mut::<State>();
    state.bodies.allow_flights(flies);
    state.progress.looked_at = looked_at;
    note_looks(world);
}

/// Systems in the tick look at the bodies from now on; see [`State::see_writers`].
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

    /// Before a tick and after the last: where one of the systems in the tick wrote into the state, that counts and not what flights
    /// say.
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

/// Adds a system to [`Stage::Observe`](super::Stage::Observe) that looks at the state at the ends of some ticks only, which
/// [`look_at_ticks`] is told, and changes nothing of it.
pub(crate) fn add_observer_of_ticks<M>(world: &mut World, system: impl IntoScheduleConfigs<ScheduleSystem, M>) {
    register(world, SimTick, Kind::Flies, |schedule| {
        schedule.add_systems(system.in_set(Stage::Observe));
    });
}

/// The state is looked at at the ends of these ticks.
pub(crate) fn look_at_ticks(world: &mut World, ticks: &[u64]) {
    let mut state = world.resource_mut::<State>();
    state.progress.looks.extend(ticks);
    state.progress.looks.sort_unstable();
}
