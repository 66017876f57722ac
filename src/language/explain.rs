//! Errors of the RON reader in plain words and at the right place.
//!
//! `ron` gives a byte and a reason. The tree of the text gives the value at that byte and the path of the value.

use ron::Error;
use serde::de::DeserializeOwned;

use super::error::SceneError;
use super::schema::{Describe, nearest_example};
use super::suggest;
use super::syntax::{Form, Id, Tree};

/// The reason why the reader stopped, and the byte, counted from the beginning of the value's text.
#[derive(Debug)]
pub struct Fault {
    pub(crate) code: Error,
    pub(crate) offset: usize,
}

impl Fault {
    /// The same in a text that begins so many bytes earlier.
    #[must_use]
    pub fn behind(self, bytes: usize) -> Self {
        Self { offset: self.offset + bytes, ..self }
    }
}

impl std::fmt::Display for Fault {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        self.code.fmt(f)
    }
}

/// Reads a value with the settings of the scene language.
///
/// # Errors
/// The [`Fault`] that stopped the reading.
pub fn read<T: DeserializeOwned>(text: &str) -> Result<T, Fault> {
    use ron::extensions::Extensions;
    let settings = ron::Options::default()
        .with_default_extension(Extensions::UNWRAP_NEWTYPES)
        .with_default_extension(Extensions::IMPLICIT_SOME | Extensions::UNWRAP_VARIANT_NEWTYPES);
    let mut reader = ron::Deserializer::from_str_with_options(text, &settings)
        .map_err(|error| Fault { code: error.code, offset: 0 })?;
    let value = T::deserialize(&mut reader).and_then(|value| reader.end().map(|()| value));
    let offset = text.len() - reader.remainder().len();
    value.map_err(|code| Fault { code, offset })
}

/// A text with its tree.
#[derive(Clone, Copy)]
pub(crate) struct Walked<'a> {
    pub(crate) text: &'a str,
    pub(crate) tree: &'a Tree,
}

/// How serde calls several values behind a name.
const TUPLE: &str = "tuple variant ";

/// The section or entry that a text should be.
#[derive(Clone, Copy)]
pub(crate) struct Wanted<'a> {
    /// The value in the tree.
    pub(crate) node: Id,
    /// One correct use of it.
    pub(crate) example: &'a str,
    pub(crate) describe: Describe,
}

/// Fields and choices inside sections that are kept for later versions of the language.
const LATER: [&str; 2] = ["shape", "soft"];

impl Walked<'_> {
    fn path(&self, id: Id) -> String {
        self.tree.path(id, self.text)
    }

    fn found(&self, id: Id) -> String {
        self.tree.describe(id, self.text)
    }

    /// The name of a value in its path, for "`clock` has no field ..".
    fn name(&self, id: Id) -> String {
        match self.tree.name(id, self.text) {
            "" => match self.path(id).as_str() {
                "" => "the scene".into(),
                path => format!("`{path}`"),
            },
            name => format!("`{name}`"),
        }
    }

    /// Turns a reader's fault into a mistake with a place. `offset` counts from the beginning of the scene.
    pub(crate) fn explain(&self, code: &Error, offset: usize, wanted: Wanted<'_>) -> SceneError {
        let at = self.tree.innermost(offset, false);
        let behind = self.tree.innermost(offset, true);
        let for_example = |id: Id| {
            let near = nearest_example(wanted.describe, *self, wanted.node, id);
            format!("for example: {}", near.as_deref().unwrap_or(wanted.example))
        };
        let wrong = |id: Id, expected: &str| {
            SceneError::new(self.path(id), format!("expected {expected}, found {}", self.found(id)))
                .at(self.tree.head_or_value(id), format!("not {}", article(expected)))
                .with_help(for_example(id))
        };
        match code {
            Error::NoSuchStructField { found, .. } | Error::NoSuchEnumVariant { found, .. }
                if LATER.contains(&found.as_str()) =>
            {
                let span = self.tree.span(behind);
                let span = match code {
                    Error::NoSuchStructField { .. } => self.tree.head(behind),
                    _ => span.start..(span.start + found.len()).min(span.end),
                };
                SceneError::new(self.path(behind), format!("`{found}` is not available yet"))
                    .at(span, "not available yet")
                    .with_help("the name is reserved for a later version; remove it")
            }
            Error::NoSuchStructField { expected, found, .. } => {
                let key = behind;
                let parent = self.tree.node(key).parent;
                let message = format!("{} has no field `{found}`", self.name(parent));
                let help = if expected.is_empty() {
                    "it takes no fields: write `()`".to_owned()
                } else {
                    suggest::among(found, expected.iter().copied(), "fields", '`')
                };
                SceneError::new(self.path(key), message).at(self.tree.head(key), "unknown field").with_help(help)
            }
            Error::NoSuchEnumVariant { expected, found, .. } => {
                let help = suggest::among(found, expected.iter().copied(), "choices", '`');
                let span = self.tree.span(behind);
                let span = span.start..(span.start + found.len()).min(span.end);
                SceneError::new(self.path(behind), format!("`{found}` is not one of the choices"))
                    .at(span, "unknown")
                    .with_help(help)
            }
            Error::MissingStructField { field, .. } => {
                let message = format!("the field `{field}` is missing");
                SceneError::new(self.path(at), message)
                    .at(self.tree.head(at), format!("`{field}: ..` is missing in here"))
                    .with_help(for_example(at))
            }
            Error::DuplicateStructField { field, .. } => {
                SceneError::new(self.path(behind), format!("`{field}` stands here twice"))
                    .at(self.tree.head(behind), "the second time")
                    .with_help("keep one of the two")
            }
            Error::ExpectedDifferentStructName { found, .. } => {
                SceneError::new(self.path(behind), format!("no name `{found}` belongs here"))
                    .at(self.tree.span(behind).start..offset, "remove this name")
                    .with_help(for_example(behind))
            }
            Error::InvalidValueForType { .. } if self.tree.key(behind).end == offset && offset > 0 => {
                let key = self.tree.key(behind);
                let message = format!("the values in here have no names, found `{}: ..`", &self.text[key.clone()]);
                let parent = self.tree.node(behind).parent;
                SceneError::new(self.path(parent), message).at(key, "no name here").with_help(for_example(parent))
            }
            Error::InvalidValueForType { expected, .. } | Error::ExpectedDifferentLength { expected, .. }
                if expected.starts_with(TUPLE) =>
            {
                let (name, count) = expected.split_once(" with ").unwrap_or((expected, "other elements"));
                let name = name.rsplit("::").next().unwrap_or(name);
                let count = count.replace("element", "value");
                let mut whole = behind;
                while whole != wanted.node && self.tree.name(whole, self.text) != name {
                    whole = self.tree.node(whole).parent;
                }
                let found = self.tree.children(whole).len();
                SceneError::new(self.path(whole), format!("`{name}` takes {count}, found {found}"))
                    .at(self.tree.head_or_value(whole), format!("not {count}"))
                    .with_help(for_example(whole))
            }
            Error::InvalidValueForType { expected, .. } => wrong(behind, expected),
            Error::ExpectedDifferentLength { expected, .. } => {
                let count = expected.strip_prefix("a tuple of size ");
                wrong(at, &count.map_or(expected.clone(), |count| format!("{count} values in round brackets")))
            }
            Error::Message(message) => {
                SceneError::new(self.path(behind), message.clone()).at(self.tree.head_or_value(behind), "this value")
            }
            Error::ExpectedBoolean => wrong(at, "`true` or `false`"),
            Error::ExpectedString if offset < self.tree.key(at).end => {
                let key = self.tree.key(at);
                let name = &self.text[key.clone()];
                SceneError::new(self.path(at), format!("the name `{name}` must stand in quotes"))
                    .at(key, "needs quotes")
                    .with_help(format!("write `\"{name}\": ..`"))
            }
            Error::ExpectedString | Error::ExpectedStringEnd => wrong(at, "a text in quotes"),
            Error::ExpectedFloat | Error::ExpectedInteger => wrong(at, "a number"),
            Error::ExpectedArray => wrong(at, "a list `[..]`"),
            Error::ExpectedMap => wrong(at, "a map `{ \"name\": (..) }`"),
            Error::ExpectedStructLike | Error::ExpectedNamedStructLike(_) | Error::ExpectedUnit => {
                let word = self.tree.innermost(self.text[..offset.min(self.text.len())].trim_end().len(), true);
                if self.tree.node(word).form == Form::Word && word != at {
                    let name = self.found(word).replace("the word ", "");
                    return SceneError::new(self.path(word), format!("brackets are missing after {name}"))
                        .at(self.tree.span(word), "`(..)` expected after this")
                        .with_help(for_example(word));
                }
                match self.tree.name(at, self.text) {
                    "" => wrong(at, "round brackets `(..)`"),
                    name => {
                        let start = self.tree.span(at).start;
                        SceneError::new(self.path(at), format!("no name `{name}` belongs here"))
                            .at(start..start + name.len(), "remove this name")
                            .with_help(for_example(at))
                    }
                }
            }
            Error::ExpectedIdentifier if self.tree.node(at).form == Form::Round => {
                SceneError::new(self.path(at), "expected a field name".to_owned())
                    .at(self.tree.head(at), "in here")
                    .with_help(for_example(at))
            }
            Error::ExpectedIdentifier | Error::SuggestRawIdentifier(_) | Error::InvalidIdentifier(_) => {
                if self.tree.key(at).is_empty() && self.tree.node(self.tree.node(at).parent).form == Form::Round {
                    let name = self.found(at);
                    SceneError::new(self.path(at), format!("expected a field name and `:`, found {name}"))
                        .at(self.tree.head_or_value(at), "no field name")
                        .with_help(for_example(at))
                } else if nearest_example(wanted.describe, *self, wanted.node, at).is_some() {
                    wrong(at, "one of the choices")
                } else {
                    wrong(at, "a word without quotes")
                }
            }
            Error::ExpectedStructLikeEnd | Error::ExpectedArrayEnd | Error::ExpectedMapEnd => {
                SceneError::new(self.path(at), "there is more in these brackets than belongs here".to_owned())
                    .at(self.tree.head_or_value(at), "too much")
                    .with_help(for_example(at))
            }
            Error::ExpectedComma | Error::TrailingCharacters if self.tree.node(behind).form == Form::Round => {
                let start = self.tree.span(behind).start;
                let name = self.tree.name(behind, self.text).len().max(1);
                SceneError::new(self.path(behind), format!("{} takes nothing in brackets", self.name(behind)))
                    .at(start..start + name, "remove the brackets after it")
                    .with_help(for_example(behind))
            }
            Error::IntegerOutOfBounds | Error::ExpectedComma => wrong(at, "a whole number that is not too large"),
            Error::InvalidEscape(why) => SceneError::new(self.path(at), format!("this text has a wrong `\\`: {why}"))
                .at(self.tree.head_or_value(at), "in here")
                .with_help("write `\\\\` for a single backslash"),
            Error::ExceededRecursionLimit => {
                SceneError::new(self.path(at), "brackets are nested too deeply".to_owned())
                    .at(self.tree.head(at), "too deep")
            }
            other => SceneError::new(self.path(at), lower_first(&other.to_string()))
                .at(self.tree.head_or_value(at), "here")
                .with_help(for_example(at)),
        }
    }
}

impl Tree {
    /// The whole value if it is short, or else its head.
    pub(crate) fn head_or_value(&self, id: Id) -> std::ops::Range<usize> {
        match self.node(id).form {
            Form::Number | Form::Text | Form::Word | Form::Character => self.span(id),
            _ if self.span(id).len() <= 60 => self.span(id),
            _ => self.head(id),
        }
    }
}

/// The first words of an expectation, short enough for the line beside a caret.
fn article(expected: &str) -> String {
    let end = [" such as", ", each"].iter().filter_map(|stop| expected.find(stop)).min().unwrap_or(expected.len());
    expected[..end].to_owned()
}

fn lower_first(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or_else(String::new, |first| first.to_lowercase().chain(letters).collect())
}
