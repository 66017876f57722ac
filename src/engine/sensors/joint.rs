//! `Joint(of: "hip")`: the free coordinate of a joint, its reaction and its drift. The coordinate is `hip.angle` in rad
//! (`hip.travel` in m for a slide), with its rate `hip.rate`. The reaction on body B at its anchor is `hip.force.x`,
//! `hip.force.y` in newtons and `hip.torque` in N m. `hip.drift` is in m. Gears have `mesh.torque` in N m, a rack has
//! `mesh.force` in N.

use bevy_app::App;
use bevy_ecs::prelude::*;
use schemars::JsonSchema;
use serde::Deserialize;

use super::names::{model_named, model_still};
use super::{Channel, SensorAppExt, add_found, known};
use crate::joints::{self, Coupling};
use crate::scene::values::Names;
use crate::scene::{Diagnostics, Entry, NameKind, Outline, SceneAppExt, WrittenEntry};
use crate::tick::State;

const QUANTITIES: &[&str] = &["angle", "travel", "rate", "force.x", "force.y", "torque", "force", "drift"];

/// The free motion of joints and the forces that they bear. A hinge has `hip.angle` in rad, a slide `piston.travel` in m, and
/// both have `hip.rate`. The reaction on `b` at its anchor is `hip.force.x`, `hip.force.y` in N and `hip.torque` in N m.
/// Before the first tick the reaction is NaN. The error of the constraint is `hip.drift` in m. Gears have one channel,
/// `mesh.torque` in N m on `b` of the second hinge. A rack has one, `mesh.force` in N on `b` of the slide, along its axis.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Joint {
    /// The joints. `*` stands for any letters.
    of: Names,
}

impl Entry for Joint {
    const SECTION: &'static str = "sensors";
    const NAME: &'static str = "Joint";
    const EXAMPLE: &'static str = "Joint(of: \"hip\")";

    fn check(&self, outline: &Outline, report: &mut Diagnostics) {
        self.of.require(NameKind::JOINT, outline, "of", report);
    }

    fn install(entries: Vec<WrittenEntry<Self>>, outline: &Outline, app: &mut App) {
        for entry in entries {
            let joints = entry.value.of.matching(NameKind::JOINT, outline).into_iter();
            let names = joints.map(|joint| &outline.names(NameKind::JOINT)[joint]);
            let channels = names.flat_map(|name| QUANTITIES.iter().map(move |quantity| format!("{name}.{quantity}")));
            add_found(app.world_mut(), channels);
        }
    }
}

fn find(world: &mut World, owner: &str, quantity: &str) -> Option<Channel> {
    let name_of: fn(&Coupling) -> &str = |coupling| &coupling.name;
    if let Some(place) = model_named(world, owner, name_of) {
        let (gives, unit) = world.resource::<State>().model_at::<Coupling>(place)?.gives();
        let name = owner.to_owned();
        let read = move |state: &State| {
            let coupling = model_still(state, (place, &name), name_of);
            coupling.map_or(f64::NAN, |coupling| known(state, coupling.force))
        };
        return (quantity == gives).then(|| Channel::of_state(format!("{owner}.{quantity}"), unit, read));
    }
    let name_of: fn(&joints::Joint) -> &str = |joint| &joint.name;
    let place = model_named(world, owner, name_of)?;
    let joint = world.resource::<State>().model_at::<joints::Joint>(place)?;
    let (freedom, free_unit) = joint.law.freedom_name();
    let (unit, read): (_, fn(&joints::Joint, &State) -> f64) = match quantity {
        "rate" => (if free_unit == "m" { "m/s" } else { "rad/s" }, |joint, state| of_freedom(joint, state).1),
        "force.x" => ("N", |joint, state| known(state, joint.reaction.0.x)),
        "force.y" => ("N", |joint, state| known(state, joint.reaction.0.y)),
        "torque" => ("N m", |joint, state| known(state, joint.reaction.1)),
        "drift" => ("m", |joint, state| joint.drift(state.bodies())),
        _ if quantity == freedom => (free_unit, |joint, state| of_freedom(joint, state).0),
        _ => return None,
    };
    let name = owner.to_owned();
    let read = move |state: &State| {
        let found = model_still(state, (place, &name), name_of);
        found.map_or(f64::NAN, |joint| read(joint, state))
    };
    Some(Channel::of_state(format!("{owner}.{quantity}"), unit, read))
}

fn of_freedom(joint: &joints::Joint, state: &State) -> (f64, f64) {
    joint.freedom(state.bodies()).unwrap_or((f64::NAN, f64::NAN))
}

pub(super) fn plugin(app: &mut App) {
    app.add_quantities(QUANTITIES, find);
    app.register_entry::<Joint>();
}
