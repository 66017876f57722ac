//! `Channel(name: "energy.residual", below: 1e-6)`: the magnitude of a channel stays below a bound, from `from` on. It
//! is checked at every tenth tick and at the end.

use bevy_app::App;
use schemars::JsonSchema;
use serde::Deserialize;

use super::{Expectations, Sight, Watch};
use crate::scene::units::{Scalar, Time};
use crate::scene::{Diagnostics, Entry, Outline, SceneAppExt, WrittenEntry, exact};
use crate::sensors::{self, energy};
use crate::tick::energy::EnergyLedger;
use crate::tick::snapshot::{Memory, UnfitSnapshot, recall};

/// The magnitude of a channel stays below a bound, at every tenth tick and at the end.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Channel {
    /// The name of the channel, such as `energy.residual` or `ball.velocity.x`. It needs no sensor.
    name: String,
    /// The bound, in the channel's unit.
    below: Scalar,
    /// The expectation holds from this time on, in seconds. Default: 0.
    #[serde(default)]
    from: Time,
}

impl Entry for Channel {
    const SECTION: &'static str = "expect";
    const NAME: &'static str = "Channel";
    const EXAMPLE: &'static str = "Channel(name: \"energy.residual\", below: 1e-6)";

    fn check(&self, outline: &Outline, report: &mut Diagnostics) {
        sensors::check_channel(&self.name, "name", outline, report);
        report.not_negative("from", self.from.si());
        report.positive("below", self.below.si());
    }

    fn install(entries: Vec<WrittenEntry<Self>>, outline: &Outline, app: &mut App) {
        let paths =
            outline.entries(Self::SECTION).iter().filter(|entry| entry.name == Self::NAME).map(|entry| &entry.path);
        for (WrittenEntry { value, text }, path) in entries.into_iter().zip(paths) {
            let channel = sensors::require(app.world_mut(), outline, &value.name, format!("{path}.name"));
            let (below, from) = (value.below.si(), value.from.si());
            let energy = value.name.split_once('.').and_then(|(owner, quantity)| energy::entry(owner, quantity));
            Expectations::add(app, text, Watching { channel, energy, below, from, largest: None });
        }
    }
}

struct Watching {
    channel: Option<sensors::Channel>,
    /// The entry of the energy ledger, for channels of energy.
    energy: Option<fn(&EnergyLedger) -> f64>,
    below: f64,
    from: f64,
    largest: Option<(f64, f64)>,
}

impl Watch for Watching {
    fn save(&self) -> Memory {
        Memory::of(&self.largest)
    }

    fn load(&mut self, bytes: &[u8]) -> Result<(), UnfitSnapshot> {
        self.largest = recall(bytes)?;
        Ok(())
    }

    fn needs_world(&self) -> bool {
        self.energy.is_none()
    }

    fn observe(&mut self, sight: &Sight) {
        let Some(channel) = self.channel.as_ref().filter(|_| sight.has_reached(self.from)) else { return };
        let value = self.energy.map_or_else(|| channel.value(sight.world()), |entry| entry(sight.energy())).abs();
        if self.largest.is_none_or(|(largest, _)| value > largest || value.is_nan()) {
            self.largest = Some((value, sight.time));
        }
    }

    /// Energies take a sum over all bodies and contacts, so only every tenth tick is checked.
    fn every(&self) -> u64 {
        10
    }

    fn verdict(&self) -> (Option<bool>, String) {
        let Some(channel) = &self.channel else { return (Some(false), "there is no such channel".to_owned()) };
        let Some((value, time)) = self.largest else {
            return (None, format!("t = {} s was not reached", exact(self.from)));
        };
        (Some(value < self.below), format!("largest {value:.3e} {} at t = {time:.4} s", channel.unit))
    }
}

pub(super) fn plugin(app: &mut App) {
    app.register_entry::<Channel>();
}
