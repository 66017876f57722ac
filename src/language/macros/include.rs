//! Files and their contents: `include`, `params`, and the sections that are merged from all files.

use std::collections::BTreeSet;
use std::path::PathBuf;
use std::rc::Rc;

use super::emit::{Context, Place};
use super::expansion::Merged;
use super::scope::Scope;
use super::{Cause, Expander, File, MOST_FILES, Outcome, SECTIONS};
use crate::error::SceneError;
use crate::lexer::lex;
use crate::source::Source;
use crate::suggest;
use crate::syntax::{Form, Id};

const EXAMPLE: &str = "include: [(file: \"parts/arm.ron\", prefix: \"a\")]";

/// A file whose parameters and templates are known, with the files that it includes.
pub(super) struct Part {
    context: Context,
    included: Vec<Part>,
}

/// The owner of the sections that are put into the scene.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Holder {
    Scene,
    Included,
    Template,
}

/// Sections whose entries make many things with numbered names.
const SERIES: [&str; 2] = ["fill", "packings"];

impl Expander {
    /// Notes the parameters and templates of a file, and opens the files that it includes.
    pub(super) fn open(
        &mut self,
        file: &Rc<File>,
        step: u32,
        prefix: &str,
        given: Option<(&Context, Id)>,
    ) -> Outcome<Part> {
        let place = Rc::new(Place { prefix: prefix.to_owned(), ..Place::default() });
        let scope = self.scopes.len();
        self.scopes.push(Scope::default());
        let context = Context { file: Rc::clone(file), scope, place, step, home: prefix.into() };
        let params = self.field(&context, 0, "params");
        self.settings(&context, params)?;
        if let Some((from, with)) = given {
            let names = self.param_names(&context, params);
            let names: BTreeSet<&str> = names.iter().map(String::as_str).collect();
            let mut values = std::mem::take(&mut self.scopes[scope]);
            self.give_values(from, with, &names, &format!("`{}`", file.source.name), &mut values)?;
            self.scopes[scope] = values;
        }
        if let Some(params) = params {
            let given = self.scopes[scope].names().map(str::to_owned).collect();
            self.register_params(&context, params, &given)?;
        }
        if let Some(templates) = self.field(&context, 0, "templates") {
            self.register_templates(&context, templates)?;
        }
        let mut included = Vec::new();
        if let Some(include) = self.field(&context, 0, "include") {
            let opening = std::mem::replace(&mut self.opening, true);
            for &item in self.list(&context, include, EXAMPLE)? {
                let opened = self.each(&context, &[item], &mut |expander, context, item| {
                    included.push(expander.include(context, item)?);
                    Ok(())
                });
                self.collect(opened);
            }
            self.opening = opening;
        }
        Ok(Part { context, included })
    }

    /// Values from outside the scene, as with `--set`.
    fn settings(&mut self, context: &Context, params: Option<Id>) -> Outcome<()> {
        if context.file.number != 0 {
            return Ok(());
        }
        let known = self.param_names(context, params);
        for (name, text) in &context.file.source.settings {
            if !known.contains(name) {
                let error = SceneError::new(format!("--set {name}"), format!("the scene has no parameter `{name}`"));
                let help = if known.is_empty() {
                    "the scene has no `params` that could be set".to_owned()
                } else {
                    suggest::among(name, known.iter().map(String::as_str), "parameters", '`')
                };
                return Err(Box::new(error.with_help(help)));
            }
            self.scopes[context.scope].give(name, text);
            self.notes.push(format!("{name} = {text} from the command line"));
        }
        Ok(())
    }

    fn param_names(&self, context: &Context, params: Option<Id>) -> BTreeSet<String> {
        let (tree, text) = (&context.file.tree, &context.file.source.text);
        let keys = params.map_or(&[][..], |params| tree.children(params)).iter().map(|&id| &text[tree.key(id)]);
        keys.map(|key| key.trim_matches('"').to_owned()).collect()
    }

    /// Gives the names of a `params: { "n": 5 }` their values, except those that have one.
    pub(super) fn register_params(&mut self, context: &Context, params: Id, given: &BTreeSet<String>) -> Outcome<()> {
        let (tree, text) = (&context.file.tree, &context.file.source.text);
        if tree.node(params).form != Form::Braces {
            let error = self.wrong_value(context, params, "a map `{ \"name\": value }`");
            return Err(Box::new(
                error.with_help("for example: params: { \"n\": 5, \"gap\": \"2 cm\", \"r\": \"0.5 * gap\" }"),
            ));
        }
        for &id in tree.children(params) {
            let name = text[tree.key(id)].trim_matches('"');
            if name.is_empty() || super::expression::name_length(name) != name.len() || name == "pi" {
                let error = self.wrong(context, tree.key(id), format!("`{name}` cannot be the name of a parameter"));
                let help = if name == "pi" {
                    "`pi` has its value already"
                } else {
                    "use letters, digits and `_`, such as `r_2`"
                };
                return Err(Box::new(error.with_help(help)));
            }
            if !given.contains(name) {
                self.scopes[context.scope].open(name, context, id);
            }
        }
        Ok(())
    }

    /// `with: (x: 1)`: values for the names of a template or an included file.
    pub(super) fn give_values(
        &mut self,
        context: &Context,
        with: Id,
        known: &BTreeSet<&str>,
        whose: &str,
        scope: &mut Scope,
    ) -> Outcome<()> {
        let (tree, text) = (&context.file.tree, &context.file.source.text);
        let unnamed = tree.children(with).iter().any(|&child| tree.key(child).is_empty());
        if !matches!(tree.node(with).form, Form::Round | Form::Braces) || unnamed {
            let error = self.wrong_value(context, with, "named values `(x: 1)`");
            return Err(Box::new(error.with_help("for example: with: (x: 1, tilt: \"10 deg\")")));
        }
        for &id in tree.children(with) {
            let name = text[tree.key(id)].trim_matches('"');
            if !known.contains(name) {
                let mut error = self.wrong(context, tree.key(id), format!("{whose} takes no value `{name}`"));
                error.label = "unknown name".into();
                return Err(Box::new(error.with_help(suggest::among(name, known.iter().copied(), "values", '`'))));
            }
            let value = self.read_value(context, id)?;
            scope.set(name, value);
        }
        Ok(())
    }

    fn include(&mut self, context: &Context, id: Id) -> Outcome<Part> {
        self.fields(context, id, &["file", "prefix", "with"], EXAMPLE)?;
        let tree = &context.file.tree;
        let at = self.required(context, id, "file", EXAMPLE)?;
        let Some(name) = self.text_of(context, at)? else {
            return Err(Box::new(self.wrong_value(context, at, "the name of a file in quotes")));
        };
        let wrong = |expander: &Self, message: String, help: String| {
            Box::new(expander.wrong(context, tree.span(at), message).with_help(help))
        };
        let Some(folder) = &context.file.source.folder else {
            let message = "this scene is in no file, so no other file can be found from it".to_owned();
            let help = "save it as a file, or write what it includes into it";
            return Err(wrong(self, message, help.to_owned()));
        };
        let path = folder.join(&name);
        let real = |path: &PathBuf| std::fs::canonicalize(path).unwrap_or_else(|_| path.clone());
        let this = real(&path);
        if let Some(first) = self.open_files.iter().position(|open| *open == this) {
            let mut names: Vec<String> =
                self.open_files[first..].iter().map(|path| path.display().to_string()).collect();
            names.push(this.display().to_string());
            let shortest = |name: &String| {
                std::path::Path::new(name)
                    .file_name()
                    .map_or_else(String::new, |name| name.to_string_lossy().into_owned())
            };
            let names: Vec<String> = names.iter().map(shortest).map(|name| format!("`{name}`")).collect();
            let message = format!("files include each other in a circle: {}", names.join(" includes "));
            return Err(wrong(self, message, "remove one of these".to_owned()));
        }
        if self.files.len() >= MOST_FILES {
            return Err(wrong(
                self,
                format!("the scene includes more than {MOST_FILES} files"),
                "include fewer".to_owned(),
            ));
        }
        self.door.admit(&path, &name).map_err(|(message, help)| wrong(self, message, help))?;
        let source = Source::read(&path).map_err(|errors| {
            let (message, help) = errors
                .errors()
                .first()
                .map_or_else(Default::default, |error| (error.message.clone(), error.help.clone().unwrap_or_default()));
            let help = if message.starts_with("there is no file") {
                "the path begins at the folder of the file that includes it".to_owned()
            } else {
                help
            };
            wrong(self, message, help)
        })?;
        self.spend(context, id, 0, source.text.len())?;
        let prefix = match self.field(context, id, "prefix") {
            Some(at) => match self.text_of(context, at)? {
                Some(prefix) if !prefix.is_empty() && !prefix.contains(['*', '.', ',', '"', '/', '{']) => prefix + "/",
                _ => {
                    let error = self.wrong_value(context, at, "a name in quotes");
                    return Err(Box::new(error.with_help("use letters, digits and `_`")));
                }
            },
            None => String::new(),
        };
        let step = self.step(context, tree.span(at), Cause::Included)?;
        let found = lex(&source.text);
        let not_a_scene = found.fault.is_none()
            && (found.tree.node(0).form != Form::Round || found.tree.name(0, &source.text) != "Scene");
        let file = self.add_file(source, found.tree);
        let mistakes = found.errors.into_iter().chain(found.fault);
        let mut mistakes: Vec<SceneError> = mistakes.map(|error| self.within(error, &file, step)).collect();
        if not_a_scene {
            let error = SceneError::new("", "expected `Scene(..)`").at(0..1, "not a scene");
            let error = error.with_help("an included file is a scene too: `Scene(format: 1, bodies: [..])`");
            mistakes.push(self.within(error, &file, step));
        }
        if let Some(last) = mistakes.pop() {
            mistakes.into_iter().for_each(|error| self.collect(Err(Box::new(error))));
            return Err(Box::new(last));
        }
        let given = self.field(context, id, "with").map(|with| (context, with));
        self.open_files.push(this);
        let part = self.open(&file, step, &format!("{}{prefix}", context.place.prefix), given);
        self.open_files.pop();
        part
    }

    fn within(&self, mut error: SceneError, file: &File, step: u32) -> SceneError {
        error.source = file.number;
        error.file = Some(file.source.name.clone());
        error.chain = self.chain(step);
        error
    }

    /// Puts a file's sections into the scene, and at the place of `include` those of the files it includes.
    pub(super) fn part(&mut self, part: &Part) {
        let holder = if part.context.step == 0 { Holder::Scene } else { Holder::Included };
        let context = &part.context;
        let (tree, text) = (&part.context.file.tree, &part.context.file.source.text);
        for &id in tree.children(0) {
            if &text[tree.key(id)] == "include" {
                part.included.iter().for_each(|part| self.part(part));
            } else {
                let done = self.section(context, id, holder);
                self.collect(done);
            }
        }
    }

    /// Settles the meaning of names in a file and in its included files, before any thing is made. So a template may be
    /// used ahead of its own file.
    pub(super) fn name_places(&mut self, part: &mut Part, around: Option<&Rc<Place>>) {
        if !part.context.place.prefix.is_empty() {
            let (names, numbered) = self.names_of_part(part);
            let prefix = part.context.place.prefix.clone();
            part.context.place =
                Rc::new(Place { around: around.cloned(), prefix, names, numbered, ..Place::default() });
        }
        let place = Rc::clone(&part.context.place);
        self.homes.insert(part.context.file.number, Rc::clone(&place));
        part.included.iter_mut().for_each(|inner| self.name_places(inner, Some(&place)));
    }

    fn names_of_part(&mut self, part: &Part) -> (BTreeSet<String>, BTreeSet<String>) {
        let (mut names, mut numbered) = self.names_in(&part.context, 0);
        for inner in &part.included {
            let own = &inner.context.place.prefix[part.context.place.prefix.len()..];
            if own.is_empty() {
                let (more, many) = self.names_of_part(inner);
                names.extend(more);
                numbered.extend(many);
            } else {
                names.insert(own.trim_end_matches('/').to_owned());
            }
        }
        (names, numbered)
    }

    /// Puts the sections of a template into the scene.
    pub(super) fn sections_of(&mut self, context: &Context, id: Id, holder: Holder) -> Outcome<()> {
        let file = Rc::clone(&context.file);
        for &child in file.tree.children(id) {
            if &file.source.text[file.tree.key(child)] != "args" {
                self.section(context, child, holder)?;
            }
        }
        Ok(())
    }

    fn section(&mut self, context: &Context, id: Id, holder: Holder) -> Outcome<()> {
        let file = Rc::clone(&context.file);
        let (tree, text) = (&file.tree, &file.source.text);
        let key = tree.key(id);
        let name = &text[key.clone()];
        let form = tree.node(id).form;
        let many = matches!(form, Form::List | Form::Braces);
        match name {
            "params" => return Ok(()),
            "templates" | "include" if holder == Holder::Template => {
                let error = self.wrong(context, key, format!("`{name}` cannot stand in a template"));
                return Err(Box::new(error.with_help("it belongs to the scene or to a file")));
            }
            "templates" => return Ok(()),
            "instances" => {
                for &item in self.list(context, id, "instances: [(of: \"bob\", name: \"left\")]")? {
                    let made =
                        self.each(context, &[item], &mut |expander, context, item| expander.instance(context, item));
                    if holder == Holder::Template {
                        made?;
                    } else {
                        self.collect(made);
                    }
                }
                return Ok(());
            }
            "" if holder != Holder::Scene => {
                return Err(Box::new(self.wrong_value(context, id, "a section such as `bodies: [..]`")));
            }
            _ if !many && holder == Holder::Template => {
                let message = format!("a template holds lists and maps such as `bodies: [..]`, not `{name}`");
                let mut error = self.wrong(context, key, message);
                error.label = "not in a template".into();
                return Err(Box::new(error.with_help("move it into the scene")));
            }
            _ if !many && holder == Holder::Included => {
                if !["format", "title", "notes"].contains(&name) {
                    self.notes.push(format!(
                        "{}: its `{name}` is left out: an included file brings lists and maps",
                        file.source.name
                    ));
                }
                return Ok(());
            }
            _ => {}
        }
        let position = self.sections.iter().position(|section| section.name == name && many);
        let position = position.unwrap_or_else(|| {
            self.sections.push(Merged::new(name, form, &file, key.clone(), context.step));
            self.sections.len() - 1
        });
        if self.sections[position].form != form {
            let message = format!("`{name}` is a list in one place and a map in another");
            return Err(Box::new(self.wrong(context, key, message).with_help("write both in the same way")));
        }
        let mut out = std::mem::take(&mut self.sections[position].out);
        let mut done = Ok(());
        match form {
            Form::List => {
                for &item in tree.children(id) {
                    let made = self.each(context, &[item], &mut |expander, context, item| {
                        if !out.text.is_empty() {
                            out.text.push_str(", ");
                        }
                        expander.entry(context, &mut out, item, name)
                    });
                    if holder == Holder::Template && made.is_err() {
                        done = made;
                        break;
                    }
                    self.collect(made);
                }
            }
            Form::Braces => done = self.named_values(context, &mut out, id),
            _ => done = self.value(context, &mut out, id, name, &[], false),
        }
        self.sections[position].out = out;
        done
    }

    /// The names that the sections in a bracket declare, without prefix; and the prefixes of numbered names. Mistakes
    /// there are reported when the sections are put into the scene.
    pub(super) fn names_in(&mut self, context: &Context, id: Id) -> (BTreeSet<String>, BTreeSet<String>) {
        let (made, steps) = (self.made, self.steps.len());
        let (mut names, mut numbered) = (BTreeSet::new(), BTreeSet::new());
        let file = Rc::clone(&context.file);
        let (tree, text) = (&file.tree, &file.source.text);
        for &section in tree.children(id) {
            let key = &text[tree.key(section)];
            if (SECTIONS.contains(&key) && key != "instances") || key == "args" {
                continue;
            }
            match tree.node(section).form {
                Form::Braces => {
                    let keys = tree.children(section).iter().map(|&child| &text[tree.key(child)]);
                    names.extend(keys.map(|key| key.trim_matches('"').to_owned()));
                }
                Form::List => {
                    let _ = self.each(context, tree.children(section), &mut |expander, context, item| {
                        expander.spend(context, item, 0, 64)?;
                        if let Some(name) = expander.name_of(context, item)? {
                            if SERIES.contains(&key) {
                                numbered.insert(name)
                            } else {
                                names.insert(name)
                            };
                        }
                        Ok(())
                    });
                }
                _ => {}
            }
        }
        self.made = made;
        self.steps.truncate(steps);
        (names, numbered)
    }
}
