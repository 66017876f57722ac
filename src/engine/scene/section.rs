//! Registration of a name of the scene language by a plugin. It is a top-level section (`gravity: ..`) or an entry of a
//! section that takes several kinds (`forces: [Drag(..)]`, `contacts: Penalty(..)`).

use bevy_app::App;
use schemars::JsonSchema;
use serde::de::DeserializeOwned;

use super::{Diagnostics, Outline};

/// A top-level section of the scene, `name: value`.
///
/// The type determines the form of the value. A struct with named fields is `(a: 1, b: 2)`, and a newtype of a `Vec` is
/// `[..]`. Give every struct and enum in it `#[serde(deny_unknown_fields)]`, and use the quantities of
/// [`units`](super::units) for numbers with units. Do not use `flatten` or `untagged`, because they lose places and
/// words. Its `JsonSchema` gives `jostle schema` and the manual their fields. Doc comments are the meanings.
pub trait Section: DeserializeOwned + JsonSchema + Send + Sync + 'static {
    /// The name in scenes.
    const NAME: &'static str;
    /// One correct use, shown in error messages and in the manual.
    const EXAMPLE: &'static str;

    /// Tells the outline which names (bodies, walls, materials ...) this section brings. Sections declare in the order
    /// of the file. Paths are relative to the section.
    fn declare(&self, _outline: &mut Outline) {}

    /// Reports every mistake that the types alone cannot exclude; paths are relative to the section.
    fn check(&self, _outline: &Outline, _report: &mut Diagnostics) {}

    /// Turns the section into entities, resources and systems. Called only when nothing was reported; sections and
    /// entries are installed in the order of their registration.
    fn install(self, outline: &Outline, app: &mut App);
}

/// One kind of entry of a section that takes several kinds.
pub trait Entry: DeserializeOwned + JsonSchema + Send + Sync + 'static {
    /// Its section, for example `"forces"`.
    const SECTION: &'static str;
    /// Its leading name, for example `"Drag"`. The type reads the content of the brackets after it.
    const NAME: &'static str;
    /// One correct use, shown in error messages and in the manual.
    const EXAMPLE: &'static str;

    /// Tells the outline which names this entry brings.
    fn declare(&self, _outline: &mut Outline) {}

    /// Reports every mistake that the types alone cannot exclude; paths are relative to the entry.
    fn check(&self, _outline: &Outline, _report: &mut Diagnostics) {}

    /// Installs all entries of this kind at once, in the order of the file. `texts` are the entries as they were
    /// written. Called only when nothing was reported.
    fn install(entries: Vec<WrittenEntry<Self>>, outline: &Outline, app: &mut App);
}

/// An entry together with its text in the scene.
pub struct WrittenEntry<T> {
    /// The entry.
    pub value: T,
    /// Its text in the file, without comments at both ends.
    pub text: String,
}
