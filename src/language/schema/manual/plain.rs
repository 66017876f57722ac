//! One section or entry in plain words, for the terminal.

use super::{Content, Language, Manual, default_of, in_cell, is_needed, meaning_of};

impl Language {
    /// The meaning of a section or an entry, and a line for each of its fields. The line holds name, value, unit,
    /// default and meaning. `None` if the language has no such section or entry.
    pub fn told(&self, section: &str, entry: Option<&str>) -> Option<String> {
        let section = self.sections.iter().chain([&self.repeat]).find(|other| other.name == section)?;
        let schema = match (entry, &section.content) {
            (None, Content::Value(schema)) => schema,
            (None, Content::Entries(..)) => return Some(section.meaning.clone()),
            (Some(name), Content::Entries(_, entries)) => &entries.iter().find(|entry| entry.name == name)?.schema,
            (Some(_), Content::Value(_)) => return None,
        };
        let manual = Manual::new(self);
        let (_, whole) = self.resolve(schema);
        let mut told = meaning_of(if schema["description"].is_null() { whole } else { schema }).to_owned();
        // The items of a list, the values of a map.
        let mut about = whole;
        for key in ["items", "additionalProperties"] {
            if about[key].is_object() {
                about = self.resolve(&about[key]).1;
            }
        }
        for (name, field) in about["properties"].as_object().into_iter().flatten() {
            let (value, unit) = manual.cell(name, field);
            let unit = if unit.is_empty() { unit } else { format!(" in {unit}") };
            let default = match default_of(field) {
                Some(default) => format!("; default: {default}"),
                None if is_needed(about, name) => "; needed".to_owned(),
                None => String::new(),
            };
            let line = format!("\n  {name}: {value}{unit}{default}. {}", in_cell(meaning_of(field)));
            told.push_str(&line.replace('`', "").replace("\\|", "|"));
        }
        Some(told.trim_start().to_owned())
    }
}
