//! Copies values into the made text. Expressions are evaluated, names get their prefix, and fields are overridden.

use std::collections::{BTreeMap, BTreeSet};
use std::rc::Rc;

use super::expansion::Buffer;
use super::formula::Formula;
use super::overrides::{Override, Overrides, Patch, by_field};
use super::scope::{Failed, Filled, Value, is_quantity};
use super::{Expander, File, Outcome, Reader, table_file};
use crate::lexer::skip_blank;
use crate::outline::fits;
use crate::syntax::{Form, Id, Tree};

/// Fields that hold texts and never numbers: a parameter may have the same name as a material.
const TEXTS: [&str; 11] = ["name", "title", "notes", "rows", "color", "material", "of", "on", "between", "a", "b"];
/// Fields whose texts are never names of things.
const WORDS: [&str; 4] = ["title", "notes", "rows", "color"];
/// The work of one value, in bytes: it may leave three pieces.
pub(super) const WORK: usize = 128;
/// The work of one byte of a text that may have to be evaluated. It takes as long as copying twelve bytes.
pub(super) const WORK_OF_TEXT: usize = 12;
/// The work of comparing a name with a pattern: 20 ns, which copying of four bytes takes. Long names take twice as long.
pub(super) const WORK_OF_PATTERN: usize = 8;
/// The work of one byte that is copied unchanged. It keeps the scene below its largest size.
const WORK_OF_COPY: usize = 8;
/// Depth of values in values: parameters that stand for brackets can hold each other.
const DEEPEST: u32 = 300;

/// The surroundings of a value that is copied: its file, and the meaning of names there.
#[derive(Clone)]
pub(super) struct Context {
    pub(super) file: Rc<File>,
    pub(super) scope: usize,
    pub(super) place: Rc<Place>,
    pub(super) step: u32,
    /// The prefix of the names of templates in this file.
    pub(super) home: Rc<str>,
}

/// A part of the scene whose names have a prefix: an instance or an included file.
#[derive(Default)]
pub(super) struct Place {
    /// The place that resolves names which the part lacks: the file of a template, or the including file.
    pub(super) around: Option<Rc<Place>>,
    /// Empty, or with a `/` at its end.
    pub(super) prefix: String,
    /// Names of the part, without the prefix.
    pub(super) names: BTreeSet<String>,
    /// Names of the part that are prefixes of numbered names, as in `fill`.
    pub(super) numbered: BTreeSet<String>,
    pub(super) overrides: Overrides,
    /// The template of which this is an instance.
    pub(super) template: Option<String>,
}

impl Context {
    /// The letters of a text. Also their first byte in the file, if the file holds them unchanged.
    pub(super) fn text(&self, id: Id) -> Option<(String, Option<usize>)> {
        let span = self.file.tree.span(id);
        let written = &self.file.source.text[span.clone()];
        match written.strip_prefix('"').and_then(|rest| rest.strip_suffix('"')) {
            Some(inner) if !inner.contains('\\') => Some((inner.to_owned(), Some(span.start + 1))),
            _ => ron::from_str::<String>(written).ok().map(|text| (text, None)),
        }
    }
}

impl Place {
    /// The full name of the thing in a text, such as `ball`, `ball.position.x`, `b*`. The thing belongs to this part or
    /// to one around it.
    pub(super) fn resolved(&self, text: &str) -> Option<String> {
        let around = || self.around.as_ref()?.resolved(text);
        self.own(text).or_else(around)
    }

    /// The full name of the thing in a text, if the thing belongs to this part.
    pub(super) fn own(&self, text: &str) -> Option<String> {
        (!self.prefix.is_empty() && self.has(text)).then(|| format!("{}{text}", self.prefix))
    }

    /// Whether a text names things of this part.
    fn has(&self, text: &str) -> bool {
        let name = text.split('.').next().unwrap_or(text);
        if name.contains('*') {
            let numbered = self.numbered.iter().any(|stem| fits_numbered(name, stem));
            return numbered || self.names.iter().any(|known| fits(name, known));
        }
        let number = |rest: &str| !rest.is_empty() && rest.bytes().all(|byte| byte.is_ascii_digit());
        let numbered = name.rsplit_once('_').is_some_and(|(stem, rest)| self.numbered.contains(stem) && number(rest));
        let inside = name.match_indices('/').any(|(end, _)| self.names.contains(&name[..end]));
        inside || numbered || self.names.contains(name)
    }
}

/// Whether a pattern fits `stem_0`, `stem_1` or any other number of a stem.
fn fits_numbered(pattern: &str, stem: &str) -> bool {
    let digits = |text: &str| text.chars().filter(char::is_ascii_digit).collect::<String>();
    // If any number fits, one of three does: the digits behind the last `_`, all digits, or 0.
    let written = [digits(pattern.rsplit('_').next().unwrap_or_default()), digits(pattern), "0".to_owned()];
    written.iter().filter(|number| !number.is_empty()).any(|number| fits(pattern, &format!("{stem}_{number}")))
}

/// For each value, whether it can be copied unchanged.
pub(super) fn plain(tree: &Tree, text: &str, readers: &[Reader]) -> Vec<bool> {
    let mut plain = vec![true; tree.next() as usize];
    for id in (0..tree.next()).rev() {
        let name = tree.name(id, text);
        let read = |(known, _): &Reader| known.place.field().is_some() && known.name == name;
        let changes =
            tree.node(id).form == Form::Text || matches!(name, "Repeat" | table_file::NAME) || readers.iter().any(read);
        plain[id as usize] = !changes && tree.children(id).iter().all(|&child| plain[child as usize]);
    }
    plain
}

/// A text in quotes.
pub(super) fn quoted(text: &str) -> String {
    format!("\"{}\"", text.replace('\\', "\\\\").replace('"', "\\\""))
}

impl Expander {
    /// Copies an entry of a section whose `name` is the name of a thing.
    pub(super) fn entry(&mut self, context: &Context, out: &mut Buffer, id: Id, section: &str) -> Outcome<()> {
        let patches = match self.name_of(context, id)? {
            Some(name) => self.patches_of(context, id, &name)?,
            None => Vec::new(),
        };
        self.value(context, out, id, section, &patches, true)
    }

    fn patches_of(&mut self, context: &Context, id: Id, name: &str) -> Outcome<Vec<Patch>> {
        let overrides = &context.place.overrides;
        self.spend(context, id, 0, WORK_OF_PATTERN * overrides.pattern_count())?;
        Ok(overrides.of(name))
    }

    /// The name that an entry declares, without the prefix. A name with a dot is that of a channel, to which the entry
    /// only refers.
    pub(super) fn name_of(&mut self, context: &Context, id: Id) -> Outcome<Option<String>> {
        let Some(field) = self.field(context, id, "name") else { return Ok(None) };
        Ok(self.text_of(context, field)?.filter(|name| !name.contains('.')))
    }

    /// The letters of a text, with the expressions in braces evaluated.
    pub(super) fn text_of(&mut self, context: &Context, id: Id) -> Outcome<Option<String>> {
        let Some((text, shift)) = context.text(id) else { return Ok(None) };
        self.filled(context, id, &text, shift).map(|filled| Some(filled.text))
    }

    /// Copies the values of a map whose keys are names of things.
    pub(super) fn named_values(&mut self, context: &Context, out: &mut Buffer, id: Id) -> Outcome<()> {
        let file = &context.file;
        for &child in file.tree.children(id) {
            let key = file.tree.key(child);
            let name = file.source.text[key.clone()].trim_matches('"');
            if !out.text.is_empty() {
                out.text.push_str(", ");
            }
            out.made(&quoted(&format!("{}{name}", context.place.prefix)), file.number, key, context.step);
            out.text.push_str(": ");
            let patches = self.patches_of(context, child, name)?;
            self.value(context, out, child, "", &patches, false)?;
        }
        Ok(())
    }

    /// Copies any value. `key` is the nearest field name above it.
    pub(super) fn value(
        &mut self,
        context: &Context,
        out: &mut Buffer,
        id: Id,
        key: &str,
        patches: &[Patch],
        is_entry: bool,
    ) -> Outcome<()> {
        let file = Rc::clone(&context.file);
        let (tree, text) = (&file.tree, &file.source.text);
        let span = tree.span(id);
        if file.plain[id as usize] && patches.is_empty() {
            self.spend(context, id, 0, WORK / 2 + WORK_OF_COPY * span.len())?;
            out.verbatim(&file, span, context.step);
            return Ok(());
        }
        self.spend(context, id, 0, WORK)?;
        match tree.node(id).form {
            Form::Text if patches.is_empty() => self.text(context, out, id, key),
            Form::List if patches.is_empty() => {
                out.verbatim(&file, span.start..span.start + 1, context.step);
                let mut first = true;
                self.each(context, tree.children(id), &mut |expander, context, item| {
                    if !std::mem::take(&mut first) {
                        out.text.push_str(", ");
                    }
                    expander.value(context, out, item, key, &[], false)
                })?;
                out.verbatim(&file, span.end - 1..span.end, context.step);
                Ok(())
            }
            Form::Round if table_file::FIELDS.contains(&key) && tree.name(id, text) == table_file::NAME => {
                self.table(context, out, id)
            }
            Form::Round if Self::is_heights(context, id, key) => self.heights(context, out, id),
            Form::Round | Form::Braces | Form::List => {
                let start = out.text.len();
                let name = tree.name(id, text).len();
                let open = skip_blank(text, span.start + name).unwrap_or(span.start);
                if name > 0 {
                    out.verbatim(&file, span.start..span.start + name, context.step);
                }
                out.verbatim(&file, open..open + 1, context.step);
                let fields = by_field(patches);
                for (index, &child) in tree.children(id).iter().enumerate() {
                    if index > 0 {
                        out.text.push_str(", ");
                    }
                    self.child(context, out, child, key, &fields, is_entry)?;
                }
                self.added(context, out, id, patches)?;
                if let Some(reader) = self.reader_of(tree.name(id, text), key, is_entry) {
                    self.embed(context, out, (id, reader), start)?;
                }
                out.verbatim(&file, span.end - 1..span.end, context.step);
                Ok(())
            }
            _ => match patches.first() {
                Some((patch, depth)) => Err(Box::new(self.no_such_field(patch, *depth))),
                None => Ok(()),
            },
        }
    }

    fn child(
        &mut self,
        context: &Context,
        out: &mut Buffer,
        child: Id,
        key: &str,
        fields: &BTreeMap<&str, Vec<Patch>>,
        is_entry: bool,
    ) -> Outcome<()> {
        let file = Rc::clone(&context.file);
        let (tree, text) = (&file.tree, &file.source.text);
        let span = tree.key(child);
        let field = &text[span.clone()];
        let key = if field.is_empty() { key } else { field };
        if !field.is_empty() {
            out.verbatim(&file, span, context.step);
            out.text.push_str(": ");
        }
        if is_entry && field == "name" && tree.node(child).form == Form::Text {
            return self.name(context, out, child);
        }
        if fields.is_empty() {
            return self.value(context, out, child, key, &[], false);
        }
        let label = if field.is_empty() { format!("[{}]", tree.node(child).index) } else { field.to_owned() };
        let inner = fields.get(label.as_str()).map_or(&[][..], Vec::as_slice);
        // The last one wins: it comes from farthest outside.
        match inner.iter().rfind(|(patch, depth)| patch.fields.len() == *depth) {
            Some((patch, _)) => {
                inner.iter().for_each(|(patch, _)| patch.used.set(true));
                let there = Context { step: context.step, ..patch.context.clone() };
                self.value(&there, out, patch.value, key, &[], false)
            }
            None => self.value(context, out, child, key, inner, false),
        }
    }

    /// Fields that an override adds to a bracket without a field of that name.
    fn added(&mut self, context: &Context, out: &mut Buffer, id: Id, patches: &[Patch]) -> Outcome<()> {
        let file = Rc::clone(&context.file);
        let (tree, text) = (&file.tree, &file.source.text);
        if patches.is_empty() {
            return Ok(());
        }
        let label = |(index, &child): (usize, &Id)| match &text[tree.key(child)] {
            "" => format!("[{index}]"),
            key => key.to_owned(),
        };
        let present: BTreeSet<String> = tree.children(id).iter().enumerate().map(label).collect();
        let field = |(index, (patch, depth)): (usize, &'_ Patch)| (patch.fields[*depth].clone(), index);
        let last: BTreeMap<String, usize> = patches.iter().enumerate().map(field).collect();
        let named = tree.children(id).iter().all(|&child| !tree.key(child).is_empty());
        for (index, (patch, depth)) in patches.iter().enumerate() {
            let field = &patch.fields[*depth];
            if present.contains(field) {
                continue;
            }
            if patch.fields.len() != depth + 1 || tree.node(id).form != Form::Round || !named {
                return Err(Box::new(self.no_such_field(patch, *depth)));
            }
            patch.used.set(true);
            if last[field] != index {
                continue;
            }
            let there = Context { step: context.step, ..patch.context.clone() };
            if !tree.children(id).is_empty() || index > 0 {
                out.text.push_str(", ");
            }
            out.made(field, there.file.number, there.file.tree.key(patch.value), there.step);
            out.text.push_str(": ");
            self.value(&there, out, patch.value, field, &[], false)?;
        }
        Ok(())
    }

    fn no_such_field(&self, patch: &Override, depth: usize) -> crate::SceneError {
        let key = patch.context.file.tree.key(patch.value);
        let field = &patch.fields[depth];
        let mut error = self.wrong(&patch.context, key, format!("`{}` has no field `{field}` there", patch.target));
        error.label = "leads nowhere".into();
        error.with_help("the path names a thing and then its fields, such as \"ball.atoms.radius\"")
    }

    fn name(&mut self, context: &Context, out: &mut Buffer, id: Id) -> Outcome<()> {
        let Some((text, shift)) = context.text(id) else {
            out.verbatim(&context.file, context.file.tree.span(id), context.step);
            return Ok(());
        };
        let name = self.filled(context, id, &text, shift)?.text;
        self.spend(context, id, 0, WORK + WORK_OF_TEXT * (text.len() + name.len()))?;
        if name.contains('.') {
            return self.text(context, out, id, "name");
        }
        let full = quoted(&format!("{}{name}", context.place.prefix));
        out.made(&full, context.file.number, context.file.tree.span(id), context.step);
        Ok(())
    }

    fn text(&mut self, context: &Context, out: &mut Buffer, id: Id, key: &str) -> Outcome<()> {
        let file = &context.file;
        let span = file.tree.span(id);
        self.spend(context, id, 0, WORK_OF_TEXT * span.len())?;
        let Some((written, shift)) = context.text(id) else {
            out.verbatim(file, span, context.step);
            return Ok(());
        };
        let mut text = written.clone();
        let mut given = false;
        if text.contains(['{', '}']) {
            Filled { text, given } = self.filled(context, id, &text, shift)?;
        } else if !TEXTS.contains(&key) && !is_quantity(&text) {
            let place = (file.number, span.start);
            self.quiet = self.reasons.contains_key(&place);
            match self.expression(context, &text) {
                Ok(Value::Number(number)) => {
                    out.made(&number.written(), file.number, span, context.step);
                    return Ok(());
                }
                Ok(Value::Text(value)) => text = value,
                Ok(Value::Given(value)) => (text, given) = (value, true),
                Ok(Value::Node(there, value)) => {
                    self.depth += 1;
                    if self.depth > DEEPEST {
                        let error = self.wrong(context, span, "parameters contain each other without end");
                        return Err(Box::new(error.with_help("a parameter must not hold itself")));
                    }
                    let there = Context { step: context.step, ..there };
                    let copied = self.value(&there, out, value, key, &[], false);
                    self.depth -= 1;
                    return copied;
                }
                Err(Failed::Elsewhere(error)) => return Err(error),
                Err(Failed::Here(wrong)) if !self.quiet => {
                    let reason = self.wrong_expression(context, id, shift, wrong);
                    self.reasons.insert(place, reason);
                }
                Err(Failed::Here(_)) => {}
            }
            self.quiet = false;
        }
        if !WORDS.contains(&key) {
            let full = |text: &str| if given { context.place.own(text) } else { context.place.resolved(text) };
            if !given {
                self.note_foreign(context, span.start, &text);
            }
            // The names in a formula of channels are those of things, each on its own.
            let formula = key == "of" && !context.place.prefix.is_empty();
            let formula = formula.then(|| Formula::new(&*text).renamed(full)).flatten();
            text = formula.or_else(|| full(&text)).unwrap_or(text);
        }
        if text == written {
            out.verbatim(file, span, context.step);
        } else {
            self.spend(context, id, 0, WORK_OF_COPY * text.len())?;
            out.made(&quoted(&text), file.number, span, context.step);
        }
        Ok(())
    }
}

impl Expander {
    /// Notes a pattern in a template that fits none of the template's things. The pattern may mean the things around
    /// the template, or be misspelt.
    fn note_foreign(&mut self, context: &Context, start: usize, text: &str) {
        let is_pattern = text.contains('*') && !text.contains(char::is_whitespace);
        let Some(template) = &context.place.template else { return };
        if is_pattern && !context.place.has(text) && self.foreign.insert((context.file.number, start)) {
            self.notes.push(format!(
                "the template `{template}` makes no \"{text}\". The name means things around the template"
            ));
        }
    }
}
