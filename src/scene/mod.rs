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

mod error;
mod explain;
mod load;
mod outline;
mod registry;
mod report;
mod scan;
mod section;
pub mod sections;
mod source;
mod suggest;
mod tree;
pub mod units;
pub mod values;

pub use error::{SceneError, SceneErrors};
pub use load::{SceneHeader, load};
pub use outline::{Kind, Mention, Obstacle, Outline};
pub use registry::{Arity, SceneAppExt, SceneRegistry};
pub use report::{Problem, Report};
pub use section::{Entry, Section, Written};
pub use source::{LARGEST_SCENE, Source};

#[cfg(test)]
mod tests;
