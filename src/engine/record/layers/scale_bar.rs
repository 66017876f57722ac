//! `ScaleBar`: a bar of a round length in the corner of the picture: `1 m`, `10 cm`, `200 km`.

use bevy_app::App;
use bevy_ecs::prelude::*;
use schemars::JsonSchema;
use serde::Deserialize;

use super::{Mark, MarkShape, add_own_layer};
use crate::record::sections::look::LAYERS;
use crate::scene::{Entry, Outline, SceneAppExt, WrittenEntry};

/// A bar of a round length in the corner of the picture.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct ScaleBar {}

impl Entry for ScaleBar {
    const SECTION: &'static str = LAYERS;
    const NAME: &'static str = "ScaleBar";
    const EXAMPLE: &'static str = "ScaleBar";

    fn install(_: Vec<WrittenEntry<Self>>, _: &Outline, app: &mut App) {
        add_own_layer(app, |_: &World, marks: &mut Vec<Mark>| marks.push(Mark::plain(MarkShape::ScaleBar)));
    }
}

pub(super) fn plugin(app: &mut App) {
    app.register_entry::<ScaleBar>();
}
