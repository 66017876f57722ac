//! The scene language as JSON schema.
//!
//! A scene in JSON is what it is in RON: `(a: 1)` is `{"a": 1}`, `(1, 2)` is `[1, 2]`, the map `{ "a": 1 }` is itself,
//! `Drag(linear: 1)` is `{"Drag": {"linear": 1}}`, the word `Auto` is `"Auto"`.

use serde_json::{Map, Value, json};

use super::tidy::visit;
use super::{Content, Entry, Language, Section};
use crate::scene::registry::Arity;

/// The sections that every scene has.
const NEEDED: [&str; 2] = ["format", "clock"];

impl Language {
    /// The JSON schema, draft 2020-12, of whole scenes.
    pub fn json(&self) -> Value {
        let outermost = self.sections.iter().filter(|section| !section.name.contains('.'));
        let properties: Map<String, Value> = outermost.map(|section| (section.name.clone(), section.json())).collect();
        let mut schema = json!({
            "$schema": "https://json-schema.org/draft/2020-12/schema",
            "title": "Scene",
            "description": "A scene of Jostle, with `(a: 1)` as {\"a\": 1}, `(1, 2)` as [1, 2], `Drag(linear: 1)` as {\"Drag\": {\"linear\": 1}}.",
            "type": "object",
            "properties": properties,
            "required": NEEDED,
            "additionalProperties": false,
            "$defs": self.definitions,
        });
        self.complete_templates(&mut schema);
        self.put_lists_inside(&mut schema);
        visit(&mut schema, &mut let_be_made);
        schema["$defs"][REPEATED] = json!({
            "type": "object",
            "properties": { "Repeat": { "$ref": "#/$defs/Repeat" } },
            "required": ["Repeat"],
            "additionalProperties": false,
        });
        visit(&mut schema, &mut |schema| {
            if let Some(map) = schema.as_object_mut() {
                map.retain(|key, _| !key.starts_with("x-"));
            }
        });
        schema
    }
}

const REPEATED: &str = "Repeated";

/// Lets stand what makes a value in place of the value: an expression for a number, a parameter for two values, `Repeat`
/// in a list.
fn let_be_made(schema: &mut Value) {
    let Some(map) = schema.as_object_mut() else { return };
    if let Some(kind) = map.get_mut("type")
        && (kind == "number" || kind == "integer" || kind == "array" && map.contains_key("prefixItems"))
    {
        let kind = map["type"].take();
        map["type"] = json!([kind, "string"]);
    }
    if let Some(items) = map.get_mut("items").filter(|items| items.is_object()) {
        let item = items.take();
        *items = json!({ "anyOf": [item, { "$ref": format!("#/$defs/{REPEATED}") }] });
    }
}

impl Language {
    /// A section such as `look.layers` is a field of another one.
    fn put_lists_inside(&self, schema: &mut Value) {
        for section in &self.sections {
            let Some((outer, field)) = section.name.split_once('.') else { continue };
            let whole = &schema["properties"][outer];
            let definition = whole["$ref"].as_str().and_then(|path| path.strip_prefix("#/$defs/")).map(str::to_owned);
            let place = match definition {
                Some(name) => &mut schema["$defs"][name],
                None => &mut schema["properties"][outer],
            };
            place["properties"][field] = section.json();
        }
    }

    /// Templates hold the sections that are lists or maps.
    fn complete_templates(&self, schema: &mut Value) {
        let held = self.sections.iter().filter(|section| match &section.content {
            Content::Entries(arity, _) => *arity == Arity::List,
            Content::Value(Some(schema)) => {
                let (_, about) = self.resolve(schema);
                about["type"] == "array" && about["prefixItems"].is_null() || about["additionalProperties"].is_object()
            }
            Content::Value(None) => true,
        });
        let template = &mut schema["$defs"]["Template"];
        template["additionalProperties"] = Value::Bool(false);
        for section in held {
            let whole = json!({ "$ref": format!("#/properties/{}", section.name) });
            if let Some(fields) = template["properties"].as_object_mut() {
                fields.entry(section.name.clone()).or_insert(whole);
            }
        }
    }
}

impl Section {
    fn json(&self) -> Value {
        match &self.content {
            Content::Value(Some(schema)) => schema.clone(),
            Content::Value(None) => json!({ "description": "No fields are told." }),
            Content::Entries(arity, entries) => {
                let one = one_of_the(entries);
                match arity {
                    Arity::List => json!({ "description": self.meaning, "type": "array", "items": one }),
                    Arity::Words => {
                        let words: Vec<&str> = entries.iter().map(|entry| entry.name).collect();
                        let item = json!({ "anyOf": [{ "enum": words }, one] });
                        json!({ "description": self.meaning, "type": "array", "items": item })
                    }
                    Arity::One => with_description(one, &self.meaning),
                    Arity::OneOrNone => json!({ "description": self.meaning, "anyOf": [one, { "const": "None" }] }),
                }
            }
        }
    }
}

/// `{"Drag": {..}}`: an object of exactly one field. Editors complete that better than a choice of objects.
fn one_of_the(entries: &[Entry]) -> Value {
    let field = |entry: &Entry| (entry.name.to_owned(), entry.schema.clone().unwrap_or(Value::Bool(true)));
    let properties: Map<String, Value> = entries.iter().map(field).collect();
    json!({
        "type": "object",
        "properties": properties,
        "minProperties": 1,
        "maxProperties": 1,
        "additionalProperties": false,
    })
}

fn with_description(mut schema: Value, text: &str) -> Value {
    schema["description"] = Value::from(text);
    schema
}
