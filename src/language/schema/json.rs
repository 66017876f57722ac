//! The scene language as JSON schema.
//!
//! A scene in JSON has the values of the scene in RON. `(a: 1)` is `{"a": 1}`, `(1, 2)` is `[1, 2]`, and the map `{
//! "a": 1 }` is itself. `Drag(linear: 1)` is `{"Drag": {"linear": 1}}`, and the word `Auto` is `"Auto"`.

use serde_json::{Map, Value, json};

use super::tidy::visit;
use super::{Content, Entry, Language, Section};
use crate::registry::Arity;

/// The sections that every scene has.
const NEEDED: [&str; 2] = ["format", "clock"];

impl Language {
    /// The JSON schema, draft 2020-12, of whole scenes.
    pub fn json(&self) -> Value {
        let (inside, outermost): (Vec<&Section>, Vec<&Section>) =
            self.sections.iter().partition(|section| section.name.contains('.'));
        let properties: Map<String, Value> =
            outermost.into_iter().map(|section| (section.name.clone(), section.json(self))).collect();
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
        for list in inside {
            if let Some((definition, field)) = self.field_of(&list.name) {
                let field = &mut schema["$defs"][definition]["properties"][field];
                let description = field.get("description").cloned();
                *field = list.json(self);
                if let Some(description) = description {
                    field["description"] = description;
                }
            }
        }
        self.complete_templates(&mut schema);
        visit(&mut schema, &mut let_be_made);
        let is_structure = |(_, about): &(&String, &Value)| about["type"] == "object";
        let structures: Vec<String> =
            self.definitions.iter().filter(is_structure).map(|(name, _)| format!("#/$defs/{name}")).collect();
        for definition in schema["$defs"].as_object_mut().into_iter().flat_map(Map::values_mut) {
            visit(definition, &mut |part| name_structures(part, &structures));
        }
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

/// Allows a value to be made: an expression for a number, a parameter for two values, `Repeat` in a list.
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

/// Allows the name of a parameter in place of a structure.
fn name_structures(schema: &mut Value, structures: &[String]) {
    // `get_mut`, because an index would add the key to a schema without it.
    let fields = schema.get_mut("properties").and_then(Value::as_object_mut);
    for field in fields.into_iter().flat_map(Map::values_mut) {
        if field["$ref"].as_str().is_some_and(|name| structures.iter().any(|structure| structure == name)) {
            let structure = field["$ref"].take();
            field.as_object_mut().and_then(|field| field.shift_remove("$ref"));
            field["anyOf"] = json!([{ "$ref": structure }, { "type": "string" }]);
        }
    }
}

impl Language {
    /// The entries that need no field.
    fn bare_words(&self, entries: &[Entry]) -> Vec<&'static str> {
        let needs_none = |entry: &&Entry| self.resolve(&entry.schema).1["required"].is_null();
        entries.iter().filter(needs_none).map(|entry| entry.name).collect()
    }

    /// Templates hold the sections that are lists or maps.
    fn complete_templates(&self, schema: &mut Value) {
        let held = self.sections.iter().filter(|section| match &section.content {
            Content::Entries(arity, _) => *arity == Arity::List && !section.name.contains('.'),
            Content::Value(schema) => {
                let (_, about) = self.resolve(schema);
                about["type"] == "array" && about["prefixItems"].is_null() || about["additionalProperties"].is_object()
            }
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
    fn json(&self, language: &Language) -> Value {
        match &self.content {
            Content::Value(schema) => schema.clone(),
            Content::Entries(arity, entries) => {
                let one = one_of_the(entries);
                match arity {
                    Arity::List => json!({ "description": self.meaning, "type": "array", "items": one }),
                    Arity::Words => {
                        let words = language.bare_words(entries);
                        let item = json!({ "anyOf": [one, { "enum": words }] });
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
    let field = |entry: &Entry| (entry.name.to_owned(), entry.schema.clone());
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
