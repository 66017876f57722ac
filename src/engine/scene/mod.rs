//! From scene text to the world: the scene language, and its extension by plugins.
//!
//! Each top-level section belongs to the plugin that registered its name ([`SceneAppExt`]). So does each entry of a
//! list such as `forces`. [`Scene`] describes how a scene is read.
//!
//! A plugin with a section:
//!
//! ```
//! # extern crate jostle_engine as jostle;
//! use bevy_app::App;
//! use bevy_ecs::resource::Resource;
//! use jostle::scene::units::Speed;
//! use jostle::scene::{Outline, Diagnostics, SceneAppExt, Section, Source, load};
//!
//! #[derive(serde::Deserialize, schemars::JsonSchema)]
//! #[serde(deny_unknown_fields)]
//! struct WindSection {
//!     /// From the left, in m/s.
//!     speed: Speed,
//! }
//!
//! #[derive(Resource)]
//! struct Wind(f64);
//!
//! impl Section for WindSection {
//!     const NAME: &'static str = "wind";
//!     const EXAMPLE: &'static str = "wind: (speed: \"10 km/h\")";
//!
//!     fn check(&self, _outline: &Outline, report: &mut Diagnostics) {
//!         report.between("speed", self.speed, -100.0, 100.0);
//!     }
//!
//!     fn install(self, _outline: &Outline, app: &mut App) {
//!         app.insert_resource(Wind(self.speed.si()));
//!     }
//! }
//!
//! let mut app = App::empty();
//! app.register_section::<WindSection>();
//! let scene = Source::new("storm.ron", "Scene(format: 1, clock: (duration: 1), wind: (speed: \"2 kg\"))");
//! let errors = load(&mut app, &scene).unwrap_err();
//! let wind = errors.errors().iter().find(|error| error.path == "wind.speed").unwrap();
//! assert_eq!(
//!     wind.message,
//!     "expected a speed such as `0.2` or \"20 cm/s\", got a mass `2 kg`"
//! );
//! assert_eq!((wind.line, wind.column), (Some(1), Some(54)));
//! ```

mod registry;
mod section;

use bevy_app::App;
use bevy_ecs::world::World;

pub use jostle_language::*;
pub use registry::{SceneAppExt, SceneRegistry};
pub(crate) use registry::{install_word, register_embedding};
pub use section::{Entry, Section, WrittenEntry};

/// Reads a scene and installs its sections.
///
/// The reader checks the whole scene before it installs a part, so an error leaves the `App` unchanged.
///
/// # Errors
/// Those of [`Scene::read`].
pub fn load(app: &mut App, source: &Source) -> Result<SceneHeader, SceneErrors> {
    let scene = match app.world().get_resource::<SceneRegistry>() {
        Some(registry) => Scene::read(registry, source)?,
        None => Scene::read(&Registry::default(), source)?,
    };
    Ok(scene.install(app))
}

/// Mistakes that only turned out when the scene was put together, at their places in the text.
pub(crate) fn found_later(world: &World, source: &Source, errors: Vec<SceneError>) -> SceneErrors {
    match world.get_resource::<SceneRegistry>() {
        Some(registry) => registry.found_later(source, errors),
        None => Registry::<App>::default().found_later(source, errors),
    }
}

#[cfg(test)]
mod tests;
