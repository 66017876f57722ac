//! The contents of snapshots beside the state: resources and components that plugins register.
//!
//! A snapshot refuses a type from outside the engine that is not registered, and names it. The engine registers its
//! types itself.

use std::any::TypeId;

use bevy_app::App;
use bevy_ecs::component::ComponentId;
use bevy_ecs::prelude::*;
use bevy_ecs::resource::IsResource;
use serde::Serialize;
use serde::de::DeserializeOwned;

use super::registered::is_own;
use super::snapshot::{Memory, UnfitSnapshot, Unsaved, recall};

/// Registration of the contents of snapshots by plugins.
pub trait SnapshotAppExt {
    /// Snapshots keep a resource. It is written to them, and replaces that of the world that continues from them.
    fn keep_resource<R: Resource + Serialize + DeserializeOwned>(&mut self) -> &mut Self;

    /// Snapshots keep a component of bodies, walls and other entities.
    fn keep_component<C: Component<Mutability = bevy_ecs::component::Mutable> + Serialize + DeserializeOwned>(
        &mut self,
    ) -> &mut Self;

    /// A resource or component follows from the scene and never changes in a run: snapshots leave it out.
    fn follows_from_scene<T: 'static>(&mut self) -> &mut Self;
}

type Save = fn(&mut World) -> Memory;
type Load = fn(&mut World, &[u8]) -> Result<(), UnfitSnapshot>;

/// The registered types, in order.
#[derive(Resource, Default)]
pub(crate) struct Kept {
    types: Vec<TypeId>,
    keepers: Vec<(&'static str, Save, Load)>,
}

impl SnapshotAppExt for App {
    fn keep_resource<R: Resource + Serialize + DeserializeOwned>(&mut self) -> &mut Self {
        let save: Save = |world| world.get_resource::<R>().map_or(Memory::Nothing, Memory::of);
        let load: Load = |world, bytes| {
            world.insert_resource(recall::<R>(bytes)?);
            Ok(())
        };
        self.follows_from_scene::<R>();
        self.world_mut().resource_mut::<Kept>().keepers.push((std::any::type_name::<R>(), save, load));
        self
    }

    fn keep_component<C: Component<Mutability = bevy_ecs::component::Mutable> + Serialize + DeserializeOwned>(
        &mut self,
    ) -> &mut Self {
        let save: Save = |world| {
            let mut found: Vec<(Entity, &C)> = world.query::<(Entity, &C)>().iter(world).collect();
            found.sort_unstable_by_key(|(entity, _)| *entity);
            Memory::of(&found)
        };
        let load: Load = |world, bytes| {
            let saved: Vec<(Entity, C)> = recall(bytes)?;
            let present: Vec<Entity> = world.query_filtered::<Entity, With<C>>().iter(world).collect();
            for entity in present {
                world.entity_mut(entity).remove::<C>();
            }
            for (entity, component) in saved {
                let mut entity = world
                    .get_entity_mut(entity)
                    .map_err(|_| UnfitSnapshot(format!("the entity {entity} of a component is not there")))?;
                entity.insert(component);
            }
            Ok(())
        };
        self.follows_from_scene::<C>();
        self.world_mut().resource_mut::<Kept>().keepers.push((std::any::type_name::<C>(), save, load));
        self
    }

    fn follows_from_scene<T: 'static>(&mut self) -> &mut Self {
        self.world_mut().get_resource_or_init::<Kept>().types.push(TypeId::of::<T>());
        self
    }
}

/// All registered resources and components, as bytes.
pub(crate) fn save(world: &mut World) -> Result<Vec<Option<Vec<u8>>>, Unsaved> {
    demand_all_known(world)?;
    let keepers = world.get_resource_or_init::<Kept>().keepers.clone();
    let mut saved = Vec::new();
    for (name, save, _) in keepers {
        saved.push(save(world).bytes(|| name.to_owned())?);
    }
    Ok(saved)
}

/// Takes up what [`save`] gave.
pub(crate) fn load(world: &mut World, saved: &[Option<Vec<u8>>]) -> Result<(), UnfitSnapshot> {
    let keepers = world.get_resource_or_init::<Kept>().keepers.clone();
    if keepers.len() != saved.len() {
        return Err(UnfitSnapshot("its plugins keep other resources or components than those of this run".to_owned()));
    }
    for ((name, _, load), bytes) in keepers.into_iter().zip(saved) {
        if let Some(bytes) = bytes {
            load(world, bytes).map_err(|UnfitSnapshot(why)| UnfitSnapshot(format!("`{name}`: {why}")))?;
        }
    }
    Ok(())
}

/// Refuses a type from outside the engine that was not registered.
fn demand_all_known(world: &mut World) -> Result<(), Unsaved> {
    let known = world.get_resource_or_init::<Kept>().types.clone();
    let is_resource = world.components().component_id::<IsResource>();
    let holds_bodies = |id: &ComponentId| Some(*id) != is_resource;
    for archetype in world.archetypes().iter().filter(|archetype| !archetype.is_empty()) {
        for id in archetype.components().iter().filter(|id| holds_bodies(id)) {
            let Some(info) = world.components().get_info(*id) else { continue };
            let name = info.name().to_string();
            let own = is_own(&name);
            let registered = info.type_id().is_some_and(|id| known.contains(&id));
            if !own && !registered {
                return Err(Unsaved { name });
            }
        }
    }
    Ok(())
}
