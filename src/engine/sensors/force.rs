//! `Force(of: "b", part: Joint)`: the force on a body in newtons, or a part of it, `b.joint_force.x`, `b.joint_force.y`.

use bevy_app::App;
use bevy_ecs::prelude::*;
use glam::DVec2;
use schemars::JsonSchema;
use serde::Deserialize;

use super::{Channel, SensorAppExt, add_found, body_named, known};
use crate::scene::values::Names;
use crate::scene::{Diagnostics, Entry, NameKind, Outline, SceneAppExt, WrittenEntry};
use crate::tick::{ForcePart, State, index_of};

/// The parts of the force on a body that a sensor can measure.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, JsonSchema)]
enum Part {
    /// `m g` in the field of `gravity`: `b.weight.x`.
    Weight,
    /// The sum of all contacts: `b.contact_force.x`.
    Contact,
    /// The sum of all springs and dampers: `b.spring_force.x`.
    Spring,
    /// The sum of all joints and of what drives them: `b.joint_force.x`.
    Joint,
    /// The sum of all forces, mass times acceleration: `b.total_force.x`.
    #[default]
    Total,
}

/// The names of the parts in channels.
const PARTS: [(Part, &str); 5] = [
    (Part::Weight, "weight"),
    (Part::Contact, "contact_force"),
    (Part::Spring, "spring_force"),
    (Part::Joint, "joint_force"),
    (Part::Total, "total_force"),
];
const QUANTITIES: &[&str] = &[
    "weight.x",
    "weight.y",
    "contact_force.x",
    "contact_force.y",
    "spring_force.x",
    "spring_force.y",
    "joint_force.x",
    "joint_force.y",
    "total_force.x",
    "total_force.y",
];

/// The force on bodies in N, all of it or a part: `b.weight.x`, `b.contact_force.x`, `b.spring_force.x`, `b.joint_force.x`,
/// `b.total_force.x`, and the same with `.y`. Drag, thrust and the like count in the total only. Before the first tick only the
/// weight is known, and all others are NaN.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Force {
    /// The bodies. `*` stands for any letters.
    of: Names,
    /// The part that the sensor measures. Default: `Total`.
    #[serde(default)]
    part: Part,
}

impl Entry for Force {
    const SECTION: &'static str = "sensors";
    const NAME: &'static str = "Force";
    const EXAMPLE: &'static str = "Force(of: \"ball\", part: Joint)";

    fn check(&self, outline: &Outline, report: &mut Diagnostics) {
        self.of.require(NameKind::BODY, outline, "of", report);
    }

    fn install(entries: Vec<WrittenEntry<Self>>, outline: &Outline, app: &mut App) {
        for WrittenEntry { value: Self { of, part }, .. } in entries {
            let quantity = PARTS.iter().find(|(known, _)| *known == part).map_or("", |(_, name)| name);
            let names =
                of.matching(NameKind::BODY, outline).into_iter().map(|body| &outline.names(NameKind::BODY)[body]);
            let channels = names.flat_map(|name| ["x", "y"].map(|axis| format!("{name}.{quantity}.{axis}")));
            add_found(app.world_mut(), channels);
        }
    }
}

fn find(world: &mut World, owner: &str, quantity: &str) -> Option<Channel> {
    let (quantity, axis) = quantity.split_once('.')?;
    let (part, name) = PARTS.into_iter().find(|(_, name)| *name == quantity)?;
    let component: fn(DVec2) -> f64 = match axis {
        "x" => |force| force.x,
        "y" => |force| force.y,
        _ => return None,
    };
    let entity = body_named(world, owner)?;
    if part == Part::Contact {
        world.get_resource_or_init::<State>().contact_forces.get_or_insert_default();
    }
    let value = move |world: &World| {
        let index = index_of(world, entity);
        let state = world.resource();
        let value = index.map_or(f64::NAN, |index| component(of(part, state, index)));
        if part == Part::Weight { value } else { known(state, value) }
    };
    Some(Channel::of_resources(format!("{owner}.{name}.{axis}"), "N", value))
}

/// A part of the force on the body at a place, in newtons.
fn of(part: Part, state: &State, index: usize) -> DVec2 {
    let bodies = state.bodies();
    let told = |part: ForcePart| {
        let forces = state.models().filter_map(|model| model.force_on(state, index));
        forces.filter(|told| told.part == part).fold(DVec2::ZERO, |sum, told| sum + told.force)
    };
    match part {
        Part::Weight if !bodies.dynamic[index] => DVec2::ZERO,
        Part::Weight => state.gravity() * bodies.mass[index],
        Part::Contact => {
            let forces = state.contact_forces().and_then(|forces| forces.on_body.get(index));
            forces.copied().unwrap_or(DVec2::ZERO)
        }
        Part::Spring => told(ForcePart::Spring),
        Part::Joint => told(ForcePart::Joint),
        Part::Total if bodies.dynamic[index] => bodies.force[index],
        Part::Total => bodies.prescribed.acceleration(index).0 * bodies.mass[index],
    }
}

pub(super) fn plugin(app: &mut App) {
    app.add_quantities(QUANTITIES, find);
    app.register_entry::<Force>();
}
