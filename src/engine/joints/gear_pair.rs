//! Gears: the rate of the second hinge is `ratio` times that of the first.

use bevy_app::App;
use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::Deserialize;

use super::coupling::{self, Member};
use crate::scene::units::Scalar;
use crate::scene::{Entry, Outline, Report, SceneAppExt, Written};

/// Gears on two hinges: the rate of the second is `ratio` times the rate of the first, without play.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct GearPair {
    /// The two hinges, by name.
    of: (String, String),
    /// Rate of the second over rate of the first; negative for gears that mesh from outside. Not zero.
    ratio: Scalar,
}

impl Entry for GearPair {
    const SECTION: &'static str = "joints";
    const NAME: &'static str = "GearPair";
    const EXAMPLE: &'static str = "GearPair(of: (\"hip\", \"knee\"), ratio: -2)";

    fn schema(generator: &mut SchemaGenerator) -> Option<Schema> {
        Some(generator.subschema_for::<Self>())
    }

    fn check(&self, outline: &Outline, report: &mut Report) {
        coupling::check(&self.of, outline, report);
        if report.finite("ratio", self.ratio) && self.ratio.si() == 0.0 {
            report.error("ratio", "nothing would be coupled").help("give `ratio` a value that is not zero");
        }
    }

    fn install(entries: Vec<Written<Self>>, outline: &Outline, app: &mut App) {
        let couplings = entries.into_iter().map(|Written { value, .. }| (value.of, value.ratio.si()));
        coupling::install::<Self>(app, outline, [Member::Hinge, Member::Hinge], couplings);
    }
}

pub(super) fn plugin(app: &mut App) {
    app.register_entry::<GearPair>();
}
