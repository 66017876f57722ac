//! The point of application of a force. It is one point in the frame of each body, counted from the body's datum.

use bevy_ecs::prelude::*;
use glam::DVec2;

use super::Targets;
use crate::tick::State;
use crate::world::anchor;

/// The point of application of a force.
#[derive(Clone, Debug, Default)]
pub struct AppliedAt {
    /// As the scene gives it; `None`: the centre of mass.
    given: Option<DVec2>,
    /// Bodies that do not count from their centre of mass: key, and the point from that centre. By key.
    elsewhere: Vec<(u64, DVec2)>,
}

impl AppliedAt {
    /// At a point that the scene gives, in metres, or at the centre of mass.
    pub fn new(given: Option<DVec2>) -> Self {
        Self { given, elsewhere: Vec::new() }
    }

    /// Looks where the point is on each body. `path` is that of the entry.
    pub fn start(&mut self, of: &mut Targets, path: &str, world: &mut World) {
        let Some(given) = self.given else { return };
        let bodies = &world.resource::<State>().bodies;
        let targets: Vec<(u64, Entity)> =
            of.indices(bodies).map(|index| (bodies.key.at(index), bodies.entity[index])).collect();
        for (key, entity) in targets {
            let at = anchor::from_center(world, entity, format!("{path}.at"), given);
            if at != given {
                self.elsewhere.push((key, at));
            }
        }
    }

    /// The point on the body of a key, from its centre of mass, in metres.
    pub fn on(&self, key: u64) -> DVec2 {
        let found = self.elsewhere.binary_search_by_key(&key, |(key, _)| *key);
        found.map_or(self.given.unwrap_or_default(), |index| self.elsewhere[index].1)
    }
}
