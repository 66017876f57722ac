//! Contact events: which bodies began and which ceased to touch in the last tick.
//!
//! Whoever wants to know says so with [`ContactEventsAppExt::watch_contacts`]; then the contact law notes who touches and
//! the lists of two ticks are compared. In a scene where nobody asks there is neither the list nor the system. Two bodies
//! touch as long as any of their atoms do.

use std::collections::BTreeSet;

use bevy_app::App;
use bevy_ecs::prelude::*;

use serde::{Deserialize, Serialize};

use crate::tick::{Notes, State, add_packed_observer};

/// A body and another body or a wall. Of two bodies the first stands before the second in canonical order; a wall stands
/// second.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct Touching {
    /// The first body.
    pub a: Entity,
    /// The second body, or the wall.
    pub b: Entity,
}

/// What the last tick changed: an observer reads it in [`crate::tick::Stage::Observe`] after [`FindContactEvents`], or between ticks.
#[derive(Resource, Clone, Debug, Default, Serialize, Deserialize)]
pub struct ContactEvents {
    /// Pairs that began to touch, in canonical order. In the first tick these are all that touch. Where events are located a
    /// pair stands here as often as it began to touch in the tick, else once if it touches and did not before.
    pub begun: Vec<Touching>,
    /// Pairs that ceased to touch, as often as they did, in canonical order.
    pub ended: Vec<Touching>,
    /// All pairs that touch, in canonical order.
    pub present: Vec<Touching>,
    /// End of the tick in seconds.
    pub time: f64,
}

impl ContactEvents {
    /// How many bodies and walls touch a body or wall.
    pub fn count(&self, entity: Entity) -> usize {
        self.present.iter().filter(|pair| pair.a == entity || pair.b == entity).count()
    }
}

/// Where contact events are found.
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct FindContactEvents;

/// How plugins ask for contact events.
pub trait ContactEventsAppExt {
    /// Keeps [`ContactEvents`] from the next tick on. Asking twice does nothing.
    fn watch_contacts(&mut self) -> &mut Self;
}

impl ContactEventsAppExt for App {
    fn watch_contacts(&mut self) -> &mut Self {
        watch(self.world_mut());
        self
    }
}

/// The same for whoever has no app.
pub fn watch(world: &mut World) {
    if world.contains_resource::<ContactEvents>() {
        return;
    }
    world.init_resource::<ContactEvents>();
    let mut state = world.get_resource_or_init::<State>();
    state.touches.get_or_insert_default();
    // The pairs that touch already are found by an evaluation, also where all bodies are asleep.
    state.bodies.touched = true;
    add_packed_observer(world, find_contact_events.in_set(FindContactEvents));
}

fn find_contact_events(
    mut state: ResMut<State>,
    mut events: ResMut<ContactEvents>,
    notes: Option<ResMut<Notes>>,
    mut warned: Local<bool>,
) {
    let law = state.contact_law();
    let State { bodies, clock, touches: Some(touches), .. } = state.bypass_change_detection() else { return };
    if let Some(name) = law.filter(|_| !touches.told && !*warned) {
        *warned = true;
        if let Some(mut notes) = notes {
            let note =
                format!("contacts: `{name}` does not tell who touches: contact events and `Contacts` see nothing");
            notes.0.push(note);
        }
    }
    touches.pairs.sort_unstable();
    touches.pairs.dedup();
    let entities = |&(is_wall, a, b): &(bool, u32, u32)| {
        let b = if is_wall { bodies.walls[b as usize].entity } else { bodies.entity[b as usize] };
        Touching { a: bodies.entity[a as usize], b }
    };
    let ContactEvents { begun, ended, present, time } = &mut *events;
    *time = clock.time();
    let before = std::mem::take(present);
    present.extend(touches.pairs.iter().map(entities));
    ended.clear();
    begun.clear();
    let known: BTreeSet<Touching> = before.iter().copied().collect();
    let now: BTreeSet<Touching> = present.iter().copied().collect();
    begun.extend(present.iter().filter(|pair| !known.contains(pair)));
    ended.extend(before.iter().filter(|pair| !now.contains(pair)));
    if touches.begun.is_empty() {
        return;
    }
    // What was located is known exactly, and replaces what two states show.
    let located: Vec<Touching> = touches.begun.drain(..).map(|pair| entities(&pair)).collect();
    let seen: BTreeSet<Touching> = located.iter().copied().collect();
    begun.retain(|pair| !seen.contains(pair));
    ended.retain(|pair| !seen.contains(pair));
    for pair in &seen {
        let times = located.iter().filter(|other| *other == pair).count();
        let left = usize::from(known.contains(pair)) + times - usize::from(now.contains(pair));
        begun.extend(std::iter::repeat_n(*pair, times));
        ended.extend(std::iter::repeat_n(*pair, left));
    }
    begun.sort_unstable();
    ended.sort_unstable();
}
