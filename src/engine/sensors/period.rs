//! `Period(name: "swing", of: "hip.angle", crossing: 0)`: how often a channel crosses a value upwards, and how long that takes.
//!
//! A channel is known at looks: at ticks, or within each step if steps follow from their errors. A crossing is the root of the cubic
//! polynomial through the four looks about it. For an oscillation of angular frequency `w` and looks every `dt` the root errs by some
//! `(w dt)^3 dt/40` (remainder of interpolation). The sensor knows a crossing one look later.

use bevy_app::App;
use bevy_ecs::prelude::*;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::named::Named;
use super::{Channel, SensorAppExt, add_found, check_channel, declare, require};
use crate::scene::{Diagnostics, Entry, Outline, SceneAppExt, WrittenEntry};
use crate::tick::kept::SnapshotAppExt;
use crate::tick::{State, add_inner_looker};

const QUANTITIES: &[&str] = &["period", "period.mean", "crossings", "crossings.last"];

/// The crossings of a value upwards by a channel, and their period. `swing.crossings` is their number.
/// `swing.crossings.last` is the time of the last crossing in s, and NaN before the first. `swing.period` is the duration
/// of the last period in s, `swing.period.mean` the mean of all periods. Both are NaN before the second crossing.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Period {
    /// Its name: that of its channels.
    name: String,
    /// The channel, such as `"hip.angle"` or `"ball.position.x"`.
    of: String,
    /// The value, in the unit of the channel. Default: 0.
    #[serde(default)]
    crossing: f64,
}

/// The records of a run, one for each meter.
#[derive(Resource, Default, Serialize, Deserialize)]
struct Meters(Vec<Meter>);

/// The channels that they follow, with the value to be crossed.
type Followed = Named<(Channel, f64)>;

/// The record of one meter.
#[derive(Clone, Default, Serialize, Deserialize)]
struct Meter {
    /// The last looks, at most four: times in s, and values above the one to be crossed.
    samples: Vec<(f64, f64)>,
    crossings: u64,
    /// Times in s of the first crossing, of the one before the last, and of the last.
    first: f64,
    before: f64,
    last: f64,
}

impl Entry for Period {
    const SECTION: &'static str = "sensors";
    const NAME: &'static str = "Period";
    const EXAMPLE: &'static str = "Period(name: \"swing\", of: \"ball.position.x\", crossing: 0)";

    fn declare(&self, outline: &mut Outline) {
        declare(&self.name, outline);
    }

    fn check(&self, outline: &Outline, report: &mut Diagnostics) {
        check_channel(&self.of, "of", outline, report);
        report.finite("crossing", self.crossing);
    }

    fn install(entries: Vec<WrittenEntry<Self>>, outline: &Outline, app: &mut App) {
        let world = app.world_mut();
        let paths =
            outline.entries(Self::SECTION).iter().filter(|entry| entry.name == Self::NAME).map(|entry| &entry.path);
        for (WrittenEntry { value: Self { name, of, crossing }, .. }, path) in entries.into_iter().zip(paths) {
            let Some(channel) = require(world, outline, &of, format!("{path}.of")) else { continue };
            if !world.contains_resource::<Meters>() {
                world.init_resource::<Meters>();
                world.init_resource::<Followed>();
                add_inner_looker(world, follow);
            }
            world.resource_mut::<Meters>().0.push(Meter::default());
            world.resource_mut::<Followed>().push(&name, (channel, crossing));
            add_found(world, QUANTITIES.iter().map(|quantity| format!("{name}.{quantity}")));
        }
    }
}

/// All meters look at their channels.
fn follow(world: &mut World) {
    let time = world.resource::<State>().clock().time();
    world.resource_scope(|world, mut meters: Mut<Meters>| {
        let followed = world.resource::<Followed>().iter();
        for (meter, (channel, crossing)) in meters.0.iter_mut().zip(followed) {
            meter.see(time, channel.value(world) - crossing);
        }
    });
}

impl Meter {
    fn see(&mut self, time: f64, value: f64) {
        // A value that is not known begins anew.
        if !value.is_finite() {
            return self.samples.clear();
        }
        let full = self.samples.len() == 4;
        if full {
            self.samples.remove(0);
        }
        self.samples.push((time, value));
        if self.samples.len() < 4 {
            return;
        }
        // The first four show two intervals at once.
        for begin in if full { 1..2 } else { 0..2 } {
            if self.samples[begin].1 < 0.0 && self.samples[begin + 1].1 >= 0.0 {
                self.note(self.root(begin));
            }
        }
    }

    fn note(&mut self, time: f64) {
        (self.before, self.last) = (self.last, time);
        if self.crossings == 0 {
            self.first = time;
        }
        self.crossings += 1;
    }

    /// The time at which the polynomial through all samples vanishes between a sample and the next, by bisection.
    fn root(&self, begin: usize) -> f64 {
        let (mut low, mut high) = (self.samples[begin].0, self.samples[begin + 1].0);
        loop {
            let middle = 0.5 * (low + high);
            if middle <= low || middle >= high {
                return high;
            }
            if self.interpolated(middle) < 0.0 { low = middle } else { high = middle }
        }
    }

    /// Neville's scheme.
    fn interpolated(&self, time: f64) -> f64 {
        let mut values: Vec<f64> = self.samples.iter().map(|(_, value)| *value).collect();
        for width in 1..values.len() {
            for index in 0..values.len() - width {
                let (from, to) = (self.samples[index].0, self.samples[index + width].0);
                values[index] = (values[index] * (to - time) + values[index + 1] * (time - from)) / (to - from);
            }
        }
        values[0]
    }

    fn value(&self, quantity: &str) -> f64 {
        match quantity {
            "period" if self.crossings > 1 => self.last - self.before,
            "period.mean" if self.crossings > 1 => (self.last - self.first) / (self.crossings - 1) as f64,
            "crossings" => self.crossings as f64,
            "crossings.last" if self.crossings > 0 => self.last,
            _ => f64::NAN,
        }
    }
}

fn find(world: &mut World, owner: &str, quantity: &str) -> Option<Channel> {
    let quantity = *QUANTITIES.iter().find(|known| **known == quantity)?;
    let index = world.get_resource::<Followed>()?.place(owner)?;
    let unit = if quantity == "crossings" { "" } else { "s" };
    let read = move |world: &World| {
        let meter = world.get_resource::<Meters>().and_then(|meters| meters.0.get(index));
        meter.map_or(f64::NAN, |meter| meter.value(quantity))
    };
    Some(Channel::of_resources(format!("{owner}.{quantity}"), unit, read))
}

pub(super) fn plugin(app: &mut App) {
    app.add_quantities(QUANTITIES, find);
    app.register_entry::<Period>();
    app.keep_resource::<Meters>();
    app.follows_from_scene::<Followed>();
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Law: crossings of a sine of period 1 s are one period apart. Tolerance: the remainder of cubic interpolation between ticks
    /// of a hundredth of a period, over the slope `w`. The remainder is `(w dt)^4/(24 * 16/9)` of the amplitude, so 6e-9 s, twice
    /// in each period.
    #[test]
    fn periods_of_a_sine_are_found_between_ticks() {
        let mut meter = Meter::default();
        for tick in 0..1000 {
            let time = 0.01 * f64::from(tick) + 0.0037;
            meter.see(time, libm::sin(std::f64::consts::TAU * (time - 0.123)));
        }
        assert_eq!(meter.value("crossings"), 10.0);
        let bound = 2.0 * libm::pow(0.02 * std::f64::consts::PI, 4.0) / (24.0 * 16.0 / 9.0) / std::f64::consts::TAU;
        assert!((meter.value("crossings.last") - 9.123).abs() < bound, "{}", meter.value("crossings.last"));
        assert!((meter.value("period") - 1.0).abs() < bound && (meter.value("period.mean") - 1.0).abs() < bound);
    }

    /// A crossing in the first interval counts, a rise that turns back just below does not.
    #[test]
    fn the_first_interval_counts() {
        let mut meter = Meter::default();
        for (tick, value) in [-1.0, 1.0, 2.0, 3.0, -1.0, -1e-9, -2.0, -2.0].into_iter().enumerate() {
            meter.see(tick as f64, value);
        }
        assert_eq!(meter.crossings, 1);
        assert!(meter.value("period").is_nan() && (0.0..1.0).contains(&meter.value("crossings.last")));
    }
}
