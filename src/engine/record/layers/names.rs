//! `Names(of: ["T"])`: the names of bodies above them.

use bevy_app::App;
use bevy_ecs::prelude::*;
use schemars::JsonSchema;
use serde::Deserialize;

use super::boxes::bounding_box;
use super::of_bodies::OfBodies;
use super::{Layer, Mark, MarkShape, Shown};
use crate::scene::values::Names as Choice;
use crate::scene::{Outline, SceneAppExt};
use crate::tick::State;
use crate::world::{Bodies, Name};

/// The most names by default, because more would be a wall of text. With names in `of` there is no limit.
const MOST: usize = 60;

/// The names of bodies, beside them.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Names {
    /// The bodies. `*` stands for any letters. Default: all mobile bodies, if they are at most sixty.
    #[serde(default)]
    of: Option<Choice>,
}

impl OfBodies for Names {
    const NAME: &'static str = "Names";
    const EXAMPLE: &'static str = "Names(of: [\"ball\"])";

    fn of(&self) -> Option<&Choice> {
        self.of.as_ref()
    }

    fn layer(self, shown: Shown, _: &Outline) -> impl Layer {
        let chosen = self.of.is_some();
        move |world: &World, marks: &mut Vec<Mark>| {
            let bodies = &world.resource::<State>().bodies;
            if chosen || shown.indices(bodies).nth(MOST).is_none() {
                marks.extend(shown.indices(bodies).filter_map(|body| label(world, bodies, body)));
            }
        }
    }
}

fn label(world: &World, bodies: &Bodies, body: usize) -> Option<Mark> {
    let text = world.get::<Name>(bodies.entity[body])?.to_string();
    let (low, high) = bounding_box(bodies, body)?;
    Some(Mark::plain(MarkShape::Label { at: 0.5 * (low + high), clear: 0.5 * (high.y - low.y), text }))
}

pub(super) fn plugin(app: &mut App) {
    app.register_entry::<Names>();
}
