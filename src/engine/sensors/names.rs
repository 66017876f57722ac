//! Bodies, walls and models by name.
//!
//! An index holds them while a scene is put together, and while many are looked for. A look-up then costs a logarithm
//! of their number. The index is made anew if their number changed, or if an entity lost its name.

use std::any::TypeId;
use std::collections::BTreeMap;

use bevy_ecs::prelude::*;

use crate::scene::values::Names;
use crate::scene::{NameKind, Outline};
use crate::tick::State;
use crate::world::{Body, Name, Wall};

/// Bodies, walls and models by name.
#[derive(Resource, Default)]
pub(super) struct NameIndex {
    bodies: Listed,
    walls: Listed,
    /// For each type, its places among all models, and the number of all models at that time.
    models: BTreeMap<TypeId, (usize, BTreeMap<String, usize>)>,
    /// Names that were written into the index, the measure of its cost.
    #[cfg(test)]
    pub written: usize,
}

/// Entities of one kind.
#[derive(Default)]
struct Listed {
    by_name: BTreeMap<String, Entity>,
    /// Their number when the list was made.
    count: usize,
}

type List = fn(&mut NameIndex) -> &mut Listed;

/// The entity of the body called `name`.
pub(super) fn body_named(world: &mut World, name: &str) -> Option<Entity> {
    named::<Body>(world, name, |index| &mut index.bodies)
}

/// The entity of the wall called `name`.
pub(super) fn wall_named(world: &mut World, name: &str) -> Option<Entity> {
    named::<Wall>(world, name, |index| &mut index.walls)
}

/// The bodies that names mean, in the order of [`Names::matching`].
pub(super) fn bodies_named(world: &mut World, names: &Names, outline: &Outline) -> Vec<Entity> {
    let names = names.matching(NameKind::BODY, outline).into_iter().map(|index| &outline.names(NameKind::BODY)[index]);
    with_index(world, |world| names.filter_map(|name| body_named(world, name)).collect())
}

/// Looks many bodies and walls up by name.
pub(super) fn with_index<T>(world: &mut World, look: impl FnOnce(&mut World) -> T) -> T {
    if world.contains_resource::<NameIndex>() {
        return look(world);
    }
    world.init_resource::<NameIndex>();
    let found = look(world);
    forget_names(world);
    found
}

/// The scene is put together: from now on names are searched for, because bodies come and go.
pub(crate) fn forget_names(world: &mut World) {
    world.remove_resource::<NameIndex>();
}

/// The place among all models of the first one of a type with this name.
pub(super) fn model_named<T: 'static>(world: &mut World, name: &str, name_of: fn(&T) -> &str) -> Option<usize> {
    let state = world.get_resource::<State>()?;
    let count = state.model_count();
    let bears_it = |place: usize| state.model_at(place).is_some_and(|model| name_of(model) == name);
    let Some(index) = world.get_resource::<NameIndex>() else { return (0..count).find(|place| bears_it(*place)) };
    if let Some((_, places)) = index.models.get(&TypeId::of::<T>()).filter(|(known, _)| *known == count) {
        let found = places.get(name).copied();
        if found.is_none_or(bears_it) {
            return found;
        }
    }
    let mut places = BTreeMap::new();
    for place in 0..count {
        if let Some(model) = state.model_at(place) {
            places.entry(name_of(model).to_owned()).or_insert(place);
        }
    }
    let found = places.get(name).copied();
    world.resource_mut::<NameIndex>().models.insert(TypeId::of::<T>(), (count, places));
    found
}

/// A model at a place among all. If models came or went, it is looked for by its name.
pub(super) fn model_still<'a, T: 'static>(
    state: &'a State,
    (place, name): (usize, &str),
    name_of: fn(&T) -> &str,
) -> Option<&'a T> {
    let found = state.model_at(place).filter(|model| name_of(model) == name);
    found.or_else(|| state.models_of().find(|model| name_of(model) == name))
}

fn named<C: Component>(world: &mut World, name: &str, list: List) -> Option<Entity> {
    if !world.contains_resource::<NameIndex>() {
        let mut query = world.query_filtered::<(Entity, &Name), With<C>>();
        return query.iter(world).find(|(_, found)| **found == *name).map(|(entity, _)| entity);
    }
    let count = world.query_filtered::<&Name, With<C>>().iter(world).len();
    let mut index = world.resource_mut::<NameIndex>();
    let listed = list(&mut index);
    let (as_many, found) = (listed.count == count, listed.by_name.get(name).copied());
    let bears_it = |entity: Entity| world.get::<Name>(entity).is_some_and(|found| *found == *name);
    if as_many && found.is_none_or(bears_it) {
        return found;
    }
    let mut by_name = BTreeMap::new();
    for (entity, name) in world.query_filtered::<(Entity, &Name), With<C>>().iter(world) {
        by_name.entry(name.to_string()).or_insert(entity);
    }
    let mut index = world.resource_mut::<NameIndex>();
    #[cfg(test)]
    {
        index.written += count;
    }
    let listed = list(&mut index);
    *listed = Listed { by_name, count };
    listed.by_name.get(name).copied()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[derive(Component)]
    struct Thing;

    fn of(world: &mut World, name: &str) -> Option<Entity> {
        named::<Thing>(world, name, |index| &mut index.bodies)
    }

    /// Law: as many names are written as there are things, whatever the number of look-ups. Things that come, go or change their
    /// names are found all the same.
    #[test]
    fn names_are_written_once_for_all_look_ups() {
        let mut world = World::new();
        let mut all: Vec<Entity> =
            (0..100).map(|index| world.spawn((Thing, Name::from(format!("thing {index}")))).id()).collect();
        with_index(&mut world, |world| {
            for (index, entity) in all.iter().enumerate() {
                assert_eq!(of(world, &format!("thing {index}")), Some(*entity));
            }
            assert_eq!((of(world, "no thing"), world.resource::<NameIndex>().written), (None, 100));
            all.push(world.spawn((Thing, Name::from("late"))).id());
            assert_eq!(of(world, "late"), Some(all[100]));
            world.entity_mut(all[100]).insert(Name::from("later"));
            assert_eq!((of(world, "late"), of(world, "later")), (None, Some(all[100])));
            world.despawn(all[0]);
            assert_eq!(of(world, "thing 0"), None);
        });
        assert!(!world.contains_resource::<NameIndex>());
        assert_eq!(of(&mut world, "later"), Some(all[100]));
    }
}
