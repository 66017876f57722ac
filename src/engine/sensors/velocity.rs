//! `Velocity(of: "T")`: velocity in m/s and angular velocity in rad/s, `T.velocity.x`, `T.velocity.y`, `T.spin`.

use bevy_app::App;
use bevy_ecs::prelude::*;
use schemars::JsonSchema;
use serde::Deserialize;

use super::{Channel, SensorAppExt, add_found, of_body};
use crate::scene::values::Names;
use crate::scene::{Diagnostics, Entry, NameKind, Outline, SceneAppExt, WrittenEntry};

/// The columns of the sensor.
const COLUMNS: &[&str] = &["velocity.x", "velocity.y", "spin"];
/// The quantities that plots and expectations may name.
const QUANTITIES: &[&str] = &["velocity.x", "velocity.y", "spin", "speed"];

/// The velocities and spins of bodies: `T.velocity.x`, `T.velocity.y` in m/s, `T.spin` in rad/s. Plots and expectations may
/// also name `T.speed`, in m/s.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Velocity {
    /// The bodies. `*` stands for any letters.
    of: Names,
}

impl Entry for Velocity {
    const SECTION: &'static str = "sensors";
    const NAME: &'static str = "Velocity";
    const EXAMPLE: &'static str = "Velocity(of: \"ball\")";

    fn check(&self, outline: &Outline, report: &mut Diagnostics) {
        self.of.require(NameKind::BODY, outline, "of", report);
    }

    fn install(entries: Vec<WrittenEntry<Self>>, outline: &Outline, app: &mut App) {
        for entry in entries {
            let names =
                entry.value.of.matching(NameKind::BODY, outline).into_iter().map(|b| &outline.names(NameKind::BODY)[b]);
            let channels = names.flat_map(|name| COLUMNS.iter().map(move |quantity| format!("{name}.{quantity}")));
            add_found(app.world_mut(), channels);
        }
    }
}

fn find(world: &mut World, owner: &str, quantity: &str) -> Option<Channel> {
    match quantity {
        "velocity.x" => of_body(world, owner, quantity, "m/s", |bodies, body| bodies.velocity[body].x),
        "velocity.y" => of_body(world, owner, quantity, "m/s", |bodies, body| bodies.velocity[body].y),
        "spin" => of_body(world, owner, quantity, "rad/s", |bodies, body| bodies.spin[body]),
        "speed" => of_body(world, owner, quantity, "m/s", |bodies, body| bodies.velocity[body].length()),
        _ => None,
    }
}

pub(super) fn plugin(app: &mut App) {
    app.add_quantities(QUANTITIES, find);
    app.register_entry::<Velocity>();
}
