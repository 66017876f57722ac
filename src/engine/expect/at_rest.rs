//! `AtRest(of: "*", from: 18, speed_below: 1e-6)`: from a time on, every point of the bodies is slower than a speed.

use bevy_app::App;
use schemars::JsonSchema;
use serde::Deserialize;

use super::{Expectations, Sight, Watch, indices};
use crate::scene::units::{Speed, Time};
use crate::scene::values::Names;
use crate::scene::{Diagnostics, Entry, NameKind, Outline, SceneAppExt, WrittenEntry, exact};
use crate::tick::snapshot::{Memory, UnfitSnapshot, recall};

/// From a time on, every point of the bodies is slower than a speed, at every tick.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct AtRest {
    /// The bodies. `*` stands for any letters.
    of: Names,
    /// The expectation holds from this time on, in seconds.
    from: Time,
    /// All points are slower than this, in m/s.
    speed_below: Speed,
}

impl Entry for AtRest {
    const SECTION: &'static str = "expect";
    const NAME: &'static str = "AtRest";
    const EXAMPLE: &'static str = "AtRest(of: \"*\", from: 18, speed_below: 1e-6)";

    fn check(&self, outline: &Outline, report: &mut Diagnostics) {
        self.of.require(NameKind::BODY, outline, "of", report);
        report.not_negative("from", self.from.si());
        report.positive("speed_below", self.speed_below.si());
    }

    fn install(entries: Vec<WrittenEntry<Self>>, outline: &Outline, app: &mut App) {
        for WrittenEntry { value, text } in entries {
            let keys = value.of.matching(NameKind::BODY, outline).into_iter().map(|body| body as u64).collect();
            let (from, below) = (value.from.si(), value.speed_below.si());
            Expectations::add(app, text, Watching { keys, from, below, fastest: None });
        }
    }
}

struct Watching {
    keys: Vec<u64>,
    from: f64,
    below: f64,
    fastest: Option<(f64, f64)>,
}

impl Watch for Watching {
    fn save(&self) -> Memory {
        Memory::of(&self.fastest)
    }

    fn load(&mut self, bytes: &[u8]) -> Result<(), UnfitSnapshot> {
        self.fastest = recall(bytes)?;
        Ok(())
    }

    fn observe(&mut self, sight: &Sight) {
        if !sight.has_reached(self.from) {
            return;
        }
        let bodies = sight.bodies;
        // Bodies that are asleep stand, and a speed of zero is no faster than those seen before.
        if self.fastest.is_some() && bodies.all_asleep() {
            return;
        }
        for index in indices(bodies, &self.keys) {
            let speed = bodies.velocity[index].length() + bodies.spin[index].abs() * bodies.extent(index);
            if self.fastest.is_none_or(|(fastest, _)| speed > fastest || speed.is_nan()) {
                self.fastest = Some((speed, sight.time));
            }
        }
    }

    fn verdict(&self) -> (Option<bool>, String) {
        let Some((speed, time)) = self.fastest else {
            return (None, format!("nothing before t = {} s counts", exact(self.from)));
        };
        (Some(speed < self.below), format!("fastest {speed:.3e} m/s at t = {time:.4} s"))
    }
}

pub(super) fn plugin(app: &mut App) {
    app.register_entry::<AtRest>();
}
