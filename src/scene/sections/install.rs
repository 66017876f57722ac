//! What becomes of `clock`, `film` and `camera`: resources, for whoever runs and draws the scene.

use bevy_app::App;
use bevy_ecs::prelude::*;

use super::camera::{self, FitCamera, LookCamera};
use super::{ClockSection, FilmSection};
use crate::raster::COLOR_NAMES;
use crate::scene::{Arity, Entry, Outline, Report, SceneAppExt, Section, Written};
use crate::world::material::COLORS;

/// Names of the language that are kept for later.
const RESERVED: [&str; 10] =
    ["joints", "plots", "look", "params", "include", "templates", "instances", "randomise", "controllers", "scene"];

/// Registers the sections that describe the run and the film, and keeps the names of later ones.
pub fn plugin(app: &mut App) {
    app.register_word(ClockSection::METHODS, ClockSection::AUTO);
    for method in ClockSection::RESERVED_METHODS {
        app.reserve_word(ClockSection::METHODS, method);
    }
    app.register_section::<ClockSection>();
    app.register_section::<FilmSection>();
    app.register_entry_section(camera::SECTION, Arity::One, camera::EXAMPLE);
    app.register_entry::<FitCamera>();
    app.register_entry::<LookCamera>();
    for later in camera::RESERVED {
        app.reserve_entry(camera::SECTION, later);
    }
    for color in COLOR_NAMES {
        app.register_word(COLORS, color);
    }
    for later in RESERVED {
        app.reserve_section(later);
    }
}

impl Section for ClockSection {
    const NAME: &'static str = Self::NAME;
    const EXAMPLE: &'static str = Self::EXAMPLE;

    fn check(&self, outline: &Outline, report: &mut Report) {
        self.check(outline, report);
    }

    fn install(self, _: &Outline, app: &mut App) {
        app.insert_resource(self);
    }
}

impl Section for FilmSection {
    const NAME: &'static str = Self::NAME;
    const EXAMPLE: &'static str = Self::EXAMPLE;

    fn check(&self, _: &Outline, report: &mut Report) {
        self.check(report);
    }

    fn install(self, _: &Outline, app: &mut App) {
        app.insert_resource(self);
    }
}

/// The camera of the scene. Absent: everything fits, with the default margin.
#[derive(Resource, Clone, Debug)]
pub enum CameraChoice {
    /// Everything that moves stays in the picture.
    Fit(FitCamera),
    /// A fixed part of the world.
    Look(LookCamera),
}

impl Entry for FitCamera {
    const SECTION: &'static str = camera::SECTION;
    const NAME: &'static str = Self::NAME;
    const EXAMPLE: &'static str = Self::EXAMPLE;

    fn check(&self, _: &Outline, report: &mut Report) {
        self.check(report);
    }

    fn install(entries: Vec<Written<Self>>, _: &Outline, app: &mut App) {
        for entry in entries {
            app.insert_resource(CameraChoice::Fit(entry.value));
        }
    }
}

impl Entry for LookCamera {
    const SECTION: &'static str = camera::SECTION;
    const NAME: &'static str = Self::NAME;
    const EXAMPLE: &'static str = Self::EXAMPLE;

    fn check(&self, _: &Outline, report: &mut Report) {
        self.check(report);
    }

    fn install(entries: Vec<Written<Self>>, _: &Outline, app: &mut App) {
        for entry in entries {
            app.insert_resource(CameraChoice::Look(entry.value));
        }
    }
}
