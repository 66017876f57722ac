//! Sensors: each file one measured quantity. A sensor measures and never pushes.
//!
//! A sensor entry of the scene makes *channels*, one column each, named `owner.quantity[.component]`. Any channel can
//! also be asked for by its name alone ([`find`]): expectations do that.

mod contact_force;
mod energy;
mod overlap;
mod pose;
mod velocity;

use bevy_app::App;
use bevy_ecs::prelude::*;

use crate::scene::{Arity, SceneAppExt};
use crate::world::{Bodies, Name};

/// One measured number: its name, its unit and how it is read.
pub struct Channel {
    /// Name, `owner.quantity[.component]`.
    pub name: String,
    /// Unit as a symbol, empty for a pure number.
    pub unit: &'static str,
    /// Reads the present value.
    pub read: Box<dyn Fn(&World) -> f64 + Send + Sync>,
}

impl Channel {
    fn new(name: String, unit: &'static str, read: impl Fn(&World) -> f64 + Send + Sync + 'static) -> Self {
        Self { name, unit, read: Box::new(read) }
    }
}

/// The channels the scene asks for, in the order of the file.
#[derive(Resource, Default)]
pub struct Channels(pub Vec<Channel>);

/// Turns a channel's name into the channel, if it is one of its own.
pub type Finder = fn(&mut World, owner: &str, quantity: &str) -> Option<Channel>;

/// What can be measured: each sensor adds how its channels are found.
#[derive(Resource, Default)]
pub struct Finders(Vec<(Finder, &'static [&'static str])>);

impl Finders {
    /// Adds a sensor's finder, with the quantities it knows (for messages).
    pub fn add(&mut self, finder: Finder, quantities: &'static [&'static str]) {
        self.0.push((finder, quantities));
    }

    /// All quantities that can follow a name and a dot.
    pub fn quantities(&self) -> impl Iterator<Item = &'static str> {
        self.0.iter().flat_map(|(_, quantities)| quantities.iter().copied())
    }
}

/// The channel called `name`, for example `ball.position.x` or `energy.residual`. Bodies and walls must have been
/// spawned.
pub fn find(world: &mut World, name: &str) -> Option<Channel> {
    let (owner, quantity) = name.split_once('.')?;
    let finders: Vec<Finder> = world.get_resource::<Finders>()?.0.iter().map(|(finder, _)| *finder).collect();
    finders.into_iter().find_map(|finder| finder(world, owner, quantity))
}

/// Whether a channel name can be right: known quantity behind a dot.
pub fn is_quantity(finders: &Finders, name: &str) -> bool {
    name.split_once('.').is_some_and(|(_, quantity)| finders.quantities().any(|known| known == quantity))
}

fn add_found(world: &mut World, names: impl IntoIterator<Item = String>) {
    for name in names {
        if let Some(channel) = find(world, &name) {
            world.get_resource_or_init::<Channels>().0.push(channel);
        }
    }
}

/// Entity of the body or wall called `name`.
fn entity_named<C: Component>(world: &mut World, name: &str) -> Option<Entity> {
    let mut query = world.query_filtered::<(Entity, &Name), With<C>>();
    query.iter(world).find(|(_, found)| found.0 == name).map(|(entity, _)| entity)
}

/// A channel of a body: read by its place in the packed state; not a number once the body is gone.
fn of_body(
    world: &mut World,
    name: &str,
    quantity: &str,
    unit: &'static str,
    read: fn(&Bodies, usize) -> f64,
) -> Option<Channel> {
    let entity = entity_named::<crate::world::Body>(world, name)?;
    let value = move |world: &World| {
        let bodies = world.resource::<Bodies>();
        world.get::<crate::world::Slot>(entity).map_or(f64::NAN, |slot| read(bodies, slot.0 as usize))
    };
    Some(Channel::new(format!("{name}.{quantity}"), unit, value))
}

/// Registers the sensors of this folder.
pub fn plugin(app: &mut App) {
    app.init_resource::<Finders>();
    app.register_entry_section("sensors", Arity::List, "sensors: [Pose(of: \"ball\"), Energy()]");
    pose::plugin(app);
    velocity::plugin(app);
    energy::plugin(app);
    contact_force::plugin(app);
    overlap::plugin(app);
    app.reserve_entry("sensors", "Contacts");
}
