//! The standard plugins, in the order of the tick: the table of contents of the physics.
//!
//! They only register the names for scenes here. A scene installs its sections when it is read, in this order. Other
//! sections are not scheduled, not stored, and cost nothing.

use bevy_app::App;
use jostle_frames::color_names;

use crate::record::sections::look::THEMES;
use crate::scene::SceneAppExt;
use crate::world::material::COLORS;
use crate::{contacts, controllers, expect, forces, integrate, joints, record, sensors, world};

/// Names of the language that are kept for later.
const RESERVED: [&str; 2] = ["randomise", "scene"];

/// Registers the sections that describe the run and the film, their words, and the names that are kept for later.
pub fn run_and_film(app: &mut App) {
    integrate::clock_section::plugin(app);
    record::sections::plugin(app);
    // The painter has its names of colours, and the language checks against them.
    for color in color_names::COLOR_NAMES {
        app.register_word(COLORS, color);
    }
    for (theme, _) in color_names::THEMES {
        app.register_word(THEMES, theme);
    }
    for later in RESERVED {
        app.reserve_section(later);
    }
}

/// Registers everything the scene language offers.
pub fn standard(app: &mut App) {
    run_and_film(app);
    integrate::plugin(app);
    world::plugin(app);
    forces::plugin(app);
    joints::plugin(app);
    controllers::plugin(app);
    contacts::plugin(app);
    sensors::plugin(app);
    expect::plugin(app);
    record::layers::plugin(app);
}
