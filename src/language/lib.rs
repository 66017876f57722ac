//! The scene language: from text to values, with the place of every mistake. It depends on no ECS and no model.
//!
//! A scene is one RON file. Each top-level section belongs to the type that is registered for its name ([`Registry`]).
//! So does each entry of a list such as `forces`. This crate itself reads only `format`, `title` and `notes`. Reading
//! takes five steps, and the last one builds the scene if all others passed:
//!
//! 1. *walk* the text: brackets, commas, duplicate fields, and numbers that are NaN or infinite;
//! 2. *read* every section with the type registered for it;
//! 3. *declare* the names of each section ([`Outline`]);
//! 4. *check* the rules that types cannot express ([`Diagnostics`]);
//! 5. *install*, in the order of registration ([`Scene::install`]).
//!
//! Mistakes come with file, line, column, path, source line and remedy ([`SceneErrors`]).

mod delimited;
mod diagnostics;
pub mod digest;
mod edit;
pub mod embed;
mod error;
pub mod explain;
mod format;
mod hidden;
mod lexer;
mod load;
mod macros;
pub mod name_series;
mod number;
pub mod numbers;
mod outline;
mod registry;
pub mod schema;
mod source;
pub mod suggest;
mod syntax;
pub mod units;
pub mod values;

pub use delimited::{cells, drop_empty_ends, separator};
pub use diagnostics::{Diagnostic, Diagnostics};
pub use error::{SceneError, SceneErrors};
pub use explain::read as read_value;
pub use format::formatted;
pub use hidden::{is_hidden, visible, visible_json, visible_line};
pub use load::{Scene, SceneHeader};
pub use macros::{Formula, Mistake};
pub use number::{count, exact, number};
pub use outline::{Mention, NameKind, Obstacle, Outline, fits};
pub use registry::{Arity, Described, MakeEntries, ReadEntries, ReadOneSection, ReadSection, RegisteredName, Registry};
pub use source::{LARGEST_SCENE, Source};
pub use suggest::nearest as nearest_name;
