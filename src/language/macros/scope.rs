//! Scopes of names with values: parameters, arguments of templates, the numbers of repetitions.

use std::collections::BTreeMap;

use super::emit::{Context, WORK, WORK_OF_TEXT};
use super::expression::{self, FormulaMistake};
use super::quantity::Number;
use super::{Expander, Outcome};
use crate::error::SceneError;
use crate::suggest;
use crate::syntax::{Form, Id};
use crate::units;

/// Parameters may depend on each other this deep.
const DEEPEST: usize = 100;
/// Texts that are put together may be this long, in bytes.
const LONGEST_TEXT: usize = 1 << 16;

/// The meaning of a name.
#[derive(Clone)]
pub(super) enum Value {
    Number(Number),
    Text(String),
    /// A text that an instance gives its template. It names things of the template, or of the place of the instance. It
    /// never names things of the template's file.
    Given(String),
    /// Any other value, as it stands in a file.
    Node(Context, Id),
}

#[derive(Clone)]
enum Binding {
    Known(Value),
    /// Worked out when it is first asked for.
    Open(Context, Id),
    /// From outside the scene.
    Given(String),
}

/// A text with what stood in braces filled in.
pub(super) struct Filled {
    pub(super) text: String,
    /// Whether a [`Value::Given`] is in it.
    pub(super) given: bool,
}

/// Names with values. The scope around it resolves all other names.
#[derive(Default)]
pub(super) struct Scope {
    pub(super) around: Option<usize>,
    bindings: BTreeMap<String, Binding>,
}

impl Scope {
    pub(super) fn around(around: usize) -> Self {
        Self { around: Some(around), ..Self::default() }
    }

    pub(super) fn set(&mut self, name: &str, value: Value) {
        self.bindings.insert(name.to_owned(), Binding::Known(value));
    }

    pub(super) fn open(&mut self, name: &str, context: &Context, id: Id) {
        self.bindings.insert(name.to_owned(), Binding::Open(context.clone(), id));
    }

    pub(super) fn give(&mut self, name: &str, text: &str) {
        self.bindings.insert(name.to_owned(), Binding::Given(text.to_owned()));
    }

    /// Marks its texts as those that an instance gives its template.
    pub(super) fn mark_given(&mut self) {
        for binding in self.bindings.values_mut() {
            if let Binding::Known(Value::Text(text)) = binding {
                *binding = Binding::Known(Value::Given(std::mem::take(text)));
            }
        }
    }

    pub(super) fn has(&self, name: &str) -> bool {
        self.bindings.contains_key(name)
    }

    pub(super) fn names(&self) -> impl Iterator<Item = &str> + Clone {
        self.bindings.keys().map(String::as_str)
    }
}

/// Why a name has no value: because it is unknown, or because of a mistake elsewhere.
enum Missing {
    Unknown,
    Elsewhere(Box<SceneError>),
}

impl Expander {
    /// The meaning of a name, seen from a place. `asked` are the parameters that are being evaluated.
    fn find(&mut self, scope: usize, name: &str, asked: &mut Vec<(usize, String)>) -> Result<Value, Missing> {
        let mut at = Some(scope);
        while let Some(number) = at {
            match self.scopes[number].bindings.get(name) {
                Some(Binding::Known(value)) => return Ok(value.clone()),
                Some(open) => {
                    let open = open.clone();
                    let value = self.work_out(number, name, open, asked).map_err(Missing::Elsewhere)?;
                    self.scopes[number].set(name, value.clone());
                    return Ok(value);
                }
                None => at = self.scopes[number].around,
            }
        }
        Err(Missing::Unknown)
    }

    fn work_out(
        &mut self,
        scope: usize,
        name: &str,
        open: Binding,
        asked: &mut Vec<(usize, String)>,
    ) -> Outcome<Value> {
        let first = asked.iter().position(|(other, known)| *other == scope && known == name);
        let objection = match first {
            Some(first) if first + 1 == asked.len() => Some(format!("the parameter `{name}` is made from itself")),
            Some(first) => {
                let names = asked[first..].iter().map(|(_, name)| name.as_str()).chain([name]);
                let circle: Vec<String> = names.map(|name| format!("`{name}`")).collect();
                Some(format!("parameters are made from each other in a circle: {}", circle.join(" needs ")))
            }
            None if asked.len() >= DEEPEST => {
                Some(format!("parameters are made from each other more than {DEEPEST} deep"))
            }
            None => None,
        };
        let (context, id) = match open {
            Binding::Known(value) => return Ok(value),
            Binding::Given(text) => {
                let path = format!("--set {name}");
                if let Some(message) = objection {
                    return Err(Box::new(SceneError::new(path, message).with_help("give it a number")));
                }
                asked.push((scope, name.to_owned()));
                let value = self.text_value(scope, &text, asked);
                asked.pop();
                return value.map_err(|failed| {
                    failed.into_error(|wrong| {
                        let message = format!("{} in `{text}`", wrong.message);
                        Box::new(SceneError { help: wrong.help, ..SceneError::new(path, message) })
                    })
                });
            }
            Binding::Open(context, id) => (context, id),
        };
        if let Some(message) = objection {
            let mut error = self.wrong(&context, context.file.tree.head_or_value(id), message);
            error.label = "needs itself".into();
            return Err(Box::new(error.with_help("give one of them a number")));
        }
        let text = if context.file.tree.node(id).form == Form::Text { context.text(id) } else { None };
        let Some((text, shift)) = text else { return self.read_value(&context, id) };
        asked.push((scope, name.to_owned()));
        let value = self.text_value(context.scope, &text, asked);
        asked.pop();
        value.map_err(|failed| failed.into_error(|wrong| Box::new(self.wrong_expression(&context, id, shift, wrong))))
    }

    /// The value of a parameter or argument: a number, a text or any other form.
    pub(super) fn read_value(&mut self, context: &Context, id: Id) -> Outcome<Value> {
        let tree = &context.file.tree;
        self.spend(context, id, 0, WORK + WORK_OF_TEXT * tree.span(id).len())?;
        match tree.node(id).form {
            Form::Number => self.number(context, id).map(Value::Number),
            Form::Text => {
                let Some((text, shift)) = context.text(id) else { return Ok(Value::Node(context.clone(), id)) };
                let value = self.text_value(context.scope, &text, &mut Vec::new());
                let error = |wrong| Box::new(self.wrong_expression(context, id, shift, wrong));
                let value = value.map_err(|failed| failed.into_error(error))?;
                Ok(match value {
                    Value::Text(text) => Value::Text(context.place.resolved(&text).unwrap_or(text)),
                    Value::Given(text) => Value::Given(context.place.own(&text).unwrap_or(text)),
                    value => value,
                })
            }
            _ => Ok(Value::Node(context.clone(), id)),
        }
    }

    /// A text in quotes in place of a value: an expression, or a text if it cannot be an expression.
    fn text_value(&mut self, scope: usize, text: &str, asked: &mut Vec<(usize, String)>) -> Result<Value, Failed> {
        if text.contains('{') {
            let Filled { text, given } = self.fill_in(scope, text, asked)?;
            return Ok(if given { Value::Given(text) } else { Value::Text(text) });
        }
        if is_name(text) {
            return match self.find(scope, text.trim(), asked) {
                Ok(value) => Ok(value),
                Err(Missing::Unknown) => Ok(Value::Text(text.to_owned())),
                Err(Missing::Elsewhere(error)) => Err(Failed::Elsewhere(error)),
            };
        }
        match self.evaluate(scope, text, asked) {
            Ok(number) => Ok(Value::Number(number)),
            Err(Failed::Here(wrong)) => {
                // A name such as `steel-blue` has neither a number nor a known name in it.
                let digits = text.contains(|c: char| c.is_ascii_digit());
                let words = text.split(|c: char| !(c.is_ascii_alphanumeric() || c == '_'));
                let known = words.filter(|word| !word.is_empty()).any(|word| self.is_known(scope, word));
                let meant = (digits || known) && text.contains(['+', '-', '*', '/', '^', '(']);
                if meant { Err(Failed::Here(wrong)) } else { Ok(Value::Text(text.to_owned())) }
            }
            Err(elsewhere) => Err(elsewhere),
        }
    }

    /// Whether a name has a value, seen from a place.
    pub(super) fn is_known(&self, scope: usize, name: &str) -> bool {
        let scopes = std::iter::successors(Some(scope), |&scope| self.scopes[scope].around);
        scopes.into_iter().any(|scope| self.scopes[scope].bindings.contains_key(name))
    }

    /// Works out an expression.
    fn evaluate(&mut self, scope: usize, text: &str, asked: &mut Vec<(usize, String)>) -> Result<Number, Failed> {
        let mut elsewhere = None;
        let value = expression::evaluate(text, &mut |name| match self.find(scope, name, asked) {
            Ok(Value::Number(number)) => Ok(number),
            Ok(Value::Text(text) | Value::Given(text)) => {
                Err((format!("`{name}` is the text \"{text}\", not a number"), None))
            }
            Ok(Value::Node(..)) => Err((format!("`{name}` is not a number"), None)),
            Err(Missing::Unknown) if self.quiet => Err((String::new(), None)),
            Err(Missing::Unknown) => Err((format!("`{name}` has no value here"), Some(self.known(scope, name)))),
            Err(Missing::Elsewhere(error)) => {
                elsewhere = Some(error);
                Err((String::new(), None))
            }
        });
        match elsewhere {
            Some(error) => Err(Failed::Elsewhere(error)),
            None => value.map_err(Failed::Here),
        }
    }

    /// The names that are valid at a place, nearest first, as help for an unknown one.
    fn known(&self, scope: usize, name: &str) -> String {
        let scopes = std::iter::successors(Some(scope), |&scope| self.scopes[scope].around);
        let names: Vec<&str> = scopes.flat_map(|scope| self.scopes[scope].names()).collect();
        suggest::among(name, names.iter().copied(), "names with a value here", '`')
    }

    /// `bob_{i}`: texts with expressions in braces; `{{` and `}}` are braces.
    fn fill_in(&mut self, scope: usize, text: &str, asked: &mut Vec<(usize, String)>) -> Result<Filled, Failed> {
        let here = |range, message: &str, help: &str| {
            Failed::Here(FormulaMistake { range, message: message.to_owned(), help: Some(help.to_owned()) })
        };
        let mut filled = String::new();
        let mut given = false;
        let mut at = 0;
        while let Some(brace) = text[at..].find(['{', '}']).map(|length| at + length) {
            filled.push_str(&text[at..brace]);
            if text[brace..].starts_with("{{") || text[brace..].starts_with("}}") {
                filled.push_str(&text[brace..=brace]);
                at = brace + 2;
                continue;
            }
            let help = "an expression stands in braces, as in `ball_{i}`; for a brace itself write `{{` or `}}`";
            let end = text[brace..].find('}').filter(|length| *length > 0).map(|length| brace + length);
            let Some(end) = end else { return Err(here(brace..brace + 1, "this brace stands alone", help)) };
            let inner = &text[brace + 1..end];
            let shift = |mut wrong: FormulaMistake| {
                wrong.range = wrong.range.start + brace + 1..wrong.range.end + brace + 1;
                Failed::Here(wrong)
            };
            let value = match is_name(inner).then(|| self.find(scope, inner.trim(), asked)) {
                Some(Ok(value)) => Some(value),
                Some(Err(Missing::Elsewhere(error))) => return Err(Failed::Elsewhere(error)),
                Some(Err(Missing::Unknown)) | None => None,
            };
            match value {
                Some(Value::Text(text)) => filled.push_str(&text),
                Some(Value::Given(text)) => {
                    filled.push_str(&text);
                    given = true;
                }
                _ => {
                    let number = self.evaluate(scope, inner, asked).map_err(|failed| match failed {
                        Failed::Here(wrong) => shift(wrong),
                        elsewhere => elsewhere,
                    })?;
                    filled.push_str(&number.shown());
                }
            }
            if filled.len() > LONGEST_TEXT {
                return Err(here(brace..end + 1, "the text becomes too long", "a text may have 65536 bytes"));
            }
            at = end + 1;
        }
        filled.push_str(&text[at..]);
        Ok(Filled { text: filled, given })
    }

    /// A text of the scene with the expressions in braces evaluated.
    pub(super) fn filled(&mut self, context: &Context, id: Id, text: &str, shift: Option<usize>) -> Outcome<Filled> {
        if !text.contains(['{', '}']) {
            return Ok(Filled { text: text.to_owned(), given: false });
        }
        let filled = self.fill_in(context.scope, text, &mut Vec::new());
        filled.map_err(|failed| failed.into_error(|wrong| Box::new(self.wrong_expression(context, id, shift, wrong))))
    }

    /// The value of a quoted text, if it is an expression; else the reason why it is not.
    pub(super) fn expression(&mut self, context: &Context, text: &str) -> Result<Value, Failed> {
        if is_name(text) {
            match self.find(context.scope, text.trim(), &mut Vec::new()) {
                Ok(value) => return Ok(value),
                Err(Missing::Elsewhere(error)) => return Err(Failed::Elsewhere(error)),
                Err(Missing::Unknown) => {}
            }
        }
        self.evaluate(context.scope, text, &mut Vec::new()).map(Value::Number)
    }

    /// A number, or an expression that is one.
    pub(super) fn number(&mut self, context: &Context, id: Id) -> Outcome<Number> {
        let (tree, text) = (&context.file.tree, &context.file.source.text);
        match tree.node(id).form {
            Form::Number => {
                let value = ron::from_str::<f64>(&text[tree.span(id)]).ok().map(Number::plain);
                value.ok_or_else(|| Box::new(self.wrong_value(context, id, "a number")))
            }
            Form::Text => {
                let Some((text, shift)) = context.text(id) else {
                    return Err(Box::new(self.wrong_value(context, id, "a number or an expression")));
                };
                let value = self.evaluate(context.scope, &text, &mut Vec::new());
                let error = |wrong| Box::new(self.wrong_expression(context, id, shift, wrong));
                value.map_err(|failed| failed.into_error(error))
            }
            _ => Err(Box::new(self.wrong_value(context, id, "a number or an expression"))),
        }
    }

    /// A mistake inside an expression, under its own letters. `shift` is the first byte of its text in the file, if the
    /// file holds the text unchanged.
    pub(super) fn wrong_expression(
        &self,
        context: &Context,
        id: Id,
        shift: Option<usize>,
        wrong: FormulaMistake,
    ) -> SceneError {
        let whole = context.file.tree.span(id);
        let span = match shift {
            Some(shift) if !wrong.range.is_empty() => wrong.range.start + shift..wrong.range.end + shift,
            _ => whole,
        };
        let mut error = self.wrong(context, span, wrong.message);
        error.path = context.file.tree.path(id, &context.file.source.text);
        error.label = "in this expression".into();
        error.help = wrong.help;
        error
    }
}

/// The reason why a text has no value: a mistake in the text, or in a parameter that it uses.
pub(super) enum Failed {
    Here(FormulaMistake),
    Elsewhere(Box<SceneError>),
}

impl Failed {
    fn into_error(self, here: impl FnOnce(FormulaMistake) -> Box<SceneError>) -> Box<SceneError> {
        match self {
            Self::Here(wrong) => here(wrong),
            Self::Elsewhere(error) => error,
        }
    }
}

/// Whether a text is one name and nothing else.
fn is_name(text: &str) -> bool {
    let name = text.trim();
    !name.is_empty() && expression::name_length(name) == name.len()
}

/// Whether a quoted text is a number with its unit and nothing else: such a text needs no working out.
pub(super) fn is_quantity(text: &str) -> bool {
    units::is_quantity(text)
}
