//! `ContactPoints(of: ["T"])`: a dot at each contact of atoms with each other or with a wall.

use bevy_app::App;
use bevy_ecs::prelude::*;
use schemars::JsonSchema;
use serde::Deserialize;

use super::of_bodies::OfBodies;
use super::{Layer, Mark, MarkShape, Shown};
use crate::contacts::Other;
use crate::scene::values::Names;
use crate::scene::{Outline, SceneAppExt};
use crate::tick::State;

/// The points where bodies touch each other and walls.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct ContactPoints {
    /// The bodies. `*` stands for any letters. Default: all that move.
    #[serde(default)]
    of: Option<Names>,
}

impl OfBodies for ContactPoints {
    const NAME: &'static str = "ContactPoints";
    const EXAMPLE: &'static str = "ContactPoints(of: [\"ball\"])";

    fn of(&self) -> Option<&Names> {
        self.of.as_ref()
    }

    fn layer(self, shown: Shown, _: &Outline) -> impl Layer {
        move |world: &World, marks: &mut Vec<Mark>| {
            let indices: Vec<usize> = shown.indices(&world.resource::<State>().bodies).collect();
            let is_shown = |body: usize| indices.binary_search(&body).is_ok();
            let dots = world.resource::<State>().contact_points().unwrap_or_default().into_iter().filter(|contact| {
                is_shown(contact.body) || matches!(contact.other, Other::Body(other) if is_shown(other))
            });
            marks.extend(dots.map(|contact| Mark::new(MarkShape::Dot(contact.point), "force")));
        }
    }
}

pub(super) fn plugin(app: &mut App) {
    app.register_entry::<ContactPoints>();
}
