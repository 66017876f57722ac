//! `Position(of: "ball", at: 2.0, is: (2, 0.2), within: 1e-3)`: the position of a body at a time, between ticks too.

use bevy_app::App;
use glam::DVec2;
use schemars::JsonSchema;
use serde::Deserialize;

use super::{Expectations, Sight, Watch, indices};
use crate::scene::units::{Length, LengthPair as Place, Time};
use crate::scene::{Diagnostics, Entry, NameKind, Outline, SceneAppExt, WrittenEntry, exact};
use crate::tick::snapshot::{Memory, UnfitSnapshot, recall};
use crate::world::between::{MotionSample, position_between};

/// A body is at a place at a time, which may lie between ticks.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Position {
    /// The name of the body.
    of: String,
    /// The time in seconds.
    at: Time,
    /// The expected position of its centre of mass, in metres.
    is: Place,
    /// The greatest distance from there, in metres.
    within: Length,
}

impl Entry for Position {
    const SECTION: &'static str = "expect";
    const NAME: &'static str = "Position";
    const EXAMPLE: &'static str = "Position(of: \"ball\", at: 2, is: (2, 0.2), within: 1e-3)";

    fn check(&self, outline: &Outline, report: &mut Diagnostics) {
        outline.require(NameKind::BODY, &self.of, "of", report);
        report.not_negative("at", self.at.si());
        report.positive("within", self.within.si());
    }

    fn install(entries: Vec<WrittenEntry<Self>>, outline: &Outline, app: &mut App) {
        for WrittenEntry { value, text } in entries {
            let Some(body) = outline.position(NameKind::BODY, &value.of) else { continue };
            let watch = Watching {
                key: body as u64,
                at: value.at.si(),
                is: value.is.si(),
                within: value.within.si(),
                before: None,
                found: None,
            };
            Expectations::add(app, text, watch);
        }
    }
}

struct Watching {
    key: u64,
    at: f64,
    is: DVec2,
    within: f64,
    before: Option<MotionSample>,
    found: Option<DVec2>,
}

impl Watch for Watching {
    fn save(&self) -> Memory {
        Memory::of(&(self.before, self.found))
    }

    fn load(&mut self, bytes: &[u8]) -> Result<(), UnfitSnapshot> {
        (self.before, self.found) = recall(bytes)?;
        Ok(())
    }

    fn observe(&mut self, sight: &Sight) {
        if self.found.is_some() {
            return;
        }
        let Some(index) = indices(sight.bodies, &[self.key]).next() else { return };
        let now = MotionSample::of(sight.bodies, index, sight.time);
        if sight.has_reached(self.at) {
            self.found = Some(self.before.map_or(now.position, |before| position_between(&before, &now, self.at)));
        }
        self.before = Some(now);
    }

    fn samples(&self) -> bool {
        false
    }

    fn verdict(&self) -> (Option<bool>, String) {
        let Some(found) = self.found else { return (None, format!("t = {} s was not reached", exact(self.at))) };
        let distance = found.distance(self.is);
        (Some(distance <= self.within), format!("({:.9}, {:.9}), {distance:.3e} m away", found.x, found.y))
    }
}

pub(super) fn plugin(app: &mut App) {
    app.register_entry::<Position>();
}
