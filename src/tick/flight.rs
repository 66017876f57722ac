//! Whether bodies may fly ([`crate::world::Bodies::flying`]), and who sees where they are.

use bevy_ecs::prelude::*;
use bevy_ecs::schedule::IntoScheduleConfigs;
use bevy_ecs::system::ScheduleSystem;

use super::direct::{Direct, Observer, held_mut};
use super::drive::Drive;
use super::registered::{Registered, register};
use super::{Evaluate, Modes, SimTick, Stage};
use crate::world::Bodies;

/// Before a batch of ticks: sees whether all that makes forces is right while bodies fly, and whether others look at the bodies at
/// each tick. `flies`: the method is one under which they may.
pub(super) fn allow(world: &mut World, flies: bool, sim: &Schedule, evaluation: [&Schedule; 2]) {
    let registered = world.resource::<Registered>();
    let [evaluate, modes] = evaluation;
    let flies = flies && registered.all_fly(Evaluate, evaluate) && registered.all_fly(Modes, modes);
    let looked_at = flies && !registered.all_fly(SimTick, sim);
    world.resource_mut::<Bodies>().allow_flights(flies);
    world.resource_mut::<Drive>().looked_at = looked_at;
    note_looks(world);
}

/// Systems in the tick look at the bodies from now on; see [`see_writers`].
pub(super) fn note_looks(world: &mut World) {
    let changed = world.resource_ref::<Bodies>().last_changed();
    world.resource_mut::<Drive>().shown_at = Some(changed);
}

/// Before a tick and after the last: where one of the systems in the tick wrote into the packed state, that counts and not what flights say.
pub(super) fn see_writers(world: &mut World) {
    let changed = world.resource_ref::<Bodies>().last_changed();
    if world.resource::<Drive>().shown_at.is_some_and(|shown| shown != changed) {
        world.resource_mut::<Bodies>().forget_flights();
    }
}

/// Adds a system to [`Stage::Observe`](super::Stage::Observe), and its direct form, that looks at the packed state at the ends of some
/// ticks only, which [`look_at_ticks`] is told, and changes nothing of it.
pub(crate) fn add_observer_of_ticks<M>(
    world: &mut World,
    system: impl IntoScheduleConfigs<ScheduleSystem, M>,
    direct: impl Observer,
) {
    let mark = Registered::mark(world);
    register(world, SimTick, true, |schedule| {
        schedule.add_systems(system.in_set(Stage::Observe));
    });
    Direct::add_observer(world, mark, direct);
}

/// Somebody looks at the packed state at the ends of these ticks.
pub(crate) fn look_at_ticks(world: &mut World, ticks: &[u64]) {
    let mut drive = world.resource_mut::<Drive>();
    drive.looks.extend(ticks);
    drive.looks.sort_unstable();
}

/// Somebody looks at all bodies, those that fly too.
pub(super) fn land(world: &mut World, mut direct: Option<&mut Direct>) {
    let bodies: &mut Bodies = held_mut(world, direct.as_deref_mut());
    let travel = bodies.land();
    let drive: &mut Drive = held_mut(world, direct);
    drive.travel = drive.travel.max(travel);
}
