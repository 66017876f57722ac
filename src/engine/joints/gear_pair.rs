//! A gear pair: the rate of the second hinge is `ratio` times that of the first.

use bevy_app::App;
use schemars::JsonSchema;
use serde::Deserialize;

use super::coupling::{self, Asked, Member};
use super::joint_model;
use crate::scene::units::Scalar;
use crate::scene::{Diagnostics, Entry, Outline, SceneAppExt, WrittenEntry};

/// Gears on two hinges: the rate of the second is `ratio` times the rate of the first, without play. They give torques and
/// no force: a ratio names no place for teeth. So the bearings bear no force of them.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct GearPair {
    /// Its name, for channels. Default: none.
    name: Option<String>,
    /// The two hinges, by name.
    of: (String, String),
    /// Rate of the second hinge over rate of the first. It is negative for gears that mesh from outside. Not zero.
    ratio: Scalar,
}

impl Entry for GearPair {
    const SECTION: &'static str = "joints";
    const NAME: &'static str = "GearPair";
    const EXAMPLE: &'static str = "GearPair(name: \"mesh\", of: (\"hip\", \"knee\"), ratio: -2)";

    fn declare(&self, outline: &mut Outline) {
        joint_model::declare(self.name.as_deref(), outline);
    }

    fn check(&self, outline: &Outline, report: &mut Diagnostics) {
        coupling::check(&self.of, outline, report);
        if report.finite("ratio", self.ratio) && self.ratio.si() == 0.0 {
            report.error("ratio", "the gears would couple no motion").help("give `ratio` a value that is not zero");
        }
    }

    fn install(entries: Vec<WrittenEntry<Self>>, outline: &Outline, app: &mut App) {
        let couplings = entries.into_iter().map(|WrittenEntry { value, .. }| Asked {
            name: value.name,
            of: value.of,
            ratio: value.ratio.si(),
        });
        coupling::install::<Self>(app, outline, [Member::Hinge, Member::Hinge], couplings);
    }
}

pub(super) fn plugin(app: &mut App) {
    app.register_entry::<GearPair>();
}
