//! `Acceleration(of: "T")`: accelerations by all forces of the present state. `T.acceleration.x` and `T.acceleration.y` in m/s2
//! are those of the centre of mass, `T.angular_acceleration` in rad/s2 is that of the angle.

use bevy_app::App;
use bevy_ecs::prelude::*;
use glam::DVec2;
use schemars::JsonSchema;
use serde::Deserialize;

use super::{Channel, SensorAppExt, add_found, body_named, known};
use crate::scene::values::Names;
use crate::scene::{Diagnostics, Entry, NameKind, Outline, SceneAppExt, WrittenEntry};
use crate::tick::{State, index_of};
use crate::world::Bodies;

const QUANTITIES: &[&str] = &["acceleration.x", "acceleration.y", "angular_acceleration"];

/// The rates of the velocities of bodies, by all forces on them: `T.acceleration.x`, `T.acceleration.y` in m/s2,
/// `T.angular_acceleration` in rad/s2. Before the first tick no force is known, and they are NaN.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Acceleration {
    /// The bodies. `*` stands for any letters.
    of: Names,
}

impl Entry for Acceleration {
    const SECTION: &'static str = "sensors";
    const NAME: &'static str = "Acceleration";
    const EXAMPLE: &'static str = "Acceleration(of: \"ball\")";

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
    let (unit, read): (_, fn(&Bodies, usize) -> f64) = match quantity {
        "acceleration.x" => ("m/s2", |bodies, body| of(bodies, body).0.x),
        "acceleration.y" => ("m/s2", |bodies, body| of(bodies, body).0.y),
        "angular_acceleration" => ("rad/s2", |bodies, body| of(bodies, body).1),
        _ => return None,
    };
    let entity = body_named(world, owner)?;
    let value = move |world: &World| {
        let state = world.resource::<State>();
        index_of(world, entity).map_or(f64::NAN, |index| known(state, read(state.bodies(), index)))
    };
    Some(Channel::of_resources(format!("{owner}.{quantity}"), unit, value))
}

/// Bodies that move as prescribed have the acceleration of their motion.
fn of(bodies: &Bodies, body: usize) -> (DVec2, f64) {
    match bodies.dynamic[body] {
        true => (bodies.force[body] * bodies.inverse_mass(body), bodies.torque[body] * bodies.inverse_inertia(body)),
        false => bodies.prescribed.acceleration(body),
    }
}

pub(super) fn plugin(app: &mut App) {
    app.add_quantities(QUANTITIES, find);
    app.register_entry::<Acceleration>();
}
