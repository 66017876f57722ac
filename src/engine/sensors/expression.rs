//! `Expression(name: "gap", of: "a.position.x - b.position.x")`: a number that follows from other channels by a formula.
//!
//! Its syntax is that of all expressions in scenes, with channels in place of parameters. It knows their units: a length is never
//! added to a mass.

use std::borrow::Cow;
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Mutex;

use bevy_app::App;
use bevy_ecs::prelude::*;
use schemars::JsonSchema;
use serde::Deserialize;

use super::{Channel, SensorAppExt, add_found, check_channel, declare, find, missing};
use crate::scene::{Diagnostics, Entry, Formula, Mistake, Outline, SceneAppExt, SceneError, WrittenEntry};
use crate::tick::kept::SnapshotAppExt;
use crate::tick::{AfterLoad, LoadErrors};

const QUANTITY: &str = "value";

/// Symbols of units, each in place of its product of base units.
const SYMBOLS: [&str; 12] = ["m/s", "m/s2", "rad/s", "rad/s2", "N", "J", "W", "N/m", "N s", "N m/rad", "kg/s", "1/s"];

/// A number that follows from other channels: `gap.value`. In `of` stand names of channels, numbers with or without units,
/// and the signs `+ - * / ^`. Comparisons, brackets and functions such as `sqrt`, `abs`, `min`, `max`, `hypot` and `if` may
/// stand there too. Its unit follows from those of the channels: `heap.repose / 1 deg` is a plain number. Names with other
/// signs than letters, digits and `_` stand in single quotes, parameters of the scene in braces. An expression may name
/// others. It is NaN where a channel in it is.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Expression {
    /// Its name: that of its channel.
    name: String,
    /// The expression, such as `"a.position.x - b.position.x"`.
    of: String,
}

/// The expressions of the scene.
#[derive(Resource, Default)]
struct Expressions {
    list: Vec<Asked>,
    /// Indices of the expressions that are under construction, by which a cycle is found.
    open: Vec<usize>,
    /// The words for quantities, for messages.
    words: Vec<&'static str>,
}

struct Asked {
    name: String,
    text: String,
    /// The path of the sensor in the scene.
    path: String,
}

impl Entry for Expression {
    const SECTION: &'static str = "sensors";
    const NAME: &'static str = "Expression";
    const EXAMPLE: &'static str = "Expression(name: \"gap\", of: \"a.position.x - b.position.x\")";

    fn declare(&self, outline: &mut Outline) {
        declare(&self.name, outline);
    }

    fn check(&self, outline: &Outline, report: &mut Diagnostics) {
        match Formula::new(self.of.as_str()).names() {
            Ok(names) if names.is_empty() => {
                let help = "name a channel in it, such as `ball.position.x`";
                report.error("of", "this expression names no channel: its value would never change").help(help);
            }
            Ok(names) => names.iter().collect::<BTreeSet<_>>().into_iter().for_each(|name| {
                check_channel(name, "of", outline, report);
            }),
            Err(Mistake { message, help }) => {
                let help = help.unwrap_or_else(|| format!("for example {}", Self::EXAMPLE));
                report.error("of", message).help(help);
            }
        }
    }

    fn install(entries: Vec<WrittenEntry<Self>>, outline: &Outline, app: &mut App) {
        let mentions = outline.entries(Self::SECTION).iter().filter(|mention| mention.name == Self::NAME);
        let asked =
            entries.into_iter().zip(mentions).map(|(WrittenEntry { value: Self { name, of }, .. }, mention)| Asked {
                name,
                text: of,
                path: format!("{}.of", mention.path),
            });
        let words = outline.words(super::QUANTITIES).map(|(word, _)| word).collect();
        app.insert_resource(Expressions { list: asked.collect(), open: Vec::new(), words });
        // By then all channels are there that one may name.
        app.world_mut().get_resource_or_init::<AfterLoad>().0.push(put_together);
    }
}

/// Makes the channels of all expressions, and reports those that cannot be.
fn put_together(world: &mut World) {
    for index in 0..world.resource::<Expressions>().list.len() {
        match channel(world, index) {
            Ok(channel) => add_found(world, [channel.name]),
            Err(Mistake { message, help }) => {
                let path = world.resource::<Expressions>().list[index].path.clone();
                let help = help.unwrap_or_else(|| format!("for example {}", Expression::EXAMPLE));
                world.get_resource_or_init::<LoadErrors>().0.push(SceneError::new(path, message).with_help(help));
            }
        }
    }
}

/// The channel of an expression.
fn channel(world: &mut World, index: usize) -> Result<Channel, Mistake> {
    let Expressions { list, open, .. } = &mut *world.resource_mut::<Expressions>();
    let Asked { name, text, .. } = &list[index];
    if open.contains(&index) {
        let message = format!("the expression `{name}` is part of itself");
        return Err(Mistake { message, help: Some("let it name other channels".to_owned()) });
    }
    open.push(index);
    let (name, formula) = (name.clone(), Formula::new(text.as_str()));
    let parts = parts(world, &formula);
    world.resource_mut::<Expressions>().open.pop();
    let parts = parts?;
    let value = move |world: &World, parts: &BTreeMap<String, Channel>| {
        formula.value(|name| parts.get(name).map(|channel| (channel.value(world), channel.unit)))
    };
    let (_, powers) = value(world, &parts)?;
    let own: Vec<&'static str> = parts.values().map(|channel| channel.unit).collect();
    let symbol = Formula::symbol(powers, &[&own[..], &SYMBOLS].concat());
    // The unit of a length to the power of a channel depends on a value, so later evaluations may fail.
    let read = move |world: &World| value(world, &parts).map_or(f64::NAN, |(value, _)| value);
    Ok(Channel::of_resources(format!("{name}.{QUANTITY}"), kept(symbol), read))
}

/// The channels that a formula names.
fn parts(world: &mut World, formula: &Formula) -> Result<BTreeMap<String, Channel>, Mistake> {
    let names: BTreeSet<String> = formula.names()?.into_iter().collect();
    let mut parts = BTreeMap::new();
    for name in names {
        let owner = name.split_once('.').and_then(|(owner, quantity)| (quantity == QUANTITY).then_some(owner));
        let inner = world.resource::<Expressions>().list.iter().position(|asked| Some(&*asked.name) == owner);
        let found = match inner {
            Some(inner) => channel(world, inner)?,
            None => find(world, &name).ok_or_else(|| {
                let words = world.resource::<Expressions>().words.clone();
                let (message, help) = missing(world, &words, &name);
                Mistake { message, help: Some(help) }
            })?,
        };
        parts.insert(name, found);
    }
    Ok(parts)
}

/// A symbol that lives as long as the program. Each symbol is kept once.
fn kept(symbol: Cow<'static, str>) -> &'static str {
    static MADE: Mutex<BTreeSet<&'static str>> = Mutex::new(BTreeSet::new());
    let symbol = match symbol {
        Cow::Borrowed(symbol) => return symbol,
        Cow::Owned(symbol) => symbol,
    };
    let mut made = MADE.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
    if let Some(symbol) = made.get(&*symbol) {
        return symbol;
    }
    let symbol: &'static str = symbol.leak();
    made.insert(symbol);
    symbol
}

fn find_own(world: &mut World, owner: &str, quantity: &str) -> Option<Channel> {
    let list = &world.get_resource::<Expressions>()?.list;
    let index = list.iter().position(|asked| asked.name == owner && quantity == QUANTITY)?;
    channel(world, index).ok()
}

pub(super) fn plugin(app: &mut App) {
    app.add_quantities(&[QUANTITY], find_own);
    app.register_entry::<Expression>();
    app.follows_from_scene::<Expressions>();
}
