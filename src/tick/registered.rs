//! Which systems of the tick the engine knows, by identity: a system that somebody takes out, or puts in its place, is another one.

use std::collections::BTreeSet;

use bevy_ecs::intern::Interned;
use bevy_ecs::prelude::*;
use bevy_ecs::schedule::{NodeId, ScheduleLabel, SystemKey};

use super::{Evaluate, Modes, SimTick};

/// A system in one of the schedules of the tick, as it was registered.
#[derive(Clone, Copy, Debug)]
struct Known {
    schedule: Interned<dyn ScheduleLabel>,
    system: SystemKey,
    /// Whether it is right while bodies fly.
    flies: bool,
    /// Whether a direct form stands for it.
    direct: bool,
}

/// The systems that work on the packed state only, in the order in which they were registered.
#[derive(Resource, Debug, Default)]
pub(crate) struct Registered(Vec<Known>);

/// The keys of all systems of a schedule.
fn keys(schedule: &Schedule) -> impl Iterator<Item = SystemKey> + '_ {
    schedule.graph().hierarchy().graph().nodes().filter_map(|node| match node {
        NodeId::System(key) => Some(key),
        NodeId::Set(_) => None,
    })
}

/// Adds systems to a schedule, with `add`, that work on the packed state only. `flies`: they are right while bodies fly.
pub(crate) fn register(world: &mut World, label: impl ScheduleLabel, flies: bool, add: impl FnOnce(&mut Schedule)) {
    let label = label.intern();
    let mut schedules = world.get_resource_or_init::<Schedules>();
    let schedule = schedules.entry(label);
    let before: BTreeSet<SystemKey> = keys(schedule).collect();
    add(schedule);
    let added: Vec<SystemKey> = keys(schedule).filter(|key| !before.contains(key)).collect();
    let known = added.into_iter().map(|system| Known { schedule: label, system, flies, direct: false });
    world.get_resource_or_init::<Registered>().0.extend(known);
}

impl Registered {
    /// How many systems are registered: those that come later are told apart by it.
    pub fn mark(world: &World) -> usize {
        world.get_resource::<Self>().map_or(0, |registered| registered.0.len())
    }

    /// A direct form stands for all systems that were registered since the `mark`.
    pub fn cover(world: &mut World, mark: usize) {
        let mut registered = world.get_resource_or_init::<Self>();
        registered.0[mark..].iter_mut().for_each(|known| known.direct = true);
    }

    fn knows(&self, label: Interned<dyn ScheduleLabel>, schedule: &Schedule, which: impl Fn(&Known) -> bool) -> bool {
        // A dozen systems: a list is searched sooner than a set is made, once a batch.
        let known = |key| self.0.iter().any(|known| known.system == key && known.schedule == label && which(known));
        keys(schedule).all(known)
    }

    /// Whether all systems of a schedule work on the packed state only.
    pub fn all_packed(&self, label: impl ScheduleLabel, schedule: &Schedule) -> bool {
        self.knows(label.intern(), schedule, |_| true)
    }

    /// Whether all systems of a schedule are right while bodies fly.
    pub fn all_fly(&self, label: impl ScheduleLabel, schedule: &Schedule) -> bool {
        self.knows(label.intern(), schedule, |known| known.flies)
    }

    /// Whether the systems with a direct form are those that the schedules of ticks, evaluations and modes have: none is missing
    /// and there is no other.
    pub fn all_direct(&self, [tick, evaluate, modes]: [&Schedule; 3]) -> bool {
        let schedules = [(SimTick.intern(), tick), (Evaluate.intern(), evaluate), (Modes.intern(), modes)];
        let present: usize = schedules.iter().map(|(_, schedule)| keys(schedule).count()).sum();
        let direct = self.0.iter().filter(|known| known.direct).count();
        present == direct
            && schedules.into_iter().all(|(label, schedule)| self.knows(label, schedule, |known| known.direct))
    }
}
