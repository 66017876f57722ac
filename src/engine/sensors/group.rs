//! Groups of bodies: those with given names whose centres of mass are in a region.

use bevy_ecs::prelude::*;

use super::bodies_named;
use crate::scene::values::Names;
use crate::scene::{Diagnostics, NameKind, Outline};
use crate::tick::{State, index_of};
use crate::world::sections::Region;

/// Bodies, and the region in which their centres of mass have to be.
pub(super) struct Group {
    of: Vec<Entity>,
    within: Option<Region>,
}

/// Reports names that fit no body, and a malformed region.
pub(super) fn check(of: &Names, within: Option<&Region>, outline: &Outline, report: &mut Diagnostics) {
    of.require(NameKind::BODY, outline, "of", report);
    if let Some(within) = within {
        report.within("within", |report| within.check(report));
    }
}

impl Group {
    /// The bodies of these names; they must have been spawned.
    pub fn new(of: &Names, within: Option<Region>, outline: &Outline, world: &mut World) -> Self {
        Self { of: bodies_named(world, of, outline), within }
    }

    /// All its bodies, wherever they are.
    pub fn all(&self) -> &[Entity] {
        &self.of
    }

    /// The bodies of the group in the region: number in the group and index among all bodies.
    pub fn present<'a>(&'a self, world: &'a World) -> impl Iterator<Item = (usize, usize)> + 'a {
        let bodies = world.resource::<State>().bodies();
        let is_within =
            |body: usize| self.within.as_ref().is_none_or(|within| within.holds(bodies.position[body], 0.0));
        let indices = self.of.iter().enumerate().filter_map(|(number, body)| Some((number, index_of(world, *body)?)));
        indices.filter(move |(_, body)| is_within(*body))
    }
}
