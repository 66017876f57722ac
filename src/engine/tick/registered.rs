//! Identification of the systems of the tick that the engine registered. A replacement of a removed system has another
//! identity.

use std::collections::BTreeSet;

use bevy_ecs::intern::Interned;
use bevy_ecs::prelude::*;
use bevy_ecs::schedule::{NodeId, ScheduleLabel, SystemKey};

use super::{Evaluate, Modes, SimTick};

/// The knowledge of a system.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum SystemKind {
    /// It works on the state only.
    Packed,
    /// It looks at the state, at the end of each tick, and changes nothing of it.
    Looks,
    /// It belongs to the engine, and is right while bodies fly.
    Flies,
}

/// A system in one of the schedules of the tick, in its registered form.
#[derive(Clone, Copy, Debug)]
struct Known {
    schedule: Interned<dyn ScheduleLabel>,
    system: SystemKey,
    kind: SystemKind,
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

/// Whether a type or function of this path belongs to the engine, by its full name.
pub(super) fn is_own(path: &str) -> bool {
    const OWN: [&str; 5] = ["jostle::", "jostle_engine::", "jostle_report::", "bevy_ecs::", "bevy_app::"];
    OWN.iter().any(|own| path.starts_with(own))
}

/// The names of the systems from outside the engine that are part of the tick, in alphabetical order. The world must be open.
pub(crate) fn systems_of_users(world: &World) -> Vec<String> {
    let Some(schedules) = world.get_resource::<Schedules>() else { return Vec::new() };
    let mut names = Vec::new();
    for label in [SimTick.intern(), Modes.intern(), Evaluate.intern()] {
        let Some(schedule) = schedules.get(label) else { continue };
        // Systems wait in the graph until the schedule is made ready.
        names.extend(schedule.graph().systems.iter().map(|(_, system, _)| system.name().to_string()));
        names.extend(schedule.systems().into_iter().flatten().map(|(_, system)| system.name().to_string()));
    }
    names.retain(|name| !is_own(name));
    names.sort_unstable();
    names
}

/// Adds systems to a schedule, with `add`, that work on the packed state only.
pub(crate) fn register(
    world: &mut World,
    label: impl ScheduleLabel,
    kind: SystemKind,
    add: impl FnOnce(&mut Schedule),
) {
    let mut schedules = std::mem::take(&mut *world.get_resource_or_init::<Schedules>());
    Registered::add(world, label.intern(), schedules.entry(label.intern()), kind, add);
    *world.resource_mut::<Schedules>() = schedules;
}

impl Registered {
    /// Likewise to a schedule that is at hand.
    pub fn add(
        world: &mut World,
        label: impl ScheduleLabel,
        schedule: &mut Schedule,
        kind: SystemKind,
        add: impl FnOnce(&mut Schedule),
    ) {
        let label = label.intern();
        let before: BTreeSet<SystemKey> = keys(schedule).collect();
        add(schedule);
        let added = keys(schedule).filter(|key| !before.contains(key));
        let known = added.map(|system| Known { schedule: label, system, kind });
        world.get_resource_or_init::<Self>().0.extend(known);
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
        self.knows(label.intern(), schedule, |known| known.kind == SystemKind::Flies)
    }

    /// Whether no system of a schedule changes anything of the state but those of the engine.
    pub fn none_writes(&self, label: impl ScheduleLabel, schedule: &Schedule) -> bool {
        self.knows(label.intern(), schedule, |known| known.kind != SystemKind::Packed)
    }

    /// Whether a schedule holds exactly the systems that the engine registered for it.
    pub fn is_as_registered(&self, label: impl ScheduleLabel, schedule: &Schedule) -> bool {
        let label = label.intern();
        let own = |known: &Known| known.kind == SystemKind::Flies;
        let registered = self.0.iter().filter(|known| known.schedule == label && own(known)).count();
        keys(schedule).count() == registered && self.knows(label, schedule, own)
    }
}
