//! Which plugin reads which name of the scene language.

use std::collections::BTreeMap;

use bevy_app::App;
use bevy_ecs::resource::Resource;

use super::embed::Embedding;
use super::explain::{self, Fault};
use super::outline::{Outline, Words, join};
use super::report::Report;
use super::schema::Describe;
use super::section::{Entry, Section, Written};

/// How many entries a section of entries takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Arity {
    /// Any number, in a list: `forces: [Drag(..), Thrust(..)]`.
    List,
    /// Any number, in a list; one that needs no field may stand without brackets: `layers: [Trails(seconds: 2), Names]`.
    Words,
    /// Exactly one: `camera: Fit(..)`.
    One,
    /// One, or the word `None`: `contacts: None`.
    OneOrNone,
}

/// A section that was read, before anything is built from it.
pub(crate) trait ReadSection: Send + Sync {
    fn declare(&self, outline: &mut Outline);
    fn check(&self, outline: &Outline, report: &mut Report);
    fn install(self: Box<Self>, outline: &Outline, app: &mut App);
}

impl<S: Section> ReadSection for S {
    fn declare(&self, outline: &mut Outline) {
        Section::declare(self, outline);
    }

    fn check(&self, outline: &Outline, report: &mut Report) {
        Section::check(self, outline, report);
    }

    fn install(self: Box<Self>, outline: &Outline, app: &mut App) {
        Section::install(*self, outline, app);
    }
}

/// All entries of one kind that were read, in the order of the file.
pub(crate) trait ReadEntries: Send + Sync {
    /// `text` is the whole entry, `bracket` where its bracket opens.
    fn push(&mut self, text: &str, bracket: usize) -> Result<usize, Fault>;
    fn declare(&self, which: usize, outline: &mut Outline);
    fn check(&self, which: usize, outline: &Outline, report: &mut Report);
    fn install(self: Box<Self>, outline: &Outline, app: &mut App);
}

struct Entries<E>(Vec<Written<E>>);

impl<E: Entry> ReadEntries for Entries<E> {
    fn push(&mut self, text: &str, bracket: usize) -> Result<usize, Fault> {
        let value = explain::read(&text[bracket..])
            .map_err(|fault| Fault { offset: fault.offset + bracket, code: fault.code })?;
        self.0.push(Written { value, text: text.to_owned() });
        Ok(self.0.len() - 1)
    }

    fn declare(&self, which: usize, outline: &mut Outline) {
        self.0[which].value.declare(outline);
    }

    fn check(&self, which: usize, outline: &Outline, report: &mut Report) {
        self.0[which].value.check(outline, report);
    }

    fn install(self: Box<Self>, outline: &Outline, app: &mut App) {
        E::install(self.0, outline, app);
    }
}

type ReadOneSection = fn(&str) -> Result<Box<dyn ReadSection>, Fault>;

#[derive(Clone)]
pub(crate) enum Reader {
    Section(ReadOneSection),
    Entries(Arity, BTreeMap<&'static str, EntryReader>),
    Reserved,
}

#[derive(Clone)]
pub(crate) struct SectionReader {
    pub(crate) reader: Reader,
    pub(crate) example: &'static str,
    /// The schema of a section that is read as a whole.
    pub(crate) describe: Describe,
    /// What a section of entries is for.
    pub(crate) meaning: &'static str,
    pub(crate) order: usize,
    origin: &'static str,
}

impl SectionReader {
    /// One that tells nothing of itself yet; its order is that of its registration.
    fn new(reader: Reader, example: &'static str) -> Self {
        Self { reader, example, describe: |_| None, meaning: "", order: 0, origin: "" }
    }
}

#[derive(Clone)]
pub(crate) struct EntryReader {
    /// Makes an empty store; none for a reserved name.
    pub(crate) make: Option<fn() -> Box<dyn ReadEntries>>,
    pub(crate) describe: Describe,
    pub(crate) example: &'static str,
    pub(crate) order: usize,
    origin: &'static str,
}

/// A section, or an entry of one, that a scene may name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Known {
    /// Its name.
    pub name: &'static str,
    /// One correct use.
    pub example: &'static str,
    /// The module of the model that reads it, such as `jostle::forces::drag`. For a section of entries what their modules
    /// have in common.
    pub origin: &'static str,
    /// Whether it is a section that takes entries by their leading names.
    pub takes_entries: bool,
}

/// The names of the scene language and who reads them. Filled by plugins through [`SceneAppExt`] before a scene is
/// loaded.
#[derive(Resource, Clone, Default)]
pub struct SceneRegistry {
    pub(crate) sections: BTreeMap<&'static str, SectionReader>,
    pub(crate) words: Words,
    /// Entries that name files beside the scene.
    pub(crate) embeddings: Vec<Embedding>,
    count: usize,
}

impl SceneRegistry {
    fn next(&mut self) -> usize {
        self.count += 1;
        self.count
    }

    fn claim(&mut self, name: &'static str, mut section: SectionReader) {
        section.order = self.next();
        if let Some(before) = self.sections.get(name) {
            let claimed = !matches!(before.reader, Reader::Reserved);
            // Two plugins with one name cannot both be right, and the scene is not to blame.
            assert!(!claimed, "the scene section `{name}` is registered twice");
        }
        self.sections.insert(name, section);
    }

    fn claim_entry(&mut self, section: &'static str, name: &'static str, entry: EntryReader) {
        let Some(SectionReader { reader: Reader::Entries(_, entries), .. }) = self.sections.get_mut(section) else {
            panic!("the entry `{name}` needs `register_entry_section(\"{section}\", ..)` first");
        };
        let before = entries.insert(name, entry);
        let claimed = before.is_some_and(|before| before.make.is_some());
        assert!(!claimed, "the entry `{name}` of `{section}` is registered twice");
    }

    /// The registered sections in the order of registration, reserved ones among them.
    pub(crate) fn readers(&self) -> Vec<(&'static str, &SectionReader)> {
        let mut list: Vec<_> = self.sections.iter().map(|(name, section)| (*name, section)).collect();
        list.sort_unstable_by_key(|(_, section)| section.order);
        list
    }

    /// The registered sections in the order of registration; reserved ones are left out, and lists of entries inside a
    /// section (`look.layers`) as well.
    pub fn sections(&self) -> Vec<Known> {
        let known = |(name, section): (&'static str, &SectionReader)| {
            let (origin, takes_entries) = match section.reader {
                Reader::Section(_) => (section.origin, false),
                Reader::Entries(..) => (shared_module(&self.entries(name)), true),
                Reader::Reserved => return None,
            };
            Some(Known { name, example: section.example, origin, takes_entries })
        };
        let outermost = self.readers().into_iter().filter(|(name, _)| !name.contains('.'));
        outermost.filter_map(known).collect()
    }

    /// The entries of a section in the order of registration; reserved ones are left out.
    pub fn entries(&self, section: &str) -> Vec<Known> {
        let Some(SectionReader { reader: Reader::Entries(_, entries), .. }) = self.sections.get(section) else {
            return Vec::new();
        };
        let mut real: Vec<_> = entries.iter().filter(|(_, entry)| entry.make.is_some()).collect();
        real.sort_unstable_by_key(|(_, entry)| entry.order);
        let known = |(&name, entry): (&&'static str, &EntryReader)| Known {
            name,
            example: entry.example,
            origin: entry.origin,
            takes_entries: false,
        };
        real.into_iter().map(known).collect()
    }

    /// The open lists of words, such as `method`.
    pub fn word_lists(&self) -> Vec<&'static str> {
        self.words.keys().copied().collect()
    }

    /// The words of an open list, in the order of the alphabet; reserved ones are left out.
    pub fn words(&self, list: &str) -> Vec<&'static str> {
        let words = self.words.get(list).into_iter().flatten();
        words.filter(|(_, available)| **available).map(|(word, _)| *word).collect()
    }
}

/// The module of a type.
fn module_of<T>() -> &'static str {
    let path = std::any::type_name::<T>();
    let end = path.find('<').unwrap_or(path.len());
    path[..end].rsplit_once("::").map_or(path, |(module, _)| module)
}

/// What the modules of entries have in common; only those of the first one's crate count, others are guests.
fn shared_module(entries: &[Known]) -> &'static str {
    let home = |entry: &Known| entry.origin.split("::").next().unwrap_or_default();
    let Some(first) = entries.first() else { return "" };
    let same_crate = entries.iter().filter(|entry| home(entry) == home(first));
    same_crate.fold(first.origin, |shared, entry| {
        let pairs = shared.split("::").zip(entry.origin.split("::"));
        let same: Vec<&str> = pairs.take_while(|(a, b)| a == b).map(|(a, _)| a).collect();
        &shared[..same.join("::").len()]
    })
}

/// Installs an entry that stands in no scene, with the defaults of its fields. Returns whether there is such an entry and
/// it needs no field.
pub(crate) fn install_word(app: &mut App, outline: &Outline, section: &str, name: &str) -> bool {
    let registry = app.world().get_resource::<SceneRegistry>();
    let found = registry.and_then(|registry| match &registry.sections.get(section)?.reader {
        Reader::Entries(_, entries) => entries.get(name)?.make,
        _ => None,
    });
    let Some(mut store) = found.map(|make| make()) else { return false };
    let read = store.push(&format!("{name}()"), name.len()).is_ok();
    if read {
        store.install(outline, app);
    }
    read
}

/// How plugins take part in the scene language. Everything here is called from `Plugin::build`.
///
/// # Panics
/// A name that is registered twice, or an entry whose section is not registered, is a mistake of the program and
/// panics when it starts. A reserved name may be registered later.
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
    registry(app).embeddings.push(embedding);
}

fn registry(app: &mut App) -> &mut SceneRegistry {
    app.init_resource::<SceneRegistry>();
    app.world_mut().resource_mut::<SceneRegistry>().into_inner()
}

impl SceneAppExt for App {
    fn register_section<S: Section>(&mut self) -> &mut Self {
        let read: ReadOneSection = |text| Ok(Box::new(explain::read::<S>(text)?));
        let section = SectionReader::new(Reader::Section(read), S::EXAMPLE);
        let section = SectionReader { describe: S::schema, origin: module_of::<S>(), ..section };
        registry(self).claim(S::NAME, section);
        self
    }

    fn register_entry_section(&mut self, name: &'static str, arity: Arity, example: &'static str) -> &mut Self {
        registry(self).claim(name, SectionReader::new(Reader::Entries(arity, BTreeMap::new()), example));
        self
    }

    fn describe_section(&mut self, name: &'static str, meaning: &'static str) -> &mut Self {
        if let Some(section) = registry(self).sections.get_mut(name) {
            section.meaning = meaning;
        }
        self
    }

    fn register_entry<E: Entry>(&mut self) -> &mut Self {
        let registry = registry(self);
        let make: fn() -> Box<dyn ReadEntries> = || Box::new(Entries::<E>(Vec::new()));
        let order = registry.next();
        let (describe, example, origin): (Describe, _, _) = (E::schema, E::EXAMPLE, module_of::<E>());
        registry.claim_entry(E::SECTION, E::NAME, EntryReader { make: Some(make), describe, example, order, origin });
        self
    }

    fn reserve_section(&mut self, name: &'static str) -> &mut Self {
        let registry = registry(self);
        if !registry.sections.contains_key(name) {
            registry.claim(name, SectionReader::new(Reader::Reserved, ""));
        }
        self
    }

    fn reserve_entry(&mut self, section: &'static str, name: &'static str) -> &mut Self {
        let registry = registry(self);
        let order = registry.next();
        let entry = EntryReader { make: None, describe: |_| None, example: "", order, origin: "" };
        registry.claim_entry(section, name, entry);
        self
    }

    fn register_word(&mut self, list: &'static str, word: &'static str) -> &mut Self {
        registry(self).words.entry(list).or_default().insert(word, true);
        self
    }

    fn reserve_word(&mut self, list: &'static str, word: &'static str) -> &mut Self {
        registry(self).words.entry(list).or_default().entry(word).or_insert(false);
        self
    }
}

/// Where an entry's relative paths begin.
pub(crate) fn entry_scope(section: &str, arity: Arity, index: usize) -> String {
    match arity {
        Arity::List | Arity::Words => join(section, &format!("[{index}]")),
        Arity::One | Arity::OneOrNone => section.to_owned(),
    }
}
