//! `Joints`: arms from the centres of bodies to the anchors of their joints, and the anchors.

use bevy_app::App;
use bevy_ecs::prelude::*;
use glam::DVec2;
use schemars::JsonSchema;
use serde::Deserialize;

use super::{Mark, MarkShape, PictureHeight, add_own_layer};
use crate::joints::Joint;
use crate::joints::ends::JointEnd;
use crate::record::sections::look::LAYERS;
use crate::scene::{Entry, Outline, SceneAppExt, WrittenEntry};
use crate::tick::State;

/// Radius of a hinge as a share of the picture's height.
const HINGE: f64 = 0.006;

/// Joints: an arm from the centre of each body to its anchor, and a ring at the anchor. Anchors in the world have a dot
/// inside. A scene with joints shows them by default.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Joints {}

impl Entry for Joints {
    const SECTION: &'static str = LAYERS;
    const NAME: &'static str = "Joints";
    const EXAMPLE: &'static str = "Joints";

    fn install(_: Vec<WrittenEntry<Self>>, _: &Outline, app: &mut App) {
        add_own_layer(app, draw);
    }
}

fn draw(world: &World, marks: &mut Vec<Mark>) {
    let state = world.resource::<State>();
    let radius = HINGE * PictureHeight::of(world);
    for joint in state.models_of::<Joint>() {
        let Some(pair) = joint.pair(state.bodies()) else { continue };
        for end in [&pair.a, &pair.b] {
            if end.arm != DVec2::ZERO {
                line(marks, end.position - end.arm, end.position);
            }
        }
        if pair.between().length() > radius {
            line(marks, pair.a.position, pair.b.position);
        }
        for (end, other) in [(&pair.a, &pair.b), (&pair.b, &pair.a)] {
            let together = other.position.distance(end.position) <= radius;
            // A rod that ends in the middle of a body needs no ring; a hinge has one.
            let shown = if together {
                other.body.is_some() || end.body.is_none()
            } else {
                end.arm != DVec2::ZERO || end.body.is_none()
            };
            if shown {
                anchor(marks, end, radius);
            }
        }
    }
}

fn line(marks: &mut Vec<Mark>, from: DVec2, to: DVec2) {
    marks.push(Mark::plain(MarkShape::Line(from, to)));
}

fn anchor(marks: &mut Vec<Mark>, end: &JointEnd, radius: f64) {
    marks.push(Mark::plain(MarkShape::Circle(end.position, radius)));
    if end.body.is_none() {
        marks.push(Mark::plain(MarkShape::Dot(end.position)));
    }
}

pub(super) fn plugin(app: &mut App) {
    app.register_entry::<Joints>();
}
