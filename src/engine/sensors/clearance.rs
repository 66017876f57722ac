//! `Clearance(name: "gap", a: "arm", b: "wall")`: the least distance between two bodies, or a body and a wall. It is below zero
//! if they overlap.
//!
//! Distances are those of surfaces as contacts see them: if two sharp shapes meet, contacts make their corners round.

use bevy_app::App;
use bevy_ecs::prelude::*;
use glam::DVec2;
use schemars::JsonSchema;
use serde::Deserialize;

use super::named::Named;
use super::{Channel, SensorAppExt, add_found, body_named, declare, wall_named};
use crate::scene::{Diagnostics, Entry, NameKind, Outline, SceneAppExt, WrittenEntry};
use crate::tick::kept::SnapshotAppExt;
use crate::tick::{State, index_of};
use crate::world::{Bodies, Intangible, PackedWall};
use jostle_shapes::{Hull, Pose, distance};

const QUANTITIES: &[&str] = &["clearance"];

/// The least distance in m of the surfaces of two bodies, or of a body and a wall: `gap.clearance`. It is the least over all
/// pairs of their parts. If they overlap, it is below zero: the depth of the deepest pair. It is below zero in a half-plane too,
/// and in a block of ground that a line goes around clockwise. Behind another line, or a strip with one side, it is the distance
/// again. Corners of sharp shapes are as round as contacts make them. If a body has parts that touch, only those count.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Clearance {
    /// Its name: that of its channel.
    name: String,
    /// A body.
    a: String,
    /// Another body, or a wall.
    b: String,
}

/// The sensors of the scene: each with a body, and the other body or wall.
type Asked = Named<(Entity, Entity)>;

impl Entry for Clearance {
    const SECTION: &'static str = "sensors";
    const NAME: &'static str = "Clearance";
    const EXAMPLE: &'static str = "Clearance(name: \"gap\", a: \"ball\", b: \"floor\")";

    fn declare(&self, outline: &mut Outline) {
        declare(&self.name, outline);
    }

    fn check(&self, outline: &Outline, report: &mut Diagnostics) {
        outline.require_any(&[NameKind::BODY], &self.a, "a", report);
        outline.require_any(&[NameKind::BODY, NameKind::WALL], &self.b, "b", report);
        if self.a == self.b {
            report.error("b", format!("`{}` has no distance from itself", self.b)).help("name another body, or a wall");
        }
    }

    fn install(entries: Vec<WrittenEntry<Self>>, _: &Outline, app: &mut App) {
        let world = app.world_mut();
        for WrittenEntry { value: Self { name, a, b }, .. } in entries {
            let other = body_named(world, &b).or_else(|| wall_named(world, &b));
            let Some((a, b)) = body_named(world, &a).zip(other) else { continue };
            world.get_resource_or_init::<Asked>().push(&name, (a, b));
            add_found(world, QUANTITIES.iter().map(|quantity| format!("{name}.{quantity}")));
        }
    }
}

fn find(world: &mut World, owner: &str, quantity: &str) -> Option<Channel> {
    if !QUANTITIES.contains(&quantity) {
        return None;
    }
    let (a, b) = *world.get_resource::<Asked>()?.of(owner)?;
    let value = move |world: &World| {
        let bodies = world.resource::<State>().bodies();
        let Some(first) = Side::of(world, a) else { return f64::NAN };
        match (Side::of(world, b), bodies.walls.iter().position(|wall| wall.entity == b)) {
            (Some(second), _) => between_bodies(bodies, &first, &second),
            (None, Some(wall)) => from_wall(bodies, &first, wall),
            (None, None) => f64::NAN,
        }
    };
    Some(Channel::of_resources(format!("{owner}.{quantity}"), "m", value))
}

/// A body, and its parts that touch nothing if it has no others.
struct Side<'a> {
    body: usize,
    intangible: &'a [Hull],
}

/// A hull, and the same where it meets another that is sharp too.
struct Surface {
    hull: Hull,
    rounded: Option<Hull>,
}

impl<'a> Side<'a> {
    fn of(world: &'a World, entity: Entity) -> Option<Self> {
        let (bodies, body) = (world.resource::<State>().bodies(), index_of(world, entity)?);
        let intangible = world.get::<Intangible>(entity).filter(|_| bodies.atoms_of(body).is_empty());
        Some(Self { body, intangible: intangible.map_or(&[], |intangible| &intangible.hulls) })
    }

    fn is_of_discs(&self, bodies: &Bodies) -> bool {
        self.intangible.is_empty() && bodies.hulls_of(self.body).next().is_none()
    }

    /// Its discs and hulls, about its centre of mass.
    fn surfaces(&self, bodies: &Bodies) -> Vec<Surface> {
        let discs = bodies.atoms_of(self.body).filter(|atom| !bodies.is_corner(*atom));
        let discs = discs.filter_map(|atom| Hull::disc(bodies.atom_offset(atom), bodies.atom_radius[atom]).ok());
        let sharp = |hull: Hull| Surface { hull, rounded: None };
        let hulls = bodies.hulls_of(self.body).map(|packed| Surface {
            hull: packed.hull.clone(),
            rounded: packed.rounded.as_ref().map(|rounded| rounded.hull.clone()),
        });
        discs.chain(self.intangible.iter().cloned()).map(sharp).chain(hulls).collect()
    }

    /// Places in the world and radii of its discs and corners, in metres.
    fn places(&self, bodies: &Bodies) -> Vec<(DVec2, f64)> {
        let atoms = bodies.atoms_of(self.body).map(|atom| (bodies.atom_place(atom), bodies.atom_radius[atom]));
        let pose = self.pose(bodies);
        let corners = self
            .intangible
            .iter()
            .flat_map(|hull| hull.corners().iter().map(move |corner| (pose.point_to_world(*corner), hull.radius())));
        atoms.chain(corners).collect()
    }

    fn pose(&self, bodies: &Bodies) -> Pose {
        Pose::new(bodies.position[self.body], bodies.angle[self.body])
    }
}

impl Surface {
    /// Both as contacts see them.
    fn meets<'a>(&'a self, other: &'a Self) -> (&'a Hull, &'a Hull) {
        self.rounded.as_ref().zip(other.rounded.as_ref()).unwrap_or((&self.hull, &other.hull))
    }
}

fn between_bodies(bodies: &Bodies, first: &Side, second: &Side) -> f64 {
    if ![first, second].iter().all(|side| side.is_of_discs(bodies)) {
        return least((&first.surfaces(bodies), first.pose(bodies)), (&second.surfaces(bodies), second.pose(bodies)));
    }
    let pairs = bodies.atoms_of(first.body).flat_map(|a| bodies.atoms_of(second.body).map(move |b| (a, b)));
    let gap = |(a, b): (usize, usize)| {
        let reach = bodies.atom_radius[a] + bodies.atom_radius[b];
        (bodies.atom_place(a) - bodies.atom_place(b)).length() - reach
    };
    pairs.map(gap).fold(f64::INFINITY, f64::min)
}

fn least((first, at): (&[Surface], Pose), (second, there): (&[Surface], Pose)) -> f64 {
    let pairs = first.iter().flat_map(|a| second.iter().map(move |b| a.meets(b)));
    pairs.map(|(a, b)| distance(a, &at, b, &there)).fold(f64::INFINITY, f64::min)
}

fn from_wall(bodies: &Bodies, side: &Side, wall: usize) -> f64 {
    let Some(line) = bodies.walls[wall].line.map(|line| &bodies.lines[line as usize]) else {
        return from_pieces(bodies, side, wall..wall + 1);
    };
    let nearest = from_pieces(bodies, side, line.pieces());
    let height = |(at, radius): (DVec2, f64)| bodies.height_over_line(line, at) - radius;
    let inside = side.places(bodies).into_iter().filter(|_| line.is_block()).map(height);
    inside.filter(|height| *height < 0.0).fold(nearest, f64::min)
}

/// The least distance from a few walls, or pieces of a line.
fn from_pieces(bodies: &Bodies, side: &Side, pieces: std::ops::Range<usize>) -> f64 {
    let (places, surfaces) = (side.places(bodies), side.surfaces(bodies));
    let from_piece = |wall: &PackedWall| {
        if wall.ends.is_none() || side.is_of_discs(bodies) {
            let gap = |(at, radius): &(DVec2, f64)| wall.nearest(*at).height - radius;
            return places.iter().map(gap).fold(f64::INFINITY, f64::min);
        }
        let [(from, radius), (to, _)] = [false, true].map(|right| wall.end(right));
        let Ok(hull) = Hull::capsule(from, to, radius) else { return f64::INFINITY };
        let strip = [Surface { rounded: wall.is_thin().then(|| hull.clone()), hull }];
        least((&surfaces, side.pose(bodies)), (&strip, Pose::new(DVec2::ZERO, 0.0)))
    };
    bodies.walls[pieces].iter().map(from_piece).fold(f64::INFINITY, f64::min)
}

pub(super) fn plugin(app: &mut App) {
    app.add_quantities(QUANTITIES, find);
    app.register_entry::<Clearance>();
    app.follows_from_scene::<Asked>();
}
