//! Sensors: each file one measured quantity. A sensor measures and never pushes.
//!
//! A sensor entry of the scene makes *channels*, one column each, named `owner.quantity[.component]`. Any channel can
//! also be asked for by its name alone ([`find`]): expectations do that.

mod acceleration;
mod clearance;
mod contact_force;
mod contacts;
mod count;
mod counter;
pub(crate) mod energy;
mod expression;
mod flow;
mod force;
mod gate;
mod group;
mod joint;
mod mean;
mod motor;
mod named;
mod names;
mod overlap;
mod period;
mod pose;
mod range;
mod repose;
mod velocity;

use std::collections::BTreeSet;

use bevy_app::App;
use bevy_ecs::prelude::*;

use crate::controllers::output::CONTROLLER;
use crate::scene::values::Word;
use crate::scene::{Arity, Diagnostics, NameKind, Outline, SceneAppExt, SceneError, fits, suggest};
use crate::tick::energy::CHANNELS;
use crate::tick::kept::SnapshotAppExt;
use crate::tick::{LoadErrors, State, index_of};
use crate::world::Bodies;

pub(crate) use names::forget_names;
use names::{NameIndex, bodies_named, body_named, wall_named, with_index};

/// One measured number: its name, its unit and how it is read.
pub struct Channel {
    /// Name, `owner.quantity[.component]`.
    pub name: String,
    /// Unit as a symbol, empty for a pure number.
    pub unit: &'static str,
    read: Box<dyn Fn(&World) -> f64 + Send + Sync>,
    /// Whether it may read components that the state keeps.
    components: bool,
}

impl Channel {
    /// A channel that reads anything of the world. Components are brought up to date for it after each batch of ticks.
    pub fn new(
        name: impl Into<String>,
        unit: &'static str,
        read: impl Fn(&World) -> f64 + Send + Sync + 'static,
    ) -> Self {
        Self { components: true, ..Self::of_resources(name, unit, read) }
    }

    /// A channel that reads the state of the run: nothing is copied for it.
    pub fn of_state(
        name: impl Into<String>,
        unit: &'static str,
        read: impl Fn(&State) -> f64 + Send + Sync + 'static,
    ) -> Self {
        Self::of_resources(name, unit, move |world| read(world.resource()))
    }

    /// A channel that reads no pose and no velocity of a component.
    fn of_resources(
        name: impl Into<String>,
        unit: &'static str,
        read: impl Fn(&World) -> f64 + Send + Sync + 'static,
    ) -> Self {
        Self { name: name.into(), unit, read: Box::new(read), components: false }
    }

    /// The present value.
    pub fn value(&self, world: &World) -> f64 {
        (self.read)(world)
    }
}

/// The channels the scene asks for, in the order of the file.
#[derive(Resource, Default)]
pub struct Channels {
    list: Vec<Channel>,
    names: BTreeSet<String>,
}

impl Channels {
    /// Adds a channel behind the others.
    pub fn add(world: &mut World, channel: Channel) {
        see_components(world, &channel);
        let mut channels = world.get_resource_or_init::<Self>();
        channels.names.insert(channel.name.clone());
        channels.list.push(channel);
    }

    /// All channels in order.
    pub fn iter(&self) -> std::slice::Iter<'_, Channel> {
        self.list.iter()
    }

    /// Whether the scene asks for none.
    pub fn is_empty(&self) -> bool {
        self.list.is_empty()
    }
}

/// The present values of channels, in their order. Expressions that several of them name are worked out once.
pub fn read_all<'a>(world: &World, channels: impl IntoIterator<Item = &'a Channel>) -> Vec<f64> {
    expression::together(world, || channels.into_iter().map(|channel| channel.value(world)).collect())
}

/// From now on components are brought up to date after each batch, if a channel may read them.
fn see_components(world: &mut World, channel: &Channel) {
    if channel.components {
        world.get_resource_or_init::<State>().show_components();
    }
}

/// A value that follows from the forces of the last evaluation. Before the first tick there is no evaluation, and the value is
/// NaN.
fn known(state: &State, value: f64) -> f64 {
    if state.clock().ticks_begun() > 0 { value } else { f64::NAN }
}

/// Turns a channel's name into the channel, if it is one of its own.
pub type Finder = fn(&mut World, owner: &str, quantity: &str) -> Option<Channel>;

/// How the channels of each sensor are found.
#[derive(Resource, Default)]
struct Finders(Vec<Finder>);

/// The open list of quantities that a sensor can measure on a body or wall, such as `position.x`.
pub const QUANTITIES: &str = "quantity";

/// The interface by which plugins add channels.
pub trait SensorAppExt {
    /// Adds how the channels `<body or wall>.<quantity>` are found.
    fn add_quantities(&mut self, quantities: &[&'static str], finder: Finder) -> &mut Self;

    /// Adds how channels of these full names are found.
    fn add_channels(&mut self, channels: &[&'static str], finder: Finder) -> &mut Self;
}

impl SensorAppExt for App {
    fn add_quantities(&mut self, quantities: &[&'static str], finder: Finder) -> &mut Self {
        add(self, QUANTITIES, quantities, finder)
    }

    fn add_channels(&mut self, channels: &[&'static str], finder: Finder) -> &mut Self {
        add(self, CHANNELS, channels, finder)
    }
}

fn add<'a>(app: &'a mut App, list: &'static str, words: &[&'static str], finder: Finder) -> &'a mut App {
    app.world_mut().get_resource_or_init::<Finders>().0.push(finder);
    for word in words {
        app.register_word(list, word);
    }
    app
}

/// Declares the name of a sensor whose channels bear it. A name that begins channels of the whole scene, such as `energy`, is
/// reported: the sensor would hide behind them.
fn declare(name: &str, outline: &mut Outline) {
    let of_world = |(word, _): &(&str, bool)| word.split_once('.').is_some_and(|(owner, _)| owner == name);
    let taken = outline.words(CHANNELS).find(of_world);
    if let Some((word, _)) = taken {
        let message = format!("the name \"{name}\" is taken: `{word}` is a channel of the whole scene");
        outline.refuse("name", message).help("give the sensor another name");
    } else {
        outline.declare(NameKind::SENSOR, name, "name");
    }
}

/// Reports a channel name that cannot be right.
pub fn check_channel(name: &str, path: &str, outline: &Outline, report: &mut Diagnostics) {
    if outline.word(CHANNELS, name).is_some() {
        return;
    }
    let Some((owner, quantity)) = name.split_once('.') else {
        let help = "a channel is a name, a dot and a quantity, such as \"ball.position.x\" or \"energy.total\"";
        report.error(path, format!("{name:?} is not a channel")).help(help);
        return;
    };
    if ["energy", "overlap"].contains(&owner) {
        Word(name.to_owned()).check(outline, CHANNELS, path, report);
    } else if Word(quantity.to_owned()).check(outline, QUANTITIES, path, report) {
        let named = |kind: &NameKind| [NameKind::WALL, NameKind::BODY].contains(kind) || outline.count(*kind) > 0;
        let owners: Vec<NameKind> = [NameKind::WALL, NameKind::BODY, NameKind::JOINT, CONTROLLER, NameKind::SENSOR]
            .into_iter()
            .filter(named)
            .collect();
        outline.require_any(&owners, owner, path, report);
    }
}

/// Reports a choice of channels that cannot be right. A choice is a channel's name, in which `*` stands for any letters of the
/// names of bodies.
pub fn check_channels(pattern: &str, path: &str, outline: &Outline, report: &mut Diagnostics) {
    match pattern.split_once('.').filter(|(owner, _)| owner.contains('*')) {
        Some((owner, quantity)) => {
            if check_quantity(quantity, path, outline, report) {
                outline.require_matching(NameKind::BODY, owner, path, report);
            }
        }
        None => check_channel(pattern, path, outline, report),
    }
}

/// Reports a quantity that no sensor can measure on a body or wall. Returns whether one can.
pub fn check_quantity(quantity: &str, path: &str, outline: &Outline, report: &mut Diagnostics) -> bool {
    Word(quantity.to_owned()).check(outline, QUANTITIES, path, report)
}

/// The names of the channels that a choice means, in canonical order of their bodies.
pub fn chosen(pattern: &str, outline: &Outline) -> Vec<String> {
    let Some((owner, quantity)) = pattern.split_once('.').filter(|(owner, _)| owner.contains('*')) else {
        return vec![pattern.to_owned()];
    };
    let bodies = outline.matching(NameKind::BODY, owner).into_iter().map(|index| &outline.names(NameKind::BODY)[index]);
    bodies.map(|body| format!("{body}.{quantity}")).collect()
}

/// The names of all channels that a pattern means, in canonical order of bodies and walls. In the pattern `*` stands for any
/// letters, also of the quantity. Bodies and walls must have been spawned.
pub fn expanded(pattern: &str, world: &mut World, outline: &Outline) -> Vec<String> {
    let Some((owner, _)) = pattern.split_once('.').filter(|(_, quantity)| quantity.contains('*')) else {
        return chosen(pattern, outline);
    };
    let whole = outline.words(CHANNELS).map(|(name, _)| name.to_owned());
    let owners = [NameKind::BODY, NameKind::WALL].into_iter().flat_map(|kind| outline.names(kind));
    let owners = owners.filter(|name| fits(owner, name));
    let own = owners.flat_map(|name| outline.words(QUANTITIES).map(move |(quantity, _)| format!("{name}.{quantity}")));
    let fitting: Vec<String> = whole.chain(own).filter(|name| fits(pattern, name)).collect();
    let found = find_all(world, &fitting);
    fitting.into_iter().zip(found).filter(|(_, channel)| channel.is_some()).map(|(name, _)| name).collect()
}

/// The channel called `name`, for example `ball.position.x` or `energy.residual`. Bodies and walls must have been
/// spawned.
pub fn find(world: &mut World, name: &str) -> Option<Channel> {
    let (owner, quantity) = name.split_once('.')?;
    let finders: Vec<Finder> = world.get_resource::<Finders>()?.0.clone();
    let channel = finders.into_iter().find_map(|finder| finder(world, owner, quantity))?;
    see_components(world, &channel);
    Some(channel)
}

/// The same, with a message if the channel does not exist. It is a mistake of the scene at `path`, and names the channels that
/// the owner has.
pub fn require(world: &mut World, outline: &Outline, name: &str, path: String) -> Option<Channel> {
    let found = find(world, name);
    if found.is_none() {
        let words: Vec<&str> = outline.words(QUANTITIES).map(|(word, _)| word).collect();
        let (message, help) = missing(world, &words, name);
        let error = SceneError::new(path, message).with_help(help);
        world.get_resource_or_init::<LoadErrors>().0.push(error);
    }
    found
}

/// The message about a channel that does not exist. Its help names those of the `words` for quantities that the owner has.
fn missing(world: &mut World, words: &[&str], name: &str) -> (String, String) {
    let (owner, quantity) = name.split_once('.').unwrap_or((name, ""));
    let has = |word: &&&str| find(world, &format!("{owner}.{word}")).is_some();
    let known: Vec<&str> = words.iter().filter(has).copied().collect();
    let help = suggest::among(quantity, known.into_iter(), &format!("channels of `{owner}`"), '`');
    (format!("`{owner}` has no `{quantity}`"), help)
}

/// Adds channels; one that is there already stays the only one of its name.
fn add_found(world: &mut World, names: impl IntoIterator<Item = String>) {
    let channels = world.get_resource_or_init::<Channels>();
    let names: Vec<String> = names.into_iter().filter(|name| !channels.names.contains(name)).collect();
    let found: Vec<Channel> = find_all(world, &names).into_iter().flatten().collect();
    let Channels { list, names } = &mut *world.resource_mut::<Channels>();
    list.extend(found.into_iter().filter(|channel| names.insert(channel.name.clone())));
}

/// The channels of these names, each as [`find`] finds it. The time grows with the sum, not the product, of the numbers of names
/// and bodies.
pub fn find_all(world: &mut World, names: &[String]) -> Vec<Option<Channel>> {
    with_index(world, |world| names.iter().map(|name| find(world, name)).collect())
}

/// A channel of a body, read by the body's index in the packed state. It is NaN once the body is gone.
fn of_body(
    world: &mut World,
    name: &str,
    quantity: &str,
    unit: &'static str,
    read: fn(&Bodies, usize) -> f64,
) -> Option<Channel> {
    let entity = body_named(world, name)?;
    let value = move |world: &World| {
        let bodies = &world.resource::<State>().bodies;
        index_of(world, entity).map_or(f64::NAN, |index| read(bodies, index))
    };
    Some(Channel::of_resources(format!("{name}.{quantity}"), unit, value))
}

/// Registers the sensors of this folder.
pub fn plugin(app: &mut App) {
    app.init_resource::<Finders>().init_resource::<NameIndex>();
    app.follows_from_scene::<NameIndex>();
    app.register_entry_section("sensors", Arity::List, "sensors: [Pose(of: \"ball\"), Energy()]");
    app.describe_section(
        "sensors",
        "Quantities to measure. Each number is a channel, `name.quantity`, and a column of the CSV. Sensors read channels at \
         ticks. Under a `tolerance` or `method: Reference` ticks are the frames of the film. `Period`, `Flow` and `Counter` then \
         also look at moments within each step, so that they miss no swing.",
    );
    pose::plugin(app);
    velocity::plugin(app);
    acceleration::plugin(app);
    energy::plugin(app);
    force::plugin(app);
    contact_force::plugin(app);
    overlap::plugin(app);
    contacts::plugin(app);
    joint::plugin(app);
    motor::plugin(app);
    expression::plugin(app);
    period::plugin(app);
    clearance::plugin(app);
    range::plugin(app);
    counter::plugin(app);
    flow::plugin(app);
    repose::plugin(app);
    count::plugin(app);
    mean::plugin(app);
}
