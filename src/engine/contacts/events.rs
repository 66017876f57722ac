//! Contact events: pairs of bodies that began or ceased to touch in the last tick.
//!
//! [`ContactEventsAppExt::watch_contacts`] switches them on. Then the contact law notes the touching pairs, and the
//! lists of two ticks are compared. Other scenes have neither the list nor the system. Two bodies touch as long as any
//! of their atoms do.

use std::collections::BTreeSet;

use bevy_app::App;
use bevy_ecs::prelude::*;

use serde::{Deserialize, Serialize};

use crate::tick::{Notes, State, add_observer};

/// A body and another body or a wall. In canonical order the first of two bodies precedes the second. A wall is second.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct Touching {
    /// The first body.
    pub a: Entity,
    /// The second body, or the wall.
    pub b: Entity,
}

/// The changes of the last tick. An observer reads them in [`crate::tick::Stage::Observe`] after [`FindContactEvents`],
/// or between ticks.
#[derive(Resource, Clone, Debug, Default, Serialize, Deserialize)]
pub struct ContactEvents {
    /// Pairs that began to touch, in canonical order. In the first tick these are all touching pairs. If events are
    /// located, a pair occurs each time that it began to touch in the tick. Otherwise it occurs once, if it touches and
    /// did not before.
    pub begun: Vec<Touching>,
    /// Pairs that ceased to touch, once for each time, in canonical order.
    pub ended: Vec<Touching>,
    /// All pairs that touch, in canonical order.
    pub present: Vec<Touching>,
    /// End of the tick in seconds.
    pub time: f64,
}

impl ContactEvents {
    /// The number of bodies and walls that touch a body or wall.
    pub fn count(&self, entity: Entity) -> usize {
        self.present.iter().filter(|pair| pair.a == entity || pair.b == entity).count()
    }
}

/// The system that finds contact events.
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

/// The same for a world without an app.
pub fn watch(world: &mut World) {
    if world.contains_resource::<ContactEvents>() {
        return;
    }
    world.init_resource::<ContactEvents>();
    let mut state = world.get_resource_or_init::<State>();
    state.touches.get_or_insert_default();
    // An evaluation finds the pairs that touch from the beginning, even if all bodies sleep.
    state.bodies.touched = true;
    add_observer(world, find_contact_events.in_set(FindContactEvents));
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
            let note = format!(
                "contacts: `{name}` does not tell which bodies touch: contact events and `Contacts` see nothing"
            );
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
    // Located events are exact, and replace the comparison of two states.
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
