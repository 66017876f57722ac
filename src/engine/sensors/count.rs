//! `Count(name: "bin", of: "grain_*", within: ((0, 0), (1, 1)))`: how many bodies are in a region now, and their mass.

use bevy_app::App;
use bevy_ecs::prelude::*;
use schemars::JsonSchema;
use serde::Deserialize;

use super::group::{self, Group};
use super::named::Named;
use super::{Channel, SensorAppExt, add_found, declare};
use crate::scene::values::Names;
use crate::scene::{Diagnostics, Entry, Outline, SceneAppExt, WrittenEntry};
use crate::tick::State;
use crate::tick::kept::SnapshotAppExt;
use crate::world::sections::Region;

const QUANTITIES: &[&str] = &["count", "mass"];

/// The number of bodies whose centres of mass are in a region, `bin.count`, and their mass in kg, `bin.mass`. `Counter`
/// counts touches of bodies, and `Flow` counts bodies that pass a line.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Count {
    /// Its name: that of its channels.
    name: String,
    /// The bodies. `*` stands for any letters.
    of: Names,
    /// Two opposite corners of a box, or the corners of a polygon in order, in m. Default: everywhere.
    within: Option<Region>,
}

/// The sensors of the scene.
type Asked = Named<Group>;

impl Entry for Count {
    const SECTION: &'static str = "sensors";
    const NAME: &'static str = "Count";
    const EXAMPLE: &'static str = "Count(name: \"bin\", of: \"grain_*\", within: ((0, 0), (1, 1)))";

    fn declare(&self, outline: &mut Outline) {
        declare(&self.name, outline);
    }

    fn check(&self, outline: &Outline, report: &mut Diagnostics) {
        group::check(&self.of, self.within.as_ref(), outline, report);
    }

    fn install(entries: Vec<WrittenEntry<Self>>, outline: &Outline, app: &mut App) {
        let world = app.world_mut();
        for WrittenEntry { value: Self { name, of, within }, .. } in entries {
            let group = Group::new(&of, within, outline, world);
            world.get_resource_or_init::<Asked>().push(&name, group);
            add_found(world, QUANTITIES.iter().map(|quantity| format!("{name}.{quantity}")));
        }
    }
}

fn find(world: &mut World, owner: &str, quantity: &str) -> Option<Channel> {
    let index = world.get_resource::<Asked>()?.place(owner)?;
    let (unit, is_mass) = match quantity {
        "count" => ("", false),
        "mass" => ("kg", true),
        _ => return None,
    };
    let read = move |world: &World| {
        let bodies = world.resource::<State>().bodies();
        let group = world.get_resource::<Asked>().and_then(|asked| asked.get(index));
        let of = |(_, body): (usize, usize)| if is_mass { bodies.mass[body] } else { 1.0 };
        group.map_or(f64::NAN, |group| group.present(world).map(of).fold(0.0, |sum, more| sum + more))
    };
    Some(Channel::of_resources(format!("{owner}.{quantity}"), unit, read))
}

pub(super) fn plugin(app: &mut App) {
    app.add_quantities(QUANTITIES, find);
    app.register_entry::<Count>();
    app.follows_from_scene::<Asked>();
}
