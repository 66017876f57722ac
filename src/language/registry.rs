//! The registry of the scene language: the type that reads each name, and the target into which it is built.
//!
//! The language does not fix that target. It is the parameter `A` here, and a Bevy app in the engine.

use std::collections::BTreeMap;

use super::diagnostics::Diagnostics;
use super::embed::Embedding;
use super::explain::Fault;
use super::outline::{Outline, Words, join};
use super::schema::Describe;

/// How many entries a section of entries takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Arity {
    /// Any number, in a list: `forces: [Drag(..), Thrust(..)]`.
    List,
    /// Any number of entries in a list. An entry that needs no field may omit its brackets: `layers: [Trails(seconds:
    /// 2), Names]`.
    Words,
    /// Exactly one: `camera: Fit(..)`.
    One,
    /// One, or the word `None`: `contacts: None`.
    OneOrNone,
}

/// A section that was read, before anything is built from it.
pub trait ReadSection<A>: Send + Sync {
    /// Tells the outline which names it brings.
    fn declare(&self, outline: &mut Outline);
    /// Reports what types cannot exclude.
    fn check(&self, outline: &Outline, report: &mut Diagnostics);
    /// Builds the section.
    fn install(self: Box<Self>, outline: &Outline, into: &mut A);
}

/// All entries of one kind that were read, in the order of the file.
pub trait ReadEntries<A>: Send + Sync {
    /// Reads one more and returns its index. `text` is the whole entry, `bracket` where its bracket opens.
    ///
    /// # Errors
    /// The [`Fault`] of an entry that is not written as it should be.
    fn push(&mut self, text: &str, bracket: usize) -> Result<usize, Fault>;
    /// Tells the outline which names an entry brings.
    fn declare(&self, which: usize, outline: &mut Outline);
    /// Reports what types cannot exclude in an entry.
    fn check(&self, which: usize, outline: &Outline, report: &mut Diagnostics);
    /// Builds what all of them ask for.
    fn install(self: Box<Self>, outline: &Outline, into: &mut A);
}

/// Reads the text of a section.
pub type ReadOneSection<A> = fn(&str) -> Result<Box<dyn ReadSection<A>>, Fault>;

/// Makes an empty list of entries of one kind.
pub type MakeEntries<A> = fn() -> Box<dyn ReadEntries<A>>;

pub(crate) enum Reader<A> {
    /// A section that is read as a whole, and its schema.
    Section(ReadOneSection<A>, Describe),
    Entries(Arity, BTreeMap<&'static str, EntryReader<A>>),
    Reserved,
}

impl<A> Clone for Reader<A> {
    fn clone(&self) -> Self {
        match self {
            Self::Section(read, schema) => Self::Section(*read, *schema),
            Self::Entries(arity, entries) => Self::Entries(*arity, entries.clone()),
            Self::Reserved => Self::Reserved,
        }
    }
}

pub(crate) struct SectionReader<A> {
    pub(crate) reader: Reader<A>,
    pub(crate) example: &'static str,
    /// The purpose of a section of entries.
    pub(crate) meaning: &'static str,
    pub(crate) order: usize,
    origin: &'static str,
}

impl<A> Clone for SectionReader<A> {
    fn clone(&self) -> Self {
        Self { reader: self.reader.clone(), ..*self }
    }
}

impl<A> SectionReader<A> {
    /// A description without details; its order is that of the registration.
    fn new(reader: Reader<A>, example: &'static str) -> Self {
        Self { reader, example, meaning: "", order: 0, origin: "" }
    }
}

pub(crate) struct EntryReader<A> {
    /// Makes an empty store; `None` for a reserved name.
    pub(crate) make: Option<MakeEntries<A>>,
    pub(crate) describe: Describe,
    pub(crate) example: &'static str,
    pub(crate) order: usize,
    origin: &'static str,
}

impl<A> Clone for EntryReader<A> {
    fn clone(&self) -> Self {
        Self { ..*self }
    }
}

/// The description of a type that reads a section or an entry.
#[derive(Clone, Copy)]
pub struct Described {
    /// One correct use.
    pub example: &'static str,
    /// Its schema.
    pub schema: Describe,
    /// The path of the type, as [`std::any::type_name`] gives it.
    pub path: &'static str,
}

/// A section, or an entry of one, that a scene may name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RegisteredName {
    /// Its name.
    pub name: &'static str,
    /// One correct use.
    pub example: &'static str,
    /// The module of the model that reads it, such as `jostle::forces::drag`. For a section of entries it is the common
    /// part of their modules.
    pub origin: &'static str,
    /// Whether it is a section that takes entries by their leading names.
    pub takes_entries: bool,
}

/// The names of the scene language and their readers, which are registered before a scene is read.
pub struct Registry<A> {
    pub(crate) sections: BTreeMap<&'static str, SectionReader<A>>,
    pub(crate) words: Words,
    /// Entries that name files beside the scene.
    pub(crate) embeddings: Vec<Embedding>,
    count: usize,
}

impl<A> Clone for Registry<A> {
    fn clone(&self) -> Self {
        let Self { sections, words, embeddings, count } = self;
        Self { sections: sections.clone(), words: words.clone(), embeddings: embeddings.clone(), count: *count }
    }
}

impl<A> Default for Registry<A> {
    fn default() -> Self {
        Self { sections: BTreeMap::new(), words: Words::new(), embeddings: Vec::new(), count: 0 }
    }
}

/// The registration of names.
///
/// # Panics
/// It is a mistake of the program to register a name twice, or an entry before its section. The program then panics
/// when it starts. A reserved name may be registered later.
impl<A> Registry<A> {
    /// Lets a type read a top-level section.
    pub fn add_section(&mut self, name: &'static str, read: ReadOneSection<A>, of: Described) {
        let section = SectionReader::new(Reader::Section(read, of.schema), of.example);
        self.claim(name, SectionReader { origin: module(of.path), ..section });
    }

    /// Makes a top-level section that takes entries by their leading names.
    pub fn add_entry_section(&mut self, name: &'static str, arity: Arity, example: &'static str) {
        self.claim(name, SectionReader::new(Reader::Entries(arity, BTreeMap::new()), example));
    }

    /// Says what such a section is for.
    pub fn describe_section(&mut self, name: &'static str, meaning: &'static str) {
        if let Some(section) = self.sections.get_mut(name) {
            section.meaning = meaning;
        }
    }

    /// Lets a type read one kind of entry of such a section.
    pub fn add_entry(&mut self, section: &'static str, name: &'static str, make: MakeEntries<A>, of: Described) {
        let order = self.next();
        let Described { example, schema, path } = of;
        let entry = EntryReader { make: Some(make), describe: schema, example, order, origin: module(path) };
        self.claim_entry(section, name, entry);
    }

    /// Keeps a section's name for later.
    pub fn reserve_section(&mut self, name: &'static str) {
        if !self.sections.contains_key(name) {
            self.claim(name, SectionReader::new(Reader::Reserved, ""));
        }
    }

    /// Keeps an entry's name for later.
    pub fn reserve_entry(&mut self, section: &'static str, name: &'static str) {
        let order = self.next();
        let entry = EntryReader { make: None, describe: |_| false.into(), example: "", order, origin: "" };
        self.claim_entry(section, name, entry);
    }

    /// Adds a word to an open list of words.
    pub fn add_word(&mut self, list: &'static str, word: &'static str) {
        self.words.entry(list).or_default().insert(word, true);
    }

    /// Keeps a word for later.
    pub fn reserve_word(&mut self, list: &'static str, word: &'static str) {
        self.words.entry(list).or_default().entry(word).or_insert(false);
    }

    /// Makes an entry known that names a file beside the scene.
    pub fn add_embedding(&mut self, embedding: Embedding) {
        self.embeddings.push(embedding);
    }

    /// An entry outside of any scene, with the defaults of its fields. `None` if there is no such entry, or if it needs
    /// a field.
    pub fn bare_entry(&self, section: &str, name: &str) -> Option<Box<dyn ReadEntries<A>>> {
        let Reader::Entries(_, entries) = &self.sections.get(section)?.reader else { return None };
        let mut store = entries.get(name)?.make?();
        store.push(&format!("{name}()"), name.len()).is_ok().then_some(store)
    }

    fn next(&mut self) -> usize {
        self.count += 1;
        self.count
    }

    fn claim(&mut self, name: &'static str, mut section: SectionReader<A>) {
        section.order = self.next();
        if let Some(before) = self.sections.get(name) {
            let claimed = !matches!(before.reader, Reader::Reserved);
            // Two plugins with one name cannot both be right, and the scene is not to blame.
            assert!(!claimed, "the scene section `{name}` is registered twice");
        }
        self.sections.insert(name, section);
    }

    fn claim_entry(&mut self, section: &'static str, name: &'static str, entry: EntryReader<A>) {
        let Some(SectionReader { reader: Reader::Entries(_, entries), .. }) = self.sections.get_mut(section) else {
            panic!("the entry `{name}` needs `register_entry_section(\"{section}\", ..)` first");
        };
        let before = entries.insert(name, entry);
        let claimed = before.is_some_and(|before| before.make.is_some());
        assert!(!claimed, "the entry `{name}` of `{section}` is registered twice");
    }

    /// The registered sections in the order of registration, reserved ones among them.
    pub(crate) fn readers(&self) -> Vec<(&'static str, &SectionReader<A>)> {
        let mut list: Vec<_> = self.sections.iter().map(|(name, section)| (*name, section)).collect();
        list.sort_unstable_by_key(|(_, section)| section.order);
        list
    }

    /// The registered sections in the order of registration. Reserved sections and lists of entries inside a section
    /// (`look.layers`) are left out.
    pub fn sections(&self) -> Vec<RegisteredName> {
        let known = |(name, section): (&'static str, &SectionReader<A>)| {
            let (origin, takes_entries) = match section.reader {
                Reader::Section(..) => (section.origin, false),
                Reader::Entries(..) => (shared_module(&self.entries(name)), true),
                Reader::Reserved => return None,
            };
            Some(RegisteredName { name, example: section.example, origin, takes_entries })
        };
        let outermost = self.readers().into_iter().filter(|(name, _)| !name.contains('.'));
        outermost.filter_map(known).collect()
    }

    /// The entries of a section in the order of registration; reserved ones are left out.
    pub fn entries(&self, section: &str) -> Vec<RegisteredName> {
        let Some(SectionReader { reader: Reader::Entries(_, entries), .. }) = self.sections.get(section) else {
            return Vec::new();
        };
        let mut real: Vec<_> = entries.iter().filter(|(_, entry)| entry.make.is_some()).collect();
        real.sort_unstable_by_key(|(_, entry)| entry.order);
        let known = |(&name, entry): (&&'static str, &EntryReader<A>)| RegisteredName {
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
fn module(path: &'static str) -> &'static str {
    let end = path.find('<').unwrap_or(path.len());
    path[..end].rsplit_once("::").map_or(path, |(module, _)| module)
}

/// The common part of the modules of entries. Only the crate of the first entry counts, because the others are guests.
fn shared_module(entries: &[RegisteredName]) -> &'static str {
    let home = |entry: &RegisteredName| entry.origin.split("::").next().unwrap_or_default();
    let Some(first) = entries.first() else { return "" };
    let same_crate = entries.iter().filter(|entry| home(entry) == home(first));
    same_crate.fold(first.origin, |shared, entry| {
        let pairs = shared.split("::").zip(entry.origin.split("::"));
        let same: Vec<&str> = pairs.take_while(|(a, b)| a == b).map(|(a, _)| a).collect();
        &shared[..same.join("::").len()]
    })
}

/// The prefix of the relative paths of an entry.
pub(crate) fn entry_scope(section: &str, arity: Arity, index: usize) -> String {
    match arity {
        Arity::List | Arity::Words => join(section, &format!("[{index}]")),
        Arity::One | Arity::OneOrNone => section.to_owned(),
    }
}
