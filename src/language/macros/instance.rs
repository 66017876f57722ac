//! `templates` and `instances`: parts of scenes, and their copies with arguments.

use std::cell::Cell;
use std::collections::BTreeSet;
use std::rc::Rc;

use super::emit::{Context, Place, WORK, WORK_OF_PATTERN};
use super::include::Holder;
use super::overrides::{Override, Overrides};
use super::scope::Scope;
use super::{Cause, Expander, Outcome};
use crate::suggest;
use crate::syntax::{Form, Id};

const EXAMPLE: &str = "instances: [(of: \"bob\", name: \"left\", with: (x: 1), set: {\"ball.mass\": 2})]";
const TEMPLATES: &str = "templates: { \"bob\": (args: [\"x\"], bodies: [(name: \"ball\", at: (\"x\", 0), ..)]) }";

/// A template as the author wrote it.
pub(super) struct Template {
    context: Context,
    node: Id,
    args: Vec<String>,
}

impl Expander {
    /// Takes note of a file's templates.
    pub(super) fn register_templates(&mut self, context: &Context, id: Id) -> Outcome<()> {
        let (tree, text) = (&context.file.tree, &context.file.source.text);
        if tree.node(id).form != Form::Braces {
            let error = self.wrong_value(context, id, "a map `{ \"name\": (..) }`");
            return Err(Box::new(error.with_help(format!("for example: {TEMPLATES}"))));
        }
        for &node in tree.children(id) {
            let name = text[tree.key(node)].trim_matches('"');
            let args = self.args(context, node)?;
            let template = Rc::new(Template { context: context.clone(), node, args });
            if self.templates.insert(format!("{}{name}", context.home), template).is_some() {
                let message = format!("there are two templates `{}{name}`", context.home);
                let error = self.wrong(context, tree.key(node), message);
                return Err(Box::new(error.with_help("give one another name, or the included file a `prefix`")));
            }
        }
        Ok(())
    }

    fn args(&mut self, context: &Context, node: Id) -> Outcome<Vec<String>> {
        let tree = &context.file.tree;
        let unnamed = tree.children(node).iter().any(|&child| tree.key(child).is_empty());
        if tree.node(node).form != Form::Round || unnamed {
            let error = self.wrong_value(context, node, "round brackets with named fields");
            return Err(Box::new(error.with_help(format!("for example: {TEMPLATES}"))));
        }
        let Some(args) = self.field(context, node, "args") else { return Ok(Vec::new()) };
        let mut names = Vec::new();
        for &item in self.list(context, args, "args: [\"x\", \"tilt\"]")? {
            match context.text(item) {
                Some((name, _)) if super::expression::name_length(&name) == name.len() => names.push(name),
                _ => {
                    let error = self.wrong_value(context, item, "a name in quotes, of letters, digits and `_`");
                    return Err(Box::new(error.with_help("for example: args: [\"x\", \"tilt\"]")));
                }
            }
        }
        Ok(names)
    }

    /// Makes what an instance asks for.
    pub(super) fn instance(&mut self, context: &Context, id: Id) -> Outcome<()> {
        self.fields(context, id, &["of", "name", "with", "set"], EXAMPLE)?;
        self.spend(context, id, 1, context.file.tree.span(id).len())?;
        let of = self.required(context, id, "of", EXAMPLE)?;
        let (template, called) = self.template(context, of)?;
        let name_id = self.required(context, id, "name", EXAMPLE)?;
        let name = self.instance_name(context, id, name_id)?;
        let head = context.file.tree.head_or_value(name_id);
        let step = self.step(context, head, Cause::Instance { name: name.clone(), template: called.clone() })?;
        let scopes = self.scopes.len();
        let scope = self.arguments(context, id, &template, &called)?;
        self.scopes.push(scope);
        let overrides = self.overrides(context, id)?;
        let own = overrides.len();
        let around = self.homes.get(&template.context.file.number).cloned();
        let prefix = format!("{}{name}/", context.place.prefix);
        let place = |names, numbered, overrides| {
            let (around, prefix, template) = (around.clone(), prefix.clone(), Some(called.clone()));
            Rc::new(Place { around, prefix, names, numbered, overrides, template })
        };
        let inner = Context {
            scope: scopes,
            step,
            place: place(BTreeSet::new(), BTreeSet::new(), Overrides::default()),
            ..template.context.clone()
        };
        self.open_params(&inner, &template)?;
        self.spend(context, id, 0, WORK_OF_PATTERN * context.place.overrides.pattern_count())?;
        let overrides: Vec<Rc<Override>> = overrides.into_iter().chain(context.place.overrides.within(&name)).collect();
        let (names, numbered) = self.names_in(&inner, template.node);
        let known = names.clone();
        let inner = Context { place: place(names, numbered, Overrides::new(overrides)), ..inner };
        let made = self.sections_of(&inner, template.node, Holder::Template);
        self.scopes.truncate(scopes);
        made?;
        let unused = inner.place.overrides.all()[..own].iter().find(|patch| !patch.used.get());
        unused.map_or(Ok(()), |patch| Err(Box::new(self.unused(patch, &called, &known))))
    }

    fn unused(&self, patch: &Override, template: &str, names: &BTreeSet<String>) -> crate::SceneError {
        let key = patch.context.file.tree.key(patch.value);
        let message = format!("the template `{template}` makes no \"{}\"", patch.target);
        let mut error = self.wrong(&patch.context, key, message);
        error.label = "unknown name".into();
        let help = suggest::among(&patch.target, names.iter().map(String::as_str), "names in the template", '"');
        error.with_help(help)
    }

    fn template(&mut self, context: &Context, of: Id) -> Outcome<(Rc<Template>, String)> {
        let Some((text, shift)) = context.text(of) else {
            let error = self.wrong_value(context, of, "the name of a template");
            return Err(Box::new(error.with_help(format!("for example: {EXAMPLE}"))));
        };
        let name = self.filled(context, of, &text, shift)?.text;
        // Those of the file, then those of the files that include it.
        let mut home = &*context.home;
        let found = loop {
            match self.templates.get(&format!("{home}{name}")) {
                None if !home.is_empty() => {
                    home = home[..home.len() - 1].rfind('/').map_or("", |slash| &home[..=slash]);
                }
                found => break found,
            }
        };
        match found {
            Some(template) => Ok((Rc::clone(template), name)),
            None => {
                let message = format!("there is no template `{name}`");
                let mut error = self.wrong(context, context.file.tree.span(of), message);
                error.label = "unknown template".into();
                let names = self.templates.keys().map(String::as_str);
                Err(Box::new(error.with_help(suggest::among(&name, names, "templates", '"'))))
            }
        }
    }

    fn instance_name(&mut self, context: &Context, id: Id, name_id: Id) -> Outcome<String> {
        let Some(name) = self.name_of(context, id)? else {
            return Err(Box::new(self.wrong_value(context, name_id, "a name in quotes")));
        };
        if name.is_empty() || name.contains(['*', '.', ',', '"', '/']) {
            let message = format!("the name {name:?} cannot begin the names of things");
            let error = self.wrong(context, context.file.tree.span(name_id), message);
            return Err(Box::new(error.with_help("use letters, digits and `_`")));
        }
        let full = format!("{}{name}", context.place.prefix);
        if !self.instances.insert(full.clone()) {
            let message = format!("another instance has the name \"{full}\"");
            let mut error = self.wrong(context, context.file.tree.span(name_id), message);
            error.label = "here again".into();
            let help = "give every instance its own name; in a `Repeat` put its index in: \"left_{i}\"";
            return Err(Box::new(error.with_help(help)));
        }
        Ok(name)
    }

    /// The values of the arguments in an instance.
    fn arguments(&mut self, context: &Context, id: Id, template: &Template, called: &str) -> Outcome<Scope> {
        let params = self.field(&template.context, template.node, "params");
        let file = &template.context.file;
        let optional: Vec<String> = params.map_or_else(Vec::new, |params| {
            let keys = file.tree.children(params).iter().map(|&child| &file.source.text[file.tree.key(child)]);
            keys.map(|key| key.trim_matches('"').to_owned()).collect()
        });
        self.spend(context, id, 0, WORK * (template.args.len() + optional.len()))?;
        let mut scope = Scope::around(template.context.scope);
        let with = self.field(context, id, "with");
        if let Some(with) = with {
            let known: BTreeSet<&str> = template.args.iter().chain(&optional).map(String::as_str).collect();
            self.give_values(context, with, &known, &format!("the template `{called}`"), &mut scope)?;
            scope.mark_given();
        }
        if let Some(missing) = template.args.iter().find(|arg| !scope.has(arg)) {
            let at = with.unwrap_or(id);
            let message = format!("the template `{called}` needs a value for `{missing}`");
            let mut error = self.wrong(context, context.file.tree.head(at), message);
            error.path = context.file.tree.path(at, &context.file.source.text);
            error.label = format!("no `{missing}` in here");
            return Err(Box::new(error.with_help(format!("write `with: ({missing}: ..)`"))));
        }
        Ok(scope)
    }

    /// The parameters of the template itself, unless the instance gives them other values.
    fn open_params(&mut self, inner: &Context, template: &Template) -> Outcome<()> {
        let Some(params) = self.field(inner, template.node, "params") else { return Ok(()) };
        let given: BTreeSet<String> = self.scopes[inner.scope].names().map(str::to_owned).collect();
        self.register_params(inner, params, &given)
    }

    /// `set: {"ball.mass": 2}`.
    fn overrides(&mut self, context: &Context, id: Id) -> Outcome<Vec<Rc<Override>>> {
        let Some(set) = self.field(context, id, "set") else { return Ok(Vec::new()) };
        let (tree, text) = (&context.file.tree, &context.file.source.text);
        if tree.node(set).form != Form::Braces {
            let error = self.wrong_value(context, set, "a map `{ \"ball.mass\": .. }`");
            return Err(Box::new(error.with_help(format!("for example: {EXAMPLE}"))));
        }
        let mut overrides = Vec::new();
        for &value in tree.children(set) {
            let path = text[tree.key(value)].trim_matches('"');
            let spread = path.replace('[', ".[");
            let mut parts = spread.split('.');
            let target = parts.next().unwrap_or_default().to_owned();
            let fields: Vec<String> = parts.map(str::to_owned).collect();
            if target.is_empty() || fields.is_empty() || fields.iter().any(String::is_empty) || fields[0] == "name" {
                let message = if fields.first().is_some_and(|field| field == "name") {
                    "a template's names stay as they are".to_owned()
                } else {
                    format!("`{path}` is not the path of a field")
                };
                let mut error = self.wrong(context, tree.key(value), message);
                error.label = "not a path".into();
                let help = "a path names a thing of the template and then its field, such as \"ball.mass\"";
                return Err(Box::new(error.with_help(help)));
            }
            let used = Rc::new(Cell::new(false));
            overrides.push(Rc::new(Override { target, fields, context: context.clone(), value, used }));
        }
        Ok(overrides)
    }
}
