//! `Inside(of: "*", box: ((0, 0), (6, 6)))`: at every tick the centres of mass are in the box.

use bevy_app::App;
use glam::DVec2;
use schemars::JsonSchema;
use serde::Deserialize;

use super::{Expectations, Sight, Watch, indices};
use crate::scene::units::LengthPair as Place;
use crate::scene::values::Names;
use crate::scene::{Diagnostics, Entry, NameKind, Outline, SceneAppExt, WrittenEntry};
use crate::tick::snapshot::{Memory, UnfitSnapshot, recall};

/// The centres of mass stay in a box, at every tick.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Inside {
    /// The bodies. `*` stands for any letters.
    of: Names,
    /// Lower left and upper right corner in metres.
    r#box: (Place, Place),
}

impl Entry for Inside {
    const SECTION: &'static str = "expect";
    const NAME: &'static str = "Inside";
    const EXAMPLE: &'static str = "Inside(of: \"*\", box: ((0, 0), (6, 6)))";

    fn check(&self, outline: &Outline, report: &mut Diagnostics) {
        self.of.require(NameKind::BODY, outline, "of", report);
        let (low, high) = (self.r#box.0.si(), self.r#box.1.si());
        if !low.cmplt(high).all() {
            report.error("box", "the first corner must be below and to the left of the second");
        }
    }

    fn install(entries: Vec<WrittenEntry<Self>>, outline: &Outline, app: &mut App) {
        for WrittenEntry { value, text } in entries {
            let bodies = value.of.matching(NameKind::BODY, outline);
            let watch = Watching {
                keys: bodies.iter().map(|&body| body as u64).collect(),
                names: bodies.iter().map(|&body| outline.names(NameKind::BODY)[body].clone()).collect(),
                low: value.r#box.0.si(),
                high: value.r#box.1.si(),
                escaped: None,
            };
            Expectations::add(app, text, watch);
        }
    }
}

struct Watching {
    keys: Vec<u64>,
    names: Vec<String>,
    low: DVec2,
    high: DVec2,
    escaped: Option<(String, f64, DVec2)>,
}

impl Watch for Watching {
    fn save(&self) -> Memory {
        Memory::of(&self.escaped)
    }

    fn load(&mut self, bytes: &[u8]) -> Result<(), UnfitSnapshot> {
        self.escaped = recall(bytes)?;
        Ok(())
    }

    fn observe(&mut self, sight: &Sight) {
        if self.escaped.is_some() {
            return;
        }
        for index in indices(sight.bodies, &self.keys) {
            let position = sight.bodies.position[index];
            // In this form a NaN or infinite position is outside.
            if !(position.cmpge(self.low).all() && position.cmple(self.high).all()) {
                let which = self.keys.iter().position(|&key| key == sight.bodies.key.at(index));
                let name = which.map_or_else(String::new, |which| self.names[which].clone());
                self.escaped = Some((name, sight.time, position));
                return;
            }
        }
    }

    fn verdict(&self) -> (Option<bool>, String) {
        match &self.escaped {
            None => (Some(true), "never left the box".to_owned()),
            Some((name, time, at)) => {
                (Some(false), format!("{name} was at ({:.4}, {:.4}) at t = {time:.4} s", at.x, at.y))
            }
        }
    }
}

pub(super) fn plugin(app: &mut App) {
    app.register_entry::<Inside>();
}
