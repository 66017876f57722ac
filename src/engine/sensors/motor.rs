//! `Motor(of: "drive")`: the output of a motor or controller. `drive.torque` is in N m (on a slide a force in N), its power
//! `drive.power` in W.

use bevy_app::App;
use bevy_ecs::prelude::*;
use schemars::JsonSchema;
use serde::Deserialize;

use super::names::{model_named, model_still};
use super::{Channel, SensorAppExt, add_found, known};
use crate::controllers::Output;
use crate::controllers::output::CONTROLLER;
use crate::scene::values::Names;
use crate::scene::{Diagnostics, Entry, Outline, SceneAppExt, WrittenEntry};
use crate::tick::State;

const QUANTITIES: &[&str] = &["torque", "power"];

/// The torques and powers of motors and controllers. `drive.torque` is in N m, or for a slide a force in N. `drive.power` is
/// in W. Before the first tick both are NaN.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Motor {
    /// The controllers. `*` stands for any letters.
    of: Names,
}

impl Entry for Motor {
    const SECTION: &'static str = "sensors";
    const NAME: &'static str = "Motor";
    const EXAMPLE: &'static str = "Motor(of: \"drive\")";

    fn check(&self, outline: &Outline, report: &mut Diagnostics) {
        self.of.require(CONTROLLER, outline, "of", report);
    }

    fn install(entries: Vec<WrittenEntry<Self>>, outline: &Outline, app: &mut App) {
        for entry in entries {
            let found = entry.value.of.matching(CONTROLLER, outline).into_iter();
            let names = found.map(|index| &outline.names(CONTROLLER)[index]);
            let channels = names.flat_map(|name| QUANTITIES.iter().map(move |quantity| format!("{name}.{quantity}")));
            add_found(app.world_mut(), channels);
        }
    }
}

fn find(world: &mut World, owner: &str, quantity: &str) -> Option<Channel> {
    let name_of: fn(&Output) -> &str = |output| &output.name;
    let place = model_named(world, owner, name_of)?;
    let (unit, read): (_, fn(&Output) -> f64) = match quantity {
        "torque" => ("N m", |output| output.values.0),
        "power" => ("W", |output| output.values.1),
        _ => return None,
    };
    let name = owner.to_owned();
    let value = move |state: &State| {
        let output = model_still(state, (place, &name), name_of);
        output.map_or(f64::NAN, |output| known(state, read(output)))
    };
    Some(Channel::of_state(format!("{owner}.{quantity}"), unit, value))
}

pub(super) fn plugin(app: &mut App) {
    app.add_quantities(QUANTITIES, find);
    app.register_entry::<Motor>();
}
