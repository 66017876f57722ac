//! Macros of the scene language: `params`, `templates`, `instances`, `include` and `Repeat` are replaced before any
//! section is read. Pictures (`Png`) become discs, and tables (`Csv`) become points. Tables of `packings` are read too,
//! and stand beside the text.
//!
//! So every section, also one of a plugin, gets all of this without extra code. Each piece of the made text keeps its
//! source: the file, and the instances and repetitions on the way. Mistakes are reported where the author has to
//! correct them. A scene that uses nothing of it is not touched.

mod beside;
mod door;
mod emit;
mod expansion;
mod expression;
mod formula;
mod heights;
mod include;
mod instance;
mod overrides;
mod quantity;
mod repeat;
mod scope;
mod source_map;
mod table_file;

use std::any::Any;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::rc::Rc;
use std::sync::Arc;

use super::embed::{Embed, Embedding};
use super::error::{Mark, SceneError, SceneErrors};
use super::lexer::{Lexed, lex};
use super::source::{LARGEST_SCENE, Source};
use super::suggest;
use super::syntax::{Form, Id, Tree};
pub use door::{Door, FileRequest, told};
use emit::{Context, Place};
use expansion::{Buffer, Merged};
pub use formula::{Formula, Mistake};
use instance::Template;
use scope::Scope;

/// The sections that are replaced by their results.
pub(super) const SECTIONS: [&str; 4] = ["include", "params", "templates", "instances"];
/// At most this many things from repetitions and instances. Each is a text that is read; `fill` and `packings` make
/// more.
const MOST_MADE: u64 = 200_000;
/// The greatest work of making, about in bytes that it copies: some seconds, and some 100 MiB.
const MOST_WORK: usize = 8 * LARGEST_SCENE;
/// Templates in templates, files in files: this deep.
const DEEPEST: u32 = 32;
/// A scene is made of at most this many files.
const MOST_FILES: usize = 1000;
/// More mistakes than this are not looked for.
const MOST_ERRORS: usize = 50;

/// The contents of files beside the scene, by their keys in the text.
pub(super) type Tables = BTreeMap<u64, Arc<dyn Any + Send + Sync>>;
/// An entry that names files, with what reads them.
type Reader = (Embedding, Box<dyn Embed>);
type Outcome<T> = Result<T, Box<SceneError>>;

/// A file with its tree.
struct File {
    /// Its number among the files of the scene; the scene itself is 0.
    number: usize,
    source: Source,
    tree: Tree,
    /// Of each value, whether nothing in it can change.
    plain: Vec<bool>,
}

/// Through what something came to be.
#[derive(Clone, Debug)]
enum Cause {
    Instance { name: String, template: String },
    Repetition { names: Rc<[String]>, i: u64, j: Option<u64> },
    Included,
}

/// One step on the way from the scene to a made thing. Step 0 is the scene itself.
#[derive(Clone, Debug)]
struct Step {
    before: u32,
    depth: u32,
    file: usize,
    at: (u32, u32),
    cause: Option<Cause>,
}

/// A scene with everything made, and where each piece of it comes from.
pub(super) struct Expanded {
    pub(super) text: String,
    pub(super) notes: Vec<String>,
    pub(super) tables: Tables,
    /// The files that were read.
    pub(super) opened: Vec<PathBuf>,
    files: Vec<Rc<File>>,
    steps: Vec<Step>,
    pieces: Vec<expansion::Piece>,
    /// The reason for which a text is no expression, by file and place.
    reasons: BTreeMap<(usize, usize), SceneError>,
}

/// Whether there is anything to be made.
pub(super) fn is_wanted(source: &Source, tree: &Tree, embeddings: &[Embedding]) -> bool {
    if tree.node(0).form != Form::Round || tree.name(0, &source.text) != "Scene" {
        return false;
    }
    let mut sections = tree.children(0).iter().map(|&id| &source.text[tree.key(id)]);
    !source.settings.is_empty()
        || sections.any(|name| SECTIONS.contains(&name) || embeddings.iter().any(|known| known.name == name))
        || source.text.contains("Repeat")
        || source.text.contains("repeat(")
        || embeddings.iter().any(|known| known.place.field().is_some() && source.text.contains(known.name))
        || source.text.contains(table_file::NAME)
        || source.text.contains(heights::FIELD)
        || (0..tree.next()).any(|id| tree.node(id).form == Form::Text && is_expression(&source.text[tree.span(id)]))
}

/// Whether a text in quotes is an expression without parameters, or cannot be meant as anything else.
fn is_expression(quoted: &str) -> bool {
    let text = quoted.trim_matches('"');
    let calculates = || text.contains(['*', '^', '(', '+']) && text.contains(|c: char| c.is_ascii_digit());
    let value = || expression::evaluate(text, &mut |_| Err((String::new(), None)));
    !scope::is_quantity(text) && (calculates() || value().is_ok())
}

/// The sections of a scene after all macros, by name. `None` if they cannot be made. `embeddings` replace the entries
/// that name files.
pub(super) fn made(source: &Source, embeddings: &[Embedding]) -> Option<BTreeMap<String, String>> {
    let found = lex(&source.text);
    if found.fault.is_some() {
        return None;
    }
    let wanted = is_wanted(source, &found.tree, embeddings);
    let text = if wanted { expand(source, found, embeddings).ok()?.text } else { source.text.clone() };
    let tree = lex(&text).tree;
    let section = |&id: &Id| (text[tree.key(id)].to_owned(), text[tree.span(id)].to_owned());
    Some(tree.children(0).iter().map(section).collect())
}

/// Makes the scene from the result of the walk over its text.
pub(super) fn expand(source: &Source, found: Lexed, embeddings: &[Embedding]) -> Result<Expanded, SceneErrors> {
    let readers = embeddings.iter().map(|known| (*known, (known.reader)())).collect();
    let mut expander = Expander { readers, door: Door::of(source), ..Expander::default() };
    expander.steps.push(Step { before: 0, depth: 0, file: 0, at: (0, 0), cause: None });
    expander.errors = found.errors;
    let file = expander.add_file(source.clone(), found.tree);
    if expander.errors.is_empty() {
        expander.scene(&file);
    }
    expander.finish()
}

#[derive(Default)]
struct Expander {
    files: Vec<Rc<File>>,
    steps: Vec<Step>,
    /// Names with values, innermost last. They exist only while the text is made.
    scopes: Vec<Scope>,
    templates: BTreeMap<String, Rc<Template>>,
    /// The meaning of names in each file.
    homes: BTreeMap<usize, Rc<Place>>,
    /// Patterns of templates that were noted as foreign, by file and place.
    foreign: BTreeSet<(usize, usize)>,
    /// Whether files are being opened: their values are needed until all is made.
    opening: bool,
    sections: Vec<Merged>,
    errors: Vec<SceneError>,
    notes: Vec<String>,
    reasons: BTreeMap<(usize, usize), SceneError>,
    /// Full names of the instances so far.
    instances: BTreeSet<String>,
    /// The files that are being opened, each included by the one before.
    open_files: Vec<PathBuf>,
    /// Entries that name files, with what reads them.
    readers: Vec<Reader>,
    door: Door,
    tables: Tables,
    made: u64,
    work: usize,
    /// The number of values that are nested by name.
    depth: u32,
    /// Whether the reason for a wrong expression is not needed.
    quiet: bool,
}

impl Expander {
    fn add_file(&mut self, source: Source, tree: Tree) -> Rc<File> {
        let plain = emit::plain(&tree, &source.text, &self.readers);
        let file = Rc::new(File { number: self.files.len(), source, tree, plain });
        self.files.push(Rc::clone(&file));
        file
    }

    /// The scene itself, and all that it includes.
    fn scene(&mut self, file: &Rc<File>) {
        if let Some(folder) = &file.source.folder {
            let name = Path::new(&file.source.name).file_name().unwrap_or_default();
            let path = folder.join(name);
            self.open_files.push(std::fs::canonicalize(&path).unwrap_or(path));
        }
        match self.open(file, 0, "", None) {
            Ok(mut part) => {
                self.name_places(&mut part, None);
                self.part(&part);
            }
            Err(error) => self.errors.push(*error),
        }
    }

    fn finish(self) -> Result<Expanded, SceneErrors> {
        let mut errors = self.errors;
        let sources = || self.files.iter().map(|file| file.source.clone()).collect::<Vec<_>>();
        if !errors.is_empty() {
            source_map::merge(&mut errors);
            return Err(SceneErrors::of_files(sources(), errors, self.notes));
        }
        let mut out = Buffer::default();
        let root = &self.files[0];
        out.verbatim(root, root.tree.head(0), 0);
        out.made("(", 0, root.tree.head(0), 0);
        for section in self.sections {
            section.close_into(&mut out);
        }
        out.made(")", 0, root.tree.span(0).end - 1..root.tree.span(0).end, 0);
        if out.text.len() > LARGEST_SCENE {
            let message = format!("the scene becomes too large: the limit is {} MiB", LARGEST_SCENE >> 20);
            let error = SceneError::new("", message).at(root.tree.head(0), "with all that it makes");
            let error = error.with_help("make fewer things, or smaller ones");
            return Err(SceneErrors::of_files(sources(), vec![error], self.notes));
        }
        let Buffer { text, pieces } = out;
        let (files, steps) = (self.files, self.steps);
        let (notes, tables, opened) = (self.notes, self.tables, self.door.opened());
        Ok(Expanded { text, notes, tables, opened, files, steps, pieces, reasons: self.reasons })
    }

    /// A mistake at a place of a file, with the way there.
    fn wrong(&self, context: &Context, span: std::ops::Range<usize>, message: impl Into<String>) -> SceneError {
        let tree = &context.file.tree;
        let path = tree.path(tree.innermost(span.start, false), &context.file.source.text);
        let mut error = SceneError::new(path, message).at(span, "here");
        error.source = context.file.number;
        if error.source > 0 {
            error.file = Some(context.file.source.name.clone());
        }
        error.chain = self.chain(context.step);
        error
    }

    fn wrong_value(&self, context: &Context, id: Id, expected: &str) -> SceneError {
        let (tree, text) = (&context.file.tree, &context.file.source.text);
        let message = format!("expected {expected}, found {}", tree.describe(id, text));
        let mut error = self.wrong(context, tree.head_or_value(id), message);
        error.path = tree.path(id, text);
        error.label = format!("not {expected}");
        error
    }

    fn chain(&self, step: u32) -> Vec<Mark> {
        source_map::chain(&self.steps, step)
    }

    fn step(&mut self, context: &Context, span: std::ops::Range<usize>, cause: Cause) -> Outcome<u32> {
        let depth = self.steps[context.step as usize].depth + 1;
        if depth > DEEPEST {
            let message = match &cause {
                Cause::Instance { template, .. } if self.makes(context.step, template) => {
                    format!("the template `{template}` makes itself, more than {DEEPEST} deep")
                }
                _ => format!("templates, files and repetitions stand in each other more than {DEEPEST} deep"),
            };
            let mut error = self.wrong(context, span, message);
            error.chain.truncate(1);
            return Err(Box::new(error.with_help("let it end: a template may make itself only so often")));
        }
        let at = (span.start as u32, span.end as u32);
        self.steps.push(Step { before: context.step, depth, file: context.file.number, at, cause: Some(cause) });
        Ok(self.steps.len() as u32 - 1)
    }

    /// Whether a step is within an instance of a template.
    fn makes(&self, step: u32, name: &str) -> bool {
        let ways = std::iter::successors(Some(step), |&step| (step > 0).then(|| self.steps[step as usize].before));
        ways.into_iter().any(|step| {
            matches!(&self.steps[step as usize].cause, Some(Cause::Instance { template, .. }) if template == name)
        })
    }

    /// Counts the made things and their work, so that a small text cannot ask for endless work.
    fn spend(&mut self, context: &Context, id: Id, made: u64, work: usize) -> Outcome<()> {
        self.made += made;
        self.work += work;
        let span = context.file.tree.head(id);
        if self.made > MOST_MADE {
            let message = format!("the scene makes more than {MOST_MADE} things by `Repeat` and `instances`");
            let error = self.wrong(context, span, message);
            return Err(Box::new(error.with_help("repeat less often")));
        }
        if self.work > MOST_WORK {
            let message = format!("here the scene has copied more than {} MiB of text", MOST_WORK >> 20);
            let error = self.wrong(context, span, message);
            return Err(Box::new(
                error.with_help("repeat less often, make smaller things, or shorten `params` and tables"),
            ));
        }
        Ok(())
    }

    /// A field of a bracket.
    fn field(&self, context: &Context, id: Id, name: &str) -> Option<Id> {
        let (tree, text) = (&context.file.tree, &context.file.source.text);
        tree.children(id).iter().copied().find(|&child| &text[tree.key(child)] == name)
    }

    fn required(&self, context: &Context, id: Id, name: &str, example: &str) -> Outcome<Id> {
        self.field(context, id, name).ok_or_else(|| {
            let tree = &context.file.tree;
            let mut error = self.wrong(context, tree.head(id), format!("the field `{name}` is missing"));
            error.path = tree.path(id, &context.file.source.text);
            error.label = format!("`{name}: ..` is missing in here");
            Box::new(error.with_help(format!("for example: {example}")))
        })
    }

    /// A bracket with named fields, all of which are known.
    fn fields(&self, context: &Context, id: Id, known: &[&str], example: &str) -> Outcome<()> {
        let (tree, text) = (&context.file.tree, &context.file.source.text);
        let unnamed = tree.children(id).iter().any(|&child| tree.key(child).is_empty());
        if tree.node(id).form != Form::Round || unnamed {
            let error = self.wrong_value(context, id, "round brackets with named fields");
            return Err(Box::new(error.with_help(format!("for example: {example}"))));
        }
        let stranger = tree.children(id).iter().copied().find(|&child| !known.contains(&&text[tree.key(child)]));
        stranger.map_or(Ok(()), |child| {
            let name = &text[tree.key(child)];
            let mut error = self.wrong(context, tree.key(child), format!("there is no field `{name}` here"));
            error.path = tree.path(child, text);
            error.label = "unknown field".into();
            Err(Box::new(error.with_help(suggest::among(name, known.iter().copied(), "fields", '`'))))
        })
    }

    /// The items of a list.
    fn list<'a>(&self, context: &'a Context, id: Id, example: &str) -> Outcome<&'a [Id]> {
        let tree = &context.file.tree;
        if tree.node(id).form == Form::List {
            return Ok(tree.children(id));
        }
        Err(Box::new(self.wrong_value(context, id, "a list `[..]`").with_help(format!("for example: {example}"))))
    }

    fn collect(&mut self, outcome: Outcome<()>) {
        if let Err(error) = outcome
            && self.errors.len() < MOST_ERRORS
        {
            self.errors.push(*error);
        }
    }
}
