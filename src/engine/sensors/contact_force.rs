//! `ContactForce(on: "floor")`: the sum of the contact forces on a wall or a body in newtons, `floor.force.x`,
//! `floor.force.y`.

use bevy_app::App;
use bevy_ecs::prelude::*;
use glam::DVec2;
use schemars::JsonSchema;
use serde::Deserialize;

use super::{Channel, SensorAppExt, add_found, body_named, wall_named};
use crate::scene::{Diagnostics, Entry, NameKind, Outline, SceneAppExt, WrittenEntry};
use crate::tick::{State, index_of};

const QUANTITIES: &[&str] = &["force.x", "force.y"];

/// The sum of the contact forces on a wall or body: `floor.force.x`, `floor.force.y` in newtons. Contacts of bodies that are
/// asleep come first in the sum. So its last digits may change when bodies fall asleep or wake, although no force does.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct ContactForce {
    /// The name of the wall or body.
    on: String,
}

impl Entry for ContactForce {
    const SECTION: &'static str = "sensors";
    const NAME: &'static str = "ContactForce";
    const EXAMPLE: &'static str = "ContactForce(on: \"floor\")";

    fn check(&self, outline: &Outline, report: &mut Diagnostics) {
        outline.require_any(&[NameKind::WALL, NameKind::BODY], &self.on, "on", report);
    }

    fn install(entries: Vec<WrittenEntry<Self>>, _: &Outline, app: &mut App) {
        let names = entries.iter().flat_map(|entry| QUANTITIES.iter().map(|q| format!("{}.{q}", entry.value.on)));
        add_found(app.world_mut(), names);
    }
}

fn find(world: &mut World, owner: &str, quantity: &str) -> Option<Channel> {
    let component: fn(DVec2) -> f64 = match quantity {
        "force.x" => |force| force.x,
        "force.y" => |force| force.y,
        _ => return None,
    };
    let wall = wall_named(world, owner);
    let entity = wall.or_else(|| body_named(world, owner))?;
    world.get_resource_or_init::<State>().contact_forces.get_or_insert_default();
    let force = move |world: &World| {
        let State { bodies, contact_forces: Some(forces), .. } = world.resource() else { return None };
        if wall.is_some() {
            let index = bodies.walls.iter().position(|wall| wall.entity == entity)?;
            return forces.on_wall.get(index).copied();
        }
        forces.on_body.get(index_of(world, entity)?).copied()
    };
    let value = move |world: &World| component(force(world).unwrap_or(DVec2::ZERO));
    Some(Channel::of_resources(format!("{owner}.{quantity}"), "N", value))
}

pub(super) fn plugin(app: &mut App) {
    app.add_quantities(QUANTITIES, find);
    app.register_entry::<ContactForce>();
}
