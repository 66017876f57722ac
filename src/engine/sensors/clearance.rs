//! `Clearance(name: "gap", a: "arm", b: "wall")`: the least distance of the surfaces of two bodies, or of a body and a wall; below zero
//! where they overlap.

use bevy_app::App;
use bevy_ecs::prelude::*;
use glam::DVec2;
use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::Deserialize;

use super::{Channel, SensorAppExt, add_found, body_named, wall_named};
use crate::scene::{Entry, Kind, Outline, Report, SceneAppExt, Written};
use crate::tick::kept::SnapshotAppExt;
use crate::tick::{State, place_of};
use crate::world::Bodies;
use jostle_shapes::{Hull, Pose, distance};

const QUANTITIES: &[&str] = &["clearance"];

/// The least distance in m of the surfaces of two bodies, or of a body and a wall: `gap.clearance`. Below zero where they overlap: then it is
/// the depth of the deepest pair of atoms. All pairs of their atoms are looked at.
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

/// What the scene asks for: names, and what they stand for.
#[derive(Resource, Default)]
struct Asked(Vec<(String, Entity, Entity)>);

impl Entry for Clearance {
    const SECTION: &'static str = "sensors";
    const NAME: &'static str = "Clearance";
    const EXAMPLE: &'static str = "Clearance(name: \"gap\", a: \"ball\", b: \"floor\")";

    fn schema(generator: &mut SchemaGenerator) -> Option<Schema> {
        Some(generator.subschema_for::<Self>())
    }

    fn declare(&self, outline: &mut Outline) {
        outline.declare(Kind::SENSOR, &self.name, "name");
    }

    fn check(&self, outline: &Outline, report: &mut Report) {
        outline.require_any(&[Kind::BODY], &self.a, "a", report);
        outline.require_any(&[Kind::BODY, Kind::WALL], &self.b, "b", report);
        if self.a == self.b {
            report.error("b", format!("`{}` has no distance from itself", self.b)).help("name another body, or a wall");
        }
    }

    fn install(entries: Vec<Written<Self>>, _: &Outline, app: &mut App) {
        let world = app.world_mut();
        for Written { value: Self { name, a, b }, .. } in entries {
            let other = body_named(world, &b).or_else(|| wall_named(world, &b));
            let Some((a, b)) = body_named(world, &a).zip(other) else { continue };
            world.get_resource_or_init::<Asked>().0.push((name.clone(), a, b));
            add_found(world, QUANTITIES.iter().map(|quantity| format!("{name}.{quantity}")));
        }
    }
}

fn find(world: &mut World, owner: &str, quantity: &str) -> Option<Channel> {
    if !QUANTITIES.contains(&quantity) {
        return None;
    }
    let (_, a, b) = *world.get_resource::<Asked>()?.0.iter().find(|(name, ..)| name == owner)?;
    let value = move |world: &World| {
        let bodies = world.resource::<State>().bodies();
        let Some(first) = place_of(world, a) else { return f64::NAN };
        match (place_of(world, b), bodies.walls.iter().position(|wall| wall.entity == b)) {
            (Some(second), _) => between_bodies(bodies, first, second),
            (None, Some(wall)) => from_wall(bodies, first, wall),
            (None, None) => f64::NAN,
        }
    };
    Some(Channel::of_resources(format!("{owner}.{quantity}"), "m", value))
}

fn between_bodies(bodies: &Bodies, first: usize, second: usize) -> f64 {
    if [first, second].iter().any(|&body| bodies.hulls_of(body).next().is_some()) {
        return between_shapes(bodies, first, second);
    }
    let pairs = bodies.atoms_of(first).flat_map(|a| bodies.atoms_of(second).map(move |b| (a, b)));
    let gap = |(a, b): (usize, usize)| {
        let reach = bodies.atom_radius[a] + bodies.atom_radius[b];
        (bodies.atom_place(a) - bodies.atom_place(b)).length() - reach
    };
    pairs.map(gap).fold(f64::INFINITY, f64::min)
}

/// The same where one of them has sides.
fn between_shapes(bodies: &Bodies, first: usize, second: usize) -> f64 {
    least((&parts(bodies, first), pose(bodies, first)), (&parts(bodies, second), pose(bodies, second)))
}

/// The discs and hulls of a body.
fn parts(bodies: &Bodies, body: usize) -> Vec<Hull> {
    let discs = bodies.atoms_of(body).filter(|atom| !bodies.is_corner(*atom));
    let discs = discs.filter_map(|atom| Hull::disc(bodies.atom_offset(atom), bodies.atom_radius[atom]).ok());
    discs.chain(bodies.hulls_of(body).map(|packed| packed.hull.clone())).collect()
}

fn pose(bodies: &Bodies, body: usize) -> Pose {
    Pose::new(bodies.position[body], bodies.angle[body])
}

fn least((first, at): (&[Hull], Pose), (second, there): (&[Hull], Pose)) -> f64 {
    let pairs = first.iter().flat_map(|a| second.iter().map(move |b| (a, b)));
    pairs.map(|(a, b)| distance(a, &at, b, &there)).fold(f64::INFINITY, f64::min)
}

fn from_wall(bodies: &Bodies, body: usize, wall: usize) -> f64 {
    let pieces = match bodies.walls[wall].line {
        Some(line) => bodies.lines[line as usize].pieces(),
        None => wall..wall + 1,
    };
    pieces.map(|piece| from_piece(bodies, body, piece)).fold(f64::INFINITY, f64::min)
}

fn from_piece(bodies: &Bodies, body: usize, wall: usize) -> f64 {
    let wall = &bodies.walls[wall];
    if wall.ends.is_some() && bodies.hulls_of(body).next().is_some() {
        let [(from, radius), (to, _)] = [false, true].map(|right| wall.end(right));
        let strip = Hull::capsule(from, to, radius).map_or_else(|_| Vec::new(), |strip| vec![strip]);
        return least((&parts(bodies, body), pose(bodies, body)), (&strip, Pose::new(DVec2::ZERO, 0.0)));
    }
    let gap = |atom: usize| wall.nearest(bodies.atom_place(atom)).height - bodies.atom_radius[atom];
    bodies.atoms_of(body).map(gap).fold(f64::INFINITY, f64::min)
}

pub(super) fn plugin(app: &mut App) {
    app.add_quantities(QUANTITIES, find);
    app.register_entry::<Clearance>();
    app.follows_from_scene::<Asked>();
}
