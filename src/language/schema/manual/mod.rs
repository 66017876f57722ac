//! The scene language as a manual in Markdown.

mod parts;
mod plain;
mod value;

pub use parts::LanguagePart;

use std::collections::BTreeMap;
use std::fmt::Write;

use serde_json::Value;

use super::{Content, Entry, Language, Section};
use crate::registry::Arity;

const INTRODUCTION: &str = "\
# The manual of the scene language

<!-- Written by `jostle schema --manual -o docs/manual.md` from the types that read scenes. Mend their doc comments. -->

This page lists every section, entry and field of a scene. [scenes.md](scenes.md) explains how scenes are written, and
[methods.md](methods.md) how the engine computes them. [tour.md](tour.md) builds a scene in ten steps. `jostle schema` writes
the same as JSON schema.

A *quantity* is a bare number in the unit of the column `unit`, or a text with its unit: `0.3`, `\"30 cm\"`. A number
may also be an expression in quotes: `\"2 * r + gap\"`. In *names* of bodies `*` stands for any letters: `\"gas_*\"`. A scene
needs each field without a default.

";

impl Language {
    /// The manual: every section, entry and field with value, unit, default and meaning.
    pub fn manual(&self) -> String {
        let mut manual = Manual::new(self);
        manual.text.push_str(INTRODUCTION);
        manual.contents();
        for section in self.sections.iter().chain([&self.repeat]) {
            manual.section(section);
        }
        manual.text.truncate(manual.text.trim_end().len());
        manual.text.push('\n');
        manual.text
    }

    /// The paths of optional fields whose default the manual omits.
    pub fn without_default(&self) -> Vec<String> {
        let mut missing = Vec::new();
        for (name, schema) in self.named_schemas() {
            each_field(schema, &mut |field, about, needed| {
                if !needed && default_of(about).is_none() {
                    missing.push(format!("{name}.{field}"));
                }
            });
        }
        missing
    }

    /// The defaults that differ between the manual and the program, one line each.
    pub fn wrong_defaults(&self) -> Vec<String> {
        let mut wrong = Vec::new();
        for (name, schema) in self.named_schemas() {
            each_field(schema, &mut |field, about, _| {
                let Some(value) = about.get("default") else { return };
                let in_ron = value::in_ron(value, about, self);
                let told = default_of(about).unwrap_or_default().replace('`', "");
                let empty = value.as_array().is_some_and(Vec::is_empty) || value.as_object().is_some();
                if !empty && !told.starts_with(&in_ron) {
                    wrong.push(format!("{name}.{field}: is {in_ron}, told is `{told}`"));
                }
            });
        }
        wrong
    }

    fn named_schemas(&self) -> Vec<(String, &Value)> {
        let sections = self.sections.iter().flat_map(|section| match &section.content {
            Content::Value(schema) => vec![(section.name.clone(), schema)],
            Content::Entries(_, entries) => {
                let named = |entry: &'_ Entry| format!("{}.{}", section.name, entry.name);
                entries.iter().map(|entry| (named(entry), &entry.schema)).collect()
            }
        });
        sections.chain(self.definitions.iter().map(|(name, schema)| (name.clone(), schema))).collect()
    }
}

/// Calls a function for each field in a schema with its name, schema, and whether it has to be there.
fn each_field(schema: &Value, tell: &mut impl FnMut(&str, &Value, bool)) {
    match schema {
        Value::Object(map) => {
            for (name, about) in schema["properties"].as_object().into_iter().flatten() {
                tell(name, about, is_needed(schema, name));
            }
            map.values().for_each(|value| each_field(value, tell));
        }
        Value::Array(list) => list.iter().for_each(|value| each_field(value, tell)),
        _ => {}
    }
}

fn is_needed(schema: &Value, field: &str) -> bool {
    schema["required"].as_array().is_some_and(|needed| needed.iter().any(|name| name == field))
}

fn description(schema: &Value) -> &str {
    schema["description"].as_str().unwrap_or_default()
}

const DEFAULT: &str = "Default: ";

/// The default of a field in its description.
fn default_of(schema: &Value) -> Option<String> {
    let (_, default) = description(schema).split_once(DEFAULT)?;
    Some(default.trim().trim_end_matches('.').to_owned())
}

/// The description without its sentence on the default.
fn meaning_of(schema: &Value) -> &str {
    let text = description(schema);
    text.split_once(DEFAULT).map_or(text, |(meaning, _)| meaning).trim()
}

/// The anchor that GitHub and others make of a heading.
pub fn anchor(heading: &str) -> String {
    let kept = heading.chars().filter(|c| c.is_alphanumeric() || matches!(c, ' ' | '-' | '_'));
    kept.collect::<String>().to_lowercase().replace(' ', "-")
}

struct Manual<'a> {
    language: &'a Language,
    text: String,
    /// The headings of definitions, by their names.
    places: BTreeMap<&'a str, String>,
}

impl<'a> Manual<'a> {
    fn new(language: &'a Language) -> Self {
        Self { language, text: String::new(), places: BTreeMap::new() }
    }

    fn line(&mut self, line: &str) {
        self.text.push_str(line);
        self.text.push('\n');
    }

    fn paragraph(&mut self, text: &str) {
        if !text.is_empty() {
            let _ = write!(self.text, "{text}\n\n");
        }
    }

    fn example(&mut self, example: &str) {
        if !example.is_empty() {
            let _ = write!(self.text, "```ron\n{example}\n```\n\n");
        }
    }

    fn contents(&mut self) {
        self.line("| section | meaning |");
        self.line("|---|---|");
        for section in self.language.sections.iter().chain([&self.language.repeat]) {
            let meaning = self.meaning(section);
            let first = meaning.split("\n\n").next().unwrap_or_default();
            let end = first.find(". ").map_or(first.len(), |end| end + 1);
            let row = format!("| [`{0}`](#{1}) | {2} |", section.name, anchor(&section.name), in_cell(&first[..end]));
            self.line(&row);
        }
        self.line("");
    }

    fn meaning(&self, section: &'a Section) -> &'a str {
        match &section.content {
            Content::Value(schema) => {
                meaning_of(if schema["description"].is_null() { self.language.resolve(schema).1 } else { schema })
            }
            _ => &section.meaning,
        }
    }

    fn section(&mut self, section: &'a Section) {
        self.paragraph(&format!("## `{}`", section.name));
        let meaning = self.meaning(section);
        self.paragraph(meaning);
        self.example(section.example);
        match &section.content {
            Content::Value(schema) => {
                if let (Some(name), _) = self.language.resolve(schema) {
                    self.places.insert(name, section.name.clone());
                }
                self.value(&section.name, schema);
            }
            Content::Entries(arity, entries) => {
                let names: Vec<String> = entries.iter().map(|entry| format!("`{}`", entry.name)).collect();
                self.paragraph(&match arity {
                    Arity::List => format!("A list of any of {}.", names.join(", ")),
                    Arity::Words => {
                        format!("A list of any of {}. Without fields they need no brackets.", names.join(", "))
                    }
                    Arity::One => format!("One of {}.", names.join(", ")),
                    Arity::OneOrNone => format!("One of {}, or `None`.", names.join(", ")),
                });
                for entry in entries {
                    self.entry(&section.name, entry);
                }
            }
        }
    }

    fn entry(&mut self, section: &str, entry: &'a Entry) {
        self.paragraph(&format!("### `{section}: {}`", entry.name));
        let (_, about) = self.language.resolve(&entry.schema);
        self.paragraph(meaning_of(about));
        self.example(entry.example);
        self.value(entry.name, &entry.schema);
    }
}

/// The text for a cell of a table.
fn in_cell(text: &str) -> String {
    text.replace('|', "\\|").replace("\n\n", " ").replace('\n', " ")
}
