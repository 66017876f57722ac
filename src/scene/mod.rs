//! Scene text -> world.
//!
//! A scene is one RON file. Each top-level section and each entry of a list such as `forces` belongs to the plugin
//! that registered its name ([`SceneAppExt`]); this module knows none of them by itself but `format`, `title` and
//! `notes`. Reading goes in five steps, and nothing is built before all of them but the last have passed:
//!
//! 1. *walk* the text: brackets, commas, double fields, numbers that are not finite;
//! 2. *read* every section with the type registered for it;
//! 3. *declare* the names it brings ([`Outline`]);
//! 4. *check* what types cannot exclude ([`Report`]);
//! 5. *install*, in the order of registration.
//!
//! Mistakes come with file, line, column, path, source line and remedy ([`SceneErrors`]).
//!
//! A plugin with a section of its own:
//!
//! ```
//! use bevy_app::App;
//! use bevy_ecs::resource::Resource;
//! use jostle::scene::units::Speed;
//! use jostle::scene::{Outline, Report, SceneAppExt, Section, Source, load};
//!
//! #[derive(serde::Deserialize)]
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
//!     fn check(&self, _outline: &Outline, report: &mut Report) {
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

mod cells;
mod edit;
pub(crate) mod embed;
mod error;
mod expand;
mod explain;
mod layout;
mod load;
pub(crate) mod names;
mod number;
mod outline;
mod registry;
mod report;
mod scan;
pub mod schema;
mod section;
mod source;
pub(crate) mod suggest;
mod tree;
pub mod units;
pub mod values;

pub(crate) use cells::{cells, drop_empty_ends, separator};
pub use error::{SceneError, SceneErrors};
pub(crate) use explain::read as read_value;
pub(crate) use layout::laid_out;
pub(crate) use load::found_later;
pub use load::{SceneHeader, load};
pub(crate) use number::{count, number};
pub(crate) use outline::fits;
pub use outline::{Kind, Mention, Obstacle, Outline};
pub use registry::{Arity, Known, SceneAppExt, SceneRegistry};
pub(crate) use registry::{install_word, register_embedding};
pub use report::{Problem, Report};
pub use section::{Entry, Section, Written};
pub use source::{LARGEST_SCENE, Source};
pub(crate) use suggest::nearest as nearest_name;

#[cfg(test)]
mod tests;
