//! A scene as it is written: values that print as RON.

use std::fmt;

/// A value of a scene.
#[derive(Clone, Debug, PartialEq)]
pub enum Written {
    /// A number or a word: it stands as it is.
    Bare(String),
    /// A text in quotes.
    Text(String),
    /// `[a, b]`.
    List(Vec<Written>),
    /// `(a, b)`.
    Tuple(Vec<Written>),
    /// `(name: a)`.
    Fields(Vec<(String, Written)>),
    /// `{ "name": a }`.
    Map(Vec<(String, Written)>),
    /// `Name(a)`; the brackets of fields and tuples are those of the name.
    Named(String, Box<Written>),
}

/// Digits after the first one: enough to tell numbers apart, few enough to read.
const DIGITS: usize = 3;

impl Written {
    /// A number with few digits.
    pub fn rounded(value: f64) -> Self {
        Self::exactly(format!("{value:.DIGITS$e}").parse().unwrap_or(value))
    }

    /// A number with all its digits.
    pub fn exactly(value: f64) -> Self {
        Self::Bare(format!("{value:?}"))
    }

    /// Two numbers with all their digits.
    pub fn pair(x: f64, y: f64) -> Self {
        Self::Tuple(vec![Self::exactly(x), Self::exactly(y)])
    }

    /// A text in quotes.
    pub fn text(text: &str) -> Self {
        Self::Text(text.to_owned())
    }

    /// The fields of a structure; `None` for other values.
    pub fn fields_mut(&mut self) -> Option<&mut Vec<(String, Self)>> {
        match self {
            Self::Fields(fields) => Some(fields),
            Self::Named(_, inner) => inner.fields_mut(),
            _ => None,
        }
    }

    /// A field of a structure.
    pub fn field(&self, name: &str) -> Option<&Self> {
        match self {
            Self::Fields(fields) => fields.iter().find(|(key, _)| key == name).map(|(_, value)| value),
            Self::Named(_, inner) => inner.field(name),
            _ => None,
        }
    }

    /// Gives a field another value, or a structure a new field.
    pub fn set(&mut self, name: &str, value: Self) {
        let Some(fields) = self.fields_mut() else { return };
        match fields.iter_mut().find(|(key, _)| key == name) {
            Some((_, old)) => *old = value,
            None => fields.push((name.to_owned(), value)),
        }
    }

    /// Removes a field from a structure.
    pub fn remove(&mut self, name: &str) {
        if let Some(fields) = self.fields_mut() {
            fields.retain(|(key, _)| key != name);
        }
    }

    /// The number, if it is one.
    pub fn number(&self) -> Option<f64> {
        match self {
            Self::Bare(text) => text.parse().ok(),
            _ => None,
        }
    }

    /// The text or word, if it is one.
    pub fn word(&self) -> Option<&str> {
        match self {
            Self::Bare(text) | Self::Text(text) => Some(text),
            _ => None,
        }
    }

    /// The two numbers of a pair.
    pub fn numbers(&self) -> Option<(f64, f64)> {
        match self {
            Self::Tuple(items) => items.first()?.number().zip(items.get(1)?.number()),
            _ => None,
        }
    }
}

fn joined(f: &mut fmt::Formatter, items: &[Written]) -> fmt::Result {
    for (index, item) in items.iter().enumerate() {
        write!(f, "{}{item}", if index > 0 { ", " } else { "" })?;
    }
    Ok(())
}

fn named(f: &mut fmt::Formatter, fields: &[(String, Written)]) -> fmt::Result {
    for (index, (name, value)) in fields.iter().enumerate() {
        write!(f, "{}{name}: {value}", if index > 0 { ", " } else { "" })?;
    }
    Ok(())
}

impl fmt::Display for Written {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Bare(text) => f.write_str(text),
            Self::Text(text) => write!(f, "{text:?}"),
            Self::List(items) => {
                f.write_str("[")?;
                joined(f, items)?;
                f.write_str("]")
            }
            Self::Tuple(items) => {
                f.write_str("(")?;
                joined(f, items)?;
                f.write_str(")")
            }
            Self::Fields(fields) => {
                f.write_str("(")?;
                named(f, fields)?;
                f.write_str(")")
            }
            Self::Map(fields) => {
                f.write_str("{ ")?;
                for (index, (name, value)) in fields.iter().enumerate() {
                    write!(f, "{}{name:?}: {value}", if index > 0 { ", " } else { "" })?;
                }
                f.write_str(" }")
            }
            Self::Named(name, inner) => match &**inner {
                Self::Fields(_) => write!(f, "{name}{inner}"),
                _ => write!(f, "{name}({inner})"),
            },
        }
    }
}

/// A scene with a line for each section, and one for each item of its lists.
pub fn scene(sections: &[(String, Written)]) -> String {
    let mut text = "Scene(\n".to_owned();
    for (name, value) in sections {
        match value {
            Written::List(items) if !items.is_empty() => {
                let lines: String = items.iter().map(|item| format!("        {item},\n")).collect();
                text += &format!("    {name}: [\n{lines}    ],\n");
            }
            _ => text += &format!("    {name}: {value},\n"),
        }
    }
    text + ")\n"
}
