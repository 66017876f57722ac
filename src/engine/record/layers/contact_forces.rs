//! `ContactForces(of: ["T"], scale: "10 N")`: the forces of contacts, as arrows.
//!
//! Forces between two bodies, or a body and a wall, through neighbouring atoms in about one direction make one arrow.
//! It is their resultant at the centre of pressure. The arrow begins there and points into the body that receives the
//! force. Of two bodies it is the one that the contact supports, or without gravity the later one in the scene. Forces
//! are those at the end of a tick, not means over a frame. In an impact of a few ticks they are large, and an impact
//! between frames is invisible.

use bevy_app::App;
use bevy_ecs::prelude::*;
use glam::DVec2;
use schemars::JsonSchema;
use serde::Deserialize;

use super::of_bodies::OfBodies;
use super::scale::{Scale, round};
use super::{Layer, Mark, PictureHeight, Shown};
use crate::contacts::{ContactPoint, Other};
use crate::scene::units::Force;
use crate::scene::values::Names;
use crate::scene::{Diagnostics, Outline, SceneAppExt};
use crate::tick::{AfterLoad, State};

/// The forces of contacts, as arrows on the body that feels them.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct ContactForces {
    /// The bodies. `*` stands for any letters. Default: all that move.
    #[serde(default)]
    of: Option<Names>,
    /// The force in N whose arrow is a tenth of the picture's height long. It follows from the weight of a body, and
    /// without gravity from the force that stops a body. Default: from the scene.
    #[serde(default)]
    scale: Option<Force>,
}

impl OfBodies for ContactForces {
    const NAME: &'static str = "ContactForces";
    const EXAMPLE: &'static str = "ContactForces(of: [\"ball\"], scale: \"10 N\")";

    fn of(&self) -> Option<&Names> {
        self.of.as_ref()
    }

    fn check_others(&self, report: &mut Diagnostics) {
        report.positive_if_given("scale", self.scale);
    }

    fn prepare(app: &mut App) {
        app.world_mut().get_resource_or_init::<AfterLoad>().0.push(note_start);
    }

    fn layer(self, shown: Shown, _: &Outline) -> impl Layer {
        let given = self.scale.map(Force::si);
        move |world: &World, marks: &mut Vec<Mark>| {
            let Some(points) = world.resource::<State>().contact_points() else { return };
            let typical = world.get_resource::<TypicalForce>().map_or(1.0, |typical| typical.0);
            let scale = Scale::new(given.unwrap_or(typical), PictureHeight::of(world), "N", "force");
            marks.push(scale.key());
            let indices: Vec<usize> = shown.indices(&world.resource::<State>().bodies).collect();
            let up = -world.resource::<State>().gravity();
            let is_shown = |body: usize| indices.binary_search(&body).is_ok();
            let contacts = points.into_iter().filter(|contact| {
                is_shown(contact.body) || matches!(contact.other, Other::Body(other) if is_shown(other))
            });
            let loads = loads(contacts);
            marks.extend(loads.iter().filter_map(|load| {
                let turned = matches!(load.other, Other::Body(_)) && load.force.dot(up) < 0.0;
                scale.arrow(load.point, if turned { -load.force } else { load.force })
            }));
        }
    }
}

/// Forces within this angle of the first one of a load count as one direction: its cosine, of 45 degrees.
/// Friction that has been stored to both sides of a face is no reason for two arrows.
const ALIKE: f64 = 0.7;

/// Contacts of one pair of bodies in about one direction, put together.
pub(super) fn loads(contacts: impl Iterator<Item = ContactPoint>) -> Vec<ContactPoint> {
    let mut loads: Vec<ContactPoint> = Vec::new();
    // Of each load the direction of its first force, and the sum of forces by which its point is weighted.
    let mut sums: Vec<(DVec2, f64)> = Vec::new();
    for contact in contacts {
        let (size, direction) = (contact.force.length(), contact.force.normalize_or_zero());
        // Contacts of one pair are consecutive in the list, except those of bodies with many atoms.
        let same = |(load, (first, _)): &(&mut ContactPoint, &mut (DVec2, f64))| {
            load.body == contact.body && load.other == contact.other && first.dot(direction) >= ALIKE
        };
        match loads.iter_mut().zip(&mut sums).rev().take(LOOKED_BACK).find(same) {
            Some((load, (_, sum))) => {
                *sum += size;
                load.point += (contact.point - load.point) * (size / *sum);
                load.force += contact.force;
            }
            None if size > 0.0 => {
                loads.push(contact);
                sums.push((direction, size));
            }
            None => (),
        }
    }
    loads
}

/// The number of loads that are searched for that of a contact. A body has few loads at once.
const LOOKED_BACK: usize = 64;

/// The force of a scene, in N, that determines the default scale. It is the same for the whole film.
#[derive(Resource)]
pub(super) struct TypicalForce(pub f64);

/// The median of the weights of bodies. Without gravity it is the force with which the fastest body would be stopped by
/// its stiffness, `v sqrt(k m)`.
pub(super) fn note_start(world: &mut World) {
    let bodies = &world.resource::<State>().bodies;
    let mut masses: Vec<f64> = (0..bodies.len()).filter(|&b| bodies.dynamic[b]).map(|b| bodies.mass[b]).collect();
    masses.sort_by(f64::total_cmp);
    let mass = masses.get(masses.len() / 2).copied().unwrap_or(1.0);
    let gravity = world.resource::<State>().gravity().length();
    let impact = |body: usize| {
        let stiffness = bodies.atoms_of(body).map(|atom| bodies.atom_stiffness(atom)).fold(0.0, f64::max);
        bodies.velocity[body].length() * (stiffness * bodies.mass[body]).sqrt()
    };
    let impacts = (0..bodies.len()).filter(|&body| bodies.dynamic[body]).map(impact).fold(0.0, f64::max);
    let typical = if gravity > 0.0 { mass * gravity } else { 0.5 * impacts };
    world.insert_resource(TypicalForce(round(typical)));
}

pub(super) fn plugin(app: &mut App) {
    app.register_entry::<ContactForces>();
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn atoms_of_one_face_are_one_arrow_at_the_centre_of_pressure() {
        let contact = |x: f64, force: DVec2, other: Other| ContactPoint {
            body: 1,
            other,
            point: DVec2::X * x,
            force,
            normal: DVec2::Y,
        };
        let floor = Other::Wall(0);
        let found = loads(
            [
                contact(0.0, DVec2::new(0.0, 1.0), floor),
                contact(1.0, DVec2::new(0.1, 3.0), floor),
                contact(2.0, DVec2::new(-2.0, 0.0), floor),
                contact(3.0, DVec2::new(0.0, 1.0), Other::Body(0)),
                contact(4.0, DVec2::ZERO, Other::Body(0)),
            ]
            .into_iter(),
        );
        assert_eq!(found.len(), 3);
        assert_eq!(found[0].force, DVec2::new(0.1, 4.0));
        // Weighted by the forces: 3.0017 of 4.0017.
        assert!((found[0].point.x - 0.75).abs() < 1e-3, "{}", found[0].point);
        assert_eq!(found[1].force, DVec2::new(-2.0, 0.0));
    }
}
