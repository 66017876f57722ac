//! `Contacts(of: "ball")`: how many bodies and walls touch a body or wall, `ball.contacts`. `ball.contacts.begun` counts the
//! beginnings of such touches since the start. A pair touches as long as any of its atoms do.

use std::collections::{BTreeMap, BTreeSet};

use bevy_app::App;
use bevy_ecs::prelude::*;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{Channel, SensorAppExt, add_found, body_named, wall_named};
use crate::contacts::ContactEvents;
use crate::contacts::events::{FindContactEvents, watch};
use crate::scene::values::Names;
use crate::scene::{Diagnostics, Entry, NameKind, Outline, SceneAppExt, WrittenEntry};
use crate::tick::add_observer;
use crate::tick::kept::SnapshotAppExt;

const QUANTITIES: &[&str] = &["contacts", "contacts.begun"];

/// The number of bodies and walls that touch a body or wall, `ball.contacts`. `ball.contacts.begun` counts the beginnings
/// of such touches since the start. A body that settles parts and touches again many times. If the run locates events, each
/// touch counts, however short. Otherwise those count that exist at the end of a tick.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Contacts {
    /// Bodies and walls. In names of bodies `*` stands for any letters.
    of: Names,
}

/// The number of touches that have begun, for each body or wall of the sensors.
#[derive(Resource, Default, Serialize, Deserialize)]
struct Begun(BTreeMap<Entity, u64>);

/// The names of bodies, for which `*` matches, and of walls, which are named in full. Each stands once, in the order of the file.
pub(super) fn owners(names: &Names, field: &str, outline: &Outline, report: &mut Diagnostics) -> Vec<String> {
    let mut owners: Vec<String> = Vec::new();
    for (pattern, path) in names.with_paths(field) {
        let Some(bodies) = outline.affordable(NameKind::BODY, pattern, &path, report) else { return Vec::new() };
        if bodies.is_empty() && outline.require_any(&[NameKind::WALL, NameKind::BODY], pattern, &path, report) {
            owners.push(pattern.clone());
        }
        owners.extend(bodies.into_iter().map(|index| outline.names(NameKind::BODY)[index].clone()));
    }
    let mut known = BTreeSet::new();
    owners.retain(|owner| known.insert(owner.clone()));
    if owners.is_empty() && names.patterns.is_empty() {
        report
            .error(field, "must name at least one body or wall")
            .help(format!("write `{field}: \"*\"` for all bodies"));
    }
    owners
}

impl Entry for Contacts {
    const SECTION: &'static str = "sensors";
    const NAME: &'static str = "Contacts";
    const EXAMPLE: &'static str = "Contacts(of: \"ball\")";

    fn check(&self, outline: &Outline, report: &mut Diagnostics) {
        owners(&self.of, "of", outline, report);
    }

    fn install(entries: Vec<WrittenEntry<Self>>, outline: &Outline, app: &mut App) {
        for entry in entries {
            let owners = owners(&entry.value.of, "of", outline, &mut Diagnostics::new());
            let names = owners.iter().flat_map(|owner| QUANTITIES.iter().map(move |q| format!("{owner}.{q}")));
            add_found(app.world_mut(), names);
        }
    }
}

fn find(world: &mut World, owner: &str, quantity: &str) -> Option<Channel> {
    if !QUANTITIES.contains(&quantity) {
        return None;
    }
    let entity = body_named(world, owner).or_else(|| wall_named(world, owner))?;
    watch(world);
    if quantity == "contacts" {
        let count = move |world: &World| {
            world.get_resource::<ContactEvents>().map_or(f64::NAN, |events| events.count(entity) as f64)
        };
        return Some(Channel::of_resources(format!("{owner}.{quantity}"), "", count));
    }
    if !world.contains_resource::<Begun>() {
        world.init_resource::<Begun>();
        add_observer(world, count_begun.after(FindContactEvents));
    }
    world.resource_mut::<Begun>().0.entry(entity).or_default();
    let count = move |world: &World| {
        let begun = world.get_resource::<Begun>().and_then(|begun| begun.0.get(&entity));
        begun.map_or(f64::NAN, |count| *count as f64)
    };
    Some(Channel::of_resources(format!("{owner}.{quantity}"), "", count))
}

fn count_begun(events: Res<ContactEvents>, mut begun: ResMut<Begun>) {
    for entity in events.begun.iter().flat_map(|pair| [pair.a, pair.b]) {
        if let Some(count) = begun.0.get_mut(&entity) {
            *count += 1;
        }
    }
}

pub(super) fn plugin(app: &mut App) {
    app.add_quantities(QUANTITIES, find);
    app.register_entry::<Contacts>();
    app.keep_resource::<Begun>();
}
