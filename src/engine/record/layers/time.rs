//! `Time`: the time of each frame in seconds, in the corner of the picture.

use bevy_app::App;
use bevy_ecs::prelude::*;
use schemars::JsonSchema;
use serde::Deserialize;

use super::{Mark, MarkShape, add_own_layer};
use crate::record::sections::look::LAYERS;
use crate::scene::{Entry, Outline, SceneAppExt, WrittenEntry};

/// The time of the physics, below the title.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Time {}

impl Entry for Time {
    const SECTION: &'static str = LAYERS;
    const NAME: &'static str = "Time";
    const EXAMPLE: &'static str = "Time";

    fn install(_: Vec<WrittenEntry<Self>>, _: &Outline, app: &mut App) {
        add_own_layer(app, |_: &World, marks: &mut Vec<Mark>| marks.push(Mark::plain(MarkShape::Time)));
    }
}

pub(super) fn plugin(app: &mut App) {
    app.register_entry::<Time>();
}
