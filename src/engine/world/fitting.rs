//! Consistency of the lengths of the packed lists. Systems of users write to them, and may shorten one.

use bevy_ecs::prelude::*;
use glam::DVec2;

use super::packed::Bodies;
use super::wall::PackedWall;
use super::{Body, Mass, Position, Rotation, Spin, Velocity};
use jostle_simd::BLOCK;

/// How many there were when the lists were filled.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Counts {
    bodies: usize,
    atoms: usize,
    walls: usize,
}

impl Bodies {
    /// Counts the lists after they were filled.
    pub(super) fn count_all(&mut self) {
        self.counts = Some(Counts { bodies: self.len(), atoms: self.atom_count(), walls: self.walls.len() });
    }

    /// Restores the lengths that the lists had when they were filled. Returns the name of the first list whose length
    /// differed.
    pub(crate) fn make_fit(&mut self) -> Option<&'static str> {
        let Some(Counts { bodies, atoms, walls }) = self.counts else {
            return Some("all of them");
        };
        let mut found = None;
        macro_rules! resize {
            ($count:expr, $fill:expr, $($list:ident)*) => {
                $(if self.$list.len() != $count {
                    found = found.or(Some(stringify!($list)));
                    self.$list.resize($count, $fill);
                })*
            };
        }
        resize!(bodies, Entity::PLACEHOLDER, entity);
        resize!(bodies, false, dynamic moves collides);
        resize!(bodies, 0.0, mass inertia angle angle_residual spin torque);
        resize!(bodies, DVec2::ZERO, position position_residual velocity force);
        resize!(atoms, 0.0, atom_radius);
        if !self.estimated_velocity.is_empty() || !self.estimated_spin.is_empty() {
            resize!(bodies, DVec2::ZERO, estimated_velocity);
            resize!(bodies, 0.0, estimated_spin);
        }
        if !self.belts.is_empty() {
            resize!(walls, DVec2::ZERO, belts);
        }
        let no_wall = PackedWall {
            entity: Entity::PLACEHOLDER,
            point: DVec2::ZERO,
            normal: DVec2::Y,
            ends: None,
            line: None,
            material: super::MaterialIndex::default(),
        };
        resize!(walls, no_wall, walls);
        self.make_rest_fit(bodies, &mut found);
        found
    }

    /// The same for data that is not one item for each body.
    fn make_rest_fit(&mut self, bodies: usize, found: &mut Option<&'static str>) {
        if self.key.count() != bodies {
            *found = found.or(Some("key"));
            self.key = Default::default();
            (0..bodies as u64).for_each(|key| self.key.push(key));
        }
        let (lone, all) = (self.first_atom.is_empty(), self.inverse_mass.is_empty());
        if self.lone_discs != lone {
            *found = found.or(Some("lone_discs"));
            self.lone_discs = lone;
        }
        if self.all_dynamic != all {
            *found = found.or(Some("all_dynamic"));
            self.all_dynamic = all;
        }
        if self.prescribed.motions.iter().any(|(body, _)| *body >= bodies) {
            *found = found.or(Some("prescribed"));
            self.prescribed.motions.clear();
        }
        let blocks = bodies.div_ceil(BLOCK);
        let sleeps = [0, blocks].contains(&self.asleep.len());
        if !sleeps || self.awake.iter().any(|block| *block as usize >= blocks) {
            *found = found.or(Some(if sleeps { "awake" } else { "asleep" }));
            self.wake_all();
        }
    }
}

/// A body that has lost a component which each body has, and the component.
pub(crate) fn incomplete(world: &mut World) -> Option<(Entity, &'static str)> {
    type Present = (Entity, Has<Mass>, Has<Position>, Has<Rotation>, Has<Velocity>, Has<Spin>);
    type Lost = (Without<Mass>, Without<Position>, Without<Rotation>, Without<Velocity>, Without<Spin>);
    let lost = |(entity, mass, position, rotation, velocity, spin)| {
        let has =
            [(mass, "Mass"), (position, "Position"), (rotation, "Rotation"), (velocity, "Velocity"), (spin, "Spin")];
        has.into_iter().find(|(there, _)| !there).map(|(_, component)| (entity, component))
    };
    world.query_filtered::<Present, (With<Body>, Or<Lost>)>().iter(world).find_map(lost)
}
