//! `Boxes(of: ["T"])`: the bounding boxes of bodies, as in the search for contacts but without its margin.

use bevy_app::App;
use bevy_ecs::prelude::*;
use glam::DVec2;
use schemars::JsonSchema;
use serde::Deserialize;

use super::of_bodies::OfBodies;
use super::{Layer, Mark, MarkShape, Shown};
use crate::scene::values::Names;
use crate::scene::{Outline, SceneAppExt};
use crate::tick::State;
use crate::world::Bodies;

/// The bounding boxes of bodies: the smallest upright rectangles around their atoms.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Boxes {
    /// The bodies. `*` stands for any letters. Default: all that move.
    #[serde(default)]
    of: Option<Names>,
}

impl OfBodies for Boxes {
    const NAME: &'static str = "Boxes";
    const EXAMPLE: &'static str = "Boxes(of: [\"ball\"])";

    fn of(&self) -> Option<&Names> {
        self.of.as_ref()
    }

    fn layer(self, shown: Shown, _: &Outline) -> impl Layer {
        move |world: &World, marks: &mut Vec<Mark>| {
            let bodies = &world.resource::<State>().bodies;
            let boxes = shown.indices(bodies).filter_map(|body| bounding_box(bodies, body));
            marks.extend(boxes.map(|(low, high)| Mark::new(MarkShape::Rectangle(low, high), "quiet")));
        }
    }
}

/// Lower left and upper right corner of the box around a body's atoms, in metres; `None` without atoms.
pub(super) fn bounding_box(bodies: &Bodies, body: usize) -> Option<(DVec2, DVec2)> {
    let atom = |atom: usize| {
        let (center, radius) = (bodies.atom_place(atom), DVec2::splat(bodies.atom_radius[atom]));
        (center - radius, center + radius)
    };
    bodies.atoms_of(body).map(atom).reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)))
}

pub(super) fn plugin(app: &mut App) {
    app.register_entry::<Boxes>();
}
