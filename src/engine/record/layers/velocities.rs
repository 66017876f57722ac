//! `Velocities(of: ["T"], scale: "2 m/s")`: the velocity of each centre of mass as an arrow.

use bevy_app::App;
use bevy_ecs::prelude::*;
use schemars::JsonSchema;
use serde::Deserialize;

use super::of_bodies::OfBodies;
use super::scale::{Scale, round};
use super::{Layer, Mark, PictureHeight, Shown};
use crate::scene::units::Speed;
use crate::scene::values::Names;
use crate::scene::{Diagnostics, Outline, SceneAppExt};
use crate::tick::{AfterLoad, State};

/// The velocities of the centres of bodies, as arrows.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Velocities {
    /// The bodies. `*` stands for any letters. Default: all that move.
    #[serde(default)]
    of: Option<Names>,
    /// The speed whose arrow is a tenth of the picture's height long, in m/s. It follows from the speeds at the start, and
    /// from that of a fall through a tenth of the picture. Default: from the scene.
    #[serde(default)]
    scale: Option<Speed>,
}

impl OfBodies for Velocities {
    const NAME: &'static str = "Velocities";
    const EXAMPLE: &'static str = "Velocities(of: [\"ball\"], scale: \"2 m/s\")";

    fn of(&self) -> Option<&Names> {
        self.of.as_ref()
    }

    fn check_others(&self, report: &mut Diagnostics) {
        report.positive_if_given("scale", self.scale);
    }

    fn prepare(app: &mut App) {
        app.world_mut().get_resource_or_init::<AfterLoad>().0.push(note_start);
    }

    fn layer(self, shown: Shown, _: &Outline) -> impl Layer {
        let given = self.scale.map(Speed::si);
        move |world: &World, marks: &mut Vec<Mark>| {
            let bodies = &world.resource::<State>().bodies;
            let height = PictureHeight::of(world);
            let reference = given.unwrap_or_else(|| typical_speed(world, height));
            let scale = Scale::new(reference, height, "m/s", "velocity");
            marks.push(scale.key());
            marks.extend(
                shown.indices(bodies).filter_map(|body| scale.arrow(bodies.position[body], bodies.velocity[body])),
            );
        }
    }
}

/// The greatest speed at the start, in m/s: scales stay the same for the whole film.
#[derive(Resource)]
struct GreatestSpeed(f64);

fn note_start(world: &mut World) {
    let speeds = world.resource::<State>().bodies.velocity.iter().map(|velocity| velocity.length());
    let greatest = GreatestSpeed(speeds.fold(0.0, f64::max));
    world.insert_resource(greatest);
}

fn typical_speed(world: &World, height: f64) -> f64 {
    let start = world.get_resource::<GreatestSpeed>().map_or(0.0, |greatest| greatest.0);
    let gravity = world.resource::<State>().gravity().length();
    round(start.max((2.0 * gravity * 0.1 * height).sqrt()))
}

pub(super) fn plugin(app: &mut App) {
    app.register_entry::<Velocities>();
}
