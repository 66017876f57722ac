//! The possible forms of a value: tables of fields, choices, and short words in a cell.

use serde_json::Value;

use super::{Language, Manual, anchor, default_of, description, in_cell, is_needed, meaning_of};

/// A type that has its own heading: its first path, its name, its schema.
type Nested<'a> = (String, &'a str, &'a Value);

impl<'a> Manual<'a> {
    /// Describes a value: its fields, items or choices, and then all nested values that need a table.
    pub(super) fn value(&mut self, path: &str, schema: &'a Value) {
        let (_, about) = self.language.resolve(schema);
        if let Some(fields) = about["properties"].as_object() {
            return if fields.is_empty() { self.paragraph("It has no fields.") } else { self.table(path, about) };
        }
        if about["additionalProperties"] == false {
            return self.paragraph("It has no fields.");
        }
        if let Some(choices) = about["oneOf"].as_array() {
            return self.choices(path, choices);
        }
        let item = |key: &str| about.get(key).filter(|item| item.is_object());
        if let (Some(items), None) = (item("items"), about.get("x-value")) {
            let told = self.language.resolve(items).0.and_then(|name| self.places.get(name));
            if let Some(place) = told {
                let list = format!("A list. Each item is as [`{place}`](#{}).", anchor(place));
                return self.paragraph(&list);
            }
            self.paragraph("A list. Each item has:");
            return self.value(&format!("{path}[..]"), items);
        }
        if let Some(values) = item("additionalProperties") {
            self.paragraph("A map of names. Each value has:");
            return self.value(&format!("{path}[..]"), values);
        }
        let (value, unit) = self.cell(path, about);
        let unit = if unit.is_empty() { String::new() } else { format!(", in {unit}") };
        self.paragraph(&format!("Value: {value}{unit}."));
    }

    fn table(&mut self, path: &str, about: &'a Value) {
        let fields = about["properties"].as_object().into_iter().flatten();
        let fields: Vec<(&str, &Value)> = fields.map(|(name, schema)| (name.as_str(), schema)).collect();
        let mut nested: Vec<Nested<'a>> = Vec::new();
        for (name, schema) in &fields {
            self.nested(&format!("{path}.{name}"), schema, &mut nested);
        }
        // Places first: the cells below link to them.
        nested.retain(|(path, name, _)| {
            let new = !self.places.contains_key(name);
            self.places.entry(name).or_insert_with(|| path.clone());
            new
        });
        self.line("| field | value | unit | default | meaning |");
        self.line("|---|---|---|---|---|");
        for (name, schema) in &fields {
            let (value, unit) = self.cell(&format!("{path}.{name}"), schema);
            let default = match default_of(schema) {
                Some(default) => default,
                None if is_needed(about, name) => "*needed*".to_owned(),
                None => String::new(),
            };
            let cells = [format!("`{name}`"), value, unit, default, meaning_of(schema).to_owned()];
            let row = cells.map(|cell| in_cell(&cell)).join(" | ");
            self.line(&format!("| {row} |"));
        }
        self.line("");
        for (name, schema) in &fields {
            self.words(name, schema);
        }
        for (path, _, schema) in nested {
            self.paragraph(&format!("### `{path}`"));
            self.paragraph(meaning_of(schema));
            self.value(&path, schema);
        }
    }

    /// The meanings of the words that a field may hold.
    fn words(&mut self, field: &str, schema: &'a Value) {
        let (_, about) = self.language.resolve(schema);
        let Some(choices) = about["oneOf"].as_array().filter(|choices| choices.iter().all(is_word)) else { return };
        if choices.iter().any(|choice| description(choice).is_empty()) {
            return;
        }
        self.paragraph(&format!("`{field}` is one of:"));
        for choice in choices {
            self.line(&format!("* `{}`: {}", word(choice), description(choice)));
        }
        self.line("");
    }

    fn choices(&mut self, path: &str, choices: &'a [Value]) {
        for choice in choices {
            for word in words_of(choice) {
                self.paragraph(&format!("#### `{word}`"));
                self.paragraph(description(choice));
            }
            for (name, fields) in choice["properties"].as_object().into_iter().flatten() {
                let own = description(choice);
                let meaning = if own.is_empty() { description(self.language.resolve(fields).1) } else { own };
                self.paragraph(&format!("#### `{name}(..)`"));
                self.paragraph(meaning);
                self.value(path, fields);
            }
        }
    }

    /// The value of a field in a few words, and its unit.
    pub(super) fn cell(&self, path: &str, schema: &'a Value) -> (String, String) {
        let (name, about) = self.language.resolve(schema);
        let text = |key: &str| about[key].as_str().or(schema[key].as_str()).map(str::to_owned);
        if let Some(place) = name.and_then(|name| self.places.get(name)) {
            let outside = place != path;
            let unlike = if outside { "as " } else { "" };
            return (format!("{unlike}[`{place}`](#{})", anchor(place)), String::new());
        }
        if let (Some(words), more) = (about["enum"].as_array(), text("x-more")) {
            let mut words: Vec<String> = words.iter().map(code).collect();
            words.extend(more);
            return (either(&words), String::new());
        }
        if let (Some(words), Some(more)) = (about["examples"].as_array(), text("x-more")) {
            let mut words: Vec<String> = words.iter().map(|word| format!("`{word}`")).collect();
            words.push(more);
            return (either(&words), String::new());
        }
        if let Some(value) = text("x-value") {
            return (value, text("x-unit").unwrap_or_default());
        }
        let several = |list: &'a Value| -> Vec<(String, String)> {
            list.as_array().into_iter().flatten().map(|one| self.cell(path, one)).collect()
        };
        for key in ["anyOf", "oneOf"] {
            if let Some(choices) = about[key].as_array() {
                let named =
                    |choice: &Value| choice["required"][0].as_str().filter(|_| key == "oneOf").map(str::to_owned);
                let choices = choices.iter().flat_map(|choice| match words_of(choice).as_slice() {
                    [] => match named(choice) {
                        Some(name) => vec![(format!("`{name}(..)`"), String::new())],
                        None => vec![self.cell(path, choice)],
                    },
                    words => words.iter().map(|word| (format!("`{word}`"), String::new())).collect(),
                });
                let cells: Vec<_> = choices.collect();
                let unit = cells.iter().map(|(_, unit)| unit.clone()).find(|unit| !unit.is_empty());
                let values: Vec<String> = cells.into_iter().map(|(value, _)| value).collect();
                return (either(&values), unit.unwrap_or_default());
            }
        }
        if about["prefixItems"].is_array() {
            let cells = several(&about["prefixItems"]);
            let (first, unit) = cells.first().cloned().unwrap_or_default();
            let values: Vec<String> = cells.into_iter().map(|(value, _)| value).collect();
            if values.len() == 2 && values.iter().all(|value| *value == first) {
                return (format!("`(a, b)`, each {first}"), unit);
            }
            let names: Vec<String> = (b'a'..).take(values.len()).map(|letter| char::from(letter).to_string()).collect();
            return (format!("`({})`: {}", names.join(", "), values.join(", then ")), unit);
        }
        if about["const"].is_string() {
            return (code(&about["const"]), String::new());
        }
        let held = |key: &str| self.cell(&format!("{path}[..]"), &about[key]);
        match about["type"].as_str() {
            Some("array") => {
                let (value, unit) = held("items");
                let value = if value == "text" { "texts".to_owned() } else { value };
                (format!("list of {value}"), unit)
            }
            Some("object") if about["additionalProperties"].is_object() => {
                let (value, unit) = held("additionalProperties");
                (format!("map of names to {value}"), unit)
            }
            Some("object") => {
                let fields = about["properties"].as_object().into_iter().flatten();
                let fields: Vec<String> = fields.map(|(name, _)| format!("{name}: ..")).collect();
                (format!("`({})`", fields.join(", ")), String::new())
            }
            Some("boolean") => ("`true` or `false`".to_owned(), String::new()),
            Some("string") => ("text".to_owned(), String::new()),
            Some("integer") => ("whole number".to_owned(), String::new()),
            Some("number") => ("number".to_owned(), String::new()),
            _ => ("anything".to_owned(), String::new()),
        }
    }

    /// The types in a value that need a heading of their own.
    fn nested(&self, path: &str, schema: &'a Value, found: &mut Vec<Nested<'a>>) {
        let (name, about) = self.language.resolve(schema);
        let wide = about["properties"].is_object()
            || about["oneOf"].as_array().is_some_and(|choices| !choices.iter().all(is_word));
        match name {
            Some(name) if wide => found.push((path.to_owned(), name, about)),
            _ => {
                for choice in about["anyOf"].as_array().into_iter().flatten() {
                    self.nested(path, choice, found);
                }
                for key in ["items", "additionalProperties"] {
                    if about[key].is_object() {
                        self.nested(&format!("{path}[..]"), &about[key], found);
                    }
                }
            }
        }
    }
}

fn code(word: &Value) -> String {
    format!("`{}`", word.as_str().unwrap_or_default())
}

fn word(choice: &Value) -> &str {
    choice["const"].as_str().unwrap_or_default()
}

fn is_word(choice: &Value) -> bool {
    choice["const"].is_string() || choice["enum"].is_array()
}

pub(super) fn words_of(choice: &Value) -> Vec<&str> {
    let several = choice["enum"].as_array().into_iter().flatten();
    choice["const"].as_str().into_iter().chain(several.filter_map(Value::as_str)).collect()
}

/// `a, b or c`.
fn either(words: &[String]) -> String {
    match words {
        [all @ .., last] if !all.is_empty() => format!("{} or {last}", all.join(", ")),
        _ => words.concat(),
    }
}

/// A default as a scene writes it.
pub(super) fn in_ron(value: &Value, schema: &Value, language: &Language) -> String {
    let (_, about) = language.resolve(schema);
    match value {
        Value::Array(list) => {
            let items: Vec<String> = list.iter().map(|item| in_ron(item, &Value::Null, language)).collect();
            let (open, close) = if about["prefixItems"].is_array() { ("(", ")") } else { ("[", "]") };
            format!("{open}{}{close}", items.join(", "))
        }
        Value::String(text) => text.clone(),
        Value::Number(number) => number.as_f64().unwrap_or_default().to_string(),
        other => other.to_string(),
    }
}
