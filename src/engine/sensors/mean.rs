//! `Mean(name: "bed", of: "grain_*", quantity: "speed")`: mean, standard deviation, least and greatest value of a quantity over a
//! group of bodies.
//!
//! The deviation is that of the group itself, `sqrt(sum (x - mean)^2/n)`, in two passes.

use bevy_app::App;
use bevy_ecs::prelude::*;
use schemars::JsonSchema;
use serde::Deserialize;

use super::group::{self, Group};
use super::named::Named;
use super::{Channel, SensorAppExt, add_found, check_quantity, declare, find_all, require};
use crate::scene::values::Names;
use crate::scene::{Diagnostics, Entry, Outline, SceneAppExt, WrittenEntry};
use crate::tick::kept::SnapshotAppExt;
use crate::world::Name;
use crate::world::sections::Region;

const QUANTITIES: &[&str] = &["mean", "deviation", "least", "greatest"];

/// The mean of a quantity over a group of bodies, each with the same weight: `bed.mean`. `bed.deviation` is the standard
/// deviation of the group, `bed.least` and `bed.greatest` are its extremes. All have the unit of the quantity, and are NaN
/// if the group is empty.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Mean {
    /// Its name: that of its channels.
    name: String,
    /// The bodies. `*` stands for any letters.
    of: Names,
    /// The quantity of each body, such as `"speed"` or `"position.y"`.
    quantity: String,
    /// Only bodies whose centre of mass is in this region count. It is two opposite corners of a box, or the corners of a polygon
    /// in order, in m. Default: everywhere.
    within: Option<Region>,
}

/// The sensors of the scene.
type Asked = Named<Averaged>;

struct Averaged {
    group: Group,
    /// One for each body of the group.
    channels: Vec<Channel>,
}

impl Entry for Mean {
    const SECTION: &'static str = "sensors";
    const NAME: &'static str = "Mean";
    const EXAMPLE: &'static str = "Mean(name: \"bed\", of: \"grain_*\", quantity: \"speed\")";

    fn declare(&self, outline: &mut Outline) {
        declare(&self.name, outline);
    }

    fn check(&self, outline: &Outline, report: &mut Diagnostics) {
        group::check(&self.of, self.within.as_ref(), outline, report);
        check_quantity(&self.quantity, "quantity", outline, report);
    }

    fn install(entries: Vec<WrittenEntry<Self>>, outline: &Outline, app: &mut App) {
        let world = app.world_mut();
        let mentions = outline.entries(Self::SECTION).iter().filter(|mention| mention.name == Self::NAME);
        for (WrittenEntry { value: Self { name, of, quantity, within }, .. }, mention) in
            entries.into_iter().zip(mentions)
        {
            let group = Group::new(&of, within, outline, world);
            let named = |body: &Entity| world.get::<Name>(*body).map(|name| format!("{name}.{quantity}"));
            let names: Vec<String> = group.all().iter().filter_map(named).collect();
            let found = find_all(world, &names);
            if let Some((missing, _)) = names.iter().zip(&found).find(|(_, channel)| channel.is_none()) {
                require(world, outline, missing, format!("{}.quantity", mention.path));
                continue;
            }
            let averaged = Averaged { group, channels: found.into_iter().flatten().collect() };
            world.get_resource_or_init::<Asked>().push(&name, averaged);
            add_found(world, QUANTITIES.iter().map(|quantity| format!("{name}.{quantity}")));
        }
    }
}

impl Averaged {
    fn value(&self, world: &World, quantity: &str) -> f64 {
        let values: Vec<f64> =
            self.group.present(world).map(|(number, _)| self.channels[number].value(world)).collect();
        let mean = |values: &[f64]| values.iter().fold(0.0, |sum, more| sum + more) / values.len() as f64;
        // A value that is NaN stays one: `min` and `max` of numbers would pass it over.
        let choose = |better: fn(f64, f64) -> bool| {
            let chosen = |a: f64, b: f64| if a.is_nan() || better(a, b) { a } else { b };
            values.iter().copied().reduce(chosen).unwrap_or(f64::NAN)
        };
        match quantity {
            "mean" => mean(&values),
            "least" => choose(|a, b| a < b),
            "greatest" => choose(|a, b| a > b),
            _ => {
                let middle = mean(&values);
                let squares: Vec<f64> = values.iter().map(|value| (value - middle) * (value - middle)).collect();
                mean(&squares).sqrt()
            }
        }
    }
}

fn find(world: &mut World, owner: &str, quantity: &str) -> Option<Channel> {
    let quantity = *QUANTITIES.iter().find(|known| **known == quantity)?;
    let asked = world.get_resource::<Asked>()?;
    let index = asked.place(owner)?;
    let unit = asked.get(index)?.channels.first().map_or("", |channel| channel.unit);
    let read = move |world: &World| {
        let averaged = world.get_resource::<Asked>().and_then(|asked| asked.get(index));
        averaged.map_or(f64::NAN, |averaged| averaged.value(world, quantity))
    };
    Some(Channel::of_resources(format!("{owner}.{quantity}"), unit, read))
}

pub(super) fn plugin(app: &mut App) {
    app.add_quantities(QUANTITIES, find);
    app.register_entry::<Mean>();
    app.follows_from_scene::<Asked>();
}
