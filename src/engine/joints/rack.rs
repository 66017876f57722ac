//! A rack: the travel of a slide is `radius` times the angle of a hinge.

use bevy_app::App;
use schemars::JsonSchema;
use serde::Deserialize;

use super::coupling::{self, Asked, Member};
use super::joint_model;
use crate::scene::units::Length;
use crate::scene::{Diagnostics, Entry, Outline, SceneAppExt, WrittenEntry};

/// A pinion and a rack. The travel of the second joint, a slide, is `radius` times the angle of the first, a hinge,
/// without play. The teeth push along the slide at the pitch point, which lies `radius` from the pin. The bearings bear
/// that force.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Rack {
    /// Its name, for channels. Default: none.
    name: Option<String>,
    /// The hinge and the slide, by name.
    of: (String, String),
    /// Radius of the pinion in metres. It is negative for the other side. Not zero.
    radius: Length,
}

impl Entry for Rack {
    const SECTION: &'static str = "joints";
    const NAME: &'static str = "Rack";
    const EXAMPLE: &'static str = "Rack(name: \"mesh\", of: (\"pinion\", \"slide\"), radius: 0.1)";

    fn declare(&self, outline: &mut Outline) {
        joint_model::declare(self.name.as_deref(), outline);
    }

    fn check(&self, outline: &Outline, report: &mut Diagnostics) {
        coupling::check(&self.of, outline, report);
        if report.finite("radius", self.radius) && self.radius.si() == 0.0 {
            report.error("radius", "the rack would couple no motion").help("give `radius` a value that is not zero");
        }
    }

    fn install(entries: Vec<WrittenEntry<Self>>, outline: &Outline, app: &mut App) {
        let couplings = entries.into_iter().map(|WrittenEntry { value, .. }| Asked {
            name: value.name,
            of: value.of,
            ratio: value.radius.si(),
        });
        coupling::install::<Self>(app, outline, [Member::Hinge, Member::Slide], couplings);
    }
}

pub(super) fn plugin(app: &mut App) {
    app.register_entry::<Rack>();
}
