//! The sections that describe the run and the film, and the names that are kept for later versions.

use bevy_app::App;

use super::camera::{self, FitCamera, FollowCamera, LookCamera};
use super::{ClockSection, FilmSection, LookSection, PlotsSection};
use crate::raster::COLOR_NAMES;
use crate::scene::{Arity, SceneAppExt};
use crate::world::material::COLORS;

/// Names of the language that are kept for later.
const RESERVED: [&str; 4] = ["joints", "randomise", "controllers", "scene"];

/// Registers the sections that describe the run and the film, and keeps the names of later ones.
pub fn plugin(app: &mut App) {
    app.register_word(ClockSection::METHODS, ClockSection::AUTO);
    app.register_word(ClockSection::METHODS, ClockSection::REFERENCE);
    app.register_section::<ClockSection>();
    app.register_section::<FilmSection>();
    app.register_section::<LookSection>();
    app.register_section::<PlotsSection>();
    app.register_entry_section(camera::SECTION, Arity::One, camera::EXAMPLE);
    app.describe_section(camera::SECTION, camera::MEANING);
    app.register_entry::<FitCamera>();
    app.register_entry::<LookCamera>();
    app.register_entry::<FollowCamera>();
    for color in COLOR_NAMES {
        app.register_word(COLORS, color);
    }
    for later in RESERVED {
        app.reserve_section(later);
    }
}
