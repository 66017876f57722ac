//! From the text of a scene to the finished world: walk, read, declare, check, install.

use std::collections::BTreeMap;
use std::path::PathBuf;

use super::diagnostics::{Diagnostic, Diagnostics};
use super::error::{SceneError, SceneErrors};
use super::explain::{self, Walked, Wanted};
use super::lexer::{lex, skip_blank};
use super::macros::{self, Tables};
use super::outline::{Mention, NameKind, Outline};
use super::registry::{Arity, ReadEntries, ReadSection, Reader, Registry, entry_scope};
use super::source::{LARGEST_SCENE, Source};
use super::suggest;
use super::syntax::{Form, Id, Tree};
use super::values::WholeNumber;
use crate::digest;

const SMALLEST: &str = "the smallest scene is `Scene(format: 1, clock: (duration: 1), bodies: [(name: \"ball\", at: (0, 0), atoms: Disc(radius: 0.1))])`";
/// More mistakes than this are not looked up in the text.
const MOST_PROBLEMS: usize = 1000;
/// The longest title of a scene, in bytes.
const LONGEST_TITLE: usize = 1000;

/// The title and notes of a scene, and the names that it declares.
#[derive(Clone, Debug, Default)]
pub struct SceneHeader {
    /// The version of the scene language; always 1 so far.
    pub format: u64,
    /// The title, shown in the film's corner and on the card.
    pub title: Option<String>,
    /// The author's words on what to look for.
    pub notes: Option<String>,
    /// Remarks of the checks. The run's error card shows them.
    pub remarks: Vec<String>,
    /// The names, sections and entries of the scene.
    pub outline: Outline,
    /// A number for the text of the scene with all that it includes: the same for the same scene.
    pub digest: u64,
    /// The files that were read for the scene, without its own: included ones, pictures, tables.
    pub files: Vec<PathBuf>,
}

/// A scene that was read and holds no mistake, before anything is built from it.
pub struct Scene<A> {
    header: SceneHeader,
    sections: Vec<WholeSection<A>>,
    /// By order of registration.
    entries: BTreeMap<(usize, &'static str), Box<dyn ReadEntries<A>>>,
}

impl<A> Scene<A> {
    /// Reads a scene with the registered sections and entries.
    ///
    /// # Errors
    /// The error holds all mistakes that one reading can find. A misplaced bracket hides the rest of the text. Other
    /// mistakes hide nothing in other sections.
    pub fn read(registry: &Registry<A>, source: &Source) -> Result<Self, SceneErrors> {
        let embeddings = &registry.embeddings;
        if source.text.len() > LARGEST_SCENE {
            let message = format!("the scene is too large: the limit is {} MiB", LARGEST_SCENE >> 20);
            let error = SceneError::new("", message).with_help("many bodies are shorter with `fill`");
            return Err(SceneErrors::new(Source::new(source.name.clone(), ""), vec![error], Vec::new()));
        }
        let found = lex(&source.text);
        if let Some(fault) = found.fault {
            return Err(SceneErrors::new(source.clone(), vec![fault], Vec::new()));
        }
        if !macros::is_wanted(source, &found.tree, embeddings) {
            return read_text(registry, &source.text, &found.tree, found.errors, Tables::new())
                .map_err(|(errors, notes)| SceneErrors::new(source.clone(), errors, notes));
        }
        let mut expanded = macros::expand(source, found, embeddings)?;
        let tables = std::mem::take(&mut expanded.tables);
        let mut found = lex(&expanded.text);
        if let Some(fault) = found.fault.take() {
            return Err(expanded.told(&found.tree, vec![fault], Vec::new()));
        }
        let mut scene = read_text(registry, &expanded.text, &found.tree, found.errors, tables)
            .map_err(|(errors, notes)| expanded.told(&found.tree, errors, notes))?;
        scene.header.remarks.splice(0..0, expanded.notes.iter().cloned());
        scene.header.files = expanded.opened;
        Ok(scene)
    }

    /// Builds the scene. Sections are installed in the order of their registration, whatever their order in the file.
    pub fn install(self, into: &mut A) -> SceneHeader {
        let Self { mut header, sections, entries } = self;
        let mut all: BTreeMap<usize, Built<A>> = BTreeMap::new();
        all.extend(sections.into_iter().map(|read| (read.order, Built::Section(read.section))));
        all.extend(entries.into_iter().map(|((order, _), read)| (order, Built::Entries(read))));
        for built in all.into_values() {
            match built {
                Built::Section(section) => section.install(&header.outline, into),
                Built::Entries(entries) => entries.install(&header.outline, into),
            }
        }
        header.outline.forget_places();
        header
    }
}

/// Reads a text in which nothing is left to be made.
fn read_text<A>(
    registry: &Registry<A>,
    text: &str,
    tree: &Tree,
    errors: Vec<SceneError>,
    tables: Tables,
) -> Result<Scene<A>, (Vec<SceneError>, Vec<String>)> {
    let mut loading = Loading {
        walked: Walked { text, tree },
        registry,
        errors,
        header: SceneHeader { outline: Outline::with(registry.words.clone(), tables), ..SceneHeader::default() },
        sections: Vec::new(),
        entries: BTreeMap::new(),
        order: Vec::new(),
    };
    loading.read_all();
    let report = loading.check_all();
    loading.place(report.problems());
    let Loading { errors, mut header, sections, entries, .. } = loading;
    if !errors.is_empty() {
        return Err((errors, report.notes().to_vec()));
    }
    header.remarks = report.notes().to_vec();
    header.digest = digest::of_bytes(text.bytes());
    Ok(Scene { header, sections, entries })
}

impl<A> Registry<A> {
    /// Mistakes that only turned out when the scene was put together, at their places in the text.
    pub fn found_later(&self, source: &Source, mut errors: Vec<SceneError>) -> SceneErrors {
        let embeddings = &self.embeddings;
        let mut found = lex(&source.text);
        let expanded = if macros::is_wanted(source, &found.tree, embeddings) {
            macros::expand(source, found, embeddings).ok()
        } else {
            None
        };
        let text = expanded.as_ref().map_or(&source.text, |expanded| &expanded.text);
        found = lex(text);
        for error in &mut errors {
            let is_flag = error.path.starts_with("--");
            if let Some(place) = found.tree.find(&error.path, text).filter(|_| !is_flag) {
                let (span, label) = if place.whole {
                    (found.tree.head_or_value(place.node), "this value")
                } else {
                    (found.tree.head(place.node), "in here")
                };
                *error = error.clone().at(span, label);
            }
        }
        match &expanded {
            Some(expanded) => expanded.told(&found.tree, errors, Vec::new()),
            None => SceneErrors::new(source.clone(), errors, Vec::new()),
        }
    }
}

struct WholeSection<A> {
    order: usize,
    scope: String,
    section: Box<dyn ReadSection<A>>,
}

/// A section or entry, in the order of the file.
enum Item {
    Section(usize),
    Entry { key: (usize, &'static str), which: usize, scope: String },
}

struct Loading<'a, A> {
    walked: Walked<'a>,
    registry: &'a Registry<A>,
    errors: Vec<SceneError>,
    header: SceneHeader,
    sections: Vec<WholeSection<A>>,
    /// By order of registration.
    entries: BTreeMap<(usize, &'static str), Box<dyn ReadEntries<A>>>,
    order: Vec<Item>,
}

impl<A> Loading<'_, A> {
    fn read_all(&mut self) {
        let Walked { text, tree } = self.walked;
        if tree.node(0).form != Form::Round || tree.name(0, text) != "Scene" {
            let span = tree.head_or_value(0);
            let error = SceneError::new("", format!("expected `Scene(..)`, found {}", tree.describe(0, text)));
            self.errors.push(error.at(span, "not a scene").with_help(SMALLEST));
            return;
        }
        let mut format = false;
        let mut clock = false;
        for &id in tree.children(0) {
            let key = &text[tree.key(id)];
            match key {
                "" => {
                    let error = SceneError::new("", format!("expected a section, found {}", tree.describe(id, text)));
                    let help = "a scene is made of sections such as `clock: (duration: 1)`";
                    self.errors.push(error.at(tree.head_or_value(id), "no section name").with_help(help));
                }
                "format" => {
                    format = true;
                    self.format(id);
                }
                "title" => self.title(id),
                "notes" => self.header.notes = self.read(id, "notes: \"Look at the second ball.\""),
                name => {
                    clock |= name == "clock";
                    self.section(name, id);
                }
            }
        }
        for (there, name, help) in [
            (format, "format", "every scene says which version of the language it is in: write `format: 1`"),
            (clock, "clock", "say how long to simulate: write `clock: (duration: 20)`"),
        ] {
            if !there {
                let error = SceneError::new("", format!("the section `{name}` is missing"));
                self.errors.push(error.at(tree.head(0), format!("no `{name}` in here")).with_help(help));
            }
        }
    }

    fn read<T: serde::de::DeserializeOwned>(&mut self, id: Id, example: &str) -> Option<T> {
        let Walked { text, tree } = self.walked;
        let span = tree.span(id);
        match explain::read(&text[span.clone()]) {
            Ok(value) => Some(value),
            Err(fault) => {
                let wanted = Wanted { node: id, example, describe: |_| true.into() };
                self.errors.push(self.walked.explain(&fault.code, span.start + fault.offset, wanted));
                None
            }
        }
    }

    fn title(&mut self, id: Id) {
        self.header.title = self.read(id, "title: \"Five balls\"");
        let length = self.header.title.as_ref().map_or(0, String::len);
        if length > LONGEST_TITLE {
            let message = format!("a title of {length} bytes is too long: {LONGEST_TITLE} are allowed");
            let error = SceneError::new("title", message).at(self.walked.tree.span(id), "this title");
            self.errors
                .push(error.with_help("a title is one line of the film; longer texts have their place in `notes`"));
        }
    }

    fn format(&mut self, id: Id) {
        let Some(WholeNumber(format)) = self.read(id, "format: 1") else { return };
        self.header.format = format;
        if format != 1 {
            let error = SceneError::new("format", format!("must be 1, got {format}"));
            let help = "this program reads scenes of format 1 only; a newer format needs a newer program";
            self.errors.push(error.at(self.walked.tree.span(id), "not 1").with_help(help));
        }
    }

    fn section(&mut self, name: &str, id: Id) {
        let Walked { text, tree } = self.walked;
        let registry = self.registry;
        let Some((_, known)) = registry.sections.get_key_value(name) else {
            let help = {
                let real = registry.sections.iter().filter(|(_, section)| !matches!(section.reader, Reader::Reserved));
                let real = real.map(|(name, _)| *name).filter(|name| !name.contains('.'));
                let names = ["format", "title", "notes"].into_iter().chain(macros::SECTIONS).chain(real);
                suggest::among(name, names.collect::<Vec<_>>().into_iter(), "sections", '`')
            };
            let error = SceneError::new("", format!("there is no section `{name}`"));
            self.errors.push(error.at(tree.key(id), "unknown section").with_help(help));
            return;
        };
        match &known.reader {
            Reader::Reserved => {
                let error = SceneError::new("", format!("the section `{name}` is not available yet"));
                let help = "the name is reserved for a later version; remove the section";
                self.errors.push(error.at(tree.key(id), "not available yet").with_help(help));
            }
            Reader::Section(read, describe) => {
                let span = tree.span(id);
                match read(&text[span.clone()]) {
                    Ok(section) => {
                        self.header.outline.add_section(name, false);
                        self.order.push(Item::Section(self.sections.len()));
                        self.sections.push(WholeSection { order: known.order, scope: name.to_owned(), section });
                        self.lists_inside(name, id);
                    }
                    Err(fault) => {
                        let wanted = Wanted { node: id, example: known.example, describe: *describe };
                        self.errors.push(self.walked.explain(&fault.code, span.start + fault.offset, wanted));
                    }
                }
            }
            Reader::Entries(arity, _) => self.entries_of(name, id, *arity),
        }
    }

    /// Reads the fields of a section that are lists of entries.
    fn lists_inside(&mut self, section: &str, id: Id) {
        let Walked { text, tree } = self.walked;
        for &field in tree.children(id) {
            let name = format!("{section}.{}", &text[tree.key(field)]);
            if let Some(Reader::Entries(arity, _)) = self.registry.sections.get(&*name).map(|known| &known.reader) {
                self.entries_of(&name, field, *arity);
            }
        }
    }

    fn entries_of(&mut self, section: &str, id: Id, arity: Arity) {
        let Walked { text, tree } = self.walked;
        let registry = self.registry;
        let Some(known) = registry.sections.get(section) else { return };
        let none = arity == Arity::OneOrNone && &text[tree.span(id)] == "None";
        self.header.outline.add_section(section, none);
        if none {
            return;
        }
        if !matches!(arity, Arity::List | Arity::Words) {
            self.entry(section, id, entry_scope(section, arity, 0));
            return;
        }
        if tree.node(id).form != Form::List {
            let message = format!("expected a list `[..]`, found {}", tree.describe(id, text));
            let error = SceneError::new(section, message).at(tree.head_or_value(id), "not a list");
            self.errors.push(error.with_help(format!("for example: {}", known.example)));
            return;
        }
        for (index, &item) in tree.children(id).iter().enumerate() {
            self.entry(section, item, entry_scope(section, arity, index));
        }
    }

    fn entry(&mut self, section: &str, id: Id, scope: String) {
        let Walked { text, tree } = self.walked;
        let registry = self.registry;
        let Some(super::registry::SectionReader { reader: Reader::Entries(arity, known), example, .. }) =
            registry.sections.get(section)
        else {
            return;
        };
        let span = tree.span(id);
        let name = match tree.node(id).form {
            Form::Word => &text[span.clone()],
            _ => tree.name(id, text),
        };
        let names = || known.iter().filter(|(_, entry)| entry.make.is_some()).map(|(name, _)| *name);
        if name.is_empty() {
            let found = tree.describe(id, text);
            let error = SceneError::new(scope, format!("expected an entry with a leading name, found {found}"));
            let help = if names().next().is_some() {
                format!("for example: {example}; entries: {}", list(names()))
            } else {
                format!("for example: {example}")
            };
            self.errors.push(error.at(tree.head_or_value(id), "no name").with_help(help));
            return;
        }
        let head = span.start..span.start + name.len();
        let Some((key, entry)) = known.get_key_value(name) else {
            let error = SceneError::new(scope, format!("`{section}` has no entry `{name}`"));
            let help = suggest::among(name, names().collect::<Vec<_>>().into_iter(), "entries", '`');
            self.errors.push(error.at(head, "unknown entry").with_help(help));
            return;
        };
        let Some(make) = entry.make else {
            let error = SceneError::new(scope, format!("`{name}` is not available yet"));
            let help = "the name is reserved for a later version; remove the entry";
            self.errors.push(error.at(head, "not available yet").with_help(help));
            return;
        };
        let bare = tree.node(id).form == Form::Word;
        let without_brackets = || {
            let error = SceneError::new(scope.clone(), format!("brackets are missing after `{name}`"));
            let help = format!("for example: {}", entry.example);
            error.at(head.clone(), "`(..)` expected after this").with_help(help)
        };
        if bare && *arity != Arity::Words {
            self.errors.push(without_brackets());
            return;
        }
        let written = if bare { format!("{name}()") } else { text[span.clone()].to_owned() };
        // Only the text in the brackets is read, because the name of the type does not matter.
        let bracket = skip_blank(text, head.end).map_or(0, |at| at - span.start);
        let store = self.entries.entry((entry.order, key)).or_insert_with(make);
        match store.push(&written, if bare { name.len() } else { bracket }) {
            Ok(which) => {
                let mention = Mention { name: name.to_owned(), path: scope.clone(), text: written };
                self.header.outline.add_entry(section, mention);
                self.order.push(Item::Entry { key: (entry.order, key), which, scope });
            }
            Err(_) if bare => self.errors.push(without_brackets()),
            Err(fault) => {
                let wanted = Wanted { node: id, example: entry.example, describe: entry.describe };
                self.errors.push(self.walked.explain(&fault.code, span.start + fault.offset, wanted));
            }
        }
    }

    /// Names first, in the order of the file, so that every check sees all of them.
    fn check_all(&mut self) -> Diagnostics {
        let outline = &mut self.header.outline;
        outline.complete = self.errors.iter().all(|error| error.label == "not finite");
        for item in &self.order {
            match item {
                Item::Section(index) => {
                    let read = &self.sections[*index];
                    outline.scope.clone_from(&read.scope);
                    read.section.declare(outline);
                }
                Item::Entry { key, which, scope } => {
                    outline.scope.clone_from(scope);
                    if let Some(read) = self.entries.get(key) {
                        read.declare(*which, outline);
                    }
                }
            }
        }
        let mut report = std::mem::take(&mut outline.report);
        for item in &self.order {
            match item {
                Item::Section(index) => {
                    let read = &self.sections[*index];
                    report.within(&read.scope, |report| read.section.check(outline, report));
                }
                Item::Entry { key, which, scope } => {
                    if let Some(read) = self.entries.get(key) {
                        report.within(scope, |report| read.check(*which, outline, report));
                    }
                }
            }
        }
        if outline.complete && report.is_clean() && outline.count(NameKind::BODY) == 0 {
            report.error("", "the scene has no bodies").help(SMALLEST);
        }
        report
    }

    /// Finds the places in the text for the mistakes of the checks.
    fn place(&mut self, problems: &[Diagnostic]) {
        let (told, counted) = problems.split_at(problems.len().min(MOST_PROBLEMS));
        self.errors.extend(told.iter().map(|problem| placed(&self.walked, problem)));
        if let Some(next) = counted.first() {
            let message = format!("the checks found {} more mistakes, the first of them here", counted.len());
            self.errors.push(SceneError { message, help: None, ..placed(&self.walked, next) });
        }
    }
}

fn placed(Walked { text, tree }: &Walked, problem: &Diagnostic) -> SceneError {
    let mut error = SceneError::new(problem.path.clone(), problem.message.clone());
    error.help.clone_from(&problem.help);
    if let Some(place) = tree.find(&problem.path, text) {
        let (span, label) = match &problem.missing {
            Some(field) => (tree.head(place.node), format!("`{field}: ..` is missing in here")),
            None if !place.whole || place.node == 0 => (tree.head(place.node), "in here".to_owned()),
            None if problem.also.is_some() => (tree.head_or_value(place.node), "here again".to_owned()),
            None => (tree.head_or_value(place.node), "this value".to_owned()),
        };
        error = error.at(span, label);
    }
    if let Some((path, label)) = &problem.also
        && let Some(place) = tree.find(path, text)
    {
        error = error.also(tree.head_or_value(place.node), label);
    }
    error
}

fn list<'a>(names: impl Iterator<Item = &'a str>) -> String {
    names.map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ")
}

enum Built<A> {
    Section(Box<dyn ReadSection<A>>),
    Entries(Box<dyn ReadEntries<A>>),
}
