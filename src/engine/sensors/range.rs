//! `Range(name: "eye", of: "car", at: (0.2, 0), angle: 0)`: how far a ray from a place of a body goes until it meets something.
//!
//! The ray begins at a place of the body and turns with it. It meets discs, shapes and walls, those of its own body and such as touch
//! nothing left out. Half-planes and lines are met from their open side.

use bevy_app::App;
use bevy_ecs::prelude::*;
use glam::DVec2;
use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::Deserialize;

use super::{Channel, SensorAppExt, add_found, body_named};
use crate::scene::units::{Angle, Length, Position};
use crate::scene::{Entry, Kind, Outline, Report, SceneAppExt, Written};
use crate::tick::kept::SnapshotAppExt;
use crate::tick::{State, place_of};
use crate::world::{Bodies, PackedWall};
use jostle_shapes::{Hull, Pose, ray};

const QUANTITIES: &[&str] = &["range"];

/// How far in m a ray from a place of a body goes until it meets another body or a wall: `eye.range`. It is infinite if the ray meets nothing
/// within its `reach`, and zero if it begins inside something.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Range {
    /// Its name: that of its channel.
    name: String,
    /// The body that carries it.
    of: String,
    /// Where the ray begins, in the body's frame from its centre of mass, in m. Default: (0, 0).
    #[serde(default)]
    at: Position,
    /// The direction of the ray in the body's frame, counter-clockwise from its x axis, in rad. Default: 0.
    #[serde(default)]
    angle: Angle,
    /// The farthest that it sees, in m. Default: as far as there is something.
    reach: Option<Length>,
}

/// A ray of a body: where it begins, its direction, and the farthest that it goes, in m.
#[derive(Clone, Copy)]
struct Beam {
    body: Entity,
    at: DVec2,
    angle: f64,
    reach: f64,
}

/// What the scene asks for.
#[derive(Resource, Default)]
struct Beams(Vec<(String, Beam)>);

impl Entry for Range {
    const SECTION: &'static str = "sensors";
    const NAME: &'static str = "Range";
    const EXAMPLE: &'static str = "Range(name: \"eye\", of: \"car\", at: (0.2, 0), angle: \"-10 deg\", reach: 5)";

    fn schema(generator: &mut SchemaGenerator) -> Option<Schema> {
        Some(generator.subschema_for::<Self>())
    }

    fn declare(&self, outline: &mut Outline) {
        outline.declare(Kind::SENSOR, &self.name, "name");
    }

    fn check(&self, outline: &Outline, report: &mut Report) {
        outline.require_any(&[Kind::BODY], &self.of, "of", report);
        report.finite_pair("at", self.at.si());
        report.finite("angle", self.angle);
        if let Some(reach) = self.reach {
            report.positive("reach", reach);
        }
    }

    fn install(entries: Vec<Written<Self>>, _: &Outline, app: &mut App) {
        let world = app.world_mut();
        for Written { value: Self { name, of, at, angle, reach }, .. } in entries {
            let Some(body) = body_named(world, &of) else { continue };
            let reach = reach.map_or(f64::INFINITY, |reach| reach.si());
            let beam = Beam { body, at: at.si(), angle: angle.si(), reach };
            world.get_resource_or_init::<Beams>().0.push((name.clone(), beam));
            add_found(world, QUANTITIES.iter().map(|quantity| format!("{name}.{quantity}")));
        }
    }
}

fn find(world: &mut World, owner: &str, quantity: &str) -> Option<Channel> {
    if !QUANTITIES.contains(&quantity) {
        return None;
    }
    let (_, beam) = *world.get_resource::<Beams>()?.0.iter().find(|(name, _)| name == owner)?;
    let value = move |world: &World| {
        let bodies = world.resource::<State>().bodies();
        place_of(world, beam.body).map_or(f64::NAN, |body| beam.range(bodies, body))
    };
    Some(Channel::of_resources(format!("{owner}.{quantity}"), "m", value))
}

impl Beam {
    fn range(&self, bodies: &Bodies, own: usize) -> f64 {
        let pose = |body: usize| Pose::new(bodies.position[body], bodies.angle[body]);
        let from = pose(own).point_to_world(self.at);
        let (sin, cos) = libm::sincos(bodies.angle[own] + self.angle);
        let direction = DVec2::new(cos, sin);
        let others = (0..bodies.len()).filter(|&body| body != own && bodies.collides[body]);
        let met = others.flat_map(|body| {
            let pose = pose(body);
            let (from, direction) = (pose.point_to_local(from), pose.direction_to_local(direction));
            let discs = bodies.atoms_of(body).filter(|&atom| !bodies.is_corner(atom));
            let discs =
                discs.filter_map(move |atom| Hull::disc(bodies.atom_offset(atom), bodies.atom_radius[atom]).ok());
            let discs = discs.filter_map(move |disc| ray(&disc, from, direction));
            discs.chain(bodies.hulls_of(body).filter_map(move |packed| ray(&packed.hull, from, direction)))
        });
        let walls = bodies.walls.iter().filter_map(|wall| to_wall(wall, from, direction));
        let nearest = met.chain(walls).fold(f64::INFINITY, f64::min);
        if nearest <= self.reach { nearest } else { f64::INFINITY }
    }
}

/// The distance in m along a ray to where it meets a wall.
fn to_wall(wall: &PackedWall, from: DVec2, direction: DVec2) -> Option<f64> {
    if let (None, Some(_)) = (wall.line, wall.ends) {
        let [(start, radius), (end, _)] = [false, true].map(|right| wall.end(right));
        return ray(&Hull::capsule(start, end, radius).ok()?, from, direction);
    }
    let (height, sinks) = (wall.normal.dot(from - wall.point), -wall.normal.dot(direction));
    match wall.ends {
        None if height <= 0.0 => Some(0.0),
        None => (sinks > 0.0).then(|| height / sinks),
        Some(ends) => {
            let way = height / sinks;
            let along = (from + direction * way - wall.point).dot(wall.normal.perp());
            (sinks > 0.0 && height >= 0.0 && (0.0..=ends.length).contains(&along)).then_some(way)
        }
    }
}

pub(super) fn plugin(app: &mut App) {
    app.add_quantities(QUANTITIES, find);
    app.register_entry::<Range>();
    app.follows_from_scene::<Beams>();
}
