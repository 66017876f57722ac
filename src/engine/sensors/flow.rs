//! `Flow(name: "out", of: "grain_*", gate: ((-0.1, 0), (0.1, 0)))`: number and mass of the bodies that pass a gate, in all and as rates.
//!
//! Rates are moving averages: the amount that has passed in the last `T` seconds, over `T`. If `n` passages in the window come at random
//! (Poisson), the rate is uncertain by about `1/sqrt(n)` of itself.

use std::collections::VecDeque;

use bevy_app::App;
use bevy_ecs::prelude::*;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::gate::{self, Gate, LastLook};
use super::named::Named;
use super::{Channel, SensorAppExt, add_found, bodies_named, declare};
use crate::scene::units::{LengthPair, Time};
use crate::scene::values::Names;
use crate::scene::{Diagnostics, Entry, NameKind, Outline, SceneAppExt, WrittenEntry};
use crate::tick::kept::SnapshotAppExt;
use crate::tick::{Clock, State, add_inner_looker};

const QUANTITIES: &[&str] = &["count", "mass", "count.rate", "mass.rate"];

/// The number of bodies that have passed a gate since the start, `out.count`, and their mass in kg, `out.mass`. Their rates
/// over a time window are `out.count.rate` in 1/s and `out.mass.rate` in kg/s. A body passes if its centre of mass crosses
/// the line between the two ends. Its way is smooth from tick to tick, or from look to look within a step. Left is the left
/// hand of a walk from the first end to the second.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Flow {
    /// Its name: that of its channels.
    name: String,
    /// The bodies. `*` stands for any letters.
    of: Names,
    /// The two ends of the gate, in m.
    gate: (LengthPair, LengthPair),
    /// The passages that count, with their signs. Default: `Net`.
    #[serde(default)]
    direction: Direction,
    /// The time window of the rates in s, rounded to whole ticks, at least one. Above zero. Earlier in the run it begins at
    /// the start. Default: 0.5.
    #[serde(default = "half_a_second")]
    window: Time,
}

fn half_a_second() -> Time {
    Time::new(0.5)
}

/// Which passages count.
#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize, JsonSchema)]
enum Direction {
    /// Those to the left count, those to the right are subtracted.
    #[default]
    Net,
    /// Those to the left alone.
    Left,
    /// Those to the right alone.
    Right,
    /// All, without a sign.
    Both,
}

impl Direction {
    fn weight(self, is_left: bool) -> i64 {
        match (self, is_left) {
            (Self::Net | Self::Left | Self::Both, true) | (Self::Right | Self::Both, false) => 1,
            (Self::Net, false) => -1,
            (Self::Left, false) | (Self::Right, true) => 0,
        }
    }
}

/// The sensors of the scene.
type Asked = Named<Meter>;

struct Meter {
    gate: Gate,
    direction: Direction,
    /// In seconds.
    window: f64,
}

impl Meter {
    /// The window in ticks.
    fn ticks(&self, clock: &Clock) -> u64 {
        ((self.window / clock.dt).round() as u64).max(1)
    }
}

/// The passages of a run, one account for each meter.
#[derive(Resource, Default, Serialize, Deserialize)]
struct Seen(Vec<Passed>);

#[derive(Clone, Default, Serialize, Deserialize)]
struct Passed {
    all: Amount,
    /// Tick and amount of those in the window, the oldest first.
    recent: VecDeque<(u64, Amount)>,
    /// Its bodies at the last look.
    before: LastLook,
}

/// A number of bodies and their mass in kg.
#[derive(Clone, Copy, Default, Serialize, Deserialize)]
struct Amount {
    count: i64,
    mass: f64,
}

impl Amount {
    fn plus(self, other: Self) -> Self {
        Self { count: self.count + other.count, mass: self.mass + other.mass }
    }
}

impl Entry for Flow {
    const SECTION: &'static str = "sensors";
    const NAME: &'static str = "Flow";
    const EXAMPLE: &'static str = "Flow(name: \"out\", of: \"grain_*\", gate: ((0.1, 0), (-0.1, 0)), window: 0.5)";

    fn declare(&self, outline: &mut Outline) {
        declare(&self.name, outline);
    }

    fn check(&self, outline: &Outline, report: &mut Diagnostics) {
        self.of.require(NameKind::BODY, outline, "of", report);
        gate::check(self.gate, report);
        report.positive("window", self.window);
    }

    fn install(entries: Vec<WrittenEntry<Self>>, outline: &Outline, app: &mut App) {
        let world = app.world_mut();
        for WrittenEntry { value: Self { name, of, gate, direction, window }, .. } in entries {
            if !world.contains_resource::<Asked>() {
                world.init_resource::<Asked>();
                world.init_resource::<Seen>();
                add_inner_looker(world, look);
            }
            let gate = Gate::new(gate, bodies_named(world, &of, outline));
            world.resource_mut::<Seen>().0.push(Passed::default());
            let meter = Meter { gate, direction, window: window.si() };
            world.resource_mut::<Asked>().push(&name, meter);
            add_found(world, QUANTITIES.iter().map(|quantity| format!("{name}.{quantity}")));
        }
    }
}

/// At the end of a tick all meters look at their gates.
fn look(world: &mut World) {
    world.resource_scope(|world, mut seen: Mut<Seen>| {
        let state = world.resource::<State>();
        for (meter, passed) in world.resource::<Asked>().iter().zip(&mut seen.0) {
            let amounts = meter.gate.passages(&mut passed.before, world).into_iter().map(|passage| {
                let count = meter.direction.weight(passage.is_left);
                Amount { count, mass: count as f64 * state.bodies().mass[passage.body] }
            });
            let now = amounts.fold(Amount::default(), Amount::plus);
            passed.all = passed.all.plus(now);
            let tick = state.clock().ticks_begun();
            if now.count != 0 || now.mass != 0.0 {
                passed.recent.push_back((tick, now));
            }
            let ticks = meter.ticks(&state.clock());
            while passed.recent.front().is_some_and(|(seen, _)| seen + ticks <= tick) {
                passed.recent.pop_front();
            }
        }
    });
}

impl Passed {
    /// The amount per second that passed in the window; NaN before the first tick.
    fn rate(&self, meter: &Meter, clock: &Clock, of: impl Fn(&Amount) -> f64) -> f64 {
        let ticks = meter.ticks(clock).min(clock.ticks_begun());
        let recent = self.recent.iter().map(|(_, amount)| amount).fold(Amount::default(), |sum, more| sum.plus(*more));
        if ticks > 0 { of(&recent) / (ticks as f64 * clock.dt) } else { f64::NAN }
    }
}

fn find(world: &mut World, owner: &str, quantity: &str) -> Option<Channel> {
    let quantity = *QUANTITIES.iter().find(|known| **known == quantity)?;
    let index = world.get_resource::<Asked>()?.place(owner)?;
    let of: fn(&Amount) -> f64 =
        if quantity.starts_with("count") { |amount| amount.count as f64 } else { |amount| amount.mass };
    let unit = match quantity {
        "mass" => "kg",
        "count.rate" => "1/s",
        "mass.rate" => "kg/s",
        _ => "",
    };
    let is_rate = quantity.ends_with("rate");
    let read = move |world: &World| {
        let meter = world.get_resource::<Asked>().and_then(|asked| asked.get(index));
        let passed = world.get_resource::<Seen>().and_then(|seen| seen.0.get(index));
        let Some((meter, passed)) = meter.zip(passed) else { return f64::NAN };
        if is_rate { passed.rate(meter, &world.resource::<State>().clock(), of) } else { of(&passed.all) }
    };
    Some(Channel::of_resources(format!("{owner}.{quantity}"), unit, read))
}

pub(super) fn plugin(app: &mut App) {
    app.add_quantities(QUANTITIES, find);
    app.register_entry::<Flow>();
    app.keep_resource::<Seen>();
    app.follows_from_scene::<Asked>();
}
