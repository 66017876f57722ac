//! `Pose(of: "T")`: position in metres and angle in radians, `T.position.x`, `T.position.y`, `T.angle`.

use bevy_app::App;
use bevy_ecs::prelude::*;
use schemars::JsonSchema;
use serde::Deserialize;

use super::{Channel, SensorAppExt, add_found, of_body};
use crate::scene::values::Names;
use crate::scene::{Diagnostics, Entry, NameKind, Outline, SceneAppExt, WrittenEntry};

const QUANTITIES: &[&str] = &["position.x", "position.y", "angle"];

/// The positions and angles of bodies: `T.position.x`, `T.position.y` in m, `T.angle` in rad.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Pose {
    /// The bodies. `*` stands for any letters.
    of: Names,
}

impl Entry for Pose {
    const SECTION: &'static str = "sensors";
    const NAME: &'static str = "Pose";
    const EXAMPLE: &'static str = "Pose(of: \"ball\")";

    fn check(&self, outline: &Outline, report: &mut Diagnostics) {
        self.of.require(NameKind::BODY, outline, "of", report);
    }

    fn install(entries: Vec<WrittenEntry<Self>>, outline: &Outline, app: &mut App) {
        for entry in entries {
            let names =
                entry.value.of.matching(NameKind::BODY, outline).into_iter().map(|b| &outline.names(NameKind::BODY)[b]);
            let channels = names.flat_map(|name| QUANTITIES.iter().map(move |quantity| format!("{name}.{quantity}")));
            add_found(app.world_mut(), channels);
        }
    }
}

fn find(world: &mut World, owner: &str, quantity: &str) -> Option<Channel> {
    match quantity {
        "position.x" => of_body(world, owner, quantity, "m", |bodies, body| bodies.position[body].x),
        "position.y" => of_body(world, owner, quantity, "m", |bodies, body| bodies.position[body].y),
        "angle" => of_body(world, owner, quantity, "rad", |bodies, body| bodies.angle[body]),
        _ => None,
    }
}

pub(super) fn plugin(app: &mut App) {
    app.add_quantities(QUANTITIES, find);
    app.register_entry::<Pose>();
}
