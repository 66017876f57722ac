//! Fields and choices by their names, wherever a scene may hold them, for the terminal.

use std::collections::BTreeSet;

use serde_json::Value;

use super::super::choices::choice;
use super::plain::line_of;
use super::value::words_of;
use super::{Content, Language, Manual, description};

/// A field or choice, and the places where it may stand.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LanguagePart {
    /// Its name, as scenes write it.
    pub name: String,
    /// The paths of the values that may hold it, such as `bodies[..].shape: Capsule`.
    pub places: Vec<String>,
    /// Its meaning; of a field its value, unit and default too.
    pub told: String,
    /// Whether it is a field.
    pub is_field: bool,
}

impl Language {
    /// All fields and choices of sections and entries. Those of one name and meaning are one part with several places. A type that several
    /// fields hold counts at the first of them.
    pub fn parts(&self) -> Vec<LanguagePart> {
        let mut walk = Walk { manual: Manual::new(self), seen: BTreeSet::new(), parts: Vec::new() };
        for section in self.sections.iter().chain([&self.repeat]) {
            match &section.content {
                Content::Value(schema) => walk.value(&section.name, schema),
                Content::Entries(_, entries) => {
                    for entry in entries {
                        let place = format!("{}: {}", section.name, entry.name);
                        walk.value(&place, &entry.schema);
                    }
                }
            }
        }
        walk.parts
    }
}

struct Walk<'a> {
    manual: Manual<'a>,
    /// The definitions that were visited.
    seen: BTreeSet<&'a str>,
    parts: Vec<LanguagePart>,
}

impl<'a> Walk<'a> {
    fn value(&mut self, place: &str, schema: &'a Value) {
        let (definition, about) = self.manual.language.resolve(schema);
        if definition.is_some_and(|definition| !self.seen.insert(definition)) {
            return;
        }
        for (name, field) in about["properties"].as_object().into_iter().flatten() {
            let told = line_of(&self.manual, about, name, field);
            self.add(name, place, told, true);
        }
        for (name, field) in about["properties"].as_object().into_iter().flatten() {
            self.value(&format!("{place}.{name}"), field);
        }
        for key in ["items", "additionalProperties"] {
            if about[key].is_object() {
                // The items of a section that is a list are its own.
                let inner = if place.contains('.') { format!("{place}[..]") } else { place.to_owned() };
                self.value(&inner, &about[key]);
            }
        }
        for other in about["anyOf"].as_array().into_iter().flatten() {
            self.value(place, other);
        }
        for one in about["oneOf"].as_array().into_iter().flatten() {
            self.choice(place, one);
        }
    }

    fn choice(&mut self, place: &str, one: &'a Value) {
        for word in words_of(one) {
            self.add(word, place, description(one).to_owned(), false);
        }
        for (name, fields) in one["properties"].as_object().into_iter().flatten() {
            let told = choice(one).map_or_else(String::new, |choice| {
                let example = Some(choice.example).filter(|example| example != name);
                let example = example.map_or_else(String::new, |example| format!("For example: {example}\n"));
                let own = if choice.meaning.is_empty() {
                    description(self.manual.language.resolve(fields).1)
                } else {
                    &choice.meaning
                };
                format!("{example}{own}")
            });
            self.add(name, place, told, false);
            self.value(&format!("{place}: {name}"), fields);
        }
    }

    fn add(&mut self, name: &str, place: &str, told: String, is_field: bool) {
        let same = |part: &&mut LanguagePart| part.name == name && part.told == told && part.is_field == is_field;
        match self.parts.iter_mut().find(same) {
            Some(part) if part.places.iter().any(|other| other == place) => {}
            Some(part) => part.places.push(place.to_owned()),
            None => {
                self.parts.push(LanguagePart { name: name.to_owned(), places: vec![place.to_owned()], told, is_field })
            }
        }
    }
}
