//! The interface of the scene language to plugins of a Bevy app.

use std::ops::{Deref, DerefMut};

use bevy_app::App;
use bevy_ecs::resource::Resource;
use jostle_language::explain::{self, Fault};
use jostle_language::{Described, ReadEntries, ReadSection, Registry};

use super::embed::Embedding;
use super::section::{Entry, Section, WrittenEntry};
use super::{Arity, Diagnostics, Outline};

/// The names of the scene language and their readers. Plugins fill it through [`SceneAppExt`] before a scene is loaded.
#[derive(Resource, Clone, Default)]
pub struct SceneRegistry(Registry<App>);

impl Deref for SceneRegistry {
    type Target = Registry<App>;

    fn deref(&self) -> &Self::Target {
        &self.0
    }
}

impl DerefMut for SceneRegistry {
    fn deref_mut(&mut self) -> &mut Self::Target {
        &mut self.0
    }
}

struct Whole<S>(S);

impl<S: Section> ReadSection<App> for Whole<S> {
    fn declare(&self, outline: &mut Outline) {
        self.0.declare(outline);
    }

    fn check(&self, outline: &Outline, report: &mut Diagnostics) {
        self.0.check(outline, report);
    }

    fn install(self: Box<Self>, outline: &Outline, app: &mut App) {
        self.0.install(outline, app);
    }
}

struct Entries<E>(Vec<WrittenEntry<E>>);

impl<E: Entry> ReadEntries<App> for Entries<E> {
    fn push(&mut self, text: &str, bracket: usize) -> Result<usize, Fault> {
        let value = explain::read(&text[bracket..]).map_err(|fault| fault.behind(bracket))?;
        self.0.push(WrittenEntry { value, text: text.to_owned() });
        Ok(self.0.len() - 1)
    }

    fn declare(&self, which: usize, outline: &mut Outline) {
        self.0[which].value.declare(outline);
    }

    fn check(&self, which: usize, outline: &Outline, report: &mut Diagnostics) {
        self.0[which].value.check(outline, report);
    }

    fn install(self: Box<Self>, outline: &Outline, app: &mut App) {
        E::install(self.0, outline, app);
    }
}

/// Installs an entry outside of any scene, with the defaults of its fields. Returns whether such an entry exists and
/// needs no field.
pub(crate) fn install_word(app: &mut App, outline: &Outline, section: &str, name: &str) -> bool {
    let registry = app.world().get_resource::<SceneRegistry>();
    let Some(entry) = registry.and_then(|registry| registry.bare_entry(section, name)) else { return false };
    entry.install(outline, app);
    true
}

/// How plugins take part in the scene language. Everything here is called from `Plugin::build`.
///
/// # Panics
/// It is a mistake of the program to register a name twice, or an entry before its section. The program then panics
/// when it starts. A reserved name may be registered later.
pub trait SceneAppExt {
    /// Lets a type read a top-level section.
    fn register_section<S: Section>(&mut self) -> &mut Self;

    /// Makes a top-level section that takes entries by their leading names. `example` is one correct use. A name such as
    /// `look.layers` is the field `layers` of the section `look`, whose type passes it over with [`Elsewhere`](super::values::Elsewhere).
    fn register_entry_section(&mut self, name: &'static str, arity: Arity, example: &'static str) -> &mut Self;

    /// Says what such a section is for, in the manual and in the schema.
    fn describe_section(&mut self, name: &'static str, meaning: &'static str) -> &mut Self;

    /// Lets a type read one kind of entry of such a section.
    fn register_entry<E: Entry>(&mut self) -> &mut Self;

    /// Keeps a section's name for later: using it is the error "not available yet".
    fn reserve_section(&mut self, name: &'static str) -> &mut Self;

    /// Keeps an entry's name for later: using it is the error "not available yet".
    fn reserve_entry(&mut self, section: &'static str, name: &'static str) -> &mut Self;

    /// Adds a word to an open list of words, such as an integrator's name to the list `"method"`.
    fn register_word(&mut self, list: &'static str, word: &'static str) -> &mut Self;

    /// Keeps a word for later: using it is the error "not available yet".
    fn reserve_word(&mut self, list: &'static str, word: &'static str) -> &mut Self;
}

/// Makes an entry known that names a file beside the scene.
pub(crate) fn register_embedding(app: &mut App, embedding: Embedding) {
    registry(app).add_embedding(embedding);
}

fn registry(app: &mut App) -> &mut SceneRegistry {
    app.init_resource::<SceneRegistry>();
    app.world_mut().resource_mut::<SceneRegistry>().into_inner()
}

impl SceneAppExt for App {
    fn register_section<S: Section>(&mut self) -> &mut Self {
        let of = Described {
            example: S::EXAMPLE,
            schema: |generator| generator.subschema_for::<S>(),
            path: std::any::type_name::<S>(),
        };
        registry(self).add_section(S::NAME, |text| Ok(Box::new(Whole(explain::read::<S>(text)?))), of);
        self
    }

    fn register_entry_section(&mut self, name: &'static str, arity: Arity, example: &'static str) -> &mut Self {
        registry(self).add_entry_section(name, arity, example);
        self
    }

    fn describe_section(&mut self, name: &'static str, meaning: &'static str) -> &mut Self {
        registry(self).describe_section(name, meaning);
        self
    }

    fn register_entry<E: Entry>(&mut self) -> &mut Self {
        let of = Described {
            example: E::EXAMPLE,
            schema: |generator| generator.subschema_for::<E>(),
            path: std::any::type_name::<E>(),
        };
        registry(self).add_entry(E::SECTION, E::NAME, || Box::new(Entries::<E>(Vec::new())), of);
        self
    }

    fn reserve_section(&mut self, name: &'static str) -> &mut Self {
        registry(self).reserve_section(name);
        self
    }

    fn reserve_entry(&mut self, section: &'static str, name: &'static str) -> &mut Self {
        registry(self).reserve_entry(section, name);
        self
    }

    fn register_word(&mut self, list: &'static str, word: &'static str) -> &mut Self {
        registry(self).add_word(list, word);
        self
    }

    fn reserve_word(&mut self, list: &'static str, word: &'static str) -> &mut Self {
        registry(self).reserve_word(list, word);
        self
    }
}
