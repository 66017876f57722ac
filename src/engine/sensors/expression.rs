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
use crate::scene::units::Powers;
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
    places: BTreeMap<String, usize>,
    /// Places of those whose channels are looked for. A channel that leads back to one of them does not exist.
    open: BTreeSet<usize>,
    /// The words for quantities, for messages.
    words: Vec<&'static str>,
    /// The values so far while several channels of one moment are read together.
    together: Mutex<Option<Values>>,
}

/// Values of expressions at one moment, by their places in the list.
type Values = BTreeMap<usize, f64>;

struct Asked {
    name: String,
    formula: Formula,
    /// The path of the sensor in the scene.
    path: String,
    /// The names in it, each once, with the places of those that are expressions.
    names: Result<Vec<(String, Option<usize>)>, Mistake>,
    made: Option<Made>,
}

/// An expression whose parts are known.
struct Made {
    parts: BTreeMap<String, Part>,
    unit: &'static str,
}

enum Part {
    Expression(usize),
    Channel(Channel),
}

/// The progress of making several expressions at one moment.
#[derive(Default)]
struct Making {
    failed: BTreeMap<usize, Mistake>,
    values: Values,
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
        let mut expressions = Expressions {
            words: outline.words(super::QUANTITIES).map(|(word, _)| word).collect(),
            ..Expressions::default()
        };
        for (place, entry) in entries.iter().enumerate() {
            expressions.places.entry(entry.value.name.clone()).or_insert(place);
        }
        for (WrittenEntry { value: Self { name, of }, .. }, mention) in entries.into_iter().zip(mentions) {
            let formula = Formula::new(of);
            let place = |name: &str| {
                let (owner, quantity) = name.split_once('.')?;
                expressions.places.get(owner).copied().filter(|_| quantity == QUANTITY)
            };
            let names = formula.names().map(|names| {
                let each: BTreeSet<String> = names.into_iter().collect();
                each.into_iter().map(|name| (place(&name), name)).map(|(place, name)| (name, place)).collect()
            });
            let path = format!("{}.of", mention.path);
            expressions.list.push(Asked { name, formula, path, names, made: None });
        }
        app.insert_resource(expressions);
        // By then all channels are there that one may name.
        app.world_mut().get_resource_or_init::<AfterLoad>().0.push(put_together);
    }
}

/// Makes the channels of all expressions, and reports those that cannot be.
fn put_together(world: &mut World) {
    let (mut making, mut names) = (Making::default(), Vec::new());
    for index in 0..world.resource::<Expressions>().list.len() {
        match make(world, index, &mut making) {
            Ok(()) => names.push(format!("{}.{QUANTITY}", world.resource::<Expressions>().list[index].name)),
            Err(Mistake { message, help }) => {
                let path = world.resource::<Expressions>().list[index].path.clone();
                let help = help.unwrap_or_else(|| format!("for example {}", Expression::EXAMPLE));
                world.get_resource_or_init::<LoadErrors>().0.push(SceneError::new(path, message).with_help(help));
            }
        }
    }
    add_found(world, names);
}

/// Makes an expression, after those that it names. Each is made once, and a chain of them takes no stack.
fn make(world: &mut World, root: usize, making: &mut Making) -> Result<(), Mistake> {
    // Expressions under construction, each with the number of its names that were looked at.
    let mut open = vec![(root, 0)];
    let mut is_open = BTreeSet::from([root]);
    while let Some((index, seen)) = open.last_mut() {
        let list = &world.resource::<Expressions>().list;
        let done = |index: usize, making: &Making| list[index].made.is_some() || making.failed.contains_key(&index);
        if done(*index, making) {
            is_open.remove(index);
            open.pop();
            continue;
        }
        let names = list[*index].names.as_ref().map_or(&[][..], |names| &names[..]);
        let inner = names.iter().skip(*seen).find_map(|(_, place)| {
            *seen += 1;
            place.filter(|place| !done(*place, making))
        });
        match inner {
            Some(inner) if is_open.insert(inner) => open.push((inner, 0)),
            Some(inner) => {
                let from = open.iter().position(|(index, _)| *index == inner).unwrap_or_default();
                for (index, _) in &open[from..] {
                    let message = format!("the expression `{}` is part of itself", list[*index].name);
                    let help = Some("let it name other channels".to_owned());
                    making.failed.insert(*index, Mistake { message, help });
                }
            }
            None => {
                let index = *index;
                world.resource_mut::<Expressions>().open.insert(index);
                let made = made(world, index, making);
                world.resource_mut::<Expressions>().open.remove(&index);
                match made {
                    Ok(made) => world.resource_mut::<Expressions>().list[index].made = Some(made),
                    Err(mistake) => {
                        making.failed.insert(index, mistake);
                    }
                }
            }
        }
    }
    making.failed.get(&root).map_or(Ok(()), |mistake| Err(mistake.clone()))
}

/// An expression of which all named expressions were made, or failed.
fn made(world: &mut World, index: usize, making: &mut Making) -> Result<Made, Mistake> {
    let names = world.resource::<Expressions>().list[index].names.clone()?;
    let mut parts = BTreeMap::new();
    for (name, place) in names {
        let part = match place {
            Some(place) => match making.failed.get(&place) {
                Some(mistake) => return Err(mistake.clone()),
                None => Part::Expression(place),
            },
            None => Part::Channel(find(world, &name).ok_or_else(|| {
                let words = world.resource::<Expressions>().words.clone();
                let (message, help) = missing(world, &words, &name);
                Mistake { message, help: Some(help) }
            })?),
        };
        parts.insert(name, part);
    }
    let expressions = world.resource::<Expressions>();
    let mut made = Made { parts, unit: "" };
    made.inner().for_each(|place| {
        expressions.value(place, world, &mut making.values);
    });
    let (value, powers) = made.value(&expressions.list[index].formula, expressions, world, &making.values)?;
    making.values.insert(index, value);
    let own: Vec<&'static str> = made.parts.values().map(|part| part.unit(expressions)).collect();
    made.unit = kept(Formula::symbol(powers, &[&own[..], &SYMBOLS].concat()));
    Ok(made)
}

impl Part {
    fn unit(&self, expressions: &Expressions) -> &'static str {
        match self {
            Self::Expression(place) => expressions.list[*place].made.as_ref().map_or("", |made| made.unit),
            Self::Channel(channel) => channel.unit,
        }
    }
}

impl Made {
    /// The places of the expressions that it names.
    fn inner(&self) -> impl Iterator<Item = usize> {
        self.parts.values().filter_map(|part| if let Part::Expression(place) = part { Some(*place) } else { None })
    }

    /// Its value, if `values` holds those of the expressions that it names. Each of its channels is read once.
    fn value(
        &self,
        formula: &Formula,
        expressions: &Expressions,
        world: &World,
        values: &Values,
    ) -> Result<(f64, Powers), Mistake> {
        let mut read: BTreeMap<&str, f64> = BTreeMap::new();
        formula.value(|name| {
            let (name, part) = self.parts.get_key_value(name)?;
            let value = *read.entry(name).or_insert_with(|| match part {
                Part::Expression(place) => values.get(place).copied().unwrap_or(f64::NAN),
                Part::Channel(channel) => channel.value(world),
            });
            Some((value, part.unit(expressions)))
        })
    }
}

impl Expressions {
    /// The value of an expression. Those that it names join `values`: each is worked out once.
    fn value(&self, root: usize, world: &World, values: &mut Values) -> f64 {
        let mut open = vec![root];
        while let Some(&index) = open.last() {
            let Asked { formula, made: Some(made), .. } = &self.list[index] else { return f64::NAN };
            let depth = open.len();
            if !values.contains_key(&index) {
                open.extend(made.inner().filter(|inner| !values.contains_key(inner)));
            }
            if open.len() > depth {
                continue;
            }
            open.pop();
            // The unit of a length to the power of a channel depends on a value, so later evaluations may fail.
            if !values.contains_key(&index) {
                let value = made.value(formula, self, world, values).map_or(f64::NAN, |(value, _)| value);
                values.insert(index, value);
            }
        }
        values.get(&root).copied().unwrap_or(f64::NAN)
    }

    fn reading(&self, index: usize, world: &World) -> f64 {
        match self.together.try_lock().as_deref_mut() {
            Ok(Some(values)) => self.value(index, world, values),
            _ => self.value(index, world, &mut Values::new()),
        }
    }
}

/// Expressions keep their values for a moment while `read` reads channels of the same world.
pub(super) fn together<T>(world: &World, read: impl FnOnce() -> T) -> T {
    let expressions = world.get_resource::<Expressions>().filter(|expressions| !expressions.list.is_empty());
    let keep = |values: Option<Values>| {
        if let Some(mut kept) = expressions.and_then(|expressions| expressions.together.try_lock().ok()) {
            *kept = values;
        }
    };
    keep(Some(Values::new()));
    let read = read();
    keep(None);
    read
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
    let expressions = world.get_resource::<Expressions>()?;
    let index = *expressions.places.get(owner).filter(|_| quantity == QUANTITY)?;
    if expressions.open.contains(&index) {
        return None;
    }
    make(world, index, &mut Making::default()).ok()?;
    let unit = world.resource::<Expressions>().list[index].made.as_ref()?.unit;
    let read = move |world: &World| {
        world.get_resource::<Expressions>().map_or(f64::NAN, |expressions| expressions.reading(index, world))
    };
    Some(Channel::of_resources(format!("{owner}.{QUANTITY}"), unit, read))
}

pub(super) fn plugin(app: &mut App) {
    app.add_quantities(&[QUANTITY], find_own);
    app.register_entry::<Expression>();
    app.follows_from_scene::<Expressions>();
}
