//! `Range(name: "eye", of: "car", at: (0.2, 0), angle: 0)`: ray casting from a place of a body, the distance to the first
//! surface on the ray.
//!
//! The ray begins at a place of the body and turns with it. It meets discs, shapes and walls, except those of its own body and
//! those that touch nothing. It meets half-planes, lines, and strips with one side from their open side, at their surface. The
//! surface of a strip is half its thickness in front of its middle line. A line that goes around a region clockwise makes it a
//! block of ground.

use bevy_app::App;
use bevy_ecs::prelude::*;
use glam::DVec2;
use schemars::JsonSchema;
use serde::Deserialize;

use super::named::Named;
use super::{Channel, SensorAppExt, add_found, body_named, declare};
use crate::scene::units::{Angle, Length, LengthPair};
use crate::scene::{Diagnostics, Entry, NameKind, Outline, SceneAppExt, WrittenEntry};
use crate::tick::kept::SnapshotAppExt;
use crate::tick::{State, index_of};
use crate::world::{Bodies, PackedLine, anchor};
use jostle_shapes::{Hull, Pose, ray};

const QUANTITIES: &[&str] = &["range"];

/// The distance in m along a ray from a body to the first other body or wall: `eye.range`. It is infinite if the ray meets
/// no body or wall within its `reach`. It is zero if it begins inside one. Lines, and strips with one side, are open from
/// behind. A line that goes around a region clockwise makes it a block of ground.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Range {
    /// Its name: that of its channel.
    name: String,
    /// The body that carries it.
    of: String,
    /// The beginning of the ray in the body's frame, in m. It counts from the centre of mass, or from the origin with
    /// `datum: Origin`. Default: the centre of mass.
    at: Option<LengthPair>,
    /// The direction of the ray in the body's frame, counter-clockwise from its x axis, in rad. Default: 0.
    #[serde(default)]
    angle: Angle,
    /// The greatest distance that it sees, in m. Default: none.
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

/// The sensors of the scene.
type Beams = Named<Beam>;

impl Entry for Range {
    const SECTION: &'static str = "sensors";
    const NAME: &'static str = "Range";
    const EXAMPLE: &'static str = "Range(name: \"eye\", of: \"car\", at: (0.2, 0), angle: \"-10 deg\", reach: 5)";

    fn declare(&self, outline: &mut Outline) {
        declare(&self.name, outline);
    }

    fn check(&self, outline: &Outline, report: &mut Diagnostics) {
        outline.require_any(&[NameKind::BODY], &self.of, "of", report);
        if let Some(at) = self.at {
            report.finite_pair("at", at.si());
        }
        report.finite("angle", self.angle);
        if let Some(reach) = self.reach {
            report.positive("reach", reach);
        }
    }

    fn install(entries: Vec<WrittenEntry<Self>>, outline: &Outline, app: &mut App) {
        let world = app.world_mut();
        let mentions = outline.entries(Self::SECTION).iter().filter(|mention| mention.name == Self::NAME);
        for (WrittenEntry { value: Self { name, of, at, angle, reach }, .. }, mention) in
            entries.into_iter().zip(mentions)
        {
            let Some(body) = body_named(world, &of) else { continue };
            let from_center =
                |at: LengthPair| anchor::from_center(world, body, format!("{}.at", mention.path), at.si());
            let at = at.map_or(DVec2::ZERO, from_center);
            let reach = reach.map_or(f64::INFINITY, |reach| reach.si());
            let beam = Beam { body, at, angle: angle.si(), reach };
            world.get_resource_or_init::<Beams>().push(&name, beam);
            add_found(world, QUANTITIES.iter().map(|quantity| format!("{name}.{quantity}")));
        }
    }
}

fn find(world: &mut World, owner: &str, quantity: &str) -> Option<Channel> {
    if !QUANTITIES.contains(&quantity) {
        return None;
    }
    let beam = *world.get_resource::<Beams>()?.of(owner)?;
    let value = move |world: &World| {
        let bodies = world.resource::<State>().bodies();
        index_of(world, beam.body).map_or(f64::NAN, |body| beam.range(bodies, body))
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
        let walls = (0..bodies.walls.len()).filter_map(|wall| to_wall(bodies, wall, from, direction));
        let is_inside = |line: &&PackedLine| line.is_block() && bodies.is_behind_line(line, from);
        let inside = bodies.lines.iter().find(is_inside).map(|_| 0.0);
        let nearest = met.chain(walls).chain(inside).fold(f64::INFINITY, f64::min);
        if nearest <= self.reach { nearest } else { f64::INFINITY }
    }
}

/// The distance in m along a ray to where it meets a wall, or a piece of a line.
fn to_wall(bodies: &Bodies, wall: usize, from: DVec2, direction: DVec2) -> Option<f64> {
    let packed = &bodies.walls[wall];
    let Some(ends) = packed.ends else {
        let (height, sinks) = (packed.normal.dot(from - packed.point), -packed.normal.dot(direction));
        return if height <= 0.0 { Some(0.0) } else { (sinks > 0.0).then(|| height / sinks) };
    };
    let round = [false, true].map(|right| packed.end(right));
    let Some(line) = packed.line else {
        return ray(&Hull::capsule(round[0].0, round[1].0, ends.half).ok()?, from, direction);
    };
    if ends.half > 0.0 && packed.nearest(from).height <= 0.0 {
        return Some(0.0);
    }
    let along = |at: DVec2| (at - packed.point).dot(packed.normal.perp());
    let (height, sinks) = (packed.normal.dot(from - packed.point) - ends.half, -packed.normal.dot(direction));
    let way = height / sinks;
    let is_met = sinks > 0.0 && height >= 0.0 && (0.0..=ends.length).contains(&along(from + direction * way));
    let is_free = bodies.lines[line as usize].round_ends(wall);
    let to_end = |((center, radius), is_free): ((DVec2, f64), bool)| {
        let way = ray(&Hull::disc(center, radius).ok()?, from, direction).filter(|_| is_free && radius > 0.0)?;
        // The other half of the disc lies behind the strip, or in it.
        (!(0.0..=ends.length).contains(&along(from + direction * way))).then_some(way)
    };
    round.into_iter().zip(is_free).filter_map(to_end).chain(is_met.then_some(way)).min_by(f64::total_cmp)
}

pub(super) fn plugin(app: &mut App) {
    app.add_quantities(QUANTITIES, find);
    app.register_entry::<Range>();
    app.follows_from_scene::<Beams>();
}
