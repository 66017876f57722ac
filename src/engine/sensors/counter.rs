//! `Counter(name: "hits", of: "ball", touching: "pin_*")`: how often bodies began to touch others, or passed a gate.
//!
//! Passages are those of a [`Gate`].

use bevy_app::App;
use bevy_ecs::prelude::*;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::contacts::owners;
use super::gate::{self, Gate, LastLook};
use super::named::Named;
use super::{Channel, SensorAppExt, add_found, body_named, declare, wall_named};
use crate::contacts::ContactEvents;
use crate::contacts::events::{FindContactEvents, watch};
use crate::scene::units::LengthPair;
use crate::scene::values::Names;
use crate::scene::{Diagnostics, Entry, NameKind, Outline, SceneAppExt, WrittenEntry};
use crate::tick::kept::SnapshotAppExt;
use crate::tick::{add_inner_looker, add_observer};

const QUANTITIES: &[&str] = &["count", "count.net"];

/// The number of touches that bodies began since the start, or of their passages through a gate: `hits.count`. For a gate
/// `grains.count.net` is the number of passages to the left, less those to the right. Contacts count as in `Contacts`.
/// Passages count on the smooth way from tick to tick, or from look to look within a step. `Period` counts the crossings of a value by a channel.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Counter {
    /// Its name: that of its channels.
    name: String,
    /// The bodies. `*` stands for any letters.
    of: Names,
    /// The touched bodies and walls. In names of bodies `*` stands for any letters. Write this or `gate`. Default: from
    /// `gate`.
    touching: Option<Names>,
    /// The two ends of a gate, in m. Write this or `touching`. Default: from `touching`.
    gate: Option<(LengthPair, LengthPair)>,
}

/// The events that a counter counts.
enum Looked {
    /// Contacts of bodies with others, both lists sorted.
    Contacts(Vec<Entity>, Vec<Entity>),
    /// Passages of bodies through a gate.
    Gate(Gate),
}

/// The counters of the scene.
type Counted = Named<Looked>;

/// The counts of a run, one for each counter.
#[derive(Resource, Default, Serialize, Deserialize)]
struct Counts(Vec<Count>);

#[derive(Clone, Default, Serialize, Deserialize)]
struct Count {
    count: u64,
    net: i64,
    /// Of a gate: its bodies at the last look.
    before: LastLook,
}

impl Entry for Counter {
    const SECTION: &'static str = "sensors";
    const NAME: &'static str = "Counter";
    const EXAMPLE: &'static str = "Counter(name: \"hits\", of: \"ball\", touching: \"pin_*\")";

    fn declare(&self, outline: &mut Outline) {
        declare(&self.name, outline);
    }

    fn check(&self, outline: &Outline, report: &mut Diagnostics) {
        self.of.require(NameKind::BODY, outline, "of", report);
        if let Some(touching) = &self.touching {
            owners(touching, "touching", outline, report);
        }
        if let Some(ends) = self.gate {
            gate::check(ends, report);
        }
        let help = "`touching: \"pin_*\"` counts contacts, `gate: ((-0.1, 0), (0.1, 0))` passages";
        match (&self.touching, &self.gate) {
            (Some(_), Some(_)) => {
                report.error("gate", "`touching` and `gate` exclude each other").help(help);
            }
            (None, None) => {
                report.error("", "the field `touching` or `gate` is missing").help(help);
            }
            _ => {}
        }
    }

    fn install(entries: Vec<WrittenEntry<Self>>, outline: &Outline, app: &mut App) {
        let world = app.world_mut();
        for WrittenEntry { value: Self { name, of, touching, gate }, .. } in entries {
            let indices = of.matching(NameKind::BODY, outline).into_iter();
            let bodies: Vec<Entity> =
                indices.filter_map(|index| body_named(world, &outline.names(NameKind::BODY)[index])).collect();
            let looked = match (touching, gate) {
                (_, Some(ends)) => Looked::Gate(Gate::new(ends, bodies)),
                (touching, None) => {
                    let names = touching
                        .map_or_else(Vec::new, |names| owners(&names, "touching", outline, &mut Diagnostics::new()));
                    let entity = |name: &String| body_named(world, name).or_else(|| wall_named(world, name));
                    Looked::Contacts(sorted(bodies), sorted(names.iter().filter_map(entity).collect()))
                }
            };
            look(world, &looked);
            let quantities = if matches!(looked, Looked::Gate(..)) { QUANTITIES } else { &QUANTITIES[..1] };
            world.get_resource_or_init::<Counts>().0.push(Count::default());
            world.get_resource_or_init::<Counted>().push(&name, looked);
            add_found(world, quantities.iter().map(|quantity| format!("{name}.{quantity}")));
        }
    }
}

fn sorted(mut entities: Vec<Entity>) -> Vec<Entity> {
    entities.sort_unstable();
    entities
}

/// Adds the observer of ticks, once for each kind of counter.
fn look(world: &mut World, looked: &Looked) {
    let is_alike = |other: &Looked| std::mem::discriminant(other) == std::mem::discriminant(looked);
    if world.get_resource_or_init::<Counted>().iter().any(is_alike) {
        return;
    }
    match looked {
        Looked::Contacts(..) => {
            watch(world);
            add_observer(world, count_contacts.after(FindContactEvents));
        }
        Looked::Gate(..) => add_inner_looker(world, count_passages),
    }
}

fn count_contacts(events: Res<ContactEvents>, counted: Res<Counted>, mut counts: ResMut<Counts>) {
    for (looked, count) in counted.iter().zip(&mut counts.0) {
        let Looked::Contacts(of, others) = looked else { continue };
        let has = |list: &[Entity], entity: Entity| list.binary_search(&entity).is_ok();
        let counts = |a: Entity, b: Entity| has(of, a) && has(others, b);
        count.count +=
            events.begun.iter().filter(|pair| counts(pair.a, pair.b) || counts(pair.b, pair.a)).count() as u64;
    }
}

fn count_passages(world: &mut World) {
    world.resource_scope(|world, mut counts: Mut<Counts>| {
        for (looked, count) in world.resource::<Counted>().iter().zip(&mut counts.0) {
            let Looked::Gate(gate) = looked else { continue };
            let passed = gate.passages(&mut count.before, world);
            count.count += passed.len() as u64;
            count.net += passed.iter().map(|passage| if passage.is_left { 1 } else { -1 }).sum::<i64>();
        }
    });
}

fn find(world: &mut World, owner: &str, quantity: &str) -> Option<Channel> {
    let quantity = *QUANTITIES.iter().find(|known| **known == quantity)?;
    let counted = world.get_resource::<Counted>()?;
    let index = counted.place(owner)?;
    let is_net = quantity == "count.net";
    if is_net && !matches!(counted.get(index), Some(Looked::Gate(..))) {
        return None;
    }
    let read = move |world: &World| {
        let count = world.get_resource::<Counts>().and_then(|counts| counts.0.get(index));
        count.map_or(f64::NAN, |count| if is_net { count.net as f64 } else { count.count as f64 })
    };
    Some(Channel::of_resources(format!("{owner}.{quantity}"), "", read))
}

pub(super) fn plugin(app: &mut App) {
    app.add_quantities(QUANTITIES, find);
    app.register_entry::<Counter>();
    app.keep_resource::<Counts>();
    app.follows_from_scene::<Counted>();
}
