//! Lists by name: the sensors of one kind, in the order of the scene.

use std::collections::BTreeMap;

use bevy_ecs::prelude::*;

/// A list whose things are found by the names of their sensors.
#[derive(Resource)]
pub(super) struct Named<T: Send + Sync + 'static> {
    list: Vec<T>,
    places: BTreeMap<String, usize>,
}

impl<T: Send + Sync + 'static> Default for Named<T> {
    fn default() -> Self {
        Self { list: Vec::new(), places: BTreeMap::new() }
    }
}

impl<T: Send + Sync + 'static> Named<T> {
    /// Adds a thing behind the others. The first one of a name keeps it.
    pub fn push(&mut self, name: &str, thing: T) {
        self.places.entry(name.to_owned()).or_insert(self.list.len());
        self.list.push(thing);
    }

    /// The place of a name in the list.
    pub fn place(&self, name: &str) -> Option<usize> {
        self.places.get(name).copied()
    }

    /// The thing of a name.
    pub fn of(&self, name: &str) -> Option<&T> {
        self.place(name).map(|place| &self.list[place])
    }

    /// The thing at a place.
    pub fn get(&self, place: usize) -> Option<&T> {
        self.list.get(place)
    }

    /// All of them in order.
    pub fn iter(&self) -> std::slice::Iter<'_, T> {
        self.list.iter()
    }
}
