//! The scene language: text -> values, with every mistake at its place. It knows no ECS and no model.
//!
//! A scene is one RON file. Each top-level section and each entry of a list such as `forces` belongs to the type that was
//! registered for its name ([`Registry`]); this crate knows none of them by itself but `format`, `title` and `notes`.
//! Reading goes in five steps, and nothing is built before all of them but the last have passed:
//!
//! 1. *walk* the text: brackets, commas, double fields, numbers that are not finite;
//! 2. *read* every section with the type registered for it;
//! 3. *declare* the names it brings ([`Outline`]);
//! 4. *check* what types cannot exclude ([`Report`]);
//! 5. *install*, in the order of registration ([`Scene::install`]).
//!
//! Mistakes come with file, line, column, path, source line and remedy ([`SceneErrors`]).

mod cells;
pub mod digest;
mod edit;
pub mod embed;
mod error;
mod expand;
pub mod explain;
mod layout;
mod load;
pub mod names;
mod number;
pub mod numbers;
mod outline;
mod registry;
mod report;
mod scan;
pub mod schema;
mod source;
pub mod suggest;
mod tree;
pub mod units;
pub mod values;

pub use cells::{cells, drop_empty_ends, separator};
pub use error::{SceneError, SceneErrors};
pub use expand::{Formula, Mistake};
pub use explain::read as read_value;
pub use layout::laid_out;
pub use load::{Scene, SceneHeader};
pub use number::{count, number};
pub use outline::{Kind, Mention, Obstacle, Outline, fits};
pub use registry::{Arity, Described, Known, MakeEntries, ReadEntries, ReadOneSection, ReadSection, Registry};
pub use report::{Problem, Report};
pub use source::{LARGEST_SCENE, Source};
pub use suggest::nearest as nearest_name;
