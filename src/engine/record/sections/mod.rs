//! The sections of a scene for the film and its plots, as plain data. They never change the physics.

pub mod camera;
pub mod film;
pub mod look;
pub mod plots;

pub use camera::{CameraChoice, FitCamera, FollowCamera, LookCamera};
pub use film::{FilmSection, FreezeEntry};
pub use look::LookSection;
pub use plots::{HistogramEntry, PlotEntry, PlotsSection};

use bevy_app::App;

use crate::scene::{Arity, SceneAppExt};

/// Registers the sections.
pub fn plugin(app: &mut App) {
    app.register_section::<FilmSection>();
    app.register_section::<LookSection>();
    app.register_section::<PlotsSection>();
    app.register_entry_section(camera::SECTION, Arity::One, camera::EXAMPLE);
    app.describe_section(camera::SECTION, camera::MEANING);
    app.register_entry::<FitCamera>();
    app.register_entry::<LookCamera>();
    app.register_entry::<FollowCamera>();
}
