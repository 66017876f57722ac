//! Messages between spawning and the tick.

use bevy_ecs::prelude::*;

/// Set where entities of bodies, atoms and walls come, go or get another mass.
#[derive(Resource, Debug, Default)]
pub(crate) struct Roster {
    /// Whether a body was spawned, despawned or given another mass: the next tick then rebuilds the packed arrays.
    pub changed: bool,
    /// Bodies have a [`Force`](super::Force) and a [`Torque`](super::Torque), for systems that work on components.
    pub pushed: bool,
}

impl Roster {
    /// Whether bodies of a world are spawned with what systems need that push components.
    pub fn pushes(world: &World) -> bool {
        world.get_resource::<Self>().is_some_and(|roster| roster.pushed)
    }
}
